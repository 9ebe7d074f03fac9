"""Curves that tests have written: text files of two columns, or three."""

from __future__ import annotations

import re
from os import PathLike

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import file_path
from stickslip.errors import ModelError
from stickslip.io.numbers import real_field
from stickslip.io.source import readable

_WORDS = {2: "two numbers", 3: "three numbers"}


def read_curve(path: str | PathLike[str], columns: int = 2) -> tuple[NDArray[np.float64], ...]:
    """Read the first columns of a text file, two or three, as CSV files have them.

    Fields are separated by commas, semicolons, tabs or spaces. Lines before the first number, and
    lines that begin with # or %, are passed over.

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
    file = file_path(path, "curve")
    rows: list[list[float]] = []
    with readable(file, "a table of numbers"):
        text = file.read_text(encoding="utf-8-sig")
    for number, line in enumerate(text.splitlines(), 1):
        fields = re.split(r"[,;\s]+", line.strip().strip(",;"))
        if not fields[0] or fields[0][0] in "#%":
            continue
        try:
            if len(fields) < columns:
                raise ValueError(f"{len(fields)} number")
            rows.append([real_field(field) for field in fields[:columns]])
        except ValueError as error:
            if rows:
                raise ModelError(
                    f"{file}: line {number}: {error}; give {_WORDS[columns]} per line"
                ) from None
    if not rows:
        raise ModelError(f"{file}: no line with {_WORDS[columns]}; give numbers in columns")
    return tuple(np.ascontiguousarray(one) for one in np.array(rows).T)
