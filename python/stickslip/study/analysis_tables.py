"""The tables [analysis] of curves over frequency: their settings and the frequencies."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Literal, Self

from pydantic import Field, PrivateAttr, model_validator

from stickslip.analyses.certify import certify
from stickslip.analyses.exact_response import exact_response
from stickslip.analyses.forced_response import forced_response
from stickslip.analyses.single_harmonic import single_harmonic
from stickslip.model import Model
from stickslip.settings.balance import BalanceSettings
from stickslip.settings.orbits import CertifySettings, OrbitSettings, SingleHarmonicSettings
from stickslip.study.analysis_entries import AnalysisEntries, OmegaEntry, OmegaRange, omegas

if TYPE_CHECKING:
    from stickslip.analyses.run import Progress
    from stickslip.results import ForcedResponse
    from stickslip.results.exact_response import ExactResponse

__all__ = ["CertifyTable", "ExactTable", "ForcedResponseTable", "SingleHarmonicTable"]

# Share of the progress that the balance is given before it is certified.
_BALANCE = 0.5


class CurveEntries(AnalysisEntries):
    """The keys of every curve over frequency."""

    omega: OmegaEntry


class ForcedResponseTable(BalanceSettings, CurveEntries):
    """Steady response to the forces, by harmonic balance."""

    kind: Literal["forced-response"] = Field(default="forced-response", description="The analysis.")

    _shown: tuple[str, ...] = PrivateAttr(default=())

    def showing(self, dofs: Sequence[str]) -> Self:
        """Return the same analysis with the DOFs that the study shows, which must be accurate."""
        table = self.model_copy()
        table._shown = tuple(dofs)
        return table

    def run(self, model: Model, progress: Progress) -> ForcedResponse:
        """Compute one curve."""
        return forced_response(
            model,
            omegas(self.omega),
            observe=self.observe,
            outputs=self._shown,
            progress=progress,
            **self.part(BalanceSettings),
        )


class CertifyTable(CertifySettings, ForcedResponseTable):
    """Steady response by harmonic balance, compared with exact orbits at some points."""

    kind: Literal["certify"] = Field(description="The analysis.")  # type: ignore[assignment]

    def run(self, model: Model, progress: Progress) -> ForcedResponse:
        """Compute one curve, and compare it."""
        balance = super().run(model, _within(progress, 0.0, _BALANCE))
        settings = self.part(CertifySettings)
        return certify(balance, progress=_within(progress, _BALANCE, 1.0), **settings)


class ExactTable(OrbitSettings, CurveEntries):
    """Steady response to the forces, by exact periodic orbits."""

    kind: Literal["exact"] = Field(description="The analysis.")

    def run(self, model: Model, progress: Progress) -> ExactResponse:
        """Compute one curve."""
        settings = self.part(OrbitSettings)
        omega = omegas(self.omega)
        return exact_response(model, omega, observe=self.observe, progress=progress, **settings)


class SingleHarmonicTable(SingleHarmonicSettings, CurveEntries):
    """Steady response to harmonic forces, by a single harmonic."""

    kind: Literal["single-harmonic"] = Field(description="The analysis.")

    @model_validator(mode="after")
    def _require_points(self) -> Self:
        if isinstance(self.omega, OmegaRange) and self.omega.points is None:
            raise ValueError("omega: a range needs 'points' here; steps are not chosen")
        return self

    def run(self, model: Model, progress: Progress) -> ForcedResponse:
        """Compute one curve."""
        settings = self.part(SingleHarmonicSettings)
        omega = omegas(self.omega)
        return single_harmonic(model, omega, observe=self.observe, progress=progress, **settings)


def _within(progress: Progress, start: float, end: float) -> Callable[[float], None] | None:
    if progress is None:
        return None
    return lambda share: progress(start + (end - start) * share)
