"""Limit ratios over a parameter of the contacts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from stickslip.results.drawn import plots
from stickslip.results.fields import Columns, Float, Numbers, Shown, column
from stickslip.results.result import ColumnResult
from stickslip.settings.cycles import MapSettings

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    pass

__all__ = ["MapArrays", "StabilityMap"]


class MapArrays(Columns):
    """The numbers of a stability map."""

    value: Float = column("value", "{unit}", "{parameter} of the contacts")
    limit: Float = column(
        "value", "1", "ratio at which the branch turns for good; not-a-number if nowhere"
    )
    omega: Float = column("value", "rad/s", "frequency there", least=0.0)
    stable_limit: Float = column(
        "value",
        "1",
        "ratio up to which the sticking side is stable without a gap; 0 if it is unstable from the "
        "start, and not-a-number if a cycle below is not decided",
    )
    negative_damping: Numbers = column("row column", "kg/s", "C_neg of the damping C + r C_neg")


class StabilityMap(ColumnResult):
    """Largest ratio r with limit cycles, and with stable ones, over a parameter of the contacts."""

    kind: ClassVar[str] = "stability_map"
    title = "Negative damping that friction bounds"

    settings: MapSettings
    arrays: MapArrays

    def __repr__(self) -> str:
        return (
            f"StabilityMap({self.values.size} values of {self.settings.variation.parameter}, limit "
            f"{np.nanmin(self.limit):.6g} to {np.nanmax(self.limit):.6g})"
        )

    values = Shown[Float]("value")
    limit = Shown[Float]()
    omega = Shown[Float]()
    stable_limit = Shown[Float]()
    negative_damping = Shown[Numbers]()

    def _words(self) -> Mapping[str, str]:
        variation = self.settings.variation
        return {"unit": variation.unit, "parameter": variation.parameter}

    def plot(self, *, ax: Axes | None = None) -> Axes:
        """Draw the map; see `stickslip.plot.stability_map`."""
        return plots.stability_map(self, ax=ax)
