"""What the flow does to a tuned disk, as study files have it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Self

from pydantic import Field, model_validator

from stickslip.disk.aerodynamics import AerodynamicDamping, Aerodynamics, ModalForces
from stickslip.disk.waves import InfluenceCoefficients
from stickslip.errors import ModelError
from stickslip.settings.entries import Dof, Index, Number, Ratio, Some, Table

Pair = Annotated[Some[Number], Field(min_length=2, max_length=2)]
"""Real and imaginary part."""


class InfluenceTable(Table):
    """Aerodynamic influence coefficients of a blade row."""

    coefficients: dict[str, Pair] = Field(
        description="L_j by the place j of the moving blade, as [real, imaginary].",
        examples=[{"0": [-30, 60], "1": [25, 18], "-1": [-10, -40]}],
    )
    dof: Dof | None = Field(default=None, description="The DOF that moves and is acted on [N/m].")
    mode: Index | None = Field(
        default=None, description="Instead: a mode of a blade by itself [1/s^2]."
    )

    @property
    def flow(self) -> InfluenceCoefficients:
        """The coefficients."""
        return InfluenceCoefficients(_complex(self.coefficients), self.dof, self.mode)


class FlowKeys(Table):
    """What the flow does; one of four forms."""

    damping_ratio: Some[Ratio] | None = Field(
        default=None,
        description="Aerodynamic damping ratio of the nodal diameters 0 to n-1.",
        examples=[["-0.1 %", "0.2 %"]],
    )
    decrement: Some[Ratio] | None = Field(
        default=None, description="Instead: logarithmic decrement, likewise."
    )
    modal_force: Some[Pair] | None = Field(
        default=None,
        description="Instead: modal forces of the nodal diameters 0 to n-1, [real, imaginary] "
        "[1/s^2].",
        examples=[[[-10, 20], [5, -3]]],
    )
    influence: InfluenceTable | None = Field(
        default=None, description="Instead: influence coefficients."
    )

    @model_validator(mode="after")
    def _require_one(self) -> Self:
        names = ("damping_ratio", "decrement", "modal_force", "influence")
        given = [name for name in names if getattr(self, name) is not None]
        if len(given) != 1:
            raise ModelError(
                f"analysis: {' and '.join(given) or 'no flow'} given; give exactly one of "
                f"{', '.join(names)}"
            )
        _ = self.flow
        return self

    @property
    def flow(self) -> Aerodynamics:
        """What the flow does."""
        if self.influence is not None:
            return self.influence.flow
        if self.modal_force is not None:
            return ModalForces([complex(*pair) for pair in self.modal_force])
        return AerodynamicDamping(ratio=self.damping_ratio, decrement=self.decrement)


def _complex(given: Mapping[str, tuple[float, ...]]) -> dict[int, complex]:
    try:
        return {int(place): complex(*pair) for place, pair in given.items()}
    except ValueError:
        raise ModelError(
            f"analysis: influence: coefficients: {', '.join(given)}; their keys are places, "
            "0 the blade itself, 1 the next, -1 the one before"
        ) from None
