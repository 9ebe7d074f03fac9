"""How the equations of harmonic balance are solved."""

from __future__ import annotations

from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.settings.entries import (
    ONE_OF,
    Count,
    Flag,
    Harmonics,
    Residual,
    ResidualOrBounds,
    Span,
    Tolerance,
    Whole,
)
from stickslip.settings.ranges import Dofs, Frequencies
from stickslip.settings.settings import Settings

_ROUNDING = 100 * np.finfo(np.float64).eps
"""Pivot, relative to the number of degrees of freedom, that counts as none."""


class ObserveKeys(Settings):
    """What is kept of a motion."""

    observe: Dofs | None = Field(
        default=None,
        description="Degrees of freedom whose motion is kept. Default: all but modal coordinates "
        '("mode-1", ...).',
        examples=[["tip"]],
    )


class CurveKeys(ObserveKeys):
    """Where a curve is computed."""

    omega: Frequencies = Field(
        description="Angular frequencies [rad/s], swept in the order given. A range, of functions "
        "a tuple of two numbers, goes from the first to the second, upwards or downwards, and the "
        "frequencies in it are chosen to `tolerance`; write ``[one, two]`` or an array for a grid "
        "of two.",
        examples=[{"from": "20 rad/s", "to": "350 rad/s", "points": 400}, ["25 Hz", "26 Hz"]],
    )


class PointSettings(Settings):
    """How long a point is iterated."""

    max_iterations: Count = Field(
        default=100, description="Iterations per point before it is reported as stalled."
    )


def _rests_on_contacts(model: Model) -> bool:
    """Whether a body would drift without its contacts, whose normal loads vary.

    Centred tractions have no mean that could hold it: its mean position would be undetermined.
    """
    if not any("N" in contact.components for contact in model.contacts):
        return False
    *_, stiffness = model.matrices_at(0)
    scale = np.sqrt(np.abs(np.diag(stiffness)))
    if not scale.all():
        return True
    try:
        pivots = np.diag(np.linalg.cholesky(stiffness / np.outer(scale, scale))).real ** 2
    except np.linalg.LinAlgError:
        return True
    return bool(pivots.min() < _ROUNDING * len(pivots))


class SteadySettings(PointSettings):
    """What a steady state leaves open."""

    residual: Residual | None = Field(
        default=None,
        description="Force [N] that a contact holds at mid-range of its displacement if it never "
        'slips; the steady state alone does not determine it. "centred" is none, "from_rest" what '
        "is left of loads raised slowly from nothing. Default: centred, and from rest as soon as a "
        "static load acts, or where contacts alone hold a body. See "
        "`ForcedResponse.residual_bounds`.",
        examples=["from_rest", "10 N"],
    )

    def suited(self, model: Model) -> Self:
        """Return the settings with what the loads decide."""
        if self.residual is not None:
            return self
        static = any(force.harmonic == 0 and force.amplitude for force in model.forces)
        from_rest = static or _rests_on_contacts(model)
        return self.model_copy(update={"residual": "from_rest" if from_rest else "centred"})


class BoundsKey(SteadySettings):
    """What a steady state leaves open, or the bounds of all that it does."""

    residual: ResidualOrBounds | None = Field(  # type: ignore[assignment]
        default=None,
        description="Force [N] that a contact holds at mid-range of its displacement if it never "
        'slips; the steady state alone does not determine it. "centred" is none, "from_rest" what '
        'is left of loads raised slowly from nothing, "bounds" everything that Coulomb allows: '
        "`lower` and `upper` of the result, beside the default's curve. Default: centred, and from "
        "rest as soon as a static load acts, or where contacts alone hold a body. See "
        "`ForcedResponse.residual_bounds`.",
        examples=["from_rest", "10 N", "bounds"],
    )

    @property
    def bounded(self) -> bool:
        """Whether bounds over the residual tractions are asked for."""
        return self.residual == "bounds"

    def nominal(self, model: Model) -> Self:
        """Return the settings of the curve that bounds belong to."""
        return self.model_copy(update={"residual": None}).suited(model) if self.bounded else self


class HarmonicSettings(SteadySettings):
    """Which harmonics are kept, and how accurately."""

    harmonics: Harmonics = Field(
        default="auto",
        description='Highest harmonic kept, or "auto": per point, as many as `tolerance` asks for.',
    )
    tolerance: Tolerance = Field(
        default=1e-3,
        description="Relative accuracy of automatic harmonics, samples and steps, from 1e-8 to "
        "0.5.",
    )
    max_harmonics: Count = Field(default=255, description="Highest harmonic that may be kept.")

    @model_validator(mode="after")
    def _require_harmonics_below_their_limit(self) -> Self:
        if self.highest > self.max_harmonics:
            raise ModelError(
                f"harmonics: {self.harmonics} lies above max_harmonics = {self.max_harmonics}; "
                "lower it, or raise max_harmonics"
            )
        return self

    @property
    def fixed_harmonics(self) -> int | None:
        """The highest harmonic kept; None if it is chosen per point."""
        return None if self.harmonics == "auto" else self.harmonics

    @property
    def highest(self) -> int:
        """The highest harmonic that may be kept."""
        return self.fixed_harmonics or self.max_harmonics

    @property
    def bound(self) -> str:
        """The key that bounds the harmonics."""
        return "max_harmonics" if self.harmonics == "auto" else "harmonics"


class BalanceSettings(HarmonicSettings):
    """How a forced response is computed by harmonic balance."""

    method: Annotated[Literal["newton", "broyden"], ONE_OF] = Field(
        default="newton",
        description="Solver of the balance equations. Broyden's updates one Jacobian per point by "
        "rank one; on failure both go over to the same homotopy.",
    )
    jacobian: Annotated[Literal["exact", "differences"], ONE_OF] = Field(
        default="exact",
        description="First Jacobian of Broyden's method: the exact one, or forward differences.",
    )
    evaluation: Annotated[Literal["exact", "marched"], ONE_OF] = Field(
        default="exact",
        description="Friction laws by exact Fourier integrals, or all marched through equidistant "
        "samples: the alternating frequency/time scheme, for comparisons. Laws without a closed "
        "form are marched in any case. The sampling error is part of the error estimate.",
    )
    samples: Harmonics = Field(
        default="auto",
        description="Samples per period of the marched evaluation, even and at least 4 (H + 1), or "
        '"auto": per point the power of two whose sampling error stays below a quarter of '
        "`tolerance`.",
    )
    max_samples: Annotated[int, Whole(32, 1 << 20)] = Field(
        default=16384, description="Most automatic samples per period, a power of two."
    )

    @model_validator(mode="after")
    def _require_sense(self) -> Self:
        if self.jacobian != "exact" and self.method != "broyden":
            raise ModelError(
                f"jacobian: {self.jacobian!r} is a first Jacobian of Broyden's method; give "
                "method='broyden' with it, or leave it out"
            )
        least, kept = 4 * (self.highest + 1), f"for harmonics up to {self.highest}"
        if self.samples != "auto":
            if self.evaluation == "exact":
                raise ModelError(
                    f"samples: {self.samples} for the exact evaluation, which has none; give "
                    "evaluation='marched' with them, or leave them out"
                )
            if self.samples < least or self.samples % 2:
                raise ModelError(
                    f"samples: {self.samples} {kept}; give an even number from {least}"
                )
        if self.max_samples & (self.max_samples - 1):
            raise ModelError(
                f"max_samples: {self.max_samples} is not a power of two; give one, such as 4096"
            )
        if self.march == "auto" and self.max_samples < least:
            raise ModelError(
                f"max_samples: {self.max_samples} {kept}; give a power of two from {least}, or "
                "keep fewer harmonics"
            )
        return self

    @property
    def march(self) -> int | Literal["auto"] | None:
        """Samples per period of a marched evaluation; None if the evaluation is exact."""
        return None if self.evaluation == "exact" else self.samples


class StabilityKey(Settings):
    """Whether the stability of motions is asked for."""

    stability: Flag = Field(
        default=True,
        description="Whether Floquet multipliers decide which motions are stable where contact "
        "laws do not say it. A point then takes some hundred steps of the linearised equations.",
    )


class ForcedSettings(BalanceSettings, StabilityKey):
    """How a forced response was computed."""

    bounds: Flag = Field(
        default=False, description="Whether the residual tractions were varied, for bounds."
    )
    span: Span | None = Field(
        default=None,
        description="Ends of an adaptive sweep [rad/s]; none: omega was given point by point.",
    )


class BalanceKeys(BoundsKey, BalanceSettings, StabilityKey, CurveKeys):
    """What a forced response is computed of, and how."""
