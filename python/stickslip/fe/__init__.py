"""Finite elements: solids, and their reduction to component modes."""

from stickslip.fe.craig_bampton import craig_bampton
from stickslip.fe.reduction import Reduction
from stickslip.fe.report import ReductionReport
from stickslip.fe.solid import Solid

__all__ = ["Reduction", "ReductionReport", "Solid", "craig_bampton"]
