"""Transients as xarray datasets: named dimensions, and units on every variable."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip.results.transient_arrays import TransientArrays
from stickslip.results.variables import (
    Variable,
    attributes,
    coordinate,
    dof_coordinate,
    names,
    parts,
    point_coordinates,
    read,
    settings_of,
    state_names,
    written,
)

if TYPE_CHECKING:
    import xarray as xr

    from stickslip.model import Model
    from stickslip.results.transient import Transient

__all__ = ["from_dataset", "to_dataset"]

_VARIABLES: Mapping[str, Variable] = {
    "displacement": Variable("displacement", ("time", "dof"), "m", "displacement"),
    "velocity": Variable("velocity", ("time", "dof"), "m/s", "velocity"),
    "contact_force": Variable(
        "contact_force", ("time", "point"), "N", "contact force against the relative displacement"
    ),
    "contact_displacement": Variable(
        "contact_displacement", ("time", "point"), "m", "relative displacement at the contacts"
    ),
    "poincare": Variable(
        "poincare",
        ("section", "state_entry"),
        "1",
        "state at the start and after each period (x in m, v in m/s, f in N)",
    ),
    "range": Variable(
        "range", ("period", "dof", "side"), "m", "lowest and highest displacement in each period"
    ),
    "change": Variable(
        "change", ("period",), "1", "change of the state over the period, relative to the motion"
    ),
    "event_time": Variable("event_time", ("event",), "s", "time of the event since the start"),
    "event_point": Variable("event_point", ("event",), "1", "contact point, over all contacts"),
    "event_kind": Variable(
        "event_kind", ("event",), "1", "0 sticks, 1 slips forward, 2 slips backward"
    ),
}
_TITLE = "Transient motion of a structure with dry friction"


def to_dataset(result: Transient, *, derived: bool = True) -> xr.Dataset:
    """Return a transient as a dataset; see `Transient.to_dataset`."""
    import xarray as xr

    dataset = xr.Dataset(
        written(_VARIABLES, result.arrays),
        coords={
            "time": (
                "time",
                result.time.copy(),
                {"units": "s", "long_name": "time since the start"},
            ),
            "dof": dof_coordinate(result),
            **point_coordinates(result.model),
            "side": names("side", ["lowest", "highest"], "end of the range"),
            "state_entry": names("state_entry", state_names(result.model), "entry of the state"),
        },
        attrs=attributes(result, result.settings, _TITLE)
        | {"settled": int(result.settled), "unbounded": int(result.unbounded)},
    )
    if derived:
        dataset["amplitude"] = (
            ("period", "dof"),
            np.stack([result.amplitudes(dof) for dof in result.dofs], axis=1),
            {"units": "m", "long_name": "half peak-to-peak amplitude in each period"},
        )
    return dataset


def from_dataset(dataset: xr.Dataset, model: Model) -> dict[str, Any]:
    """Return the arguments of the `Transient` that a dataset holds.

    Raises
    ------
    KeyError
        If a variable is missing.
    ValueError
        If a variable has other dimensions, or belongs to another model.
    """
    from stickslip.settings.motion import TransientSettings

    values = read(_VARIABLES, dataset) | {"time": coordinate(dataset, "time")}
    arrays = TransientArrays(**values)
    entries = len(state_names(model))
    if arrays.poincare.shape[1] != entries:
        raise ValueError(f"{arrays.poincare.shape[1]} entries per state, {entries} in the model")
    return parts(dataset, model) | {
        "settings": TransientSettings.stored(settings_of(dataset)),
        "arrays": arrays,
        "settled": bool(dataset.attrs["settled"]),
        "unbounded": bool(dataset.attrs["unbounded"]),
    }
