"""Whole matrices out of the triangle that files of symmetric matrices hold."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import MAX_SPARSE

if TYPE_CHECKING:
    from scipy.sparse import coo_array

__all__ = ["SIGNS", "columns_of", "require_size", "require_whole_numbers", "whole_matrix"]

# Fortran drops the letter of an exponent of three digits.
_EXPONENT = re.compile(r"(?:[ED][+-]?|(?<=[\d.])[+-])(\d+)[ \t\r]*$", re.I)

SIGNS = {"general": 0, "symmetric": 1, "skew-symmetric": -1}
"""What an entry is multiplied by when it is mirrored; 0: it is not."""


def require_whole_numbers(text: str) -> None:
    """Refuse a text that ends inside a number, as far as that can be seen.

    Parameters
    ----------
    text : str
        Lines of numbers. Many programs do not end the last line.

    Raises
    ------
    ValueError
        If the last line does not end, and its last number has no exponent or a shorter one than
        those of the lines before.
    """
    if text.endswith("\n") or not text:
        return
    *lines, last = text[-4000:].split("\n")
    digits = [len(found[1]) if (found := _EXPONENT.search(line)) else 0 for line in lines[-5:]]
    # Two digits are the rule, three the exception.
    least = min(2, *digits) if len(digits) > 2 else 0
    own = _EXPONENT.search(last)
    stops = re.search(r"[ED+.-]\s*$", last, re.I) is not None
    if stops or (len(own[1]) if own else 0) < least:
        raise ValueError(f"the last number, {last[-12:]!r}, is not whole; the file was cut short")


def require_size(*shape: int) -> None:
    """Refuse a matrix of more than `MAX_SPARSE` rows or columns before anything of it is made.

    Raises
    ------
    ValueError
        If it is larger, or a size is negative.
    """
    if max(shape) > MAX_SPARSE or min(shape) < 0:
        raise ValueError(f"{' x '.join(map(str, shape))} entries; at most {MAX_SPARSE} rows")


def columns_of(pointers: NDArray[np.int64], rows: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the column of each entry of a matrix stored by columns.

    Parameters
    ----------
    pointers : ndarray of int64, shape (columns + 1,)
        Where each column begins, from 0.
    rows : ndarray of int64, shape (entries,)
        The rows.

    Raises
    ------
    ValueError
        If the pointers do not ascend from 0 to the number of entries, or the rows of a column do
        not ascend: an entry was lost, or is there twice.
    """
    steps = np.diff(pointers)
    if pointers[0] != 0 or pointers[-1] != rows.size or (steps < 0).any():
        raise ValueError("the column pointers do not ascend from 1 to the number of entries + 1")
    columns = np.repeat(np.arange(steps.size), steps)
    wrong = np.flatnonzero((np.diff(columns) == 0) & (np.diff(rows) <= 0))
    if wrong.size:
        at = wrong[0]
        raise ValueError(
            f"column {columns[at] + 1}: row {rows[at + 1] + 1} follows row {rows[at] + 1}; "
            "rows must ascend"
        )
    return columns


def whole_matrix(
    shape: tuple[int, int],
    rows: NDArray[np.int64],
    columns: NDArray[np.int64],
    values: NDArray[np.float64],
    symmetry: str,
) -> coo_array:
    """Return a sparse matrix from its entries.

    Parameters
    ----------
    shape : tuple of int
        Rows and columns of the matrix.
    rows, columns : ndarray of int64, shape (entries,)
        Counted from 0.
    values : ndarray of float64, shape (entries,)
        One entry per place.
    symmetry : str
        A key of `SIGNS`. A matrix that is not "general" is given by one triangle.

    Returns
    -------
    scipy.sparse.coo_array
        The whole matrix.

    Raises
    ------
    ValueError
        If an entry lies outside the matrix or is given twice, or a symmetric one is not square, has
        entries in both triangles, or a skew one on its diagonal.
    """
    from scipy.sparse import coo_array

    require_size(*shape)
    for indices, size, kind in ((rows, shape[0], "row"), (columns, shape[1], "column")):
        if indices.size and not (indices.min() >= 0 and indices.max() < size):
            raise ValueError(f"a {kind} index lies outside 1 to {size}")
    places = np.sort(rows * shape[1] + columns)
    twice = places[1:][places[1:] == places[:-1]]
    if twice.size:
        row, column = divmod(int(twice[0]), shape[1])
        raise ValueError(f"entry ({row + 1}, {column + 1}) is given twice")
    sign = SIGNS[symmetry]
    if sign:
        if shape[0] != shape[1]:
            raise ValueError(f"{symmetry}, but {shape[0]} x {shape[1]}")
        if (rows > columns).any() and (rows < columns).any():
            raise ValueError(f"{symmetry}, but entries on both sides of the diagonal")
        off = rows != columns
        if sign < 0 and (values[~off] != 0.0).any():
            raise ValueError(f"{symmetry}, but an entry on the diagonal is not 0")
        rows, columns, values = (
            np.concatenate([rows, columns[off]]),
            np.concatenate([columns, rows[off]]),
            np.concatenate([values, sign * values[off]]),
        )
    return coo_array((values, (rows, columns)), shape=shape)
