"""The table [analysis] of limit cycles."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Literal, Self

from pydantic import Field, model_validator

from stickslip.analyses.limit_cycles import limit_cycles
from stickslip.checks import real_matrix
from stickslip.model import Model
from stickslip.settings.cycles import CycleKeys
from stickslip.settings.entries import (
    Contacts,
    Factor,
    ListOr,
    SlipForce,
    StiffnessValue,
    Table,
)
from stickslip.study.analysis_entries import SingleResult
from stickslip.study.matrices import damping_of, matrix_of
from stickslip.study.structure_table import (
    DampingSource,
    ModalDampingTable,
    RayleighDamping,
)

if TYPE_CHECKING:
    from stickslip.results.limit_cycles import LimitCycles
    from stickslip.study.tables import StudyTables

__all__ = ["LimitCyclesTable", "with_matrices"]


class RatioRange(Table):
    """A range of the ratio r."""

    begin: Factor = Field(alias="from", description="Lowest ratio.", examples=[0.01])
    end: Factor | None = Field(default=None, alias="to", description="Highest ratio.")


class StiffnessSpan(Table):
    """A range of contact stiffnesses."""

    begin: StiffnessValue = Field(alias="from", description="Lowest stiffness.")
    end: StiffnessValue = Field(alias="to", description="Highest stiffness.")


class SlipForceSpan(Table):
    """A range of slip forces."""

    begin: SlipForce = Field(alias="from", description="Lowest slip force.")
    end: SlipForce = Field(alias="to", description="Highest slip force.")


class LimitCyclesTable(CycleKeys, SingleResult):
    """Limit cycles under the damping C + r C_neg, along the ratio r or a parameter of contacts."""

    kind: Literal["limit-cycles"] = Field(description="The analysis.")
    negative_damping: DampingSource = Field(
        description="C_neg: a matrix, Rayleigh damping or modal damping with negative numbers.",
        examples=[{"rayleigh": {"mass": -7.49, "stiffness": -2.6e-5}}, {"modal": [-0.01, 0.0]}],
    )
    ratio: ListOr[Factor, RatioRange] | None = Field(
        default=None,
        title="ratio",
        description="Ratios r: a list or a range; left out: the whole branch.",
    )
    stiffness: StiffnessSpan | None = Field(
        default=None, title="stiffness", description="Range of contact stiffnesses to follow."
    )
    slip_force: SlipForceSpan | None = Field(
        default=None, title="slip_force", description="Range of slip forces to follow."
    )
    contacts: Contacts | None = Field(
        default=None,
        description="Names of the contacts that take the value, or [name, point]; left out: all.",
    )

    @model_validator(mode="after")
    def _require_sense(self) -> Self:
        followed = [one for one in (self.stiffness, self.slip_force) if one is not None]
        if len(followed) > 1:
            raise ValueError("give one of stiffness and slip_force")
        if followed and not (self.ratio is None or len(self._ratios()) == 1):
            raise ValueError("ratio must be one number in a list while a parameter is followed")
        return self

    def _ratios(self) -> tuple[float, ...]:
        return self.ratio if isinstance(self.ratio, tuple) else ()

    @property
    def observe(self) -> None:
        """All DOFs are kept."""
        return None

    @property
    def named_dofs(self) -> Mapping[str, Sequence[str]]:
        """The DOFs that each key names: none."""
        return {}

    def run(self, model: Model, progress: Callable[[float], None] | None) -> LimitCycles:
        """Compute the branch."""
        ratio: tuple[float, float] | list[float] | float | None = None
        if isinstance(self.ratio, RatioRange):
            ratio = (self.ratio.begin, inf if self.ratio.end is None else self.ratio.end)
        elif self.ratio is not None:
            one = self.stiffness is not None or self.slip_force is not None
            ratio = self.ratio[0] if one else list(self.ratio)
        spans = {
            name: None if span is None else (span.begin, span.end)
            for name, span in (("stiffness", self.stiffness), ("slip_force", self.slip_force))
        }
        return limit_cycles(
            model,
            damping_of(self.negative_damping, Path()),
            ratio=ratio,
            stiffness=spans["stiffness"],
            slip_force=spans["slip_force"],
            contacts=self.contacts,
            progress=progress,
            **self.part(CycleKeys),
        )


def with_matrices(tables: StudyTables, folder: Path) -> StudyTables:
    """Replace the file of a negative damping by its numbers: its folder is only known here."""
    analysis = tables.analysis
    if not isinstance(analysis, LimitCyclesTable):
        return tables
    source = analysis.negative_damping
    if isinstance(source, RayleighDamping | ModalDampingTable | tuple):
        return tables
    matrix = matrix_of(source, folder, "negative_damping")
    rows = tuple(tuple(map(float, row)) for row in real_matrix(matrix, "negative_damping"))
    read = analysis.model_copy(update={"negative_damping": rows})
    return tables.model_copy(update={"analysis": read})
