"""The table [analysis] of exact periodic orbits."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Literal

from pydantic import Field, model_validator

from stickslip.analyses.exact_response import (
    REPORTED_HARMONICS,
    ExactSettings,
    exact_response,
)
from stickslip.analyses.forced_response import MAX_ITERATIONS
from stickslip.model import Model
from stickslip.study.analysis_entries import AnalysisEntries, OmegaEntry, ResidualEntry, omegas
from stickslip.study.entries import Count, Tolerance

if TYPE_CHECKING:
    from typing import Self

    from stickslip.results.exact_response import ExactResponse

__all__ = ["ExactTable"]


class ExactTable(AnalysisEntries):
    """Steady response to the forces, by exact periodic orbits."""

    kind: Literal["exact"] = Field(description="The analysis.")
    omega: OmegaEntry
    harmonics: Count = Field(
        default=REPORTED_HARMONICS,
        description="Highest harmonic reported; the orbits do not depend on it.",
    )
    tolerance: Tolerance = Field(
        default=1e-3,
        description="Relative accuracy to which the frequencies of a range are chosen.",
    )
    residual: ResidualEntry = "centred"
    max_iterations: Count = Field(
        default=MAX_ITERATIONS,
        description="Iterations of shooting per point before it counts as stalled.",
    )

    @model_validator(mode="after")
    def _require_settings(self) -> Self:
        # what the analysis would refuse is refused while the file is read, before any computing
        ExactSettings(
            harmonics=self.harmonics,
            tolerance=self.tolerance,
            residual=self.residual,
            max_iterations=self.max_iterations,
        )
        return self

    def run(self, model: Model, progress: Callable[[float], None] | None) -> ExactResponse:
        """Compute one curve."""
        return exact_response(
            model,
            omegas(self.omega),
            harmonics=self.harmonics,
            tolerance=self.tolerance,
            residual=self.residual,
            observe=self.observe,
            progress=progress,
            max_iterations=self.max_iterations,
        )
