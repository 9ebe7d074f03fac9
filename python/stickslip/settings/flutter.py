"""How the limit cycles of the travelling waves of a disk are computed."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, Strict

from stickslip.settings.balance import HarmonicSettings
from stickslip.settings.entries import Count, Flag, Index, Whole
from stickslip.settings.ranges import Amplitudes


class FlutterModeSettings(HarmonicSettings):
    """How the nonlinear modes of the waves are computed."""

    mode: Index = Field(
        default=0,
        description="Mode of a wave with its contacts as they are at rest, counted from 0 at every "
        "nodal diameter.",
    )
    multipliers: Flag = Field(
        default=False,
        description="Decide the stability of limit cycles by the Floquet multipliers of the ring "
        "of all sectors, against all waves. Default: by the slope of the damping over the "
        "amplitude, against the own wave alone.",
    )
    direct: Flag = Field(
        default=True,
        description="Solve the whole equations for the limit cycles as well, and say how far those "
        "of the nonlinear modes are from them.",
    )
    max_harmonics: Count = Field(default=63, description="Highest harmonic that may be kept.")


class FlutterKeys(FlutterModeSettings):
    """Which waves, at which amplitudes, and how."""

    amplitude: Amplitudes | None = Field(
        default=None,
        description="Modal amplitudes of a sector, a = (X_1^H M X_1)^(1/2) [m kg^(1/2)]: a list, "
        "or a range, of functions a tuple, of which `points` are taken. Default: from half of that "
        "at which the first contact slips to 100 times the median of those at which contacts do.",
        examples=[{"from": 1e-6, "to": 1e-2}],
    )
    points: Annotated[int, Whole(4, 1000)] = Field(
        default=41, description="Amplitudes in a range, evenly spaced in their logarithm."
    )


class FlutterSettings(FlutterModeSettings):
    """How the limit cycles of all waves were computed."""

    amplitudes: Annotated[tuple[float, ...], Strict(False)] = Field(
        default=(), description="The modal amplitudes."
    )
