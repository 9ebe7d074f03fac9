"""HDF5 files, checked for the numbers that they announce before any is read."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from stickslip.io import source

if TYPE_CHECKING:
    import h5py  # type: ignore[import-untyped, unused-ignore]

_DEFLATE, _SHUFFLE, _FLETCHER = 1, 2, 3
"""Numbers of filters in HDF5; the last one has a check sum that HDF5 looks at."""
_RATIO = 1032
"""The most by which deflate packs."""


def require_own(group: h5py.Group, name: str) -> None:
    """Refuse a name that leads into another file, or out of the group."""
    import h5py

    if not isinstance(group.get(name, getlink=True), h5py.HardLink):
        raise ValueError(f"{name!r} is a link, not a part of the file")


def require_held(dataset: h5py.Dataset) -> None:
    """Refuse numbers that the file announces and does not hold, or that unpack to too many.

    None may be in another file; parts that are packed must have the bytes of their part.
    """
    name = dataset.name.lstrip("/")
    if dataset.is_virtual or dataset.external:
        raise ValueError(f"the numbers of {name!r} are in another file")
    if dataset.shape is None:
        return
    width = dataset.dtype.itemsize
    announced, held = math.prod(dataset.shape) * width, dataset.id.get_storage_size()
    if dataset.chunks is None:
        if held < announced:
            raise ValueError(f"{name!r} announces {announced} bytes and holds {held}")
        return
    chunk = math.prod(dataset.chunks) * width
    if max(announced, chunk) > source.LARGEST_UNPACKED and announced > held:
        raise ValueError(f"{name!r} unpacks to {announced} bytes; reduce the model")
    if announced > held:
        source.require_room(name, math.prod(dataset.shape))
    counts = (-(-size // step) for size, step in zip(dataset.shape, dataset.chunks, strict=True))
    parts: list[h5py.h5d.StoreInfo] = []
    dataset.id.chunk_iter(parts.append)
    if len(parts) < (needed := math.prod(counts)):
        raise ValueError(f"{name!r} has {needed} parts, the file holds {len(parts)} of them")
    packed = dataset.id.get_create_plist()
    filters = {packed.get_filter(number)[0] for number in range(packed.get_nfilters())}
    if _DEFLATE not in filters or not filters <= {_DEFLATE, _SHUFFLE, _FLETCHER}:
        return
    for part in parts:
        # HDF5 follows a packed part to any length, and does not look at the check sum of zlib.
        if part.filter_mask == 0 and (
            _FLETCHER not in filters or part.size * _RATIO > source.LARGEST_UNPACKED
        ):
            _, stored = dataset.id.read_direct_chunk(part.chunk_offset)
            source.inflate(stored, chunk)
