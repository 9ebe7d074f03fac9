"""The table [analysis] of a mistuning study."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field, Strict, Tag

from stickslip.analyses.mistuning_study import mistuning_study
from stickslip.settings.entries import (
    Count,
    Dof,
    Omega,
    Ratio,
    StiffnessValue,
    Table,
    Text,
    number_or,
)
from stickslip.settings.peaks import MistuningKeys

if TYPE_CHECKING:
    from stickslip.model import Model
    from stickslip.results.mistuning import MistuningStudy

__all__ = ["MistuningStudyTable"]


class PeakRange(Table):
    """The range of frequencies in which peaks are looked for."""

    begin: Omega = Field(alias="from", description="Lowest frequency.", examples=["150 rad/s"])
    end: Omega = Field(alias="to", description="Highest frequency.", examples=["40 Hz"])


class MistuningStudyTable(MistuningKeys):
    """Amplification factors of many disks whose sectors deviate, and their distribution."""

    kind: Literal["mistuning-study"] = Field(description="The analysis.")
    deviation: Annotated[
        Annotated[tuple[Ratio, ...], Strict(False), Field(min_length=1), Tag("<list>")]
        | Annotated[Ratio, Tag("<number>")],
        number_or("<list>"),
    ] = Field(
        description="Standard deviation of the sectors' stiffness, one or several.",
        examples=["7 %", ["1 %", "3 %", "5 %"]],
    )
    omega: PeakRange = Field(title="omega", description="Range of the peaks.")
    patterns: Annotated[
        Annotated[
            tuple[Annotated[tuple[Annotated[float, Strict(False)], ...], Strict(False)], ...],
            Strict(False),
            Field(min_length=1),
            Tag("<list>"),
        ]
        | Annotated[Count, Tag("<number>")],
        number_or("<list>"),
    ] = Field(
        default=1000,
        description="Number of patterns drawn; or the patterns, in units of the deviation.",
        examples=[1000],
    )
    dofs: Annotated[tuple[Dof, ...], Strict(False), Field(min_length=1)] | None = Field(
        default=None,
        description="DOFs of a sector; left out: those that carry a force or a contact.",
        examples=[["tip"]],
    )
    coupling_stiffness: (
        Annotated[tuple[StiffnessValue, ...], Strict(False), Field(min_length=1)] | None
    ) = Field(
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
    def levels(self) -> None:
        """A mistuning study is one result."""
        return None

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
