"""The table [analysis] of a study file: its key `kind` chooses the class."""

from __future__ import annotations

from typing import Annotated

from pydantic import Tag

from stickslip.settings.entries import chosen_by
from stickslip.study.analysis_tables import (
    CertifyTable,
    ExactTable,
    ForcedResponseTable,
    SingleHarmonicTable,
)
from stickslip.study.basin_map_table import BasinMapTable
from stickslip.study.damper_curve_table import DamperCurveTable
from stickslip.study.limit_cycles_table import LimitCyclesTable
from stickslip.study.mistuning_study_table import MistuningStudyTable
from stickslip.study.transient_table import TransientTable

__all__ = ["AnalysisTable"]

AnalysisTable = Annotated[
    Annotated[ForcedResponseTable, Tag("<forced-response>")]
    | Annotated[ExactTable, Tag("<exact>")]
    | Annotated[TransientTable, Tag("<transient>")]
    | Annotated[CertifyTable, Tag("<certify>")]
    | Annotated[SingleHarmonicTable, Tag("<single-harmonic>")]
    | Annotated[DamperCurveTable, Tag("<damper-curve>")]
    | Annotated[BasinMapTable, Tag("<basin-map>")]
    | Annotated[MistuningStudyTable, Tag("<mistuning-study>")]
    | Annotated[LimitCyclesTable, Tag("<limit-cycles>")],
    chosen_by(
        "kind",
        "forced-response",
        "exact",
        "transient",
        "certify",
        "single-harmonic",
        "damper-curve",
        "basin-map",
        "mistuning-study",
        "limit-cycles",
        default="forced-response",
    ),
]
"""Each further analysis joins this union with a table of its own."""
