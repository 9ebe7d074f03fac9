"""OUTPUT4 files of Nastran, text and binary, dense and sparse.

The readers at hand stop at the first odd column number and return what they have by then; this one
counts every record and refuses.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stickslip.io.entries import Sparse, require_size
from stickslip.io.numbers import real_field, whole_field
from stickslip.io.source import Key, Lines, plain

_FORMAT = re.compile(r"\(?(?:1P,?)?(\d+)[ED](\d+)\.\d+(?:E\d+)?\)?", re.I)
_LARGE = 65536
"""Rows from which on a sparse matrix has the addresses of large ones, whatever its sign."""
_SQUARE, _SYMMETRIC = 1, 6
_WITHOUT_ENTRIES = {3: "diagonal", 8: "identity"}
_ROUNDED = 1e-6
"""Asymmetry left by single precision, as a part of the largest entry."""

_Piece = tuple[int, NDArray[np.float64]]
"""The row of the first value, from 1, and the values below each other."""


@dataclass(frozen=True)
class _Header:
    """What precedes a matrix."""

    name: str
    columns: int
    rows: int
    form: int
    kind: int

    def __post_init__(self) -> None:
        if self.columns < 1 or self.rows == 0:
            raise ValueError(f"matrix {self.name!r} has {self.columns} columns, {self.rows} rows")
        if self.kind not in (1, 2, 3, 4):
            raise ValueError(f"matrix {self.name!r} is of unknown type {self.kind}")

    @property
    def words(self) -> int:
        """Words per number, as text counts them: 2 of double precision."""
        return 2 - self.kind % 2

    @property
    def large(self) -> bool:
        """Whether strings of a sparse matrix have two words of address."""
        return self.rows < 0 or self.rows >= _LARGE

    def string(self, address: list[int]) -> tuple[int, int]:
        """Return the words of a string of a sparse matrix, and its row."""
        words, row = address if self.large else divmod(address[0], _LARGE)
        return words - 1, row


def read_op4(path: Path, key: Key) -> Sparse:
    """Read a matrix of a file: text, or binary of either byte order with integers of 4 or 8 bytes.

    Names are in capitals. The whole file is walked through, but only the matrix that is asked for
    must be real, be called so once, and be symmetric if it says so.

    References
    ----------
    MSC Software, "MSC Nastran DMAP Programmer's Guide", module OUTPUT4.
    """
    content = path.read_bytes()
    if len(content) < 16:
        raise ValueError("the file is empty or nearly so")
    found = list(_binary(content) if 0 in content[:4] else _text(content))
    names = [header.name for header, _ in found]
    chosen = Key(path, key.name and key.name.upper()).among(dict.fromkeys(names))
    if names.count(chosen) > 1:
        raise ValueError("the file holds two matrices of this name")
    return _matrix(*found[names.index(chosen)])


_Column = tuple[_Header, list[tuple[int, list[_Piece]]]]
"""A matrix as the walks yield it: what precedes it, and the pieces of each column."""


def _matrix(header: _Header, columns: list[tuple[int, list[_Piece]]]) -> Sparse:
    from scipy.sparse import coo_array

    if header.kind > 2:
        raise ValueError(f"matrix {header.name!r} is complex; export real matrices")
    if header.form in _WITHOUT_ENTRIES:
        kind = _WITHOUT_ENTRIES[header.form]
        raise ValueError(f"matrix {header.name!r} is a packed {kind} one; export it as square")
    size = abs(header.rows)
    require_size(size, header.columns)
    before, rows, places, values = 0, [], [], []
    for column, pieces in columns:
        if not before < column <= header.columns:
            raise ValueError(f"column {column} of {header.name!r} follows column {before}")
        before, below = column, 0
        for first, piece in pieces:
            if first <= below or first + piece.size - 1 > size:
                raise ValueError(f"column {column} of {header.name!r}: row {first} of {size}")
            below = first + piece.size - 1
            rows.append(np.arange(first - 1, below))
            places.append(np.full(piece.size, column - 1))
            values.append(piece)
    nothing = np.empty(0, np.int64)
    indices = np.concatenate([nothing, *rows]), np.concatenate([nothing, *places])
    entries = np.concatenate([np.empty(0), *values])
    matrix = coo_array((entries, indices), shape=(size, header.columns))
    matrix.eliminate_zeros()
    if header.form in (_SQUARE, _SYMMETRIC) and size != header.columns:
        raise ValueError(f"square or symmetric, but {size} x {header.columns}")
    if header.form == _SYMMETRIC and matrix.nnz:
        difference = abs((matrix - matrix.T).tocsr()).max()
        if not difference <= _ROUNDED * abs(matrix).max():
            raise ValueError(f"matrix {header.name!r} calls itself symmetric and is not")
    return matrix


def _binary(content: bytes) -> Iterator[_Column]:
    """Walk through Fortran's records."""
    order = "<" if int.from_bytes(content[:4], "little") in (24, 48) else ">"
    (length,) = struct.unpack_from(f"{order}i", content)
    if length not in (24, 48):
        raise ValueError(f"the first record has {length} bytes, not 24 or 48")
    width = length // 6
    integer = np.dtype(f"{order}i{width}")
    records = _records(content, order)
    for record in records:
        if len(record) != length:
            raise ValueError(f"a record of {len(record)} bytes stands where a matrix must begin")
        sizes = np.frombuffer(record, integer, 4).tolist()
        header = _Header(_name(record[4 * width :].decode("latin-1")), *sizes)
        # Single precision follows the width of integers, double precision has always 8 bytes.
        real = np.dtype(f"{order}f{width if header.kind % 2 else 8}")
        columns = []
        for record in records:
            column, row, words = np.frombuffer(record[: 3 * width], integer, 3).tolist()
            body = record[3 * width :]
            if column > header.columns:
                if column != header.columns + 1:
                    raise ValueError(f"column {column} of {header.columns}")
                break
            if len(body) != words * width:
                raise ValueError(f"column {column}: {words} words announced, {len(body)} bytes")
            if row > 0:
                columns.append((column, [(row, np.frombuffer(body, real).astype(np.float64))]))
            else:
                columns.append((column, list(_strings(body, header, integer, real))))
        else:
            raise ValueError(f"the file ends inside matrix {header.name!r}")
        yield header, columns


def _records(content: bytes, order: str) -> Iterator[bytes]:
    place = 0
    while place < len(content):
        if len(content) - place < 8:
            raise ValueError("the file ends inside a record")
        (length,) = struct.unpack_from(f"{order}i", content, place)
        end = place + 4 + length
        if length < 12 or end + 4 > len(content):
            raise ValueError(f"a record of {length} bytes at byte {place}; the file is damaged")
        if struct.unpack_from(f"{order}i", content, end)[0] != length:
            raise ValueError(f"the record at byte {place} has two different lengths")
        yield content[place + 4 : end]
        place = end + 4


def _strings(
    body: bytes, header: _Header, integer: np.dtype[np.int64], real: np.dtype[np.float64]
) -> Iterator[_Piece]:
    """Cut a sparse column into its pieces."""
    place, count = 0, 1 + header.large
    while place < len(body):
        words, row = header.string(np.frombuffer(body, integer, count, place).tolist())
        start = place + count * integer.itemsize
        place = start + words * integer.itemsize
        if words < 1 or place > len(body) or (place - start) % real.itemsize:
            raise ValueError(f"a string of {words} words at row {row}; the file is damaged")
        yield row, np.frombuffer(body[start:place], real).astype(np.float64)


def _text(content: bytes) -> Iterator[_Column]:
    """Walk through the lines of fixed columns."""
    text = plain(content, "ascii")
    if not text.endswith("\n"):
        raise ValueError("the last line does not end; the file was cut short")
    lines = Lines(text)
    for first in lines:
        try:
            found = _lines_of_matrix(first, lines)
        except ValueError as error:
            raise ValueError(f"line {lines.number}: {error}") from error
        yield found


def _lines_of_matrix(first: str, lines: Lines) -> _Column:
    """Read the lines of a matrix."""
    header, numbers = _first_line(first)
    columns: list[tuple[int, list[_Piece]]] = []
    while True:
        column, row, words = _integers(_line(lines), 3)
        if column == header.columns + 1:
            # Writers do not agree on how many numbers follow the last column.
            if not (trailer := _line(lines).rstrip()) or len(trailer) % numbers[1]:
                raise ValueError(f"the file ends inside matrix {header.name!r}")
            return header, columns
        if row > 0:
            columns.append((column, [(row, _reals(lines, words, *numbers))]))
            continue
        pieces = []
        while words > 0:
            size, row = header.string(_integers(_line(lines), 1 + header.large))
            words -= size + 1 + header.large
            if size < 1 or words < 0 or size % header.words:
                raise ValueError(f"a string of {size} words at row {row}")
            pieces.append((row, _reals(lines, size // header.words, *numbers)))
        columns.append((column, pieces))


def _line(lines: Iterator[str]) -> str:
    line = next(lines, None)
    if line is None:
        raise ValueError("the file ends inside a matrix")
    return line


def _first_line(line: str) -> tuple[_Header, tuple[int, int]]:
    """Return what precedes a matrix, and how many numbers of what width stand in a line."""
    wide = line.rstrip().endswith("|I16")
    line = line.rstrip().removesuffix("|I16")
    end = 48 if wide else 32
    sizes = _integers(line[: end - 16], 2, (end - 16) // 2) + _integers(line[end - 16 : end], 2)
    numbers = line[end + 8 :].strip()
    written = _FORMAT.fullmatch(numbers.replace(" ", ""))
    if numbers and written is None:
        raise ValueError(f"unknown number format {numbers[:20]!r}")
    header = _Header(_name(line[end : end + 8]), *sizes)
    return header, (int(written[1]), int(written[2])) if written else (5, 16)


def _reals(lines: Iterator[str], count: int, per_line: int, width: int) -> NDArray[np.float64]:
    """Read `count` numbers of `width` characters each."""
    if count < 1 or not per_line or not width:
        raise ValueError(f"{count} numbers announced, {per_line} in a line")
    found: list[float] = []
    while len(found) < count:
        expected = min(per_line, count - len(found))
        line = _line(lines).rstrip()
        if len(line) != expected * width:
            raise ValueError(f"{expected} numbers of {width} characters expected: {line[:40]!r}")
        found += [real_field(line[at : at + width]) for at in range(0, len(line), width)]
    return np.array(found)


def _integers(line: str, count: int, width: int = 8) -> list[int]:
    words = line.split()
    if len(words) != count:  # they touch where they are long
        words = [line[at : at + width].strip() for at in range(0, width * count, width)]
    try:
        return [whole_field(word, signed=True) for word in words]
    except ValueError:
        raise ValueError(f"{count} integers expected, found {line[:40]!r}") from None


def _name(written: str) -> str:
    name = re.sub(r"[ \0]", "", written).upper()  # names of 16 bytes have blanks inside
    if not re.fullmatch(r"[A-Z0-9_]+", name):
        raise ValueError(f"{name!r} is no name of a matrix")
    return name
