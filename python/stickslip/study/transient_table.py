"""The table [analysis] of a motion from a start state."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Literal

from pydantic import Field

from stickslip.analyses.transient import transient
from stickslip.model import Model
from stickslip.settings.entries import Length
from stickslip.settings.motion import TransientSettings
from stickslip.study.analysis_entries import AnalysisEntries

if TYPE_CHECKING:
    from stickslip.results.transient import Transient

__all__ = ["TransientTable"]


class TransientTable(TransientSettings, AnalysisEntries):
    """Motion from rest or given displacements, period after period."""

    kind: Literal["transient"] = Field(description="The analysis.")
    start: Mapping[str, Length] = Field(
        default={},
        description="Displacements at the start by DOF, others zero; left out: rest.",
        examples=[{"tip": "1 mm"}],
    )

    @property
    def named_dofs(self) -> Mapping[str, Sequence[str]]:
        """The DOFs that each key names."""
        return {**super().named_dofs, "start": tuple(self.start)}

    def run(self, model: Model, progress: Callable[[float], None] | None) -> Transient:
        """Compute one motion."""
        settings = self.part(TransientSettings)
        start = self.start or None
        return transient(model, start=start, observe=self.observe, progress=progress, **settings)
