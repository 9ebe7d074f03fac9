"""NumPy's files, looked at before NumPy makes room for what they announce."""

from __future__ import annotations

import math
import os
import zipfile
from pathlib import Path
from typing import IO

import numpy as np

from stickslip.io import source
from stickslip.io.source import Key

_HEADERS = {
    (1, 0): np.lib.format.read_array_header_1_0,
    (2, 0): np.lib.format.read_array_header_2_0,
}


def read_numpy(file: Path, key: Key) -> object:
    """Read a matrix of `.npy` or `.npz`, of NumPy or of SciPy's sparse matrices.

    An array must have the bytes that its header announces, and a name of its own.
    """
    with file.open("rb") as stream:
        _require_sound(stream)
        loaded = np.load(stream, allow_pickle=False)
        if isinstance(loaded, np.ndarray):
            key.refuse()
            return loaded
        if {"format", "shape", "data"} <= set(loaded.files):
            from scipy.sparse import load_npz

            key.refuse()
            stream.seek(0)
            return load_npz(stream)
        return loaded[key.among(loaded.files)]


def _require_sound(stream: IO[bytes]) -> None:
    """Check `.npy` and `.npz`, and go back to the beginning."""
    if stream.read(2) == b"PK":
        with zipfile.ZipFile(stream) as archive:
            if len(set(archive.namelist())) < len(archive.namelist()):
                raise ValueError("two arrays have the same name")
            for member in archive.infolist():
                name, size = member.filename, member.file_size
                packed = member.compress_type != zipfile.ZIP_STORED
                if size > source.LARGEST_UNPACKED and packed:
                    raise ValueError(f"{name!r} unpacks to {size} bytes; save it unpacked")
                if name.endswith(".npy"):
                    with archive.open(member) as array:
                        count = _require_held(array, size)
                    if packed:
                        source.require_room(name, count)
    else:
        size = stream.seek(0, os.SEEK_END)
        stream.seek(0)
        _require_held(stream, size)
    stream.seek(0)


def _require_held(stream: IO[bytes], size: int) -> int:
    """Compare the header of an array with the bytes that follow; return how many numbers it has."""
    version = np.lib.format.read_magic(stream)
    if version not in _HEADERS:
        raise ValueError(f"an array of format {version}")
    shape, _, dtype = _HEADERS[version](stream)
    if any(isinstance(one, bool) or one < 0 for one in shape):
        raise ValueError(f"an array of shape {shape}; the file is damaged")
    announced, held = math.prod(shape) * dtype.itemsize, size - stream.tell()
    # NumPy refuses objects by itself.
    if not dtype.hasobject and announced != held:
        raise ValueError(f"shape {shape} takes {announced} bytes, {held} are there")
    return math.prod(shape)
