"""The content of files: text with marks removed, packed bytes up to the size they may have."""

from __future__ import annotations

import gzip
import zlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from stickslip.checks import brief, is_file, listed, unknown
from stickslip.errors import ModelError

LARGEST_UNPACKED = 2**30
"""Bytes that packed content may take unpacked, a heuristic: 30 million entries as text, a dense
matrix of 11 000 rows. What is not packed may be as large as its file."""

MOST_INCLUDED = 1000
"""Files that a deck may include in all, a heuristic: it has some tens, one per part."""

_LONGEST = 80
_MARK = b"\xef\xbb\xbf"


@dataclass(frozen=True)
class Key:
    """The name of a matrix in a file, where one was given."""

    file: Path
    name: str | None
    any_will_do: bool = False
    """Whether the rows are asked for, which are those of all matrices of a file."""

    def among(self, known: Iterable[str]) -> str:
        """Return the name, one of those in the file; the only one need not be given."""
        names = list(known)
        if self.name is None:
            if len(names) == 1 or (names and self.any_will_do):
                return names[0]
            raise ModelError(
                f"{self.file}: it holds {listed(names) or 'nothing'}; choose one with key"
            )
        if self.name not in names:
            raise ModelError(f"{self.file}: {unknown('key', self.name, names)}")
        return self.name

    def refuse(self) -> None:
        """Refuse the name of a matrix in a file that holds but one."""
        if self.name is not None:
            raise ModelError(
                f"{self.file}: key {brief(self.name)}, but the file holds one matrix; leave key out"
            )


@contextmanager
def readable(file: Path, kind: str) -> Iterator[None]:
    """Refuse a file that is not there; word whatever a reader stumbles over.

    The readers' libraries raise anything in a damaged file, struct.error and MemoryError among it.
    """
    if not is_file(file):
        raise ModelError(f"{file}: no such file; check the path")
    try:
        yield
    except Exception as error:
        # The text of a model's own error stands: of this file, or of the one beside it (k.dof).
        if isinstance(error, ModelError) and str(error).startswith(str(file.with_suffix(""))):
            raise
        cause = " ".join(str(error).split())[:_LONGEST] or type(error).__name__
        raise ModelError(
            f"{file}: cannot be read as {kind}: {cause}; write the file again"
        ) from error


def require_included(file: Path, files: Iterator[int]) -> None:
    """Refuse a file that another one names and that is not there, or is none.

    `files` counts those of a deck from 0, its own: few that name each other are read many times.
    """
    if next(files) > MOST_INCLUDED:
        raise ValueError(f"it includes more than {MOST_INCLUDED} files; join some of them")
    try:
        there = is_file(file)
    except ModelError:
        there = False
    if not there:
        raise ValueError(f"there is no file {file.name}, which it includes")


@contextmanager
def at_line(number: int, file: str = "") -> Iterator[None]:
    """Name the line of a file, the one that is read or another, in what is wrong with it."""
    try:
        yield
    except ValueError as error:
        if isinstance(error, ModelError):
            raise
        raise ValueError(f"{file} line {number}: {error}".lstrip()) from error


class Lines:
    """The lines of a text, one after the other."""

    def __init__(self, text: str) -> None:
        self._lines = iter(text.splitlines())
        self.number = 0
        """Of the line that was read last, from 1."""

    def __iter__(self) -> Iterator[str]:
        return self

    def __next__(self) -> str:
        line = next(self._lines)
        self.number += 1
        return line


def read_text(path: Path, encoding: str = "ascii", *, ended: bool = False) -> str:
    """Return the text of a file, see `plain`; of an `ended` one the last line must end."""
    text = plain(path.read_bytes(), encoding)
    if ended and not text.endswith("\n"):
        raise ValueError("the last line does not end; the file was cut short")
    return text


def of_deck(content: bytes) -> str:
    """Return the text of a deck, see `plain`: in UTF-8, or in Latin-1 where it is none."""
    try:
        return plain(content, "utf-8")
    except UnicodeDecodeError:
        return plain(content, "latin-1")


def plain(content: bytes, encoding: str) -> str:
    """Return text without the byte-order mark of Windows' editors, lines ended by line feeds."""
    text = content.removeprefix(_MARK).decode(encoding)
    return text.replace("\r\n", "\n").replace("\r", "\n")


def unzip(path: Path, most: int) -> bytes:
    """Return what gzip packed, at most so many bytes."""
    with gzip.open(path) as packed:
        content = packed.read(most + 1)
    if len(content) > most:
        raise ValueError(f"it unpacks to more than {most} bytes; unpack it, if it is meant")
    return content


def require_room(name: str, count: int) -> None:
    """Refuse packed numbers that are too many once each has the 8 bytes that all are read to."""
    if 8 * count > LARGEST_UNPACKED:
        raise ValueError(
            f"{name!r} unpacks to {count} numbers; reduce the model, or save it unpacked"
        )


def inflate(body: memoryview | bytes, size: int) -> bytes:
    """Return what zlib packed, which must be `size` bytes, and at most `LARGEST_UNPACKED`."""
    if size > LARGEST_UNPACKED:
        raise ValueError(f"it unpacks to {size} bytes; reduce the model, or save it unpacked")
    unpacker = zlib.decompressobj()
    # One byte more shows whether it would go on.
    content = unpacker.decompress(body, size + 1)
    if len(content) != size or not unpacker.eof:
        raise ValueError(f"the file is damaged: packed bytes are not the {size} announced")
    return content
