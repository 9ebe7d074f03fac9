"""Finite elements: solids, and their reduction to component modes."""

from stickslip.calls import checked_names
from stickslip.fe.component_modes import craig_bampton
from stickslip.fe.interface import ContactInterface
from stickslip.fe.mesh import Mesh
from stickslip.fe.reduction import Reduction, ReductionReport
from stickslip.fe.solid import Solid, von_mises, von_mises_range
from stickslip.fe.surface import Surface

__all__ = [
    "ContactInterface",
    "Mesh",
    "Reduction",
    "ReductionReport",
    "Solid",
    "Surface",
    "craig_bampton",
    "von_mises",
    "von_mises_range",
]

checked_names(globals(), __all__)
