"""The tables [analysis] of harmonic balances: one class per kind of analysis."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import Field, PrivateAttr, Tag, WithJsonSchema, model_validator

from stickslip.analyses.forced_response import (
    EVALUATIONS,
    JACOBIANS,
    MAX_HARMONICS,
    MAX_ITERATIONS,
    MAX_SAMPLES,
    METHODS,
    Settings,
    forced_response,
)
from stickslip.model import Model
from stickslip.study.analysis_entries import (
    AnalysisEntries,
    OmegaEntry,
    ResidualEntry,
    omegas,
)
from stickslip.study.entries import Count, Tolerance, number_or

if TYPE_CHECKING:
    from stickslip.results import ForcedResponse

__all__ = ["BalanceTable", "ForcedResponseTable"]


class BalanceTable(AnalysisEntries):
    """The keys of a harmonic balance."""

    omega: OmegaEntry
    harmonics: Annotated[
        Annotated[Count, Tag("<number>")] | Annotated[Literal["auto"], Tag("<text>")],
        number_or("<text>"),
    ] = Field(
        default="auto", description="Highest harmonic kept, or 'auto': as the tolerance asks."
    )
    tolerance: Tolerance = Field(
        default=1e-3, description="Relative accuracy of what is automatic."
    )
    residual: ResidualEntry = "centred"
    method: Annotated[str, WithJsonSchema({"enum": list(METHODS)})] = Field(
        default="newton", description="Solver."
    )
    jacobian: Annotated[str, WithJsonSchema({"enum": list(JACOBIANS)})] = Field(
        default="exact", description="First Jacobian of Broyden's method."
    )
    evaluation: Annotated[str, WithJsonSchema({"enum": list(EVALUATIONS)})] = Field(
        default="exact", description="Evaluation of the friction laws."
    )
    samples: Annotated[
        Annotated[Count, Tag("<number>")] | Annotated[Literal["auto"], Tag("<text>")],
        number_or("<text>"),
    ] = Field(
        default="auto",
        description="Samples per period of a marched evaluation, or 'auto': as the tolerance asks.",
    )
    max_harmonics: Count = Field(
        default=MAX_HARMONICS, description="Highest harmonic that may be kept."
    )
    max_samples: Count = Field(
        default=MAX_SAMPLES, description="Most automatic samples, a power of two."
    )
    max_iterations: Count = Field(
        default=MAX_ITERATIONS, description="Iterations per point before it counts as stalled."
    )

    _shown: tuple[str, ...] = PrivateAttr(default=())

    def showing(self, dofs: Sequence[str]) -> Self:
        """Return the same analysis with the DOFs that the study shows, which must be accurate."""
        table = self.model_copy()
        table._shown = tuple(dofs)
        return table

    @model_validator(mode="after")
    def _require_settings(self) -> Self:
        # what the analysis would refuse is refused while the file is read, before any computing
        Settings(
            harmonics=self.harmonics,
            tolerance=self.tolerance,
            residual=self.residual,
            method=self.method,
            jacobian=self.jacobian,
            evaluation=self.evaluation,
            samples=self.samples,
            max_harmonics=self.max_harmonics,
            max_samples=self.max_samples,
            max_iterations=self.max_iterations,
        )
        return self

    def balance(self, model: Model, progress: Callable[[float], None] | None) -> ForcedResponse:
        """Compute one curve by harmonic balance."""
        return forced_response(
            model,
            omegas(self.omega),
            self.harmonics,
            tolerance=self.tolerance,
            residual=self.residual,
            method=self.method,
            jacobian=self.jacobian,
            evaluation=self.evaluation,
            samples=self.samples,
            observe=self.observe,
            outputs=self._shown,
            progress=progress,
            max_harmonics=self.max_harmonics,
            max_samples=self.max_samples,
            max_iterations=self.max_iterations,
        )


class ForcedResponseTable(BalanceTable):
    """Steady response to the forces, by harmonic balance."""

    kind: Literal["forced-response"] = Field(default="forced-response", description="The analysis.")

    def run(self, model: Model, progress: Callable[[float], None] | None) -> ForcedResponse:
        """Compute one curve."""
        return self.balance(model, progress)
