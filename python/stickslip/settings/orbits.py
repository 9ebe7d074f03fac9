"""How exact periodic orbits, single harmonics and certificates are computed."""

from __future__ import annotations

from numbers import Integral
from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from stickslip.checks import brief, members, whole_number
from stickslip.errors import EntryError, ModelError
from stickslip.settings.balance import BoundsKey, CurveKeys, PointSettings, SteadySettings
from stickslip.settings.entries import ONE_OF, Flag, Index, Span, Tolerance, Whole
from stickslip.settings.motion import MassScalingKey
from stickslip.settings.settings import Settings


class OrbitSettings(SteadySettings, MassScalingKey):
    """How exact orbits are computed."""

    harmonics: Annotated[int, Whole(1, 255)] = Field(
        default=32,
        description="Highest harmonic of each orbit reported; the orbits do not depend on it.",
    )
    tolerance: Tolerance = Field(
        default=1e-3,
        description="Relative accuracy to which the frequencies of a range are chosen, from 1e-8 "
        "to 0.5.",
    )


class ExactSettings(OrbitSettings):
    """How exact orbits were computed."""

    method: Annotated[Literal["exact"], ONE_OF] = Field(default="exact", description="Shooting.")
    bounds: Flag = Field(
        default=False, description="Whether the residual tractions were varied, for bounds."
    )
    span: Span | None = Field(
        default=None, description="Ends of the range of frequencies [rad/s]; none: omega was given."
    )

    @property
    def fixed_harmonics(self) -> int:
        """The highest harmonic reported."""
        return self.harmonics

    @property
    def march(self) -> None:
        """Orbits are not marched."""
        return None


class OrbitKeys(BoundsKey, OrbitSettings, CurveKeys):
    """Where exact orbits are computed, and how; those of a range are of a harmonic balance."""


class SingleHarmonicKeys(PointSettings, CurveKeys):
    """Where a single harmonic is balanced, and how."""

    estimate: Flag = Field(
        default=True,
        description="Estimate the error of leaving the higher harmonics out, which takes most of "
        "the time. Without it `ForcedResponse.error_estimate` is not-a-number.",
    )

    @model_validator(mode="after")
    def _require_points(self) -> Self:
        if isinstance(self.omega, tuple):
            raise ModelError(
                f"omega: {self.omega} is a range, which a single harmonic cannot choose steps in; "
                "give a grid, as np.linspace(start, end, 400)",
                study="omega: a range needs 'points' here; steps are not chosen",
            )
        return self


def _points(value: object) -> int | str | tuple[int, ...]:
    if isinstance(value, str):
        if value != "all":
            raise EntryError("", f': {brief(value)}; give "all", a number, or positions')
        return value
    if not hasattr(value, "__iter__"):
        return whole_number(value, "", smallest=1)
    given = members(value, "", "points=[...]")
    if not given:
        raise EntryError("", ": empty; give at least one position")
    for one in given:
        if isinstance(one, bool) or not isinstance(one, Integral):
            raise EntryError("", f": {brief(one)} is not an integer; give positions from 0")
    return tuple(map(int, given))


class CertifySettings(Settings):
    """At which points a curve is compared with exact orbits."""

    points: Annotated[
        int | Literal["all"] | tuple[int, ...],
        BeforeValidator(_points),
        WithJsonSchema({"type": ["integer", "string", "array"]}),
    ] = Field(
        default=20,
        description='How many points to choose at random, "all", or the positions of points from '
        "0. Points that are not solved are passed over.",
        examples=[20, "all", [0, 10, 20]],
    )
    seed: Index = Field(
        default=0, description="Seed of the random choice: the same seed chooses the same points."
    )
