"""Results as xarray datasets: named dimensions, and units on every variable."""

from __future__ import annotations

import json
from collections.abc import Hashable, Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stickslip.results.status import Status

if TYPE_CHECKING:
    import xarray as xr

    from stickslip.model import Model
    from stickslip.results import ForcedResponse

__all__ = ["arrays_from", "to_dataset"]

# Variable: name in Arrays, dimensions, unit, long name.
_VARIABLES: Mapping[str, tuple[str, tuple[str, ...], str, str]] = {
    "displacement": (
        "displacement",
        ("omega", "harmonic", "dof"),
        "m",
        "harmonics of the displacement, x(t) = Re sum_k X_k exp(i k omega t)",
    ),
    "contact_displacement": (
        "contact_displacement",
        ("omega", "harmonic", "point"),
        "m",
        "harmonics of the relative displacement at the contacts",
    ),
    "contact_force": (
        "contact_force",
        ("omega", "harmonic", "point"),
        "N",
        "harmonics of the contact force against the relative displacement",
    ),
    "error_estimate": (
        "error_estimate",
        ("omega", "dof"),
        "m",
        "what the discarded harmonics could still change",
    ),
    "slip_fraction": (
        "slip_fraction",
        ("omega", "point"),
        "1",
        "share of the period that the contact point slips",
    ),
    "dissipation": (
        "dissipation",
        ("omega", "point"),
        "J",
        "work lost to friction per cycle",
    ),
    "residual": ("residual", ("omega",), "1", "relative residual of the balance equations"),
    "iterations": ("iterations", ("omega",), "1", "iterations of the solver"),
    "harmonics_kept": ("harmonics", ("omega",), "1", "highest harmonic kept"),
    "status": ("status", ("omega",), "1", "how the point ended"),
}


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
        `assumptions`, `timings` and `counters` are JSON texts. All
        numbers are copies.
    """
    import xarray as xr

    from stickslip._core import __version__

    arrays = result.arrays
    dataset = xr.Dataset(
        {
            name: (dims, getattr(arrays, source).copy(), {"units": unit, "long_name": meaning})
            for name, (source, dims, unit, meaning) in _VARIABLES.items()
        },
        coords=_coordinates(result),
        attrs={
            "title": "Forced response of a structure with dry friction, by harmonic balance",
            "Conventions": "CF-1.11",
            "stickslip_version": __version__,
            "settings": json.dumps(asdict(result.settings)),
            "assumptions": json.dumps(result.assumptions, ensure_ascii=False),
            "timings": json.dumps(dict(result.timings)),
            "counters": json.dumps(dict(result.counters)),
            "half_wave": int(result.half_wave),
            "interrupted": int(result.interrupted),
        },
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


def arrays_from(dataset: xr.Dataset) -> dict[str, NDArray[np.generic]]:
    """Return the arrays of a dataset by their names in `Arrays`.

    Parameters
    ----------
    dataset : xarray.Dataset
        As `to_dataset` makes it.

    Returns
    -------
    dict of ndarray
        Arguments of `Arrays`.

    Raises
    ------
    KeyError
        If a variable is missing.
    ValueError
        If a variable has other dimensions.
    """
    arrays: dict[str, NDArray[np.generic]] = {"omega": dataset["omega"].values}
    for name, (target, dims, _, _) in _VARIABLES.items():
        if dataset[name].dims != dims:
            raise ValueError(f"{name} has dimensions {dataset[name].dims} instead of {dims}")
        arrays[target] = dataset[name].values
    return arrays


def _coordinates(result: ForcedResponse) -> dict[Hashable, object]:
    harmonics = np.arange(result.arrays.displacement.shape[1])
    contacts, points = _points(result.model)
    return {
        "omega": (
            "omega",
            result.omega.copy(),
            {"units": "rad/s", "long_name": "angular frequency of the excitation"},
        ),
        "harmonic": (
            "harmonic",
            harmonics,
            {"units": "1", "long_name": "multiple of the excitation frequency"},
        ),
        "dof": (
            "dof",
            np.array(result.dofs, dtype=np.str_),
            {"units": "1", "long_name": "observed degree of freedom"},
        ),
        "point": ("point", points, {"units": "1", "long_name": "contact point"}),
        "contact": ("point", contacts, {"units": "1", "long_name": "contact of the point"}),
    }


def _points(model: Model) -> tuple[NDArray[np.str_], NDArray[np.str_]]:
    """Return for every contact point the name of its contact and its own."""
    contacts, points = [], []
    for name, contact in zip(model.contact_names, model.contacts, strict=True):
        for point in range(contact.points):
            contacts.append(name)
            points.append(name if contact.points == 1 else f"{name}[{point}]")
    return np.array(contacts, dtype=np.str_), np.array(points, dtype=np.str_)
