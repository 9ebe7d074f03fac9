"""MATLAB files: of version 7.3 HDF5, those before walked through before they are read.

SciPy's compiled reader (1.17) trusts types and lengths: a damaged one takes the process down.
"""

from __future__ import annotations

import math
import struct
import zlib
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import brief
from stickslip.errors import ModelError
from stickslip.io.entries import columns_of, require_once
from stickslip.io.hdf5 import require_held, require_own
from stickslip.io.source import Key, inflate, require_room

if TYPE_CHECKING:
    import h5py  # type: ignore[import-untyped, unused-ignore]

_HDF5 = b"\x89HDF\r\n\x1a\n"

_NUMBERS = {"double", "single", "sparse", "logical"} | {
    f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)
}
"""Classes of variables that are matrices of numbers."""

_WIDTHS = {1: 1, 2: 1, 3: 2, 4: 2, 5: 4, 6: 4, 7: 4, 9: 8, 12: 8, 13: 8, 16: 1, 17: 2, 18: 4}
"""Bytes per number, by type of element."""
_MATRIX, _COMPRESSED = 14, 15
_SPARSE, _NUMERIC = 5, range(6, 16)
_HEADER = 128
_KINDS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 12: "i8", 13: "u8"}
"""Whole numbers, by type of element."""
_KINDS_4 = ("f8", "f4", "i4", "i2", "u2", "u1")
"""Numbers of version 4, by the tens of its type."""
_SPARSE_4 = 2


def read_matlab(file: Path, key: Key) -> object:
    """Read a matrix of a file of any version."""
    with file.open("rb") as stream:
        start = stream.read(512 + len(_HDF5))
    # MATLAB puts its own 512 bytes in front of the HDF5 file.
    if start.startswith(_HDF5) or start[512:] == _HDF5:
        return _read_hdf5(file, key)
    from scipy.io import loadmat, whosmat

    _require_sound(file)
    found = whosmat(file)
    kinds = {name: kind for name, _, kind in found}
    if len(kinds) < len(found):
        raise ValueError("two matrices have the same name")
    name = key.among(kinds)
    if kinds[name] not in _NUMBERS:
        raise ModelError(f"{file}: {brief(name)} is a {kinds[name]}; save the matrix by itself")
    return loadmat(file, variable_names=[name])[name]


def _read_hdf5(file: Path, key: Key) -> object:
    import h5py

    with h5py.File(file, "r") as variables:
        name = key.among(name for name in variables if not name.startswith("#"))
        require_own(variables, name)
        variable = variables[name]
        if isinstance(variable, h5py.Group):
            return _read_sparse(file, name, variable)
        said = variable.attrs.get("MATLAB_class", b"double")
        # MATLAB writes bytes, others text.
        kind = said if isinstance(said, str) else said.decode()
        if kind in _NUMBERS and variable.attrs.get("MATLAB_empty", 0):
            raise ModelError(f"{file}: {brief(name)} is empty; save the matrix again")
        if kind not in _NUMBERS:
            raise ModelError(f"{file}: {brief(name)} is a {kind}; save the matrix by itself")
        if variable.dtype.names:
            raise ModelError(f"{file}: {brief(name)}: complex entries; give real matrices")
        require_held(variable)
        # HDF5 counts in rows, MATLAB in columns.
        return np.asarray(variable[()]).T


def _read_sparse(file: Path, name: str, group: h5py.Group) -> object:
    from scipy.sparse import csc_array

    if "MATLAB_sparse" not in group.attrs:
        raise ModelError(f"{file}: {brief(name)} is a struct; save the matrix by itself")
    parts = {}
    for part in ("jc", "ir", "data"):
        if part in group:
            require_own(group, part)
            require_held(group[part])
            parts[part] = group[part][()]
    rows, pointers = int(group.attrs["MATLAB_sparse"]), parts["jc"].astype(np.int64)
    if "data" not in parts:
        if pointers.any():
            raise ValueError(f"{pointers.max()} entries announced, 0 present")
        return csc_array((rows, len(pointers) - 1))
    values, places = parts["data"], parts["ir"].astype(np.int64)
    if values.dtype.names:
        raise ModelError(f"{file}: {brief(name)}: complex entries; give real matrices")
    columns_of(pointers, places)
    return csc_array((values, places, pointers), shape=(rows, len(pointers) - 1))


def _require_sound(path: Path) -> None:
    """Check that sizes, counts and bytes of a file agree.

    References
    ----------
    The MathWorks, "MAT-File Format" (2019), chapter 1.
    """
    content = memoryview(path.read_bytes())
    if 0 in content[:4]:
        _require_version_4(content)
        return
    if len(content) < _HEADER:
        raise ValueError("the file ends inside its header")
    order = "<" if bytes(content[126:_HEADER]) == b"IM" else ">"
    for kind, body in _elements(content[_HEADER:], order):
        found: Iterable[tuple[int, memoryview]] = [(kind, body)]
        if kind == _COMPRESSED:
            found = _elements(_unpacked(body, order), order)
        for part, matrix in found:
            if part != _MATRIX:
                raise ValueError(f"an element of type {part} stands where a matrix must be")
            _require_matrix(matrix, order, packed=kind == _COMPRESSED)


def _unpacked(body: memoryview, order: str) -> memoryview:
    """Return the one element that is packed; its tag says how long it is."""
    tag = zlib.decompressobj().decompress(body, 8)
    if len(tag) < 8:
        raise ValueError("the file is damaged: a packed element has no tag")
    return memoryview(inflate(body, 8 + struct.unpack(f"{order}II", tag)[1]))


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


def _require_matrix(body: memoryview, order: str, *, packed: bool) -> None:
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
    shape = tuple(map(int, _integers(kinds[1], bodies[1], order)))
    counts = [len(part) // _WIDTHS[kind] for kind, part in zip(kinds[3:], bodies[3:], strict=True)]
    if len(shape) < 2 or min(shape) < 0:
        raise ValueError(f"the file is damaged: a matrix of shape {shape}")
    if form == _SPARSE:
        _, room = struct.unpack_from(f"{order}II", bodies[0])
        rows = _integers(kinds[3], bodies[3], order)
        pointers = _integers(kinds[4], bodies[4], order)
        if counts[1] != shape[1] + 1 or max(counts[0], *counts[2:]) > max(room, 1):
            raise ValueError(f"the file is damaged: {counts} numbers in a sparse matrix {shape}")
        # MATLAB leaves room behind the entries.
        entries, held = int(pointers[-1]), min(rows.size, *counts[2:])
        if not 0 <= entries <= held:
            raise ValueError(f"{entries} entries announced, {held} present")
        used = rows[:entries]
        columns_of(pointers, used)
        if entries and not 0 <= used.min() <= used.max() < shape[0]:
            raise ValueError(f"a row index lies outside 1 to {shape[0]}")
    elif set(counts) != {math.prod(shape)}:
        raise ValueError(f"the file is damaged: {counts} numbers in a matrix of shape {shape}")
    elif packed:
        require_room(bytes(bodies[2]).decode("latin-1"), math.prod(shape))


def _integers(kind: int, body: memoryview, order: str) -> NDArray[np.int64]:
    if kind not in _KINDS:
        raise ValueError(f"the file is damaged: elements of type {kind} count something")
    return np.frombuffer(body, f"{order}{_KINDS[kind]}").astype(np.int64)


def _require_version_4(content: memoryview) -> None:
    """Walk from matrix to matrix."""
    place = 0
    order = "<" if int.from_bytes(content[:4], "little") < 5000 else ">"
    while place < len(content):
        if len(content) - place < 20:
            raise ValueError("the file ends inside the header of a matrix")
        kind, rows, columns, imaginary, name = struct.unpack_from(f"{order}5i", content, place)
        width = kind // 10 % 10
        sound = 0 <= kind < 5000 and width < len(_KINDS_4) and imaginary in (0, 1)
        if not sound or min(rows, columns, name) < 0:
            raise ValueError("the header of a matrix of version 4 is damaged")
        begin, count = place + 20 + name, rows * columns
        dtype = np.dtype(f"{order}{_KINDS_4[width]}")
        place = begin + count * dtype.itemsize * (1 + imaginary)
        if place > len(content):
            raise ValueError(f"{place} bytes announced, {len(content)} present")
        if kind % 10 == _SPARSE_4:
            table = np.frombuffer(content, dtype, count, begin).reshape(columns, rows)
            _require_triplets(table.astype(np.float64))


def _require_triplets(table: NDArray[np.float64]) -> None:
    """Check a sparse matrix of version 4: rows, columns, values, and behind them its size."""
    if table.shape[0] not in (3, 4) or not table.shape[1]:
        raise ValueError(f"a sparse matrix of shape {table.shape[::-1]}")
    for index in table[:2]:
        if not ((index >= 1) & (index <= index[-1]) & (index == np.rint(index))).all():
            raise ValueError(f"a row or column index lies outside 1 to {index[-1]:g}")
    rows, columns = table[:2, :-1].astype(np.int64) - 1
    require_once(rows, columns, int(table[1, -1]))
