"""Limit ratios over a parameter of the contacts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from stickslip.model import Model
from stickslip.results.arrays import Float
from stickslip.results.result import Result
from stickslip.results.variables import (
    Variable,
    attributes,
    dof_coordinate,
    parts,
    read,
    settings_of,
    written,
)

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

    from stickslip.settings.cycles import MapSettings

__all__ = ["MapArrays", "StabilityMap"]


@dataclass(frozen=True, eq=False)
class MapArrays:
    """The numbers of a stability map, of n values each."""

    value: Float
    """(n,) Value of the parameter."""
    limit: Float
    """(n,) Ratio at which the branch turns for good."""
    omega: Float
    """(n,) Frequency there [rad/s]."""
    stable_limit: Float
    """(n,) Ratio up to which the sticking side is stable; 0 if it is unstable from the start, and
    not-a-number if a cycle below is not decided."""

    def __post_init__(self) -> None:
        for entry in fields(self):
            array = np.ascontiguousarray(getattr(self, entry.name))
            array.flags.writeable = False
            object.__setattr__(self, entry.name, array)

    def __reduce__(self) -> tuple[type[Self], tuple[object, ...]]:
        return type(self), tuple(getattr(self, entry.name) for entry in fields(self))


_VARIABLES: Mapping[str, Variable] = {
    "limit": Variable("limit", ("value",), "1", "ratio at which the branch turns for good"),
    "omega": Variable("omega", ("value",), "rad/s", "frequency there"),
    "stable_limit": Variable(
        "stable_limit", ("value",), "1", "ratio up to which the sticking side is stable"
    ),
}


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class StabilityMap(Result):
    """Largest ratio r with limit cycles, and with stable ones, over a parameter of the contacts.

    Attributes
    ----------
    settings : MapSettings
        What was varied, and how.
    arrays : MapArrays
        Every number by its name.
    negative_damping : ndarray, shape (N, N)
        C_neg of the damping C + r C_neg [kg/s].
    """

    kind: ClassVar[str] = "stability_map"

    settings: MapSettings
    arrays: MapArrays
    negative_damping: NDArray[Any]

    def __repr__(self) -> str:
        return (
            f"StabilityMap({self.values.size} values of {self.settings.variation.parameter}, limit "
            f"{np.nanmin(self.limit):.6g} to {np.nanmax(self.limit):.6g})"
        )

    @property
    def values(self) -> Float:
        """Value of the parameter, shape (n,), ascending."""
        return self.arrays.value

    @property
    def limit(self) -> Float:
        """Ratio at which the branch turns for good, shape (n,); not-a-number if nowhere."""
        return self.arrays.limit

    @property
    def omega(self) -> Float:
        """Frequency there, shape (n,) [rad/s]."""
        return self.arrays.omega

    @property
    def stable_limit(self) -> Float:
        """Ratio up to which the sticking side is stable without a gap, shape (n,).

        Not-a-number where a cycle below it is not decided.
        """
        return self.arrays.stable_limit

    def to_dataset(self, *, derived: bool = True) -> xr.Dataset:
        """Return everything as an xarray dataset; see `Result.to_dataset`."""
        import xarray as xr

        variation = self.settings.variation
        meaning = f"{variation.parameter} of the contacts"
        return xr.Dataset(
            {
                **written(_VARIABLES, self.arrays),
                "negative_damping": (
                    ("row", "column"),
                    self.negative_damping.copy(),
                    {"units": "kg/s", "long_name": "C_neg of the damping C + r C_neg"},
                ),
            },
            coords={
                "value": (
                    "value",
                    self.values.copy(),
                    {"units": variation.unit, "long_name": meaning},
                ),
                "dof": dof_coordinate(self),
            },
            attrs=attributes(self, self.settings, "Negative damping that friction bounds"),
        )

    @classmethod
    def from_dataset(cls, dataset: xr.Dataset, model: Model) -> Self:
        """Return the map that a dataset holds; see `Result.from_dataset`."""
        from stickslip.settings.cycles import MapSettings

        negative = np.ascontiguousarray(dataset["negative_damping"].values)
        negative.flags.writeable = False
        return cls(
            **parts(dataset, model),
            settings=MapSettings.stored(settings_of(dataset)),
            arrays=MapArrays(value=dataset["value"].values, **read(_VARIABLES, dataset)),
            negative_damping=negative,
        )

    def plot(self, *, ax: Axes | None = None) -> Axes:
        """Draw the map; see `stickslip.plot.stability_map`."""
        from stickslip import plot

        return plot.stability_map(self, ax=ax)
