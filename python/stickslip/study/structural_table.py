"""The table of a structure-like damper in a study file."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from stickslip.model import StructuralDamper
from stickslip.settings.entries import Dof, Many, SlipForce, Some, Table, Text
from stickslip.study.structure_table import Rows

__all__ = ["StructuralTable"]

_GROUND = "ground"
"""What a file calls the ground: it has no empty entries."""


class StructuralTable(Table):
    """A structure-like damper: a massless elastic body with several slipping contacts."""

    law: Literal["structural"] = Field(description="Friction law.")
    dofs: Some[Dof] = Field(
        description="The DOF that each contact touches; 'ground' is the ground.",
        examples=[["left.tip", "right.tip", "ground"]],
    )
    stiffness: Rows = Field(
        description="Stiffness of the damper by itself, row by row [N/m].",
        examples=[[[2e6, -2e6], [-2e6, 2e6]]],
    )
    slip_forces: Many[SlipForce] = Field(
        description="Slip limit of each contact; inf: it never slips.",
        examples=[["25 N", 1e3]],
    )
    name: Text | None = Field(default=None, description="Name; left out: that of the law.")

    @property
    def touched(self) -> tuple[str, ...]:
        """The DOFs it acts on."""
        return tuple(dof for dof in self.dofs if dof != _GROUND)

    def build(self) -> StructuralDamper:
        """Return the contact."""
        return StructuralDamper(
            [None if dof == _GROUND else dof for dof in self.dofs],
            stiffness=self.stiffness,
            slip_forces=self.slip_forces,
            name=self.name,
        )
