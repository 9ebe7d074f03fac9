"""Matrices, meshes and measured responses from files."""

from stickslip.calls import checked_names
from stickslip.io.curve import read_curve
from stickslip.io.frf import Frf, read_frf, write_frf
from stickslip.io.matrices import read_dofs, read_matrix
from stickslip.io.meshes import read_mesh

__all__ = ["Frf", "read_curve", "read_dofs", "read_frf", "read_matrix", "read_mesh", "write_frf"]

checked_names(globals(), __all__)
