"""How peaks are followed along a parameter, and over many mistuned disks."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from stickslip.settings.balance import HarmonicSettings
from stickslip.settings.entries import ONE_OF, Count, Dof, Index, Measure, span_of
from stickslip.settings.variation import CommonSettings, Variation

__all__ = ["DamperKeys", "DamperSettings", "MistuningKeys", "MistuningSettings", "PeakSettings"]


def _ascending(span: object) -> tuple[float, float]:
    low, high = span_of(span)
    return min(low, high), max(low, high)


_PeakRange = Annotated[tuple[float, float], BeforeValidator(_ascending)]
_Distribution = Annotated[Literal["normal", "uniform"], ONE_OF]


class PeakSettings(HarmonicSettings):
    """Which amplitude has the peak."""

    measure: Measure = Field(
        default="half_range",
        description="Measure of the amplitude; see `ForcedResponse.amplitude`.",
    )


class _FollowedPeak(PeakSettings):
    dof: Dof = Field(description="The degree of freedom whose peak is followed.", examples=["tip"])


class DamperKeys(_FollowedPeak, CommonSettings):
    """How a damper curve is computed."""

    mode: Index = Field(
        default=0, description="The mode around whose resonance the peak is sought, counted from 0."
    )


class DamperSettings(_FollowedPeak):
    """How a damper curve was computed."""

    variation: Variation = Field(description="What is varied.")
    span: _PeakRange = Field(
        description="Range of frequencies in which the peak is the highest point [rad/s]."
    )


class MistuningKeys(PeakSettings):
    """How the disks of a mistuning study are made and computed."""

    seed: Index = Field(
        default=0,
        description="Of the patterns drawn. Pattern i of a seed is the same however many there "
        "are, and the same for all deviations and couplings.",
    )
    distribution: _Distribution = Field(
        default="normal",
        description="Distribution of zero mean and unit deviation of the patterns drawn.",
    )
    threads: Count | None = Field(
        default=None, description="Threads. Default: as many as there are processors."
    )


class MistuningSettings(PeakSettings):
    """How the disks of a mistuning study were made and computed."""

    span: _PeakRange = Field(
        description="Range of frequencies in which peaks are the highest points [rad/s]."
    )
    distribution: _Distribution | None = Field(
        default="normal", description="What patterns are drawn from; none: they were given."
    )
    seed: Index | None = Field(default=0, description="Of the patterns drawn.")
