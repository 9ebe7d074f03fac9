"""Matrices out of the entries that files hold: all of them, or those of one triangle.

Rows and columns count from 0 here. What does not fit raises `ValueError` with the reason.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import MAX_SPARSE

if TYPE_CHECKING:
    from scipy.sparse import coo_array

Sparse: TypeAlias = "coo_array"
"""Of SciPy, which takes long to load."""

SIGNS = {"general": 0, "symmetric": 1, "skew-symmetric": -1}
"""What an entry is multiplied by when it is mirrored; 0: it is not."""

_Indices: TypeAlias = NDArray[np.int64]


@dataclass(frozen=True)
class Labelled:
    """A matrix and the names of its rows, "node.direction"; None where the file has none."""

    matrix: Any
    dofs: tuple[str, ...] | None


def node_names(nodes: Iterable[Any], directions: Iterable[Any]) -> tuple[str, ...]:
    """Return "node.direction" for each row."""
    return tuple(f"{node}.{way}" for node, way in zip(nodes, directions, strict=True))


def require_size(*shape: int) -> None:
    """Refuse a matrix of more than `MAX_SPARSE` rows or columns before anything of it is made."""
    if max(shape) > MAX_SPARSE or min(shape) < 0:
        raise ValueError(f"{' x '.join(map(str, shape))} entries; at most {MAX_SPARSE} rows")


def require_once(rows: _Indices, columns: _Indices, width: int) -> None:
    """Refuse entries of which two stand at the same place, in a matrix of `width` columns."""
    places = np.sort(rows * width + columns)
    twice = places[1:][places[1:] == places[:-1]]
    if twice.size:
        row, column = divmod(int(twice[0]), width)
        raise ValueError(f"entry ({row + 1}, {column + 1}) is given twice")


def columns_of(pointers: _Indices, rows: _Indices) -> _Indices:
    """Return the column of each entry of a matrix stored by columns, which begin at `pointers`.

    The rows of a column must ascend: else an entry was lost, or is there twice.
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
    rows: _Indices,
    columns: _Indices,
    values: NDArray[np.float64],
    symmetry: str,
) -> Sparse:
    """Return a sparse matrix from its entries; one that is not "general" is given by a triangle.

    `symmetry` is a key of `SIGNS`.
    """
    require_size(*shape)
    for indices, size, kind in ((rows, shape[0], "row"), (columns, shape[1], "column")):
        if indices.size and not (indices.min() >= 0 and indices.max() < size):
            raise ValueError(f"a {kind} index lies outside 1 to {size}")
    require_once(rows, columns, shape[1])
    sign = SIGNS[symmetry]
    if sign:
        if shape[0] != shape[1]:
            raise ValueError(f"{symmetry}, but {shape[0]} x {shape[1]}")
        if (rows > columns).any() and (rows < columns).any():
            raise ValueError(f"{symmetry}, but entries on both sides of the diagonal")
        if sign < 0 and (values[rows == columns] != 0.0).any():
            raise ValueError(f"{symmetry}, but an entry on the diagonal is not 0")
    return _mirrored(shape, rows, columns, values, sign)


def square_matrix(
    rows: _Indices, columns: _Indices, values: NDArray[np.float64], size: int
) -> Sparse:
    """Return a matrix given whole or by one triangle, in formats that do not say which.

    If no place beside the diagonal has its mirror place, one triangle is taken to be given and is
    mirrored. Where some have and others not, or a row has entries beside a diagonal that is
    missing, the file was cut short.
    """
    require_size(size)
    require_once(rows, columns, size)
    off = rows != columns
    mirrored = np.isin((rows * size + columns)[off], columns[off] * size + rows[off])
    if mirrored.any() and not mirrored.all():
        row, column = (int(index[off][~mirrored][0]) + 1 for index in (rows, columns))
        raise ValueError(f"entry ({row}, {column}) lacks its mirror entry; the file is not whole")
    whole = _mirrored((size, size), rows, columns, values, 0 if mirrored.any() else 1)
    # A matrix that is not symmetric, gyroscopic terms, may have no diagonal.
    if (whole - whole.T).count_nonzero() == 0:
        diagonal = np.zeros(size)
        diagonal[rows[~off]] = values[~off]
        touched = np.union1d(rows[off & (values != 0.0)], columns[off & (values != 0.0)])
        bare = touched[diagonal[touched] == 0.0]
        if bare.size:
            raise ValueError(
                f"row {int(bare[0]) + 1} has entries but no diagonal; the file is not whole"
            )
    return whole


def _mirrored(
    shape: tuple[int, int],
    rows: _Indices,
    columns: _Indices,
    values: NDArray[np.float64],
    sign: int,
) -> Sparse:
    """Return the matrix of entries and, unless the sign is 0, of their mirror entries."""
    from scipy.sparse import coo_array

    if sign:
        off = rows != columns
        rows, columns, values = (
            np.concatenate([rows, columns[off]]),
            np.concatenate([columns, rows[off]]),
            np.concatenate([values, sign * values[off]]),
        )
    return coo_array((values, (rows, columns)), shape=shape)
