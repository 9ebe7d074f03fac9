"""Columns of numbers in text files: curves that tests have written, and small matrices."""

from __future__ import annotations

import re
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import file_path, whole_number
from stickslip.errors import ModelError
from stickslip.io.numbers import real_field
from stickslip.io.source import readable

_ENDS = ",; \t"
"""What may stand behind the last field."""
_WORDS = {2: "two numbers", 3: "three numbers"}


def read_curve(path: str | PathLike[str], columns: int = 2) -> tuple[NDArray[np.float64], ...]:
    """Read the first columns of a text file, two or three, as CSV files have them.

    Fields are separated by commas, semicolons, tabs or spaces. Where something else separates them,
    a comma is a decimal point: 20,5;0,0012. Lines before the first number, and lines that begin
    with # or %, are passed over.

    Parameters
    ----------
    path : path-like
        The file.
    columns : {2, 3}, optional
        How many.

    Returns
    -------
    tuple of ndarray of float64, shape (n,)
        The columns.

    Raises
    ------
    ModelError
        If the file is missing, or a line behind the first number has too few.
    """
    size = whole_number(columns, "columns", smallest=2, largest=3)
    rows = _rows(file_path(path, "curve"), size)
    return tuple(np.ascontiguousarray(one) for one in np.array(rows).T)


def read_table(file: Path) -> NDArray[np.float64]:
    """Read a matrix, a row per line, all of them as long; see `read_curve`."""
    return np.array(_rows(file, None))


def _rows(file: Path, columns: int | None) -> list[list[float]]:
    """Return the first columns of all lines, or all of them."""
    rows: list[list[float]] = []
    wanted = "a row of numbers" if columns is None else _WORDS[columns]
    with readable(file, "a table of numbers"):
        text = file.read_text(encoding="utf-8-sig")
    for number, line in enumerate(text.splitlines(), 1):
        fields = _fields(line.strip())
        if not line.strip() or line.strip()[0] in "#%":
            continue
        size = columns or len(rows[0] if rows else fields) or 1
        try:
            if len(fields) < size or (columns is None and len(fields) > size):
                raise ValueError(f"{len(fields)} number" + "s" * (len(fields) != 1))
            if not all(fields[:size]):
                raise ValueError("an empty field")
            rows.append([_number(field) for field in fields[:size]])
        except ValueError as error:
            if rows or not _is_heading(line, columns):
                raise ModelError(
                    f"{file}: line {number}: {error}; give {wanted} per line"
                ) from None
    if not rows:
        raise ModelError(f"{file}: no line with {wanted}; give numbers in columns")
    return rows


def _fields(line: str) -> list[str]:
    """Return the fields of a line; commas in them are decimal points."""
    body = line.rstrip(_ENDS)
    # What is left of 20,5; is one number whose neighbour is missing.
    alone = len(body.split()) == 1 and ";" not in line
    if ";" in body:
        fields = body.split(";")
    elif "," in body and (alone or re.search(r",\s|\s,", body)):
        fields = body.split(",")
    else:
        fields = body.split()
    return [field.strip() for field in fields]


def _is_heading(line: str, columns: int | None) -> bool:
    """Return whether a line before the first number begins with something else than numbers.

    That of a table, of which no row may be lost, has words and no number at all.
    """
    if columns is None:
        fields = _fields(line.strip())
        return bool(fields) and not any(map(_is_number, fields))
    words = re.split(r"[,;\s]+", line.strip(_ENDS))
    return len(words) < columns or not all(map(_is_number, words[:columns]))


def _is_number(word: str) -> bool:
    try:
        real_field(word)
    except ValueError:
        return False
    return True


def _number(field: str) -> float:
    if "," not in field:
        return real_field(field)
    if "." in field or field.count(",") > 1:
        raise ValueError(f"{field[:40]!r} has a comma beside a point")
    return real_field(field.replace(",", "."))
