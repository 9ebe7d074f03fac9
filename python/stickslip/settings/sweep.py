"""Which parameter of a model is varied, and its values."""

from __future__ import annotations

from typing import Annotated, ClassVar, Self, get_args

from pydantic import Field, Strict, model_validator

from stickslip.errors import ModelError
from stickslip.settings.entries import Index, Some
from stickslip.settings.ranges import (
    Frictions,
    Gaps,
    Levels,
    Preloads,
    SlipForces,
    Speeds,
    Springs,
    Stiffnesses,
)
from stickslip.settings.settings import Settings
from stickslip.settings.variation import ContactKeys, Parameter, Swept, Variation, one_of

ENGINE_ORDER = "engine_order"


class ParameterKeys(Settings):
    """A parameter and its values; exactly one is given."""

    parameters: ClassVar[tuple[str, ...]] = get_args(Parameter)
    """The keys of which one is given."""

    slip_force: SlipForces | None = Field(
        default=None,
        description="Slip forces F_d [N], in the order to follow; an infinite one never slips.",
        examples=[{"from": "1 N", "to": "10 kN", "points": 60}],
    )
    stiffness: Stiffnesses | None = Field(
        default=None,
        description="Instead: stiffnesses k_d of the contacts [N/m]. An infinite one is the limit "
        "of a rigid contact, and common values above 500 times the stiffness of the structure lie "
        "on the line in 1/k_d towards it.",
    )
    level: Levels | None = Field(
        default=None, description="Instead: factors on the forces that vary."
    )
    friction: Frictions | None = Field(
        default=None, description="Instead: coefficients of friction of Coulomb contacts."
    )
    preload: Preloads | None = Field(
        default=None, description="Instead: normal forces without motion [N]."
    )
    gap: Gaps | None = Field(
        default=None, description="Instead: gaps [m], negative for an interference."
    )
    tangential_stiffness: Springs | None = Field(
        default=None, description="Instead: tangential stiffnesses k_t of a node [N/m]."
    )
    normal_stiffness: Springs | None = Field(
        default=None, description="Instead: normal stiffnesses k_n of a node [N/m]."
    )

    @property
    def varied(self) -> Swept:
        """Which parameter is given."""
        return one_of(self, *self.parameters)  # type: ignore[arg-type]

    @model_validator(mode="after")
    def _require_one(self) -> Self:
        name = self.varied
        if str(name) != ENGINE_ORDER and isinstance(getattr(self, name), tuple):
            raise ModelError(f"{name}: a range needs 'points' here; values are not chosen")
        return self


class SweepKeys(ParameterKeys, ContactKeys):
    """Along which parameter models are computed; give exactly one of the parameters."""

    parameters = (*get_args(Swept), ENGINE_ORDER, "speed")

    normal_load: Preloads | None = Field(
        default=None,
        description="Instead: normal loads [N] of contacts whose slip force is friction times "
        "load.",
        examples=[["5 N", "10 N"]],
    )
    engine_order: Some[Index] | None = Field(
        default=None,
        description="Instead: engine orders of the forces on a bladed disk, tuned or mistuned.",
        examples=[[2, 3, 4]],
    )
    speed: Speeds | None = Field(
        default=None,
        description="Instead: speeds of rotation [rad/s], of a model that depends on it.",
        examples=[["3000 rpm", "3600 rpm"]],
    )


class SweepSettings(Settings):
    """What was varied along a sweep."""

    parameter: str = Field(description="Name of the parameter.")
    unit: str = Field(description="Its unit.")
    values: Annotated[tuple[float, ...], Strict(False)] = Field(description="Its values.")
    variation: Variation | None = Field(
        default=None, description="What is varied; none: models of the speed."
    )
