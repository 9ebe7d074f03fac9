"""MatrixMarket files.

SciPy's reader (1.17) takes truncated files of symmetric arrays for whole and can bring the process
down on truncated numbers; this one refuses both.
"""

from __future__ import annotations

import gzip
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import MAX_DENSE
from stickslip.io.entries import SIGNS, Sparse, whole_matrix
from stickslip.io.numbers import require_whole_numbers, table_of
from stickslip.io.source import plain, unzip

_FIELDS = {"real": False, "double": False, "integer": True, "unsigned-integer": True}
"""Whether the values are whole numbers."""
_ENTRY = np.dtype([("row", np.int64), ("column", np.int64), ("value", np.float64)])
_COMMENTS = re.compile(r"(?:[ \t]*(?:%[^\n]*)?\n)*")
_HEAD, _LINE, _LARGEST = 2**20, 256, 2**28
"""Bytes of comments, of one entry and of all that a packed file may have unpacked."""


@dataclass(frozen=True)
class _Head:
    """What the file says before its entries."""

    layout: str
    whole: bool
    symmetry: str
    rows: int
    columns: int
    entries: int
    end: int
    """Where the entries begin."""

    @classmethod
    def parse(cls, text: str) -> _Head:
        header, _, rest = text.partition("\n")
        layout, whole, symmetry = _header(header)
        comments = _COMMENTS.match(rest)
        start = comments.end() if comments else 0
        line = rest[start:].partition("\n")[0]
        end = len(header) + 1 + start + len(line) + 1
        if layout == "coordinate":
            rows, columns, entries = _sizes(line, 3)
        else:
            rows, columns = _sizes(line, 2)
            if rows * columns > MAX_DENSE**2:
                raise ValueError(f"{rows} x {columns} entries; write such a matrix in coordinates")
            # A triangle has its diagonal, a skew one not.
            sign = SIGNS[symmetry]
            entries = rows * (rows + sign) // 2 if sign else rows * columns
        return cls(layout, whole, symmetry, rows, columns, entries, end)


def read_matrix_market(path: Path) -> Sparse:
    """Read a real matrix in coordinate or array format; one triangle is mirrored.

    A file whose name ends in `.gz` is packed.

    References
    ----------
    Boisvert, Pozo and Remington, "The Matrix Market exchange formats", NISTIR 5935 (1996).
    """
    content = _unpacked(path) if path.suffix.lower() == ".gz" else path.read_bytes()
    text = plain(content, "latin-1")
    head = _Head.parse(text)
    require_whole_numbers(text)
    if head.layout == "coordinate":
        table = _table(text, head, _ENTRY)
        row, column, values = table["row"] - 1, table["column"] - 1, table["value"]
    else:
        values = _table(text, head, np.dtype(np.float64))
        row, column = _places(head.rows, head.columns, SIGNS[head.symmetry])
    if head.whole and (values != np.rint(values)).any():
        raise ValueError("integers announced, and an entry is none")
    return whole_matrix((head.rows, head.columns), row, column, values, head.symmetry)


def _unpacked(path: Path) -> bytes:
    with gzip.open(path) as packed:
        start = packed.read(_HEAD)
    entries = _Head.parse(plain(start, "latin-1")).entries
    return unzip(path, min(_LARGEST, _HEAD + _LINE * entries))


def _header(line: str) -> tuple[str, bool, str]:
    """Return layout, whether the values are whole numbers, and symmetry."""
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
    return layout, _FIELDS[field], symmetry


def _sizes(line: str, count: int) -> list[int]:
    words = line.split()
    if len(words) != count or not all(word.isdigit() and word.isascii() for word in words):
        raise ValueError(f"size line {line.strip()[:30]!r} does not hold {count} counts")
    return list(map(int, words))


def _table(whole: str, head: _Head, dtype: np.dtype[Any]) -> NDArray[Any]:
    """Read one entry per line."""
    table, text = np.empty(0, dtype), whole[head.end :]
    if text.strip():
        if not text.isascii() or "_" in text:
            text = re.sub(r"%[^\n]*", "", text)
        if not text.isascii() or "_" in text:
            raise ValueError("characters that are no part of a number")
        table = table_of(text, dtype, 1 + whole.count("\n", 0, head.end))
    if table.size != head.entries:
        raise ValueError(f"{head.entries} entries announced, {table.size} present")
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
