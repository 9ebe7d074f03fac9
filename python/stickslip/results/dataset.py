"""Response curves as xarray datasets: named dimensions, and units on every variable."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stickslip.results.arrays import Arrays
from stickslip.results.certificate import Certificate
from stickslip.results.status import Status
from stickslip.results.variables import (
    Variable,
    attributes,
    coordinate,
    dof_coordinate,
    parts,
    point_coordinates,
    read,
    settings_of,
    written,
)

if TYPE_CHECKING:
    import xarray as xr

    from stickslip.model import Model
    from stickslip.results import ForcedResponse

__all__ = [
    "CURVE_VARIABLES",
    "curve_arrays",
    "curve_dataset",
    "curve_parts",
    "from_dataset",
    "to_dataset",
]

CURVE_VARIABLES: dict[str, Variable] = {
    "displacement": Variable(
        "displacement",
        ("omega", "harmonic", "dof"),
        "m",
        "harmonics of the displacement, x(t) = Re sum_k X_k exp(i k omega t)",
    ),
    "contact_displacement": Variable(
        "contact_displacement",
        ("omega", "harmonic", "point"),
        "m",
        "harmonics of the relative displacement at the contacts",
    ),
    "contact_force": Variable(
        "contact_force",
        ("omega", "harmonic", "point"),
        "N",
        "harmonics of the contact force against the relative displacement",
    ),
    "error_estimate": Variable(
        "error_estimate",
        ("omega", "dof"),
        "m",
        "what the discarded harmonics, and more samples, could still change",
    ),
    "slip_fraction": Variable(
        "slip_fraction",
        ("omega", "point"),
        "1",
        "share of the period that the contact point slips",
    ),
    "dissipation": Variable(
        "dissipation",
        ("omega", "point"),
        "J",
        "work lost to friction per cycle",
    ),
    "residual": Variable("residual", ("omega",), "1", "relative residual of the balance equations"),
    "iterations": Variable("iterations", ("omega",), "1", "iterations of the solver"),
    "harmonics_kept": Variable("harmonics", ("omega",), "1", "highest harmonic kept"),
    "samples": Variable(
        "samples", ("omega",), "1", "samples per period of marched friction laws, 0 if not marched"
    ),
    "status": Variable("status", ("omega",), "1", "how the point ended"),
}
"""Those of every curve over frequency."""
_TITLE = "Forced response of a structure with dry friction, by harmonic balance"


def to_dataset(result: ForcedResponse, *, derived: bool = True) -> xr.Dataset:
    """Return a forced response as a dataset.

    Parameters
    ----------
    result : ForcedResponse
        The result.
    derived : bool, optional
        Whether to add the amplitude, which follows from the displacement.

    Returns
    -------
    xarray.Dataset
        Dimensions omega, harmonic, dof and point (of contact). The attributes `settings`,
        `diagnostics`, `timings` and `counters` are JSON texts. All
        numbers are copies.
    """
    dataset = curve_dataset(result, _TITLE, CURVE_VARIABLES, derived=derived)
    if result.certificate is not None:
        dataset = dataset.assign(result.certificate.variables())
    return dataset


def from_dataset(dataset: xr.Dataset, model: Model) -> dict[str, Any]:
    """Return the arguments of the `ForcedResponse` that a dataset holds.

    Parameters
    ----------
    dataset : xarray.Dataset
        As `to_dataset` makes it.
    model : Model
        What was computed.

    Returns
    -------
    dict
        Arguments by name.

    Raises
    ------
    KeyError
        If a variable is missing.
    ValueError
        If a variable has other dimensions, or belongs to another model.
    """
    from stickslip.settings.balance import ForcedSettings

    arrays = curve_arrays(dataset, CURVE_VARIABLES)
    settings = settings_of(dataset)
    if "samples" in settings and settings["samples"] is None:
        settings["samples"] = "auto"
    return curve_parts(dataset, model, Arrays(**arrays)) | {
        "settings": ForcedSettings.stored(settings),
        "certificate": Certificate.of_dataset(dataset),
    }


def curve_dataset(
    result: ForcedResponse, title: str, table: Mapping[str, Variable], *, derived: bool
) -> xr.Dataset:
    """Return a curve over frequency as a dataset of the variables in a table."""
    import xarray as xr

    dataset = xr.Dataset(
        written(table, result.arrays),
        coords=_coordinates(result),
        attrs=attributes(result, result.settings, title) | {"half_wave": int(result.half_wave)},
    )
    if derived:
        dataset["amplitude"] = (
            ("omega", "dof"),
            np.stack([result.amplitude(dof) for dof in result.dofs], axis=1),
            {"units": "m", "long_name": "half peak-to-peak amplitude of the displacement"},
        )
    dataset["status"].attrs |= {
        "flag_values": np.array([status.code for status in Status], dtype=np.uint8),
        "flag_meanings": " ".join(status.replace(" ", "_") for status in Status),
    }
    return dataset


def curve_arrays(dataset: xr.Dataset, table: Mapping[str, Variable]) -> dict[str, NDArray[Any]]:
    """Return the arrays of a curve over frequency that a dataset holds, by their names."""
    known = dict(table)
    arrays = {"omega": coordinate(dataset, "omega")}
    if "samples" not in dataset:
        # The first files name the samples of a march in their settings, unless it chose them.
        settings = settings_of(dataset)
        if settings.get("evaluation") != "marched":
            settings["samples"] = 0
        if settings["samples"] is not None:
            del known["samples"]
            arrays["samples"] = np.full(arrays["omega"].size, settings["samples"], np.int64)
    return read(known, dataset) | arrays


def curve_parts(dataset: xr.Dataset, model: Model, arrays: Arrays) -> dict[str, Any]:
    """Return the arguments that all curves over frequency have, if the arrays fit the model."""
    points = sum(contact.points for contact in model.contacts)
    if arrays.contact_force.shape[2] != points:
        raise ValueError(
            f"{arrays.contact_force.shape[2]} contact points in the arrays, {points} in the model"
        )
    if arrays.status.max(initial=0) >= len(Status):
        raise ValueError(f"status {arrays.status.max()} is unknown")
    return parts(dataset, model) | {
        "arrays": arrays,
        "half_wave": bool(dataset.attrs["half_wave"]),
    }


def _coordinates(result: ForcedResponse) -> dict[Hashable, object]:
    return {
        "omega": (
            "omega",
            result.omega.copy(),
            {"units": "rad/s", "long_name": "angular frequency of the excitation"},
        ),
        "harmonic": (
            "harmonic",
            np.arange(result.arrays.displacement.shape[1]),
            {"units": "1", "long_name": "multiple of the excitation frequency"},
        ),
        "dof": dof_coordinate(result),
        **point_coordinates(result.model),
    }
