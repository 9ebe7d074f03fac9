"""How results become datasets and back: variables with units, names as coordinates, the rest."""

from __future__ import annotations

import json
from collections.abc import Hashable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip.results.diagnostic import from_attributes, to_json

if TYPE_CHECKING:
    import xarray as xr

    from stickslip.model import Model
    from stickslip.results.result import Result
    from stickslip.settings.settings import Settings

__all__ = [
    "Variable",
    "attributes",
    "coordinate",
    "dof_coordinate",
    "names",
    "parts",
    "point_coordinates",
    "point_names",
    "read",
    "settings_of",
    "state_names",
    "written",
]

Coordinate: TypeAlias = tuple[str, NDArray[np.generic], dict[str, str]]


class Variable(NamedTuple):
    """One variable of a dataset."""

    source: str
    """Its name among the arrays of the result."""
    dims: tuple[str, ...]
    """Its dimensions."""
    unit: str
    """Its unit."""
    meaning: str
    """What it is."""


def written(table: Mapping[str, Variable], arrays: object) -> dict[Hashable, object]:
    """Return the variables of a dataset, as copies of the arrays of a result."""
    return {
        name: (
            entry.dims,
            getattr(arrays, entry.source).copy(),
            {"units": entry.unit, "long_name": entry.meaning},
        )
        for name, entry in table.items()
    }


def read(table: Mapping[str, Variable], dataset: xr.Dataset) -> dict[str, NDArray[Any]]:
    """Return the arrays of a result that a dataset holds, by their names in the result.

    Raises
    ------
    KeyError
        If a variable is missing.
    ValueError
        If a variable has other dimensions.
    """
    arrays: dict[str, NDArray[Any]] = {}
    for name, entry in table.items():
        variable = dataset[name]
        if variable.dims != entry.dims:
            raise ValueError(f"{name} has dimensions {variable.dims} instead of {entry.dims}")
        arrays[entry.source] = variable.values
    return arrays


def coordinate(dataset: xr.Dataset, name: str) -> NDArray[Any]:
    """Return the numbers along a dimension.

    Raises
    ------
    KeyError
        If they are missing: xarray would count the entries instead.
    """
    if name not in dataset.variables:
        raise KeyError(name)
    values: NDArray[Any] = dataset[name].values
    return values


def attributes(result: Result, settings: Settings, title: str) -> dict[str, object]:
    """Return what every dataset says of its result, tables as JSON texts."""
    from stickslip._core import __version__

    return {
        "title": title,
        "Conventions": "CF-1.11",
        "stickslip_version": __version__,
        "settings": json.dumps(settings.model_dump()),
        "diagnostics": to_json(result.diagnostics),
        "timings": json.dumps(dict(result.timings)),
        "counters": json.dumps(dict(result.counters)),
        "interrupted": int(result.interrupted),
    }


def parts(dataset: xr.Dataset, model: Model) -> dict[str, Any]:
    """Return what `attributes` and `dof_coordinate` wrote, as arguments of a `Result`.

    Raises
    ------
    ValueError
        If the dataset belongs to another model.
    """
    dofs = tuple(map(str, dataset["dof"].values))
    for dof in dofs:
        model.structure.index(dof)
    return {
        "model": model,
        "dofs": dofs,
        "interrupted": bool(dataset.attrs["interrupted"]),
        "timings": json.loads(dataset.attrs["timings"]),
        "counters": json.loads(dataset.attrs["counters"]),
        "diagnostics": from_attributes(dataset.attrs),
    }


def settings_of(dataset: xr.Dataset) -> dict[str, Any]:
    """Return the settings that `attributes` wrote."""
    settings: dict[str, Any] = json.loads(dataset.attrs["settings"])
    return settings


def names(dimension: str, values: object, meaning: str) -> Coordinate:
    """Return a coordinate of texts."""
    return dimension, np.array(values, dtype=np.str_), {"units": "1", "long_name": meaning}


def dof_coordinate(result: Result) -> Coordinate:
    """Return the observed degrees of freedom as a coordinate."""
    return names("dof", result.dofs, "observed degree of freedom")


def point_coordinates(model: Model) -> dict[Hashable, object]:
    """Return the contact points, and the contact of each, as coordinates."""
    owners = [
        name
        for name, contact in zip(model.contact_names, model.contacts, strict=True)
        for _ in range(contact.points)
    ]
    return {
        "point": names("point", point_names(model), "contact point"),
        "contact": names("point", owners, "contact of the point"),
    }


def point_names(model: Model) -> list[str]:
    """Return a name for every contact point: that of its contact, numbered if it has several."""
    return _numbered(model, [contact.points for contact in model.contacts])


def slider_names(model: Model) -> list[str]:
    """Return a name for every part that sticks or slips by itself."""
    return _numbered(model, [len(contact.slider_limits) for contact in model.contacts])


def _numbered(model: Model, counts: Sequence[int]) -> list[str]:
    return [
        name if count == 1 else f"{name}[{position}]"
        for name, count in zip(model.contact_names, counts, strict=True)
        for position in range(count)
    ]


def state_names(model: Model) -> list[str]:
    """Return a name for every entry of a state: displacements, velocities, contact forces."""
    dofs = model.structure.dofs
    moved = [f"{letter} {dof}" for letter in "xv" for dof in dofs]
    return moved + [f"f {slider}" for slider in slider_names(model)]
