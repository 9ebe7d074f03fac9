"""The tables [disk] and [[coupling]] of a study file."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from stickslip.checks import brief
from stickslip.disk import Coupling
from stickslip.disk.pattern import mistuning_pattern, stiffness_of
from stickslip.errors import EntryError
from stickslip.settings.entries import (
    ONE_OF,
    Count,
    Dashpot,
    Dof,
    Index,
    Ratio,
    Some,
    StiffnessValue,
    Table,
)
from stickslip.study.matrices import DampingSource, MatrixSource


def _harmonics(value: object) -> object:
    # the keys of TOML tables are texts
    if not isinstance(value, Mapping):
        return value
    for key in value:
        if not (isinstance(key, int) or (isinstance(key, str) and re.fullmatch("[0-9]{1,9}", key))):
            raise EntryError("", f": {brief(key)} is no harmonic; write {{3 = 6}}")
    return {int(key): order for key, order in value.items()}


class CouplingTable(Table):
    """A spring between two DOFs; of a disk, from each sector to the next one."""

    dof: Dof = Field(description="DOF at one end; of a disk, of a sector.", examples=["tip"])
    other: Dof | None = Field(
        default=None,
        description="DOF at the other end; of a disk, of the next sector, left out: the same.",
    )
    stiffness: StiffnessValue = Field(description="Stiffness.")
    damping: Dashpot = Field(default=0.0, description="Viscous damping [kg/s].")

    def build(self) -> Coupling:
        """Return the coupling."""
        return Coupling(**dict(self))


class InterfaceTable(Table):
    """Blocks of cyclic matrices that couple each sector to the next."""

    stiffness: MatrixSource = Field(description="Stiffness block K1.", examples=["K1.mtx"])
    mass: MatrixSource | None = Field(default=None, description="Mass block M1; left out: none.")
    damping: DampingSource | None = Field(
        default=None, description="Damping block C1, or Rayleigh factors; left out: none."
    )


class MistuningTable(Table):
    """Deviations of the sectors' stiffness: given, or drawn at random."""

    pattern: Some[Ratio] | None = Field(
        default=None,
        description="Deviation of each sector; left out: drawn at random.",
        examples=[[0.02, "-3 %", 0.0]],
    )
    frequency: Some[Ratio] | None = Field(
        default=None,
        description="Instead: deviation of the natural frequency of each blade, as measured.",
        examples=[["1 %", "-1.5 %", 0.0]],
    )
    deviation: Ratio | None = Field(
        default=None, description="Standard deviation of the random ones.", examples=["7 %"]
    )
    distribution: Annotated[Literal["normal", "uniform"], ONE_OF] = Field(
        default="normal", description="Distribution of the random ones."
    )
    seed: Index = Field(default=0, description="Seed of the random ones.")

    @model_validator(mode="after")
    def _require_one_kind(self) -> Self:
        kinds = (self.pattern, self.frequency, self.deviation)
        if sum(one is not None for one in kinds) != 1:
            raise ValueError(
                "give either 'pattern', the deviations, or 'frequency', those of blade "
                "frequencies, or 'deviation', their size"
            )
        return self

    def values(self, sectors: int) -> NDArray[np.float64]:
        """Return the deviations of all sectors."""
        if self.frequency is not None:
            return stiffness_of(self.frequency, "mistuning.frequency")
        if self.deviation is None:
            return np.array(self.pattern, dtype=np.float64)
        return mistuning_pattern(sectors, self.deviation, self.distribution, seed=self.seed)


class DiskTable(Table):
    """Makes the structure a sector of a bladed disk."""

    sectors: Count = Field(description="Number of sectors.", examples=[36])
    engine_order: Index = Field(description="Engine order of the forces.")
    engine_orders: Annotated[
        Mapping[int, Index],
        BeforeValidator(_harmonics),
        WithJsonSchema({"type": "object", "additionalProperties": {"type": "integer"}}),
    ] = Field(
        default={},
        description="Engine orders of forces of other harmonics; left out: multiples.",
        examples=[{"3": 6}],
    )
    interface: InterfaceTable | None = Field(
        default=None,
        description="Blocks that couple each sector to the next.",
    )
    boundary: Mapping[str, str] = Field(
        default={},
        description="DOFs at the right cut of the sector, each with the one at the left cut that "
        "it is in the next sector.",
        examples=[{"right": "left"}],
    )
    mistuning: MistuningTable | None = Field(
        default=None,
        description="Deviations of the sectors; left out: all are equal.",
    )

    @model_validator(mode="after")
    def _require_one_interface(self) -> Self:
        if self.interface is not None and self.boundary:
            raise ValueError("give either 'interface', the blocks, or 'boundary', the two cuts")
        return self
