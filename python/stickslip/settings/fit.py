"""How parameters are fitted to measurements."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from stickslip.checks import brief
from stickslip.errors import EntryError
from stickslip.settings.balance import HarmonicSettings
from stickslip.settings.entries import ONE_OF, Count, Tolerance, Within, percent
from stickslip.settings.ranges import by_parameter
from stickslip.settings.variation import unit_of
from stickslip.units import physical_number


def _ends(name: str, ends: object) -> tuple[float, float]:
    if not isinstance(ends, tuple | list) or len(ends) != 2:
        raise EntryError("", f": {brief(ends)}; give two bounds, (lowest, highest)")
    low, high = (physical_number(end, unit_of(name), "") for end in ends)
    if not low < high:
        raise EntryError("", f": ({low:g}, {high:g}); give lowest < highest")
    return low, high


def _given_ends(name: str, ends: Any) -> tuple[Any, ...]:
    _ends(name, ends)
    return tuple(ends)


_TAKEN = "'friction': (0.1, 1.0)", "tuple[float, float]", "(float, float)"
_NAMES = Field(
    description='Names of the parameters with their bounds: "pad.friction" of one contact; '
    '"friction" of all contacts that have it, "slip_force" of those that can slip; '
    '"damping.ratio", "damping.mass" and "damping.stiffness" of the damping law of the structure; '
    '"level", a factor on the forces that vary; "load", one on the static forces. Where the lower '
    "bound is above 0 the logarithm is fitted.",
    examples=[{"pad.friction": [0.1, 1.0]}],
)


class FitSettings(HarmonicSettings):
    """How parameters are fitted."""

    parameters: Annotated[dict[str, tuple[float, float]], by_parameter(_ends, *_TAKEN)] = _NAMES
    tolerance: Tolerance = Field(
        default=1e-4,
        description="Relative accuracy of automatic harmonics, from 1e-8 to 0.5.",
    )
    starts: Count = Field(
        default=16,
        description="From how many places between the bounds the fit is tried; the best are "
        "followed to their ends, until three lead to the same.",
    )
    intervals: Annotated[Literal["profile", "covariance"], ONE_OF] = Field(
        default="profile",
        description="How intervals are found: by the profile of the likelihood, which bends as the "
        "model does, or by the covariance at the best fit.",
    )
    confidence: Annotated[float, Within(0.5, 0.9999), percent] = Field(
        default=0.95, description="Probability with which an interval is to hold the true value."
    )
    max_evaluations: Count = Field(
        default=200, description="Evaluations of all measurements per start before it is left."
    )


class FitKeys(FitSettings):
    """How parameters are fitted, with bounds as they are given: a model knows what is a factor."""

    parameters: Annotated[dict[str, Any], by_parameter(_given_ends, *_TAKEN)] = _NAMES
