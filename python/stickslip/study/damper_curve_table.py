"""The table [analysis] of a damper curve."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Literal, Self

import numpy as np
from pydantic import Field, WithJsonSchema, model_validator

from stickslip.analyses.damper_curve import damper_curve
from stickslip.model import Model
from stickslip.results.arrays import Float
from stickslip.settings.entries import (
    Contacts,
    Factor,
    ListOr,
    SlipForce,
    Table,
    Whole,
    quantity_of,
)
from stickslip.settings.peaks import DamperKeys
from stickslip.study.analysis_entries import PeakRange, SingleResult

if TYPE_CHECKING:
    from stickslip.results.damper_curve import DamperCurve

__all__ = ["DamperCurveTable"]


Stiffness = Annotated[
    float,
    quantity_of("N/m", "not be negative", finite=False),
    WithJsonSchema({"type": ["number", "string"]}),
]


class SlipForceRange(Table):
    """Slip forces, spaced logarithmically."""

    begin: SlipForce = Field(alias="from", description="First slip force.", examples=["1 N"])
    end: SlipForce = Field(alias="to", description="Last slip force.", examples=["10 kN"])
    points: Annotated[int, Whole(2, 100_000)] = Field(description="Number of values.")


class StiffnessRange(Table):
    """Stiffnesses, spaced logarithmically."""

    begin: Stiffness = Field(alias="from", description="First stiffness.", examples=["1e4 N/m"])
    end: Stiffness = Field(alias="to", description="Last stiffness.", examples=["1e9 N/m"])
    points: Annotated[int, Whole(2, 100_000)] = Field(description="Number of values.")


class LevelRange(Table):
    """Levels of the forces, spaced logarithmically."""

    begin: Factor = Field(alias="from", description="First level.", examples=[0.1])
    end: Factor = Field(alias="to", description="Last level.", examples=[10])
    points: Annotated[int, Whole(2, 100_000)] = Field(description="Number of values.")


Range = SlipForceRange | StiffnessRange | LevelRange


def _values(given: Range | tuple[float, ...] | None) -> Float | None:
    if given is None:
        return None
    if isinstance(given, tuple):
        return np.array(given)
    return np.geomspace(given.begin, given.end, given.points)


class DamperCurveTable(DamperKeys, SingleResult):
    """Peak amplitude and frequency along a parameter of the contacts or the level of the forces."""

    kind: Literal["damper-curve"] = Field(description="The analysis.")
    slip_force: ListOr[SlipForce, SlipForceRange] | None = Field(
        default=None,
        title="slip_force",
        description="Slip forces: a list or a range.",
        examples=[{"from": "1 N", "to": "10 kN", "points": 60}],
    )
    stiffness: ListOr[Stiffness, StiffnessRange] | None = Field(
        default=None,
        title="stiffness",
        description="Contact stiffnesses: a list, inf for rigid, or a range.",
    )
    level: ListOr[Factor, LevelRange] | None = Field(
        default=None,
        title="level",
        description="Factors on every force: a list or a range.",
    )
    contacts: Contacts | None = Field(
        default=None,
        description="Names of the contacts that take the value, or [name, point]; left out: all.",
    )
    omega: PeakRange | None = Field(
        default=None,
        title="omega",
        description="Range of the peak; left out: around the resonance of 'mode'.",
    )

    @model_validator(mode="after")
    def _require_one_parameter(self) -> Self:
        given = [one for one in (self.slip_force, self.stiffness, self.level) if one is not None]
        if len(given) != 1:
            raise ValueError("give exactly one of slip_force, stiffness and level")
        return self

    @property
    def observe(self) -> tuple[str, ...]:
        """The DOF whose peak is followed."""
        return (self.dof,)

    @property
    def named_dofs(self) -> Mapping[str, Sequence[str]]:
        """The DOFs that each key names."""
        return {"dof": (self.dof,)}

    def run(self, model: Model, progress: Callable[[float], None] | None) -> DamperCurve:
        """Compute the curve."""
        return damper_curve(
            model,
            slip_force=_values(self.slip_force),
            stiffness=_values(self.stiffness),
            level=_values(self.level),
            contacts=self.contacts,
            omega=None if self.omega is None else (self.omega.begin, self.omega.end),
            progress=progress,
            **self.part(DamperKeys),
        )
