"""Which degree of freedom is followed along the speed of rotation, and under which order."""

from __future__ import annotations

from pydantic import Field

from stickslip.settings.entries import Count, Dof, Factor
from stickslip.settings.ranges import Speeds
from stickslip.settings.settings import Settings


class SpeedSettings(Settings):
    """Degree of freedom, engine order and harmonics."""

    dof: Dof = Field(description="The degree of freedom that is looked at.", examples=["tip"])
    engine_order: Factor | None = Field(
        default=None,
        description="Frequency of the forces over the speed. Default: the engine order of a disk.",
        examples=[4],
    )
    harmonics: Count = Field(default=7, description="Highest harmonic kept.")


class SpeedKeys(SpeedSettings):
    """Speeds, and what is computed there."""

    speed: Speeds = Field(
        description="Speeds of rotation [rad/s], above 0.",
        examples=[{"from": "3000 rpm", "to": "4000 rpm", "points": 60}],
    )
