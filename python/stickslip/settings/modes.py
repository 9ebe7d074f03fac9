"""How nonlinear modes are computed."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, Strict

from stickslip.settings.balance import BoundsKey, HarmonicSettings
from stickslip.settings.entries import ONE_OF, Count, Flag, Index, Whole
from stickslip.settings.ranges import Amplitudes


class BackboneSettings(HarmonicSettings):
    """How a nonlinear mode is computed."""

    mode: Index = Field(
        default=0,
        description="Mode of the structure with its contacts as they are at rest, counted from 0 "
        "by rising frequency.",
    )
    method: Annotated[Literal["periodic", "phase-resonance", "quasi-static"], ONE_OF] = Field(
        default="periodic",
        description="What the mode is taken to be. periodic: a motion that a fictitious damping "
        "keeps up. phase-resonance: one that the forces of harmonic 1 keep up, in quadrature. "
        "quasi-static: the loop of a load of the shape of the linear mode, without inertia.",
    )
    max_harmonics: Count = Field(default=63, description="Highest harmonic that may be kept.")
    max_points: Annotated[int, Whole(2)] = Field(
        default=2000, description="Most points along a range of amplitudes."
    )
    nodal_diameter: Index | None = Field(
        default=None,
        description="Nodal diameter of the travelling wave of a tuned disk. Default: its engine "
        "order.",
    )


class ModeKeys(BoundsKey, BackboneSettings):
    """Which nonlinear mode, at which amplitudes, and how."""

    amplitude: Amplitudes = Field(
        description="Modal amplitudes a = (X_1^H M X_1)^(1/2) [m kg^(1/2)]. A list: exactly these. "
        "A range, of functions a tuple of two numbers: all between, with steps as the mode "
        "asks for.",
        examples=[{"from": 1e-6, "to": 1e-2}, [1e-4, 1e-3]],
    )


class ModeSettings(BackboneSettings):
    """How a nonlinear mode was computed."""

    amplitudes: Annotated[tuple[float, ...], Strict(False)] = Field(
        default=(), description="Amplitudes that were asked for, or the two ends of their range."
    )
    whole: Flag = Field(default=False, description="Whether the range between two is wanted.")
    bounds: Flag = Field(
        default=False, description="Whether the residual tractions were varied, for bounds."
    )
