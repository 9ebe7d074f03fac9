"""How motions in time are followed and classified."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field, Strict

from stickslip.settings.entries import ONE_OF, Count, Omega, Whole, Within, percent
from stickslip.settings.settings import Settings

__all__ = ["Axis", "BasinKeys", "BasinSettings", "ClassifySettings", "TransientSettings"]

Axis: TypeAlias = str | int
"""What an axis of a map is: the displacement of a degree of freedom, or the amplitude of a mode."""


class TransientSettings(Settings):
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
        "where contacts slip.",
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


class BasinKeys(ClassifySettings):
    """How it is found out what becomes of many motions."""

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
