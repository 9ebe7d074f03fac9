"""Results in NetCDF files, with the model they belong to."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from stickslip.checks import brief, file_path, is_file, listed
from stickslip.errors import ModelError
from stickslip.files import refusal, require_place, write
from stickslip.interruption import Interruption
from stickslip.memory import SHARE, physical_memory
from stickslip.model import Model
from stickslip.results.dataset import Record, Variable
from stickslip.results.netcdf import Look, netcdf, record_of
from stickslip.results.seal import SEAL, require_harmless, seal_variable, sealed, sealed_whole
from stickslip.results.stored_model import model_of, model_variables

KINDS: Mapping[str, tuple[str, str]] = {
    "forced_response": ("stickslip.results.forced_response", "ForcedResponse"),
    "exact_response": ("stickslip.results.exact_response", "ExactResponse"),
    "transient": ("stickslip.results.transient", "Transient"),
    "damper_curve": ("stickslip.results.damper_curve", "DamperCurve"),
    "limit_cycles": ("stickslip.results.limit_cycles", "LimitCycles"),
    "nonlinear_modes": ("stickslip.results.nonlinear_modes", "NonlinearModes"),
    "optimal_damper": ("stickslip.results.optimal_damper", "OptimalDamper"),
    "motion_class": ("stickslip.results.motion_class", "MotionClass"),
    "basin_map": ("stickslip.results.basin_map", "BasinMap"),
    "mistuning_study": ("stickslip.results.mistuning", "MistuningStudy"),
    "static_response": ("stickslip.results.static_response", "StaticResponse"),
    "fit": ("stickslip.results.fit", "Fit"),
    "uncertainty": ("stickslip.results.uncertainty", "Uncertainty"),
    "campbell": ("stickslip.results.campbell", "Campbell"),
    "speed_response": ("stickslip.results.speed_response", "SpeedResponse"),
    "sweep": ("stickslip.results.sweep", "Sweep"),
    "flutter_map": ("stickslip.results.flutter_map", "FlutterMap"),
    "stability_map": ("stickslip.results.limit_cycles", "StabilityMap"),
}
"""Module and class of every kind of result; a class is loaded when a file of it is read."""

OTHERS: Mapping[str, str] = {"reduction": "stickslip.Reduction.load"}
"""What is saved beside results, with what reads it."""

_Made = TypeVar("_Made")

FORMAT = 2
"""Version of the layout of the file; it rises when an older reader could not read it."""


def save(path: str | os.PathLike[str], kind: str, record: Record, model: Model) -> None:
    """Write the record of a result, also a partial one, with its model; see `Result.save`."""
    from stickslip.results.export import FORMATS

    ending = file_path(path, "path").suffix.lower()
    if ending in FORMATS:
        raise ModelError(
            f"path: {brief(str(path))}: save writes NetCDF, .nc; {ending} is what export writes"
        )
    save_record(path, kind, record.assign(model_variables(model)))


def save_record(path: str | os.PathLike[str], kind: str, record: Record) -> None:
    """Write a record of some kind.

    Complex variables are split in two, `displacement_real` and `displacement_imag`, so that any
    reader opens the file; what follows from other variables is left out. Contacts and forces are
    JSON texts, one per variable entry. The file carries a digest of its bytes; `load` refuses a
    file that was changed.
    """
    target = file_path(path, "path")
    require_place(target)
    about = {"stickslip_format": FORMAT, "stickslip_kind": kind}
    record = _split(record).assign(seal_variable()).assign_attrs(about)
    with Interruption() as watch:
        look = watch.pass_on
        write(target, sealed(netcdf(record, SEAL, look), look), look)


def load(path: str | os.PathLike[str]) -> Any:
    """Read a result that its method `save` wrote.

    Parameters
    ----------
    path : path-like
        The file.

    Returns
    -------
    Result
        Of the kind that was saved and equal to it, bit by bit, with its model: peaks can still be
        refined, and runs continued.

    Raises
    ------
    ModelError
        If there is no such file, it is damaged, from elsewhere, or of a newer format.
    """
    source, record = _opened(path)
    kind = _required_kind(record, source)
    fault = "not a complete stickslip result"
    return _made(source, fault, lambda: kind.from_dataset(_joined(record), model_of(record)))


def load_record(path: str | os.PathLike[str], kind: str, make: Callable[[Record], _Made]) -> _Made:
    """Return what is made of a record that `save_record` wrote, of the kind that is wanted."""
    source, record = _opened(path)
    stored = record.attrs.get("stickslip_kind")
    if stored != kind:
        raise ModelError(f"{source}: holds no {kind}, but {brief(stored)}; give another file")
    _require_version(record, source)
    return _made(source, f"not a complete stickslip {kind}", lambda: make(_joined(record)))


def _opened(path: str | os.PathLike[str]) -> tuple[Path, Record]:
    source = file_path(path, "path")
    if not is_file(source):
        raise ModelError(f"{source}: no such file")
    if source.suffix == ".toml":
        raise ModelError(f"{source}: a study file, no result; 'stickslip run' computes its results")
    return source, _read(source)


def _made(source: Path, fault: str, make: Callable[[], _Made]) -> _Made:
    try:
        return make()
    except Exception as error:
        # What a file without a seal holds may lead the code below anywhere, RecursionError and
        # MemoryError among it.
        raise ModelError(
            f"{source}: {fault} ({_line(error)}); compute and save it again"
        ) from error


def content_of(source: Path) -> bytes:
    """Return the bytes of a result file, or refuse one that is larger than the memory."""
    try:
        size, memory = os.stat(source).st_size, physical_memory()
        if memory is not None and size > SHARE * memory:
            raise ModelError(f"{source}: {size / 1e9:.3g} GB, more than the memory can hold")
        return source.read_bytes()
    except OSError as error:
        raise refusal(source, "cannot be read", error) from error


def _read(source: Path) -> Record:
    content = content_of(source)
    with Interruption() as watch:
        return _read_of(source, content, watch.heed)


def _read_of(source: Path, content: bytes, look: Look) -> Record:
    whole = sealed_whole(content, look)
    if whole is False:
        raise _changed(source)
    try:
        if whole is None:
            require_harmless(content)
        record = record_of(content, look)
    except Exception as error:
        # The readers raise whatever the bytes of a damaged file lead them to.
        raise ModelError(
            f"{source}: not a readable NetCDF file, or a damaged one ({_line(error)}); "
            "load reads what save wrote"
        ) from error
    if SEAL in record and whole is None:
        raise _changed(source)
    return record


def _changed(source: Path) -> ModelError:
    return ModelError(
        f"{source}: was changed since it was saved, its digest differs; take a copy of the file as "
        "it was, or compute and save it again"
    )


def _required_kind(record: Record, source: Path) -> Any:
    """Return the class of the result in a file, or refuse a file of which this version has none."""
    kind, version = (record.attrs.get(f"stickslip_{key}") for key in ("kind", "format"))
    if kind is None or version is None:
        raise ModelError(f"{source}: a NetCDF file, but not a stickslip result")
    if isinstance(kind, str) and kind in OTHERS:
        raise ModelError(f"{source}: holds a {kind}, no result; read it with {OTHERS[kind]}")
    if not isinstance(kind, str) or kind not in KINDS:
        raise ModelError(
            f"{source}: holds {brief(kind)}, this version reads {listed(list(KINDS))}; upgrade "
            "stickslip"
        )
    _require_version(record, source)
    module, name = KINDS[kind]
    return getattr(import_module(module), name)


def _require_version(record: Record, source: Path) -> None:
    """Refuse a layout that this version does not know."""
    version = record.attrs.get("stickslip_format")
    if not isinstance(version, int | np.integer) or not 1 <= version <= FORMAT:
        writer = record.attrs.get("stickslip_version", "another version")
        raise ModelError(
            f"{source}: written by stickslip {_line(writer)} in format {_line(version)}, this "
            f"version reads format 1 to {FORMAT}; upgrade stickslip"
        )


def _split(record: Record) -> Record:
    """Replace every complex variable by its real and its imaginary part."""
    parts: dict[str, Variable] = {}
    for name, variable in record.variables.items():
        if variable.values.dtype.kind != "c":
            parts[name] = variable
            continue
        for part in ("real", "imag"):
            about = f"{part} part of the {variable.attrs['long_name']}"
            values = getattr(variable.values, part)
            parts[f"{name}_{part}"] = Variable(
                variable.dims, values, {**variable.attrs, "long_name": about}
            )
    return replace(record, variables=parts)


def _joined(record: Record) -> Record:
    """Undo `_split`."""
    wholes = {}
    for name in [name for name in record if name.endswith("_real")]:
        parts = {one: record[one] for one in (name, name.replace("_real", "_imag"))}
        for stored, part in parts.items():
            if part.values.dtype != np.float64:
                raise ValueError(f"{stored} holds {part.values.dtype.name} instead of float64")
        real, imag = parts.values()
        # Adding 1j * imag would turn an infinite or a negative zero into something else.
        values = np.empty(real.values.shape, dtype=np.complex128)
        values.real, values.imag = real.values, imag.values
        wholes[name.removesuffix("_real")] = (real.dims, values, real.attrs)
    return record.assign(wholes)


def _line(value: object) -> str:
    """Return the first line of what an error or a value says."""
    texts = str(value).splitlines()
    return texts[0] if texts else type(value).__name__
