"""At which speeds natural frequencies are computed, and which engine orders are drawn."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from stickslip.settings.entries import ONE_OF, Count, Some
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
