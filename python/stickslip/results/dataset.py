"""How results become datasets and back: columns, names along dimensions, and attributes."""

from __future__ import annotations

import json
from collections.abc import Hashable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip.results.diagnostic import to_json

if TYPE_CHECKING:
    import xarray as xr

    from stickslip.model import Model
    from stickslip.results.result import ColumnResult
    from stickslip.settings.settings import Settings

Coordinate: TypeAlias = tuple[str, NDArray[np.generic], dict[str, str]]

_NUMBERED = {"harmonic": "multiple of omega", "pattern": "number of the pattern"}
"""Dimensions along which positions are counted, with the meaning of the number."""

_LABELLED = {"side": "end of the range", "turn_entry": "entry of the place"}
"""Dimensions that have `Columns.labels`, with the meaning of a label."""


def attributes(result: ColumnResult) -> dict[str, object]:
    """Return what every dataset says of its result, tables as JSON texts."""
    from stickslip._core import __version__

    return {
        "title": result.title,
        "Conventions": "CF-1.11",
        "stickslip_version": __version__,
        "settings": json.dumps(result.settings.model_dump()),
        "diagnostics": to_json(result.diagnostics),
        "timings": json.dumps(dict(result.timings)),
        "counters": json.dumps(dict(result.counters)),
        # NetCDF has no truth values.
        **{name: 1 * getattr(result, name) for name in result.attributes},
    }


def settings_of(kind: type[ColumnResult], dataset: xr.Dataset) -> Settings:
    """Return the settings that `attributes` wrote."""
    values = json.loads(dataset.attrs["settings"])
    if values.get("samples", 0) is None:
        # The first files had no name for what is automatic.
        values["samples"] = "auto"
    if "span" in set(kind.settings_class.model_fields) - set(values):
        # No default stands for the frequencies of a result.
        raise KeyError("span")
    return kind.settings_class.stored(values)


def require_fit(dataset: xr.Dataset, model: Model, states: Sequence[str]) -> tuple[str, ...]:
    """Return the observed dofs of a dataset, or refuse one that belongs to another model."""
    for dimension, noun, names in (
        ("point", "contact points in the arrays", point_names(model)),
        ("state_entry", "entries per state", states),
    ):
        size = dataset.sizes.get(dimension, len(names))
        if size != len(names):
            raise ValueError(f"{size} {noun}, {len(names)} in the model")
    dofs = tuple(map(str, dataset["dof"].values))
    for dof in dofs:
        model.structure.index(dof)
    return dofs


def coordinates(
    result: ColumnResult, sizes: Mapping[Hashable, int], states: Sequence[str]
) -> dict[str, Any]:
    """Return the names along the dimensions of a dataset."""
    model = result.model
    made: dict[str, Any] = {"dof": labels("dof", result.dofs, "observed degree of freedom")}
    for dimension, meaning in _NUMBERED.items():
        if dimension in sizes:
            about = {"units": "1", "long_name": meaning}
            made[dimension] = (dimension, np.arange(sizes[dimension]), about)
    if "point" in sizes:
        owners = [
            name
            for name, contact in zip(model.contact_names, model.contacts, strict=True)
            for _ in range(contact.points)
        ]
        made["point"] = labels("point", point_names(model), "contact point")
        made["contact"] = labels("point", owners, "contact of the point")
    if "state_entry" in sizes:
        made["state_entry"] = labels("state_entry", states, "entry of the state")
    for dimension, names in result.arrays.labels.items():
        made[dimension] = labels(dimension, names, _LABELLED[dimension])
    return made


def labels(dimension: str, values: object, meaning: str) -> Coordinate:
    """Return a coordinate of texts."""
    return dimension, np.array(values, dtype=np.str_), {"units": "1", "long_name": meaning}


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
