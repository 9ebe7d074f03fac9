"""Harwell-Boeing and Rutherford-Boeing files, the format of ANSYS' HBMAT.

SciPy reads unsymmetric files only, without right-hand sides, with blanks between the numbers and
an E in the exponents; finite-element codes write none of these reliably.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stickslip.io.triangle import require_whole_numbers, whole_matrix

if TYPE_CHECKING:
    from scipy.sparse import coo_array

__all__ = ["read_harwell_boeing"]

_FORMAT = re.compile(
    r"\(\s*(?P<scale>\d+\s*P\s*,?\s*)?(?P<repeat>\d*)\s*(?P<kind>[IEDFG])\s*(?P<width>\d+)", re.I
)
# Fortran drops the letter of an exponent of three digits: 1.5-101.
_BARE_EXPONENT = re.compile(r"(?<=[0-9.])([+-]\d+)$")


@dataclass(frozen=True)
class _Columns:
    """Numbers in columns of fixed width, a Fortran format such as (1P,3D25.16)."""

    repeat: int
    width: int

    @classmethod
    def parse(cls, written: str) -> _Columns:
        match = _FORMAT.match(written)
        if match is None or (match["scale"] and match["kind"].upper() == "F"):
            raise ValueError(f"unsupported number format {written!r}")
        columns = cls(int(match["repeat"] or 1), int(match["width"]))
        if not (columns.repeat and columns.width):
            raise ValueError(f"unsupported number format {written!r}")
        return columns

    def fields(self, lines: list[str], count: int) -> Iterator[str]:
        """Cut the first `count` numbers out of the lines."""
        left = count
        for line in lines:
            expected = min(self.repeat, left)
            # Columns count where numbers touch; SciPy's writer does not keep to its own columns.
            words = line.split()
            if len(words) != expected:
                places = range(0, expected * self.width, self.width)
                words = [line[place : place + self.width].strip() for place in places]
            if not all(words):
                raise ValueError(f"{expected} numbers announced in line {line.strip()[:60]!r}")
            yield from words
            left -= expected
        if left:
            raise ValueError(f"{count} numbers announced, {count - left} present")

    def integers(self, lines: list[str], count: int) -> NDArray[np.int64]:
        return np.fromiter(map(int, self.fields(lines, count)), dtype=np.int64, count=count)

    def reals(self, lines: list[str], count: int) -> NDArray[np.float64]:
        return np.fromiter(map(_real, self.fields(lines, count)), dtype=np.float64, count=count)


@dataclass(frozen=True)
class _Header:
    """What the first four or five lines say."""

    kind: str
    rows: int
    columns: int
    entries: int
    lengths: tuple[int, int, int]
    formats: tuple[_Columns, _Columns, _Columns]
    lines: int

    @classmethod
    def parse(cls, lines: list[str]) -> _Header:
        if len(lines) < 4:
            raise ValueError(f"the header has 4 lines, the file {len(lines)}")
        cards = _whole_numbers(lines[1], 4)
        kind = lines[2][:3].upper()
        _require_supported(kind)
        rows, columns, entries = _whole_numbers(lines[2][3:], 3)[:3]
        formats = [_Columns.parse(written) for written in re.findall(r"\([^()]*\)", lines[3])[:3]]
        if len(formats) < 3:
            raise ValueError("line 4 does not hold three number formats")
        has_right_side = len(cards) > 4 and cards[4] > 0
        return cls(
            kind,
            rows,
            columns,
            entries,
            (cards[1], cards[2], cards[3]),
            (formats[0], formats[1], formats[2]),
            5 if has_right_side else 4,
        )


def read_harwell_boeing(path: Path) -> coo_array:
    """Read an assembled real matrix; symmetric storage is mirrored.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    scipy.sparse.coo_array
        The whole matrix. Right-hand sides in the file are left out.

    Raises
    ------
    ValueError
        With the reason, if the file is not of the format, damaged, or holds a matrix that is
        complex, elemental or a pattern without values.

    References
    ----------
    Duff, Grimes and Lewis, "Users' guide for the Harwell-Boeing sparse matrix collection" (1992);
    "The Rutherford-Boeing sparse matrix collection" (1997).
    """
    text = path.read_text(encoding="latin-1")
    lines = text.splitlines()
    header = _Header.parse(lines)
    require_whole_numbers(text)
    blocks = []
    start = header.lines
    for length in header.lengths:
        blocks.append(lines[start : start + length])
        start += length
    if len(lines) < start:
        raise ValueError(f"{start} lines announced, {len(lines)} present")
    pointers = header.formats[0].integers(blocks[0], header.columns + 1) - 1
    rows = header.formats[1].integers(blocks[1], header.entries) - 1
    values = header.formats[2].reals(blocks[2], header.entries)
    steps = np.diff(pointers)
    if pointers[0] != 0 or pointers[-1] != header.entries or (steps < 0).any():
        raise ValueError("the column pointers do not ascend from 1 to the number of entries + 1")
    columns = np.repeat(np.arange(header.columns), steps)
    symmetry = {"S": "symmetric", "Z": "skew-symmetric"}.get(header.kind[1], "general")
    return whole_matrix((header.rows, header.columns), rows, columns, values, symmetry)


def _require_supported(kind: str) -> None:
    if not re.fullmatch("[RICPQ][SUHZR][AE]", kind):
        raise ValueError(f"unknown matrix type {kind!r}")
    if kind[0] == "C" or kind[1] == "H":
        raise ValueError(f"the matrix is complex (type {kind}); export real matrices")
    if kind[0] in "PQ":
        raise ValueError(f"the file holds a pattern without values (type {kind})")
    if kind[2] == "E":
        raise ValueError(f"the matrix is elemental (type {kind}); export it assembled")


def _whole_numbers(line: str, least: int) -> list[int]:
    words = line.split()
    if len(words) < least or not all(word.isdigit() for word in words):
        raise ValueError(f"header line {line.strip()[:60]!r} does not hold {least} counts")
    return list(map(int, words))


def _real(field: str) -> float:
    try:
        return float(field)
    except ValueError:
        number = field.upper().replace("D", "E")
        return float(_BARE_EXPONENT.sub(r"E\1", number) if "E" not in number else number)
