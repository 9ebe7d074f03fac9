"""The seal of result files: a digest of all their bytes, in a variable of the file itself.

A sealed file is checked before HDF5 sees it. HDF5 trusts the addresses in a file: one wrong byte
can keep it busy for ever. Files of the first versions have no seal; another process, which can be
ended, reads them beforehand.
"""

from __future__ import annotations

import hashlib
import re
import subprocess
import sys
from collections.abc import Callable, Hashable

import numpy as np

SEAL = "seal"
"""Name of the variable."""

_MARK = bytes.fromhex("b7f3c1a9e88d9cfe94d0a6b1ff82c5e9") + b"stickslip seal 1"
_DIGEST = 32
_PART = 1 << 26
"""Bytes that are digested between two looks at signals."""
_PATIENCE = 20.0
"""Seconds for a file, which take the start of Python into account, also on a busy machine."""
_PACE = 5e6
"""Bytes for which a second more is given; ten times as many are read in it."""
_RATIO = 1100
"""Bytes that one byte of a file can stand for: deflate reaches 1032."""

_READ = """
import io, sys
import h5netcdf, h5py
content, most = sys.stdin.buffer.read(), int(sys.argv[1])
def size(name, item):
    global most
    if isinstance(item, h5py.Dataset):
        most -= (item.size or 0) * item.dtype.itemsize
with h5py.File(io.BytesIO(content), "r") as file:
    file.visititems(size)
if most < 0:
    sys.exit("it declares more numbers than it can hold")
with h5netcdf.File(io.BytesIO(content), "r") as file:
    dict(file.attrs)
    for variable in file.variables.values():
        dict(variable.attrs), variable.dimensions, variable[...]
"""


def seal_variable() -> dict[Hashable, object]:
    """Return the variable that holds the seal, to be filled by `sealed`."""
    meaning = "mark, and BLAKE2b digest of the file with the digest as zeros"
    entries = np.frombuffer(_MARK + bytes(_DIGEST), dtype=np.uint8)
    return {SEAL: ("seal_byte", entries, {"units": "1", "long_name": meaning})}


def sealed(content: memoryview, look: Callable[[], None]) -> memoryview:
    """Fill in the digest of a file that has the variable, and return the file.

    What `look` raises now and then ends it.
    """
    # A memoryview has no `find`, and a file is too large to be copied for it.
    mark = re.search(re.escape(_MARK), content)
    if mark is None:
        raise ValueError("the file has no variable for the seal")
    content[mark.end() : mark.end() + _DIGEST] = _digest(content, mark.end(), look)
    return content


def sealed_whole(content: bytes, look: Callable[[], None]) -> bool | None:
    """Tell whether a file is as it was saved; None if it has no seal."""
    place = content.find(_MARK)
    if place < 0:
        return None
    start = place + len(_MARK)
    return content[start : start + _DIGEST] == _digest(content, start, look)


def require_harmless(content: bytes) -> None:
    """Refuse, by a ValueError, a file over which HDF5 crashes, never ends, or fills the memory."""
    patience = _PATIENCE + len(content) / _PACE
    command = [sys.executable, "-P", "-c", _READ, str(_RATIO * len(content))]
    try:
        done = subprocess.run(
            command, input=content, capture_output=True, timeout=patience, check=False
        )
    except subprocess.TimeoutExpired:
        raise ValueError(f"not read within {patience:.3g} s") from None
    if done.returncode:
        told = done.stderr.decode(errors="replace").strip().splitlines()
        raise ValueError(told[-1] if told and done.returncode > 0 else "its reader crashed")


def _digest(content: bytes | memoryview, start: int, look: Callable[[], None]) -> bytes:
    mark = hashlib.blake2b(digest_size=_DIGEST)
    view = memoryview(content)
    for part in (view[:start], memoryview(bytes(_DIGEST)), view[start + _DIGEST :]):
        for begin in range(0, len(part), _PART):
            look()
            mark.update(part[begin : begin + _PART])
    return mark.digest()
