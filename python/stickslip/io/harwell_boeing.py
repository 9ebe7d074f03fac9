"""Harwell-Boeing and Rutherford-Boeing files, the format of ANSYS' HBMAT.

SciPy reads unsymmetric files only, without right-hand sides, with blanks between the numbers and
an E in the exponents; finite-element codes write none of these reliably.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.io.entries import Sparse, columns_of, whole_matrix
from stickslip.io.numbers import real_field, require_whole_numbers, whole_field
from stickslip.io.source import at_line, read_text

_CUT_EXPONENT = re.compile(r"[EeDd][+-]?\d$")
_POWER = re.compile(r"[EeDd]|[0-9.][+-]")
_NUMBER = re.compile(r"[+-]?[0-9.]+(?:[EeDd][+-]?[0-9]+|[+-][0-9]{3,})?")
"""A number in columns that touch: the exponent of three digits or more may have no letter."""
_FORMAT = re.compile(
    r"\(\s*(?P<scale>[0-9]+\s*P\s*,?\s*)?(?P<repeat>[0-9]*)\s*(?P<group>\(?)\s*(?P<kind>[IEDFG])"
    r"\s*(?P<width>[0-9]+)",
    re.I,
)
_FORMATS = re.compile(r"\((?:[^()]|\([^()]*\))*\)")
"""Formats, which may have a group: (1P,3(D25.16))."""
_COUNT = re.compile("[0-9]{1,18}")


class _Block(NamedTuple):
    """Lines that follow each other."""

    first: int
    """Number of the first line, from 1."""
    lines: list[str]


@dataclass(frozen=True)
class _Columns:
    """Numbers in columns of fixed width, a Fortran format such as (1P,3D25.16)."""

    repeat: int
    width: int
    kind: str

    @classmethod
    def parse(cls, written: str) -> _Columns:
        match = _FORMAT.match(written)
        if match is None or (match["scale"] and match["kind"].upper() == "F"):
            raise ValueError(f"unsupported number format {written!r}")
        columns = cls(int(match["repeat"] or 1), int(match["width"]), match["kind"].upper())
        if not (columns.repeat and columns.width):
            raise ValueError(f"unsupported number format {written!r}")
        return columns

    def cards(self, count: int) -> int:
        """Return how many lines `count` numbers fill."""
        return -(-count // self.repeat)

    def numbers(self, block: _Block, count: int, read: Callable[[str], Any]) -> Iterator[Any]:
        """Read `count` numbers from the lines that they fill."""
        self._require_whole(block, count)
        left = count
        for number, line in enumerate(block.lines, block.first):
            expected = min(self.repeat, left)
            # Numbers that touch are parted by the columns; SciPy's writer does not keep to its own.
            words = line.split()
            if len(words) != expected:
                end = expected * self.width
                words = [line[at : at + self.width].strip() for at in range(0, end, self.width)]
                if line[end:].strip():
                    words = []
            if not words or not all(words):
                raise ValueError(f"{expected} numbers announced in line {line.strip()[:60]!r}")
            with at_line(number):
                read_here = [read(word) for word in words]
            yield from read_here
            left -= expected

    def _require_whole(self, block: _Block, count: int) -> None:
        """Refuse lines that end inside a number, as far as the other lines show it.

        Programs write to the end of every column, and in a format with exponents one in all
        numbers or in none. G writes blanks behind numbers without one.
        """
        lines = [line.rstrip() for line in block.lines]
        numbers_on = (min(self.repeat, count - n * self.repeat) for n in range(len(lines)))
        sizes = [self.width * on_line for on_line in numbers_on]
        short = [n for n, line in enumerate(lines) if len(line) < sizes[n]]
        if self.kind in "DE":
            numbers = [_NUMBER.findall(line) for line in lines]
            powers = [[bool(_POWER.search(one)) for one in line] for line in numbers]
            short = [n for n in short if not all(powers[n][-1:])]
            bare = sum(map(len, powers)) - sum(map(sum, powers))
            known = bare == len(short) and sum(map(sum, powers)) > bare
        else:
            full = sum(len(line) == size for line, size in zip(lines, sizes, strict=True))
            known = self.kind != "G" and full > len(short)
        for n in short if known else ():
            with at_line(block.first + n):
                raise ValueError(f"{lines[n][-26:]!r} ends inside a number; the file is not whole")

    def integers(self, block: _Block, count: int) -> NDArray[np.int64]:
        return np.fromiter(self.numbers(block, count, whole_field), np.int64, count)

    def reals(self, block: _Block, count: int) -> NDArray[np.float64]:
        return np.fromiter(self.numbers(block, count, _real), np.float64, count)


def _real(word: str) -> float:
    """Return a number; a Fortran format writes two digits of an exponent and more."""
    if _CUT_EXPONENT.search(word):
        raise ValueError(f"number {word!r} has a cut exponent; the file is not whole")
    return real_field(word)


def read_harwell_boeing(path: Path) -> Sparse:
    """Read an assembled real matrix; symmetric storage is mirrored, right-hand sides are left out.

    References
    ----------
    Duff, Grimes and Lewis, "Users' guide for the Harwell-Boeing sparse matrix collection" (1992);
    "The Rutherford-Boeing sparse matrix collection" (1997).
    """
    text = read_text(path, "latin-1")
    lines = text.rstrip().split("\n") if text.strip() else []
    if len(lines) < 4:
        raise ValueError(f"the header has 4 lines, the file {len(lines)}")
    total, *cards = _whole_numbers(lines[1], 4)[:5]
    kind = lines[2][:3].upper()
    _require_supported(kind)
    height, width, entries = _whole_numbers(lines[2][3:], 3)[:3]
    formats = [_Columns.parse(written) for written in _FORMATS.findall(lines[3])[:3]]
    if len(formats) < 3:
        raise ValueError("line 4 does not hold three number formats")
    start, blocks = 5 if sum(cards[3:]) else 4, []
    end = start + total
    counts = (width + 1, entries, entries)
    if entries > height * width:
        raise ValueError(f"{entries} entries announced for {height} x {width}")
    if sum(counts) > len(text):
        raise ValueError(f"{sum(counts)} numbers announced in {len(text)} characters")
    named = zip(("pointers", "rows", "values"), counts, formats, cards, strict=False)
    for name, count, written, announced in named:
        needed = written.cards(count)
        if needed != announced:
            raise ValueError(f"{announced} lines of {name} announced, {count} fill {needed}")
        blocks.append(_Block(start + 1, lines[start : start + needed]))
        start += needed
    if total != sum(cards):
        raise ValueError(f"{total} lines announced in all, but {sum(cards)} by parts")
    if end != len(lines):
        raise ValueError(f"{end} lines announced, {len(lines)} present")
    require_whole_numbers(text)
    pointers = formats[0].integers(blocks[0], counts[0]) - 1
    rows = formats[1].integers(blocks[1], entries) - 1
    values = formats[2].reals(blocks[2], entries)
    symmetry = {"S": "symmetric", "Z": "skew-symmetric"}.get(kind[1], "general")
    return whole_matrix((height, width), rows, columns_of(pointers, rows), values, symmetry)


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
    if len(words) < least or not all(map(_COUNT.fullmatch, words)):
        raise ValueError(f"header line {line.strip()[:60]!r} does not hold {least} counts")
    return list(map(int, words))
