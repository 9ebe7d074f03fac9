"""MATLAB files of version 5, walked through before SciPy reads them.

SciPy's compiled reader (1.17) trusts types and lengths: a damaged one takes the process down.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable, Iterator
from pathlib import Path

__all__ = ["require_sound"]

_WIDTHS = {1: 1, 2: 1, 3: 2, 4: 2, 5: 4, 6: 4, 7: 4, 9: 8, 12: 8, 13: 8, 16: 1, 17: 2, 18: 4}
"""Bytes per number, by type of element."""
_MATRIX, _COMPRESSED = 14, 15
_SPARSE, _NUMERIC = 5, range(6, 16)
_HEADER = 128


def require_sound(path: Path) -> None:
    """Check the elements of a file of version 5; any other is left to its reader.

    Parameters
    ----------
    path : Path
        The file.

    Raises
    ------
    ValueError
        If an element is of an unknown type, ends outside the file or its matrix, or stands where
        another must be.
    zlib.error
        If a compressed element is damaged.

    References
    ----------
    The MathWorks, "MAT-File Format" (2019), chapter 1.
    """
    content = memoryview(path.read_bytes())
    if 0 in content[:4]:
        return  # version 4
    if len(content) < _HEADER:
        raise ValueError("the file ends inside its header")
    order = "<" if bytes(content[126:_HEADER]) == b"IM" else ">"
    for kind, body in _elements(content[_HEADER:], order):
        found: Iterable[tuple[int, memoryview]] = [(kind, body)]
        if kind == _COMPRESSED:
            found = _elements(memoryview(zlib.decompress(body)), order)
        for part, matrix in found:
            if part != _MATRIX:
                raise ValueError(f"an element of type {part} stands where a matrix must be")
            _require_matrix(matrix, order)


def _elements(content: memoryview, order: str) -> Iterator[tuple[int, memoryview]]:
    """Yield type and body of each element."""
    place = 0
    while place < len(content):
        if len(content) - place < 8:
            raise ValueError("the file is damaged: it ends inside the tag of an element")
        kind, size = struct.unpack_from(f"{order}II", content, place)
        start, step = place + 8, size if kind == _COMPRESSED else -(-size // 8) * 8
        if kind >> 16:  # up to four bytes stand in the tag itself
            kind, size, start, step = kind & 0xFFFF, kind >> 16, place + 4, 0
        width = _WIDTHS.get(kind, 1 if kind in (_MATRIX, _COMPRESSED) else 0)
        room = 4 if start == place + 4 else len(content) - start
        if not width or size % width or size > room:
            raise ValueError(f"the file is damaged: {size} bytes of type {kind} at byte {place}")
        yield kind, content[start : start + size]
        place += 8 + step


def _require_matrix(body: memoryview, order: str) -> None:
    """Check what the matrix is made of; structures, cells and texts are refused elsewhere."""
    kinds, bodies = zip(*_elements(body, order), strict=True) if body else ((), ())
    if kinds[:1] != (6,) or len(bodies[0]) != 8:
        raise ValueError("the file is damaged: a matrix does not begin with its flags")
    (flags,) = struct.unpack_from(f"{order}I", bodies[0])
    form = flags & 0xFF
    if form != _SPARSE and form not in _NUMERIC:
        return
    # Flags, dimensions, name, row indices and column pointers if sparse, real part, imaginary part.
    parts = 4 + 2 * (form == _SPARSE) + bool(flags & 0x800)
    named = len(kinds) == parts and kinds[1] in (5, 6) and kinds[2] in (1, 16)
    if not named or not set(kinds) <= set(_WIDTHS):
        raise ValueError(f"the file is damaged: a matrix is made of elements of types {kinds}")
