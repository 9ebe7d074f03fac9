"""Limit cycles as xarray datasets: named dimensions, and units on every variable."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip.results.cycle_arrays import CHANGE_KINDS, CycleArrays
from stickslip.results.stability import flag_variable
from stickslip.results.status import Status
from stickslip.results.variables import (
    Variable,
    attributes,
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
    from stickslip.results.limit_cycles import LimitCycles

__all__ = ["cycle_dataset", "cycle_parts"]

_VARIABLES: Mapping[str, Variable] = {
    "ratio": Variable("ratio", ("cycle",), "1", "factor r on the negative damping"),
    "omega": Variable("omega", ("cycle",), "rad/s", "angular frequency of the limit cycle"),
    "slipping": Variable("slipping", ("cycle",), "1", "whether it lies on the slipping side"),
    "status": Variable("status", ("cycle",), "1", "how the point ended"),
    "harmonics_kept": Variable("harmonics", ("cycle",), "1", "highest harmonic kept"),
    "displacement": Variable(
        "displacement",
        ("cycle", "harmonic", "dof"),
        "m",
        "harmonics of the displacement, x(t) = Re sum_k X_k exp(i k omega t)",
    ),
    "contact_displacement": Variable(
        "contact_displacement",
        ("cycle", "harmonic", "point"),
        "m",
        "harmonics of the relative displacement at the contacts",
    ),
    "contact_force": Variable(
        "contact_force",
        ("cycle", "harmonic", "point"),
        "N",
        "harmonics of the contact force against the relative displacement",
    ),
    "error_estimate": Variable(
        "error_estimate", ("cycle", "dof"), "m", "what the discarded harmonics could still change"
    ),
    "slip_fraction": Variable(
        "slip_fraction", ("cycle", "point"), "1", "share of the period that the contact slips"
    ),
    "dissipation": Variable("dissipation", ("cycle", "point"), "J", "friction work per cycle"),
    "range": Variable(
        "range", ("cycle", "dof", "side"), "m", "lowest and highest displacement of exact orbits"
    ),
    "state": Variable(
        "state", ("cycle", "state_entry"), "1", "state at t = 0 (x in m, v in m/s, f in N)"
    ),
    "multipliers": Variable(
        "multipliers", ("cycle", "multiplier"), "1", "Floquet multipliers over the period"
    ),
    "neutral": Variable("neutral", ("cycle",), "1", "how many multipliers are neutral, exactly 1"),
    "closed": Variable("closed", ("cycle",), "1", "whether multipliers are of an exact orbit"),
    "turn": Variable(
        "turn", ("turn_entry",), "1", "value and omega where the branch turns for good"
    ),
    "folds": Variable("folds", ("fold", "turn_entry"), "1", "value and omega where it turns"),
    "change": Variable(
        "change", ("change_of_stability", "turn_entry"), "1", "value and omega of the change"
    ),
    "change_after": Variable(
        "change_after", ("change_of_stability",), "1", "position of the cycle before the change"
    ),
    "change_kind": Variable(
        "change_kind", ("change_of_stability",), "1", f"0 to 3: {', '.join(CHANGE_KINDS)}"
    ),
    "change_unstable": Variable(
        "change_unstable",
        ("change_of_stability", "side"),
        "1",
        "multipliers outside the unit circle before and after",
    ),
}


def cycle_dataset(result: LimitCycles, *, derived: bool) -> xr.Dataset:
    """Return limit cycles as a dataset; see `LimitCycles.to_dataset`."""
    import xarray as xr

    settings, arrays = result.settings, result.arrays
    dims = ("diameter", "row", "column")[3 - result.negative_damping.ndim :]
    dataset = xr.Dataset(
        {
            **written(_VARIABLES, arrays),
            "value": (
                "cycle",
                arrays.value.copy(),
                {"units": settings.unit, "long_name": f"{settings.followed} that is followed"},
            ),
            "negative_damping": (
                dims,
                result.negative_damping.copy(),
                {"units": "kg/s", "long_name": "C_neg of the damping C + r C_neg"},
            ),
        },
        coords={
            "harmonic": (
                "harmonic",
                np.arange(arrays.displacement.shape[1]),
                {"units": "1", "long_name": "multiple of the frequency"},
            ),
            "dof": dof_coordinate(result),
            "side": names("side", ["low", "high"], "end of a range"),
            "turn_entry": names("turn_entry", ["value", "omega"], "entry of a place"),
            "state_entry": names("state_entry", state_names(result.model), "entry of a state"),
            **point_coordinates(result.model),
        },
        attrs=attributes(result, settings, "Limit cycles of a structure with dry friction"),
    )
    dataset["stable"] = flag_variable("cycle", result.stability)
    if derived:
        dataset["amplitude"] = (
            ("cycle", "dof"),
            np.stack([result.amplitude(dof) for dof in result.dofs], axis=1),
            {"units": "m", "long_name": "half peak-to-peak amplitude of the displacement"},
        )
    return dataset


def cycle_parts(dataset: xr.Dataset, model: Model) -> dict[str, Any]:
    """Return the arguments of the `LimitCycles` that a dataset holds.

    Raises
    ------
    KeyError, ValueError
        If the dataset is incomplete, or belongs to another model.
    """
    from stickslip.settings.cycles import CycleSettings

    arrays = CycleArrays(value=dataset["value"].values, **read(_VARIABLES, dataset))
    points = sum(contact.points for contact in model.contacts)
    if arrays.contact_force.shape[2] != points:
        raise ValueError(
            f"{arrays.contact_force.shape[2]} contact points in the arrays, {points} in the model"
        )
    if arrays.status.max(initial=0) >= len(Status):
        raise ValueError(f"status {arrays.status.max()} is unknown")
    negative = np.ascontiguousarray(dataset["negative_damping"].values)
    negative.flags.writeable = False
    return parts(dataset, model) | {
        "settings": CycleSettings.stored(settings_of(dataset)),
        "arrays": arrays,
        "negative_damping": negative,
    }
