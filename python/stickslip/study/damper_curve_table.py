"""The table [analysis] of a damper curve."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Literal, Self

import numpy as np
from pydantic import BeforeValidator, Field, Strict, Tag, WithJsonSchema, model_validator

from stickslip.analyses.damper_curve import damper_curve
from stickslip.analyses.forced_response import MAX_HARMONICS, MAX_ITERATIONS, Settings
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.results.arrays import Float
from stickslip.study.analysis_entries import ResidualEntry
from stickslip.study.entries import (
    HERE,
    Contacts,
    Count,
    Dof,
    Factor,
    Omega,
    SlipForce,
    Table,
    Tolerance,
    number_or,
)
from stickslip.units import quantity

if TYPE_CHECKING:
    from stickslip.results.damper_curve import DamperCurve

__all__ = ["DamperCurveTable"]


def _stiffness(value: float | str) -> float:
    number = quantity(value, "N/m", HERE, finite=False)
    if number < 0.0:
        raise ModelError(f"{HERE} = {value!r} must not be negative")
    return number


Stiffness = Annotated[
    float, BeforeValidator(_stiffness), WithJsonSchema({"type": ["number", "string"]})
]


class OmegaSpan(Table):
    """The range of frequencies in which the peak is looked for."""

    begin: Omega = Field(alias="from", description="Lowest frequency.", examples=["150 rad/s"])
    end: Omega = Field(alias="to", description="Highest frequency.", examples=["40 Hz"])


class SlipForceRange(Table):
    """Slip forces, spaced logarithmically."""

    begin: SlipForce = Field(alias="from", description="First slip force.", examples=["1 N"])
    end: SlipForce = Field(alias="to", description="Last slip force.", examples=["10 kN"])
    points: Annotated[int, Field(ge=2, le=100_000)] = Field(description="Number of values.")


class StiffnessRange(Table):
    """Stiffnesses, spaced logarithmically."""

    begin: Stiffness = Field(alias="from", description="First stiffness.", examples=["1e4 N/m"])
    end: Stiffness = Field(alias="to", description="Last stiffness.", examples=["1e9 N/m"])
    points: Annotated[int, Field(ge=2, le=100_000)] = Field(description="Number of values.")


class LevelRange(Table):
    """Levels of the forces, spaced logarithmically."""

    begin: Factor = Field(alias="from", description="First level.", examples=[0.1])
    end: Factor = Field(alias="to", description="Last level.", examples=[10])
    points: Annotated[int, Field(ge=2, le=100_000)] = Field(description="Number of values.")


Range = SlipForceRange | StiffnessRange | LevelRange


def _values(given: Range | tuple[float, ...] | None) -> Float | None:
    if given is None:
        return None
    if isinstance(given, tuple):
        return np.array(given)
    return np.geomspace(given.begin, given.end, given.points)


class DamperCurveTable(Table):
    """Peak amplitude and frequency along a parameter of the contacts or the level of the forces."""

    kind: Literal["damper-curve"] = Field(description="The analysis.")
    dof: Dof = Field(description="DOF whose peak is followed.", examples=["tip"])
    slip_force: (
        Annotated[
            Annotated[tuple[SlipForce, ...], Strict(False), Field(min_length=1), Tag("<list>")]
            | Annotated[SlipForceRange, Tag("<number>")],
            number_or("<list>"),
        ]
        | None
    ) = Field(
        default=None,
        title="slip_force",
        description="Slip forces: a list or a range.",
        examples=[{"from": "1 N", "to": "10 kN", "points": 60}],
    )
    stiffness: (
        Annotated[
            Annotated[tuple[Stiffness, ...], Strict(False), Field(min_length=1), Tag("<list>")]
            | Annotated[StiffnessRange, Tag("<number>")],
            number_or("<list>"),
        ]
        | None
    ) = Field(
        default=None,
        title="stiffness",
        description="Contact stiffnesses: a list, inf for rigid, or a range.",
    )
    level: (
        Annotated[
            Annotated[tuple[Factor, ...], Strict(False), Field(min_length=1), Tag("<list>")]
            | Annotated[LevelRange, Tag("<number>")],
            number_or("<list>"),
        ]
        | None
    ) = Field(
        default=None,
        title="level",
        description="Factors on every force: a list or a range.",
    )
    contacts: Contacts | None = Field(
        default=None,
        description="Names of the contacts that take the value, or [name, point]; left out: all.",
    )
    common: Literal["value", "factor"] = Field(
        default="value",
        description="Whether contacts take the value, or multiply their own by it.",
    )
    omega: OmegaSpan | None = Field(
        default=None,
        title="omega",
        description="Range of the peak; left out: around the resonance of 'mode'.",
    )
    mode: Annotated[int, Field(ge=0)] = Field(default=0, description="Mode, counted from 0.")
    measure: Literal["half_range", "max", "fundamental"] = Field(
        default="half_range", description="Measure of the amplitude."
    )
    harmonics: Annotated[
        Annotated[Count, Tag("<number>")] | Annotated[Literal["auto"], Tag("<text>")],
        number_or("<text>"),
    ] = Field(
        default="auto", description="Highest harmonic kept, or 'auto': as the tolerance asks."
    )
    tolerance: Tolerance = Field(
        default=1e-3, description="Relative accuracy of what is automatic."
    )
    residual: ResidualEntry = "centred"
    max_harmonics: Count = Field(
        default=MAX_HARMONICS, description="Highest harmonic that may be kept."
    )
    max_iterations: Count = Field(
        default=MAX_ITERATIONS, description="Iterations per point before it counts as stalled."
    )

    @model_validator(mode="after")
    def _require_one_parameter(self) -> Self:
        given = [one for one in (self.slip_force, self.stiffness, self.level) if one is not None]
        if len(given) != 1:
            raise ValueError("give exactly one of slip_force, stiffness and level")
        return self

    @model_validator(mode="after")
    def _require_settings(self) -> Self:
        # what the analysis would refuse is refused while the file is read, before any computing
        Settings(
            harmonics=self.harmonics,
            tolerance=self.tolerance,
            residual=self.residual,
            max_harmonics=self.max_harmonics,
            max_iterations=self.max_iterations,
        )
        return self

    @property
    def levels(self) -> None:
        """A damper curve is one result."""
        return None

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
            dof=self.dof,
            slip_force=_values(self.slip_force),
            stiffness=_values(self.stiffness),
            level=_values(self.level),
            contacts=self.contacts,
            common=self.common,
            omega=None if self.omega is None else (self.omega.begin, self.omega.end),
            mode=self.mode,
            measure=self.measure,
            harmonics=self.harmonics,
            tolerance=self.tolerance,
            residual=self.residual,
            progress=progress,
            max_harmonics=self.max_harmonics,
            max_iterations=self.max_iterations,
        )
