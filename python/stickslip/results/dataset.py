"""Names along the dimensions of datasets, and whether they fit a model."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip.model import Model

if TYPE_CHECKING:
    import xarray as xr

    from stickslip.results.record import Record

Dataset: TypeAlias = "xr.Dataset"
"""Of xarray, which takes long to load."""
Stored: TypeAlias = "xr.Dataset | Record"
"""What results are read from."""
Coordinate: TypeAlias = tuple[str, NDArray[np.generic], dict[str, str]]


def require_fit(dataset: Stored, model: Model, states: Sequence[str]) -> tuple[str, ...]:
    """Return the observed dofs of a dataset, or refuse one that belongs to another model."""
    for dimension, noun, names in (
        ("point", "contact points in the arrays", displacement_names(model)),
        ("state_entry", "entries per state", states),
    ):
        size = dataset.sizes.get(dimension, len(names))
        if size != len(names):
            raise ValueError(f"{size} {noun}, {len(names)} in the model")
    dofs = tuple(map(str, dataset["dof"].values))
    for dof in dofs:
        model.structure.index(dof)
    return dofs


def labels(dimension: str, values: object, meaning: str) -> Coordinate:
    """Return a coordinate of texts."""
    return dimension, np.array(values, dtype=np.str_), {"units": "1", "long_name": meaning}


def point_names(model: Model) -> list[str]:
    """Return a name for every contact point: that of its contact, numbered if it has several."""
    return _numbered(model, [contact.points for contact in model.contacts])


def displacement_names(model: Model) -> list[str]:
    """Return a name for every relative displacement: that of its point, with its component."""
    parts = [one.components for one in model.contacts for _ in range(one.points)]
    named = zip(point_names(model), parts, strict=True)
    return [f"{name}.{part}" if part else name for name, own in named for part in own or [""]]


def slider_names(model: Model) -> list[str]:
    """Return a name for every part that sticks or slips by itself, with its direction."""
    counts = [one.sliders for one in model.contacts]
    parts = [one.components[: one.tangential] for one in model.contacts for _ in range(one.sliders)]
    named = zip(_numbered(model, counts), parts, strict=True)
    return [f"{name}.{part}" if part else name for name, own in named for part in own or [""]]


def _numbered(model: Model, counts: Sequence[int]) -> list[str]:
    return [
        name if count == 1 else f"{name}[{position}]"
        for name, count in zip(model.contact_names, counts, strict=True)
        for position in range(count)
    ]


def state_names(model: Model) -> list[str]:
    """Return a name for every entry of a state: displacements, velocities, forces, reversals."""
    dofs = model.structure.dofs
    moved = [f"{letter} {dof}" for letter in "xv" for dof in dofs]
    sliders = iter(slider_names(model))
    names = []
    for name, one in zip(model.contact_names, model.contacts, strict=True):
        own = [f"f {next(sliders)}" for _ in one.slider_limits]
        reversals = [f"r {name}[{place}]" for place in range(len(one.remembered))]
        names += own if len(own) == len(reversals) else reversals
    return moved + names
