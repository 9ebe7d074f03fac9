"""The table [analysis] of a basin map."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from stickslip.analyses.basin_map import basin_map
from stickslip.model import Model
from stickslip.results.arrays import Float
from stickslip.settings.entries import Dof, Index, Length, Many, Table, Whole
from stickslip.settings.motion import Axis, BasinKeys
from stickslip.study.analysis_entries import ObserveEntries, SingleResult

if TYPE_CHECKING:
    from stickslip.results.basin_map import BasinMap

__all__ = ["BasinMapTable"]


class AxisTable(Table):
    """An axis of the map: a displacement or the amplitude of a mode at the start."""

    dof: Dof | None = Field(default=None, description="DOF whose displacement it is.")
    mode: Index | None = Field(
        default=None, description="Instead: stuck mode, counted from 0, whose amplitude it is."
    )
    begin: Length = Field(alias="from", description="First value.", examples=["-1 mm"])
    end: Length = Field(alias="to", description="Last value.", examples=["1 mm"])
    points: Annotated[int, Whole(1, 100_000)] = Field(description="Number of values.")

    @model_validator(mode="after")
    def _require_one(self) -> Self:
        if (self.dof is None) == (self.mode is None):
            raise ValueError("give exactly one of dof and mode")
        return self

    @property
    def axis(self) -> Axis:
        """What the analysis calls it."""
        if self.dof is not None:
            return self.dof
        return 0 if self.mode is None else self.mode

    def values(self) -> Float:
        """Return its values."""
        return np.linspace(self.begin, self.end, self.points)


class BasinMapTable(BasinKeys, ObserveEntries, SingleResult):
    """What becomes of free motions from many starts."""

    kind: Literal["basin-map"] = Field(description="The analysis.")
    axes: Many[AxisTable] = Field(
        min_length=2,
        max_length=2,
        description="The two axes of the map, the first drawn upwards.",
        examples=[[{"mode": 2, "from": "0 mm", "to": "0.4 mm", "points": 31}]],
    )
    base: Mapping[str, Length] = Field(
        default={},
        description="Displacements by DOF that the axes are added to; left out: none.",
    )

    @model_validator(mode="after")
    def _require_distinct_axes(self) -> Self:
        if self.axes[0].axis == self.axes[1].axis:
            raise ValueError("axes holds the same axis twice; give two of them")
        return self

    @property
    def named_dofs(self) -> Mapping[str, Sequence[str]]:
        """The DOFs that each key names."""
        drawn = tuple(axis.dof for axis in self.axes if axis.dof is not None)
        return {"observe": self.observe or (), "axes": drawn, "base": tuple(self.base)}

    def run(self, model: Model, progress: Callable[[float], None] | None) -> BasinMap:
        """Compute the map."""
        return basin_map(
            model,
            {axis.axis: axis.values() for axis in self.axes},
            base=self.base or None,
            observe=self.observe,
            progress=progress,
            **self.part(BasinKeys),
        )
