"""How limit cycles and the limits of their stability are computed."""

from __future__ import annotations

from math import inf
from typing import Annotated, Literal, TypeAlias

from pydantic import AfterValidator, Field, Strict

from stickslip.checks import whole_number
from stickslip.settings.entries import ONE_OF, Factor, Flag, Harmonics, Index, Tolerance, Whole
from stickslip.settings.settings import Settings
from stickslip.settings.variation import CommonSettings, Variation

__all__ = [
    "LOWEST_RATIO",
    "MOST_HARMONICS",
    "BranchSettings",
    "CycleKeys",
    "CycleMethod",
    "CycleSettings",
    "MapKeys",
    "MapSettings",
]

LOWEST_RATIO = 0.01
"""Ratio at which whole branches begin and end."""

MOST_HARMONICS = 1000
"""Highest harmonic that may be kept."""

_REPORTED = 31
"""Highest harmonic of exact orbits reported if none is named."""

CycleMethod: TypeAlias = Annotated[Literal["newton", "exact"], ONE_OF]


def _orders(order: int | Literal["auto"]) -> int | Literal["auto"]:
    if order != "auto":
        whole_number(order, "", largest=MOST_HARMONICS)
    return order


class _ModeSettings(Settings):
    mode: Index = Field(
        default=0,
        description="Mode of the stuck structure, counted from 0; with damping C the branch begins "
        "at the ratio at which this mode loses it.",
    )
    harmonics: Annotated[Harmonics, AfterValidator(_orders)] = Field(
        default=31,
        description='Harmonics kept, odd ones alone, at all points of the branch; "auto": as '
        "`tolerance` asks, which one point in twenty may miss, with that status. Of exact orbits "
        "the highest reported.",
    )


class BranchSettings(_ModeSettings):
    """How a branch of limit cycles is computed."""

    method: CycleMethod = Field(
        default="newton",
        description="Harmonic balance with the frequency as an unknown, or exact orbits by "
        "shooting with the period as an unknown.",
    )
    tolerance: Tolerance = Field(
        default=1e-3, description="Relative accuracy that automatic harmonics aim at."
    )
    stability: Flag = Field(
        default=True,
        description="Whether Floquet multipliers are computed: those of the exact orbit to which a "
        "point of the harmonic balance belongs, and along the exact flow from the balance where "
        "there is none. Not for travelling waves.",
    )
    max_harmonics: Annotated[int, Whole(1, MOST_HARMONICS)] = Field(
        default=255, description='Highest harmonic that "auto" may keep.'
    )
    max_points: Annotated[int, Whole(2)] = Field(
        default=5000, description="Most points of a branch."
    )

    @property
    def fixed_harmonics(self) -> int | None:
        """The harmonics kept, or reported of exact orbits; None if they are chosen."""
        if self.harmonics == "auto":
            return _REPORTED if self.method == "exact" else None
        return self.harmonics


class CycleKeys(BranchSettings, CommonSettings):
    """How limit cycles are computed."""


class CycleSettings(BranchSettings):
    """How limit cycles were computed."""

    variation: Variation | None = Field(
        default=None,
        description="The parameter of contacts that is followed; none for the ratio r.",
    )
    ratio: Factor = Field(default=1.0, description="r, where a parameter of contacts is followed.")
    values: Annotated[tuple[float, ...], Strict(False)] | None = Field(
        default=None,
        description="Values of what is followed at which cycles are wanted; none for the branch.",
    )
    span: Annotated[tuple[float, float], Strict(False)] = Field(
        default=(LOWEST_RATIO, inf), description="Range of what is followed."
    )

    @property
    def followed(self) -> str:
        """What is followed: "ratio", "stiffness" or "slip_force"."""
        return "ratio" if self.variation is None else self.variation.parameter

    @property
    def unit(self) -> str:
        """Unit of what is followed."""
        return "1" if self.variation is None else self.variation.unit


class _LimitSettings(_ModeSettings):
    method: CycleMethod = Field(
        default="exact",
        description="Exact orbits, or harmonic balance; see `stickslip.limit_cycles`.",
    )


class MapKeys(_LimitSettings, CommonSettings):
    """How a stability map is computed."""


class MapSettings(_LimitSettings):
    """How a stability map was computed."""

    variation: Variation = Field(description="What was varied.")
