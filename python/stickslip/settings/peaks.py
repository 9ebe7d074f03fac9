"""How peaks are followed along a parameter, and over many mistuned disks."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, Field, PlainValidator, Strict, ValidationInfo, WithJsonSchema

from stickslip.checks import brief, whole_number
from stickslip.errors import EntryError
from stickslip.settings.balance import BoundsKey, HarmonicSettings
from stickslip.settings.entries import (
    ONE_OF,
    Count,
    Dof,
    Flag,
    Index,
    ListOr,
    Many,
    Measure,
    Ratio,
    Some,
    StiffnessValue,
    Text,
    span_of,
)
from stickslip.settings.ranges import Dofs, Float, Or, PeakSpan, numbers
from stickslip.settings.settings import Settings
from stickslip.settings.sweep import ParameterKeys
from stickslip.settings.variation import ContactKeys, Parameter, Variation, unit_of
from stickslip.units import physical_number


def _ascending(span: object) -> tuple[float, float]:
    low, high = span_of(span)
    return min(low, high), max(low, high)


_PeakRange = Annotated[tuple[float, float], BeforeValidator(_ascending)]
_Distribution = Annotated[Literal["normal", "uniform"], ONE_OF]


def _bounds(bounds: object, info: ValidationInfo) -> tuple[float, float]:
    if not isinstance(bounds, tuple | list) or len(bounds) != 2:
        raise EntryError("", ": give two values, (lowest, highest)")
    factor = info.data.get("common") == "factor"
    unit = "" if factor else unit_of(info.data.get("parameter", "level"))
    low, high = (physical_number(value, unit, "") for value in bounds)
    if not 0.0 < low < high:
        raise EntryError("", f": ({low:g}, {high:g}); give 0 < lowest < highest")
    return low, high


_PAIR = WithJsonSchema(
    {"type": "array", "items": {"type": ["number", "string"]}, "minItems": 2, "maxItems": 2}
)


def _portion(part: object) -> tuple[int, int]:
    if not isinstance(part, tuple | list) or len(part) != 2:
        raise EntryError("", f": {brief(part)}; give (number, of), (0, 4) for the first of four")
    number, of = (whole_number(one, "") for one in part)
    if number >= of:
        raise EntryError("", f": part {number} of {of}; count from 0 to {max(of, 1) - 1}")
    return number, of


def _unsigned(remedy: str, unit: str) -> Callable[[Any], Float]:
    """Return what reads one or several finite numbers, none of them negative, each once."""

    def read(values: Any) -> Float:
        found = numbers(
            values, f"give {remedy}, not negative", lambda x: np.isfinite(x) & (x >= 0.0), unit
        )
        if np.unique(found).size < found.size:
            raise EntryError("", f": {brief(values)} holds a value twice; give each once")
        return found

    return read


Portion = Annotated[tuple[int, int], Or(Some[Index], "tuple[int, int]", "(int, int)", _portion)]
_SEVERAL = "ArrayLike", "float or array_like"
_Deviations = Annotated[Float, Or(ListOr[Ratio, Ratio], *_SEVERAL, _unsigned("0.05 for 5 %", ""))]
_Couplings = Annotated[
    Float,
    Or(ListOr[StiffnessValue, StiffnessValue], *_SEVERAL, _unsigned("stiffnesses in N/m", "N/m")),
]
_Patterns = Annotated[
    int | Float,
    Or(
        ListOr[Many[Annotated[float, Strict(False)]], Count],
        "int | ArrayLike",
        "int or array_like, shape (p, n)",
    ),
]
StorePath = Annotated[str | PathLike[str], Or(Text, "str | PathLike[str]", "path-like")]


class PeakSettings(HarmonicSettings):
    """Which amplitude has the peak."""

    measure: Measure = Field(
        default="half_range",
        description="Measure of the amplitude; see `ForcedResponse.amplitude`.",
    )


class _FollowedPeak(PeakSettings):
    dof: Dof = Field(description="The degree of freedom whose peak is followed.", examples=["tip"])


class PeakKeys(_FollowedPeak, ContactKeys):
    """Which peak is followed, and how."""

    mode: Index = Field(
        default=0, description="The mode around whose resonance the peak is sought, counted from 0."
    )
    omega: PeakSpan | None = Field(
        default=None,
        description="Range of frequencies in which the peak is the highest point [rad/s]. Default: "
        "from 5 % below the free to 5 % above the highest stuck natural frequency of `mode`, over "
        "the lowest harmonic of the forces.",
    )


class DamperKeys(BoundsKey, ParameterKeys, PeakKeys):
    """Along which parameter a peak is followed, and how; give exactly one of the parameters."""


class OptimumKeys(PeakKeys):
    """What is varied to make a peak least, and how."""

    parameter: Annotated[Parameter, ONE_OF] = Field(
        default="slip_force",
        description='What is varied. With "level", a factor on the forces that vary, the amplitude '
        "per unit of level is made least: friction depends on the ratio of force and slip force.",
    )
    bounds: Annotated[tuple[float, float], PlainValidator(_bounds), _PAIR] | None = Field(
        default=None,
        description="Values to look between. Default, for slip forces: from 1/1000 to all of the "
        "largest force that the stuck contacts bear in the range of frequencies, beyond which "
        "nothing slips. At light damping that rises far above the load: the lower bound is then "
        "0.03 times, and the upper one at most 10 000 times, what they bear at the low end of the "
        "range. For levels likewise; for stiffnesses: 1/100 to 250 times that of the structure. "
        "Parameters of Coulomb contacts have none: give them.",
    )


class DamperSettings(_FollowedPeak):
    """How a damper curve was computed."""

    bounds: Flag = Field(
        default=False, description="Whether the residual tractions were varied, for bounds."
    )
    variation: Variation = Field(description="What is varied.")
    span: _PeakRange = Field(
        description="Range of frequencies in which the peak is the highest point [rad/s]."
    )


class StoredKeys(Settings):
    """What a study does that keeps its results as they come."""

    store: StorePath | None = Field(
        default=None,
        description="File in which the results are kept as they come. If there is one of the same "
        "study already, with as many patterns or samples, deviations and couplings or with others, "
        "only what is missing is computed: a run that was stopped, however rudely, goes on where "
        "it was. Default: none, and beside the result of a study file.",
    )
    portion: Portion = Field(
        default=(0, 1),
        description="Which part of the patterns or samples this run computes, (0, 4) the first of "
        "four: for job arrays, with a store each. `merge_stores` joins them.",
        examples=[[0, 4]],
    )
    threads: Count | None = Field(
        default=None, description="Threads. Default: as many as there are processors."
    )


class MistuningKeys(StoredKeys, PeakSettings):
    """How the disks of a mistuning study are made and computed."""

    deviation: _Deviations = Field(
        description="Standard deviations S of the sectors' stiffness: sector i of a pattern r has "
        "(1 + S r_i) K, as ``disk.mistuned(S * r)``.",
        examples=["7 %", ["1 %", "3 %", "5 %"]],
    )
    omega: PeakSpan = Field(
        description="Range of frequencies in which peaks are the highest points [rad/s]."
    )
    patterns: _Patterns = Field(
        default=1000,
        description="How many patterns are drawn; or the patterns themselves, in units of S.",
    )
    dofs: Dofs | None = Field(
        default=None,
        description="Degrees of freedom of a sector whose amplification is sought. Default: all "
        "that carry a contact or a force.",
        examples=[["tip"]],
    )
    coupling_stiffness: _Couplings | None = Field(
        default=None,
        description="Stiffnesses that all couplings take in turn [N/m]. Default: those of the "
        "disk.",
        examples=[["1e3 N/m", "1e4 N/m"]],
    )
    seed: Index = Field(
        default=0,
        description="Seed of the patterns drawn. Pattern i of a seed is the same for any number of "
        "them, and for all deviations and couplings.",
    )
    distribution: _Distribution = Field(
        default="normal",
        description="Distribution of zero mean and unit deviation of the patterns drawn.",
    )


class MistuningSettings(PeakSettings):
    """How the disks of a mistuning study were made and computed."""

    span: _PeakRange = Field(
        description="Range of frequencies in which peaks are the highest points [rad/s]."
    )
    distribution: _Distribution | None = Field(
        default="normal", description="What patterns are drawn from; none: they were given."
    )
    seed: Index | None = Field(default=0, description="Seed of the patterns drawn.")
