"""How limit cycles and the limits of their stability are computed."""

from __future__ import annotations

from math import inf
from typing import Annotated, Literal, Self, TypeAlias

import numpy as np
from pydantic import AfterValidator, Field, Strict, model_validator

from stickslip.checks import whole_number
from stickslip.errors import ModelError
from stickslip.settings.entries import ONE_OF, Factor, Flag, Harmonics, Index, Tolerance, Whole
from stickslip.settings.ranges import (
    BranchSlipForces,
    BranchStiffnesses,
    Ratios,
    SlipForceList,
    StiffnessList,
)
from stickslip.settings.settings import Settings
from stickslip.settings.variation import ContactKeys, Variation

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


class CycleKeys(BranchSettings, ContactKeys):
    """Along what limit cycles are followed, and how."""

    ratio: Ratios | None = Field(
        default=None,
        description="A list: exactly these ratios r, on both sides of the branch. A range, of "
        "functions a tuple: the branch from its sticking side on, until it leaves this range. "
        "Default: the whole branch from r = 0.01 on. If another parameter is followed: the one r, "
        "by default 1.",
    )
    stiffness: BranchStiffnesses | None = Field(
        default=None,
        description="Follow this parameter of contacts [N/m] instead of r, at exactly these "
        "values, or in a range.",
    )
    slip_force: BranchSlipForces | None = Field(
        default=None, description="Follow this one [N], likewise."
    )

    @model_validator(mode="after")
    def _require_sense(self) -> Self:
        if self.stiffness is not None and self.slip_force is not None:
            raise ModelError("stiffness, slip_force: both are given; follow one of them")
        if self.followed != "ratio" and self.ratio is not None and np.size(self.ratio) != 1:
            raise ModelError(f"ratio: give one number while {self.followed} is followed")
        if self.followed == "ratio" and self.contacts is not None:
            raise ModelError("contacts: the ratio is no parameter of contacts; leave them out")
        return self

    @property
    def followed(self) -> Literal["ratio", "stiffness", "slip_force"]:
        """What is followed."""
        if self.stiffness is not None:
            return "stiffness"
        return "ratio" if self.slip_force is None else "slip_force"


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


class LimitSettings(_ModeSettings):
    """How limits of stability are computed."""

    method: CycleMethod = Field(
        default="exact",
        description="Exact orbits, or harmonic balance; see `stickslip.limit_cycles`.",
    )


class MapKeys(LimitSettings, ContactKeys):
    """Over which parameter of contacts limits are computed, and how; give one of the two."""

    stiffness: StiffnessList | None = Field(
        default=None, description="Stiffnesses of the contacts, above 0 [N/m]."
    )
    slip_force: SlipForceList | None = Field(
        default=None,
        description="Instead: slip forces, above 0 [N]. Limit ratios depend on them only through "
        "their proportions, as all displacements grow with them.",
    )


class MapSettings(LimitSettings):
    """How a stability map was computed."""

    variation: Variation = Field(description="What was varied.")
