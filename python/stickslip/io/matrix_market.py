"""MatrixMarket files.

SciPy's reader (1.17) takes truncated files of symmetric arrays for whole and can bring the process
down on truncated numbers; this one refuses both.
"""

from __future__ import annotations

import gzip
import io
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stickslip.io.triangle import SIGNS, require_whole_numbers, whole_matrix

if TYPE_CHECKING:
    from scipy.sparse import coo_array

__all__ = ["read_matrix_market"]

_FIELDS = ("real", "double", "integer", "unsigned-integer")
_ENTRY = np.dtype([("row", np.int64), ("column", np.int64), ("value", np.float64)])
_COMMENTS = re.compile(r"(?:[ \t]*(?:%[^\n]*)?\n)*")


def read_matrix_market(path: Path) -> coo_array:
    """Read a real matrix in coordinate or array format; one triangle is mirrored.

    Parameters
    ----------
    path : Path
        The file, packed by gzip if its name ends in `.gz`.

    Returns
    -------
    scipy.sparse.coo_array
        The whole matrix.

    Raises
    ------
    ValueError
        With the reason, if the file is not of the format, damaged, or holds a matrix that is
        complex or a pattern without values.

    References
    ----------
    Boisvert, Pozo and Remington, "The Matrix Market exchange formats", NISTIR 5935 (1996).
    """
    packed = path.suffix.lower() == ".gz"
    content = gzip.decompress(path.read_bytes()) if packed else path.read_bytes()
    header, _, text = content.decode("latin-1").replace("\r\n", "\n").partition("\n")
    layout, symmetry = _header(header)
    require_whole_numbers(text)
    start = _COMMENTS.match(text)
    sizes, _, body = text[start.end() if start else 0 :].partition("\n")
    if layout == "coordinate":
        rows, columns, entries = _sizes(sizes, 3)
        table = _table(body, _ENTRY, entries)
        row, column, values = table["row"] - 1, table["column"] - 1, table["value"]
    else:
        rows, columns = _sizes(sizes, 2)
        # A triangle has its diagonal, a skew one not.
        sign = SIGNS[symmetry]
        entries = rows * (rows + sign) // 2 if sign else rows * columns
        values = _table(body, np.dtype(np.float64), entries)
        row, column = _places(rows, columns, sign)
    return whole_matrix((rows, columns), row, column, values, symmetry)


def _header(line: str) -> tuple[str, str]:
    """Return layout and symmetry."""
    words = line.lower().split()
    if len(words) != 5 or words[:2] != ["%%matrixmarket", "matrix"]:
        raise ValueError("no %%MatrixMarket matrix header")
    layout, field, symmetry = words[2:]
    if layout not in ("coordinate", "array"):
        raise ValueError(f"unknown layout {layout!r}")
    if field == "complex" or symmetry == "hermitian":
        raise ValueError("the matrix is complex; export real matrices")
    if field == "pattern":
        raise ValueError("the file holds a pattern without values")
    if field not in _FIELDS or symmetry not in SIGNS:
        raise ValueError(f"unknown kind of matrix {field!r}, {symmetry!r}")
    return layout, symmetry


def _sizes(line: str, count: int) -> list[int]:
    words = line.split()
    if len(words) != count or not all(word.isdigit() and word.isascii() for word in words):
        raise ValueError(f"size line {line.strip()[:60]!r} does not hold {count} counts")
    return list(map(int, words))


def _table(text: str, dtype: np.dtype[Any], entries: int) -> NDArray[Any]:
    """Read one entry per line."""
    table = np.empty(0, dtype)
    if text.strip():
        # Fortran writes exponents with a D.
        lines = io.StringIO(text.upper().replace("D", "E"))
        table = np.loadtxt(lines, dtype, comments="%", ndmin=1)
    if table.size != entries:
        raise ValueError(f"{entries} entries announced, {table.size} present")
    return table


def _places(rows: int, columns: int, sign: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return rows and columns in the order in which an array file lists its entries."""
    if not sign:
        place = np.arange(rows * columns)
        return place % rows, place // rows
    if rows != columns:
        raise ValueError(f"symmetric, but {rows} x {columns}")
    # The upper triangle by rows is the lower one by columns.
    column, row = np.triu_indices(rows, 1 if sign < 0 else 0)
    return row, column
