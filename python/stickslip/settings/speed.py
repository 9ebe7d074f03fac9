"""What is computed along the speed of rotation: natural frequencies, and responses of an order."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from stickslip.settings.entries import ONE_OF, Count, Dof, Factor, Some
from stickslip.settings.ranges import Speeds
from stickslip.settings.settings import Settings

Diagram = Annotated[Literal["campbell", "safe", "nodal-diameters"], ONE_OF]


class CampbellSettings(Settings):
    """Engine orders and diagram."""

    orders: Some[Count] | None = Field(
        default=None,
        description="Engine orders that are drawn. Default: those of the forces.",
        examples=[[2, 4, 6]],
    )
    diagram: Diagram = Field(
        default="campbell",
        description="What is drawn: frequencies over the speed; over the nodal diameter, with the "
        "line of excitation (SAFE) or without it.",
    )


class CampbellKeys(CampbellSettings):
    """Speeds and engine orders."""

    speed: Speeds | None = Field(
        default=None,
        description="Speeds of rotation [rad/s]. Default: one, at which nothing is excited.",
        examples=[{"from": "500 rpm", "to": "6000 rpm", "points": 12}],
    )


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
