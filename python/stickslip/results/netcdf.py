"""Records as NetCDF 4 files, written and read by HDF5 itself.

The libraries that write NetCDF ask HDF5 for every dimension again and again, and take longer for
the curves of a study than the solver. The layout is that of the NetCDF 4 manual, "Interoperability
with HDF5": dimensions are HDF5's dimension scales, those without numbers have a name that says so.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from stickslip.io.hdf5 import require_held, require_own
from stickslip.results.dataset import Record, Variable

if TYPE_CHECKING:
    import h5py  # type: ignore[import-untyped, unused-ignore]

Look: TypeAlias = Callable[[], None]
"""Looks at signals, and raises what they ask for."""

_NO_VARIABLE = "This is a netCDF dimension but not a netCDF variable"
"""Marks what has a length and no numbers."""
_HIDDEN = (
    *("CLASS", "NAME", "REFERENCE_LIST", "DIMENSION_LIST", "DIMENSION_LABELS", "coordinates"),
    *("_Netcdf4Dimid", "_Netcdf4Coordinates", "_nc3_strict", "_NCProperties"),
)
"""Attributes by which files say what dimensions and coordinates are."""
_SLAB = 8_000_000
"""Bytes that are packed in less than a second, between two looks at signals."""
_PACKED = {"compression": "gzip", "compression_opts": 1, "shuffle": True, "fletcher32": True}


def netcdf(record: Record, plain: str, look: Look) -> memoryview:
    """Return the bytes of a file: tables packed, with check sums, and nothing encoded.

    No number stands for a missing one: every bit pattern counts. The variable that is called
    `plain` is not packed. What `look` raises now and then ends it.
    """
    import h5py

    content = io.BytesIO()
    with h5py.File(content, "w", track_order=True) as file:
        _write_attributes(file, record.attrs)
        versions = f"hdf5={h5py.version.hdf5_version},h5py={h5py.version.version}"
        file.attrs["_NCProperties"] = np.bytes_(f"version=2,{versions}")
        scales = {}
        for number, (dim, size) in enumerate(record.sizes.items()):
            name = str(dim)
            if name in record and record[name].dims == (name,):
                scale = _written(file, name, record[name], look, packed=name != plain)
                scale.make_scale(name)
            else:
                scale = file.create_dataset(name, **_extent((size,)), dtype=">f4", track_order=True)
                scale.make_scale(f"{_NO_VARIABLE}.{size:10d}")
            scale.attrs["_Netcdf4Dimid"] = np.int32(number)
            scales[name] = scale
        numbers = {name: number for number, name in enumerate(scales)}
        for name, variable in record.variables.items():
            if variable.dims == (name,):
                continue
            made = _written(file, name, variable, look, packed=name != plain)
            for axis, dim in enumerate(variable.dims):
                made.dims[axis].attach_scale(scales[dim])
            if variable.dims:
                order = [numbers[dim] for dim in variable.dims]
                made.attrs["_Netcdf4Coordinates"] = np.array(order, np.int32)
            along = [
                one
                for one in sorted(record.coordinates - {*scales, name})
                if set(record[one].dims) <= set(variable.dims)
            ]
            if along and name not in record.coordinates:
                made.attrs["coordinates"] = " ".join(along)
    return content.getbuffer()


def _written(
    file: h5py.File, name: str, variable: Variable, look: Look, *, packed: bool
) -> h5py.Dataset:
    import h5py

    values, about = variable.values, variable.attrs
    if values.dtype.kind in "UO":
        values, kind = values.astype(object), h5py.string_dtype()
        packed = False
    else:
        if values.dtype.kind == "b":
            # NetCDF has no truth values.
            values, about = values.astype(np.int8), {**about, "dtype": "bool"}
        kind = values.dtype
    options = _PACKED if packed and values.ndim and values.size else {}
    made = file.create_dataset(
        name, **_extent(values.shape), dtype=kind, track_order=True, **options
    )
    for slab in _slabs(made):
        look()
        made[slab] = values[slab]
    _write_attributes(made, about)
    return made


def _slabs(dataset: h5py.Dataset) -> Iterator[Any]:
    """Give the parts of a dataset that are read or written at once: some of its whole chunks."""
    if not dataset.size or not dataset.ndim or dataset.nbytes <= _SLAB:
        yield from [...] * bool(dataset.size)
        return
    chunk = dataset.chunks[0] if dataset.chunks else 1
    rows = max(1, _SLAB * dataset.shape[0] // dataset.nbytes // chunk) * chunk
    for start in range(0, dataset.shape[0], rows):
        yield slice(start, start + rows)


def _extent(shape: tuple[int, ...]) -> dict[str, Any]:
    """Return a shape; NetCDF has no dimension of length 0 but one that may grow."""
    if all(shape):
        return {"shape": shape}
    return {"shape": shape, "maxshape": tuple(size or None for size in shape)}


def _write_attributes(owner: h5py.File | h5py.Dataset, attrs: Mapping[str, Any]) -> None:
    for name, value in attrs.items():
        owner.attrs[name] = value if isinstance(value, str) else np.atleast_1d(value)


def record_of(content: bytes, look: Look) -> Record:
    """Return the record that a file holds; what it raises depends on the damage of a file.

    What `look` raises now and then ends it.
    """
    import h5py

    variables: dict[str, Variable] = {}
    with h5py.File(io.BytesIO(content)) as file:
        for name in file:
            require_own(file, name)
        sizes = {name: file[name].shape for name in file}
        for name in file:
            stored = file[name]
            if _NO_VARIABLE in str(stored.attrs.get("NAME", "")):
                continue
            require_held(stored)
            dims = _dimensions(file, name)
            for dim, size in zip(dims, stored.shape, strict=True):
                if sizes.get(dim, (size,))[:1] != (size,):
                    raise ValueError(f"{name} has {size} entries of {dim!r}, it {sizes[dim]}")
            variables[name] = _read(stored, dims, look)
        return Record(variables, _attributes(file))


def _dimensions(file: h5py.File, name: str) -> tuple[str, ...]:
    """Return the names of the dimensions of a variable."""
    stored = file[name]
    if "DIMENSION_LIST" in stored.attrs:
        found = [file[scales[0]].name for scales in stored.attrs["DIMENSION_LIST"]]
        return tuple(one.lstrip("/") for one in found)
    characters = stored.dtype == "S1"
    if stored.is_scale and stored.ndim == 1 + characters:
        return (name, "character")[: stored.ndim]
    if stored.ndim:
        raise ValueError(f"{name} does not name its dimensions")
    return ()


def _read(stored: h5py.Dataset, dims: tuple[str, ...], look: Look) -> Variable:
    import h5py

    about = _attributes(stored)
    values = np.empty(stored.shape, stored.dtype)
    for slab in _slabs(stored):
        look()
        values[slab] = stored[slab]
    if values.dtype == "S1" and values.ndim:
        # Texts of one length are characters along a dimension of their own.
        joined = np.ascontiguousarray(values).view(f"S{values.shape[-1]}")
        return Variable(dims[:-1], joined[..., 0], about)
    if h5py.check_string_dtype(stored.dtype) is not None:
        return Variable(dims, np.asarray(stored.asstr()[...], dtype=object), about)
    if about.pop("dtype", "") == "bool":
        values = values.astype(np.bool_)
    return Variable(dims, np.asarray(values), about)


def _attributes(owner: h5py.File | h5py.Dataset) -> dict[str, Any]:
    """Return what is said, numbers that stand alone as such."""
    found: dict[str, Any] = {}
    for name in owner.attrs:
        if name in _HIDDEN:
            continue
        value = owner.attrs[name]
        single = isinstance(value, np.ndarray) and value.size == 1
        found[name] = value.flat[0] if single else value
    return found
