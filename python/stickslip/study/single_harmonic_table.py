"""The table [analysis] of single-harmonic responses."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Literal

from pydantic import Field, model_validator

from stickslip.analyses.forced_response import MAX_ITERATIONS
from stickslip.analyses.single_harmonic import single_harmonic
from stickslip.model import Model
from stickslip.study.analysis_entries import AnalysisEntries, OmegaEntry, OmegaRange, omegas
from stickslip.study.entries import Count

if TYPE_CHECKING:
    from typing import Self

    from stickslip.results import ForcedResponse

__all__ = ["SingleHarmonicTable"]


class SingleHarmonicTable(AnalysisEntries):
    """Steady response to harmonic forces, by a single harmonic."""

    kind: Literal["single-harmonic"] = Field(description="The analysis.")
    omega: OmegaEntry
    estimate: bool = Field(
        default=True, description="Estimate the error of leaving the higher harmonics out."
    )
    max_iterations: Count = Field(
        default=MAX_ITERATIONS, description="Iterations per point before it counts as stalled."
    )

    @model_validator(mode="after")
    def _require_points(self) -> Self:
        if isinstance(self.omega, OmegaRange) and self.omega.points is None:
            raise ValueError("omega: a range needs 'points' here; steps are not chosen")
        return self

    def run(self, model: Model, progress: Callable[[float], None] | None) -> ForcedResponse:
        """Compute one curve."""
        return single_harmonic(
            model,
            omegas(self.omega),
            estimate=self.estimate,
            observe=self.observe,
            progress=progress,
            max_iterations=self.max_iterations,
        )
