"""Curves that tests have written: text files of two columns."""

from __future__ import annotations

import re
from os import PathLike

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import file_path
from stickslip.errors import ModelError
from stickslip.io.numbers import real_field
from stickslip.io.source import readable

_COLUMNS = 2


def read_curve(path: str | PathLike[str]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Read the first two columns of a text file, as CSV files have them.

    Fields are separated by commas, semicolons, tabs or spaces. Lines before the first number, and
    lines that begin with # or %, are passed over.

    Parameters
    ----------
    path : path-like
        The file.

    Returns
    -------
    tuple of ndarray of float64, shape (n,)
        The columns.

    Raises
    ------
    ModelError
        If the file is missing, or a line behind the first number has no two numbers.
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
            if len(fields) < _COLUMNS:
                raise ValueError(f"{len(fields)} number")
            rows.append([real_field(field) for field in fields[:_COLUMNS]])
        except ValueError as error:
            if rows:
                raise ModelError(
                    f"{file}: line {number}: {error}; give two numbers per line"
                ) from None
    if not rows:
        raise ModelError(f"{file}: no line with two numbers; give frequency and amplitude")
    first, second = np.array(rows).T
    return np.ascontiguousarray(first), np.ascontiguousarray(second)
