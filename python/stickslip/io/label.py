"""Matrices whose rows are nodes and directions, one entry a line."""

from __future__ import annotations

import io
import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stickslip.io.fields import require_representable
from stickslip.io.triangle import require_size

if TYPE_CHECKING:
    from scipy.sparse import coo_array

__all__ = ["Labelled", "counted", "entry_table", "node_names", "square_matrix"]


@dataclass(frozen=True)
class Labelled:
    """A matrix and the names of its rows, "node.direction"; None where the file has none."""

    matrix: Any
    dofs: tuple[str, ...] | None


def entry_table(text: str, words: int) -> NDArray[np.float64]:
    """Read lines of `words` numbers each, parted by blanks or commas.

    Parameters
    ----------
    text : str
        The lines.
    words : int
        Numbers per line.

    Returns
    -------
    ndarray of float64, shape (lines, words)
        The numbers; Fortran's exponents with a D are read too.

    Raises
    ------
    ValueError
        If the last line does not end, the sign of a file cut short, a line holds another count of
        numbers, or a number cannot be read or told from zero.
    """
    if not text.endswith("\n"):
        raise ValueError("the last line does not end; the file was cut short")
    if re.search(r",[ \t]*,", text):
        raise ValueError("nothing stands between two commas")
    if not text.split():
        raise ValueError("the file holds no entries")
    text = text.upper().replace("D", "E").replace(",", " ")
    if not set(text) <= set("0123456789+-.E \t\r\n"):
        raise ValueError("characters that are no part of a number")
    table = np.loadtxt(io.StringIO(text), dtype=np.float64, ndmin=2)
    if table.shape[1] != words:
        raise ValueError(f"{table.shape[1]} numbers in a line, {words} expected")
    require_representable(text)
    return table


def counted(numbers: NDArray[np.float64], kind: str) -> NDArray[np.int64]:
    """Return whole numbers that count from 1.

    Raises
    ------
    ValueError
        If one is not whole, or below 1.
    """
    wrong = (numbers != np.rint(numbers)) | (numbers < 1) | (numbers > 2**53)
    if wrong.any():
        raise ValueError(f"{kind} {numbers[wrong][0]:g} is not one of 1, 2, ...")
    return numbers.astype(np.int64)


def node_names(nodes: Iterable[Any], directions: Iterable[Any]) -> tuple[str, ...]:
    """Return "node.direction" for each row."""
    return tuple(f"{node}.{way}" for node, way in zip(nodes, directions, strict=True))


def square_matrix(
    rows: NDArray[np.int64], columns: NDArray[np.int64], values: NDArray[np.float64], size: int
) -> coo_array:
    """Return a matrix given whole or by one triangle, in formats that do not say which.

    Parameters
    ----------
    rows, columns : ndarray of int64, shape (entries,)
        Counted from 0.
    values : ndarray of float64, shape (entries,)
        One entry per place.
    size : int
        Rows of the matrix.

    Returns
    -------
    scipy.sparse.coo_array
        The whole matrix. If no place beside the diagonal has its mirror place, one triangle is
        taken to be given and is mirrored.

    Raises
    ------
    ValueError
        If a place is given twice, some mirror places are given and others not, or a row has
        entries beside a diagonal that is missing: what is left of a file that was cut short.
    """
    from scipy.sparse import coo_array

    require_size(size)
    places = rows * size + columns
    if np.unique(places).size < places.size:
        raise ValueError("an entry is given twice")
    off = rows != columns
    mirrored = np.isin(places[off], columns[off] * size + rows[off])
    if mirrored.any() and not mirrored.all():
        row, column = (int(index[off][~mirrored][0]) + 1 for index in (rows, columns))
        raise ValueError(f"entry ({row}, {column}) lacks its mirror entry; the file is not whole")
    whole = coo_array((values, (rows, columns)), shape=(size, size))
    if not mirrored.any():
        diagonal = np.zeros(size)
        diagonal[rows[~off]] = values[~off]
        touched = np.union1d(rows[off & (values != 0.0)], columns[off & (values != 0.0)])
        bare = touched[diagonal[touched] == 0.0]
        if bare.size:
            raise ValueError(
                f"row {int(bare[0]) + 1} has entries but no diagonal; the file is not whole"
            )
        mirror = coo_array((values[off], (columns[off], rows[off])), shape=(size, size))
        whole = coo_array(whole + mirror)
    return whole
