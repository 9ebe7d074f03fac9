"""The table [analysis] of a mistuning study."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field, Strict

from stickslip.analyses.mistuning_study import mistuning_study
from stickslip.settings.entries import (
    Count,
    Dof,
    ListOr,
    Many,
    Ratio,
    Some,
    StiffnessValue,
    Text,
)
from stickslip.settings.peaks import MistuningKeys
from stickslip.study.analysis_entries import PeakRange, SingleResult

if TYPE_CHECKING:
    from stickslip.model import Model
    from stickslip.results.mistuning import MistuningStudy

__all__ = ["MistuningStudyTable"]


class MistuningStudyTable(MistuningKeys, SingleResult):
    """Amplification factors of many disks whose sectors deviate, and their distribution."""

    kind: Literal["mistuning-study"] = Field(description="The analysis.")
    deviation: ListOr[Ratio, Ratio] = Field(
        description="Standard deviation of the sectors' stiffness, one or several.",
        examples=["7 %", ["1 %", "3 %", "5 %"]],
    )
    omega: PeakRange = Field(title="omega", description="Range of the peaks.")
    patterns: ListOr[Many[Annotated[float, Strict(False)]], Count] = Field(
        default=1000,
        description="Number of patterns drawn; or the patterns, in units of the deviation.",
        examples=[1000],
    )
    dofs: Some[Dof] | None = Field(
        default=None,
        description="DOFs of a sector; left out: those that carry a force or a contact.",
        examples=[["tip"]],
    )
    coupling_stiffness: Some[StiffnessValue] | None = Field(
        default=None,
        description="Stiffnesses that all couplings take in turn; left out: their own.",
        examples=[["1e3 N/m", "1e4 N/m"]],
    )
    store: Text | None = Field(
        default=None,
        description="File in which disks are kept as they come, for a run that goes on where it "
        "was stopped; left out: beside the result.",
    )

    @property
    def observe(self) -> tuple[str, ...] | None:
        """The DOFs studied."""
        return self.dofs

    @property
    def named_dofs(self) -> Mapping[str, Sequence[str]]:
        """The DOFs that each key names."""
        return {"dofs": self.dofs or ()}

    def run(self, model: Model, progress: Callable[[float], None] | None) -> MistuningStudy:
        """Compute the study, but for what its store holds."""
        return mistuning_study(
            model,
            self.deviation,
            omega=(self.omega.begin, self.omega.end),
            patterns=self.patterns,
            dofs=self.dofs,
            coupling_stiffness=self.coupling_stiffness,
            store=self.store,
            progress=progress,
            **self.part(MistuningKeys),
        )
