"""The table [analysis] of a motion from a start state."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Literal

from pydantic import Field, model_validator

from stickslip.analyses.transient import (
    PERIODS,
    SAMPLES,
    STEPS,
    TransientSettings,
    transient,
)
from stickslip.model import Model
from stickslip.study.analysis_entries import AnalysisEntries
from stickslip.study.entries import Count, Length, Omega, Tolerance

if TYPE_CHECKING:
    from typing import Self

    from stickslip.results.transient import Transient

__all__ = ["TransientTable"]


class TransientTable(AnalysisEntries):
    """Motion from rest or given displacements, period after period."""

    kind: Literal["transient"] = Field(description="The analysis.")
    omega: Omega = Field(description="Angular frequency of the forces.")
    periods: Count = Field(
        default=PERIODS, description="Number of periods; with a tolerance their limit."
    )
    scheme: Literal["exact", "rk4"] = Field(
        default="exact",
        description="'exact': from event to event; 'rk4': Runge-Kutta steps.",
    )
    tolerance: Tolerance | None = Field(
        default=None,
        description="Relative change over a period at which the run ends; left out: none.",
    )
    start: Mapping[str, Length] = Field(
        default={},
        description="Displacements at the start by DOF, others zero; left out: rest.",
        examples=[{"tip": "1 mm"}],
    )
    steps: Count = Field(default=STEPS, description="Steps per period, for 'rk4'.")
    samples: Count = Field(default=SAMPLES, description="Instants per period in the results.")
    keep: Count | None = Field(
        default=None, description="How many of the last periods to keep; left out: all."
    )

    @property
    def named_dofs(self) -> Mapping[str, Sequence[str]]:
        """The DOFs that each key names."""
        return {**super().named_dofs, "start": tuple(self.start)}

    @model_validator(mode="after")
    def _require_settings(self) -> Self:
        # what the analysis would refuse is refused while the file is read, before any computing
        TransientSettings(
            omega=self.omega,
            scheme=self.scheme,
            periods=self.periods,
            tolerance=self.tolerance,
            steps=self.steps,
            samples=self.samples,
            keep=self.keep,
        )
        return self

    def run(self, model: Model, progress: Callable[[float], None] | None) -> Transient:
        """Compute one motion."""
        return transient(
            model,
            self.omega,
            self.periods,
            self.scheme,
            tolerance=self.tolerance,
            start=self.start or None,
            steps=self.steps,
            samples=self.samples,
            observe=self.observe,
            keep=self.keep,
            progress=progress,
        )
