"""The content of files: text with marks removed, packed bytes up to the size they may have."""

from __future__ import annotations

import gzip
import zlib
from pathlib import Path

__all__ = ["LARGEST_UNPACKED", "inflate", "plain", "read_text", "unzip"]

LARGEST_UNPACKED = 2**30
"""Bytes that packed content may take unpacked, a heuristic: 30 million entries as text, a dense
matrix of 11 000 rows. What is not packed may be as large as its file."""

_MARK = b"\xef\xbb\xbf"


def read_text(path: Path, encoding: str = "ascii") -> str:
    """Return the text of a file, see `plain`."""
    return plain(path.read_bytes(), encoding)


def plain(content: bytes, encoding: str) -> str:
    """Return text without the byte-order mark of Windows' editors, lines ended by line feeds.

    Raises
    ------
    UnicodeDecodeError
        If there are bytes that the encoding does not have.
    """
    text = content.removeprefix(_MARK).decode(encoding)
    return text.replace("\r\n", "\n").replace("\r", "\n")


def unzip(path: Path, most: int) -> bytes:
    """Return what gzip packed.

    Parameters
    ----------
    path : Path
        The file.
    most : int
        Bytes that its contents can need.

    Raises
    ------
    ValueError
        If it is more.
    OSError, EOFError, zlib.error
        If it is damaged.
    """
    with gzip.open(path) as packed:
        content = packed.read(most + 1)
    if len(content) > most:
        raise ValueError(f"it unpacks to more than {most} bytes; unpack it, if it is meant")
    return content


def inflate(body: memoryview | bytes, size: int) -> bytes:
    """Return what zlib packed, which must be `size` bytes.

    Raises
    ------
    ValueError
        If it is more or less, or `size` is above `LARGEST_UNPACKED`.
    zlib.error
        If it is damaged.
    """
    if size > LARGEST_UNPACKED:
        raise ValueError(f"it unpacks to {size} bytes; reduce the model, or save it unpacked")
    unpacker = zlib.decompressobj()
    # One byte more shows whether it would go on.
    content = unpacker.decompress(body, size + 1)
    if len(content) != size or not unpacker.eof:
        raise ValueError(f"the file is damaged: packed bytes are not the {size} announced")
    return content
