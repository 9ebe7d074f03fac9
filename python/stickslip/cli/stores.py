"""Where studies that can go on where they were stopped keep what they have."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from stickslip.study.analysis import MistuningStudyTable

if TYPE_CHECKING:
    from stickslip.study import Study

__all__ = ["storing"]


def storing(study: Study, folder: Path) -> Study:
    """Return the study with a store beside its result, unless it names one or needs none."""
    analysis = study.tables.analysis
    if not isinstance(analysis, MistuningStudyTable) or analysis.store is not None:
        return study
    kept = analysis.model_copy(update={"store": str(folder / f"{study.name}.db")})
    return replace(study, tables=study.tables.model_copy(update={"analysis": kept}))
