"""How motions in time are followed and classified."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal, Self, TypeAlias

import numpy as np
from pydantic import AfterValidator, Field, Strict, model_validator

from stickslip.checks import brief
from stickslip.errors import EntryError
from stickslip.model.state import State
from stickslip.settings.balance import ObserveKeys
from stickslip.settings.entries import (
    ONE_OF,
    Count,
    Dof,
    Index,
    Length,
    Many,
    Omega,
    Table,
    Whole,
    Within,
    percent,
)
from stickslip.settings.ranges import Or, numbers
from stickslip.settings.settings import Settings

Axis: TypeAlias = str | int
"""What an axis of a map is: the displacement of a degree of freedom, or the amplitude of a mode."""

_Start = Annotated[
    State | Mapping[str, float],
    Or(Mapping[str, Length], "State | Mapping[str, float]", "State or mapping of str to float"),
]


class MassScalingKey(Settings):
    """Whether fast modes are slowed."""

    mass_scaling: Annotated[float, Within(1e-10, 0.1), percent] | None = Field(
        default=None,
        description="Slow modes much faster than the forces, by mass that moves with them alone, "
        "as far as contacts move differently by an estimate of this, relative. The motion takes "
        "longer steps then. Default: all modes as they are.",
        examples=[1e-5],
    )


class TransientSettings(MassScalingKey):
    """How a motion is followed."""

    omega: Omega = Field(description="Angular frequency of the forces [rad/s].")
    periods: Count = Field(
        default=200, description="Number of periods; with a tolerance their limit."
    )
    scheme: Annotated[Literal["exact", "rk4"], ONE_OF] = Field(
        default="exact",
        description='"exact": power series, exact to rounding, between the instants of stick and '
        'slip, which are located. "rk4": the classical Runge-Kutta method of fourth order with the '
        "return map of the contacts in every step; its error falls with the square of the step "
        "where contacts slip, of a StructuralDamper with the step itself.",
    )
    tolerance: Annotated[float, Within(1e-12, 0.5), percent] | None = Field(
        default=None,
        description="End the run once the state changes over a period by less than this, relative "
        "to the motion in it, in the norm of energy. Default: compute all periods.",
    )
    steps: Annotated[int, Whole(4)] = Field(
        default=1000, description='Steps per period, for "rk4".'
    )
    samples: Annotated[int, Whole(2)] = Field(
        default=128, description="Instants per period in the time histories, evenly spaced."
    )
    keep: Count | None = Field(
        default=None,
        description="How many of the last periods the time histories and events hold; Poincare "
        "samples, amplitudes and changes are kept of all. Default: all.",
    )


class TransientKeys(TransientSettings, ObserveKeys):
    """Which motion is followed, and how."""

    start: _Start | None = Field(
        default=None,
        description="State at t = 0, or displacements of some degrees of freedom [m], the others "
        "and everything else zero. ``other.final`` continues another run. Default: rest.",
        examples=[{"tip": "1 mm"}],
    )


class StaticSettings(Settings):
    """How static loads are raised: from nothing, all together."""


class StaticKeys(StaticSettings, ObserveKeys):
    """Which displacements of a structure at rest are kept."""


class ClassifySettings(Settings):
    """How it is found out what becomes of a motion."""

    periods: Annotated[int, Whole(4)] = Field(
        default=3000, description="Longest motion, in periods of the lowest stuck mode."
    )
    tolerance: Annotated[float, Within(1e-10, 0.1), percent] = Field(
        default=1e-6,
        description="Closing error of a settled motion, relative to its size in the norm of "
        "energy.",
    )


class ClassifyKeys(ClassifySettings, ObserveKeys):
    """How it is found out what becomes of a motion, and what is kept of it."""


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


def _written_axes(given: tuple[AxisTable, ...]) -> dict[Axis, list[float]]:
    axes: dict[Axis, list[float]] = {
        one.mode or 0 if one.dof is None else one.dof: np.linspace(
            one.begin, one.end, one.points
        ).tolist()
        for one in given
    }
    if len(axes) < len(given):
        raise ValueError("axes holds the same axis twice; give two of them")
    return axes


def _axes(given: object) -> dict[Axis, list[float]]:
    if not isinstance(given, Mapping) or len(given) != 2:
        shown = f"{len(given)} axes" if isinstance(given, Mapping) else brief(given)
        raise EntryError("", f': {shown}; give two, {{"tip": [...], "damper": [...]}}')
    return {
        axis: numbers(values, "give finite numbers in m", unit="m").tolist()
        for axis, values in given.items()
    }


_Axes = Annotated[
    dict[Axis, list[float]],
    Or(
        Annotated[
            Many[AxisTable], Field(min_length=2, max_length=2), AfterValidator(_written_axes)
        ],
        "Mapping[str | int, ArrayLike]",
        "mapping of str or int to array_like",
        _axes,
    ),
]


class BasinKeys(ClassifyKeys):
    """Which motions are followed, and how it is found out what becomes of them."""

    axes: _Axes | None = Field(
        default=None,
        description="Two axes of a map with their values [m], the first drawn upwards, the second "
        "to the right: the displacement of a degree of freedom by its name, or the amplitude of a "
        "stuck mode by its number, counted from 0; a mode of amplitude a moves its largest "
        "displacement by a.",
        examples=[[{"mode": 2, "from": "0 mm", "to": "0.4 mm", "points": 31}]],
    )
    base: _Start | None = Field(
        default=None,
        description="What the axes are added to. Default: rest.",
    )
    threads: Count | None = Field(
        default=None,
        description="How many processors to use. Default: all. The result does not depend on it.",
    )


class BasinSettings(ClassifySettings):
    """Which starts, and how it was found out what becomes of them."""

    axes: Annotated[
        tuple[tuple[Axis, Annotated[tuple[float, ...], Strict(False)]], ...], Strict(False)
    ] = Field(
        default=(),
        description="The two axes of a map with their values [m]; none of a list of starts.",
    )
