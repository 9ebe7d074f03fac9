"""Structures under negative damping."""

from __future__ import annotations

from typing import Literal

import numpy as np

from stickslip.checks import Matrix, choice, whole_number
from stickslip.model import Model
from stickslip.model.structure import Structure
from stickslip.reference.beams import damper, snecma_structure

__all__ = ["flutter_beam", "flutter_mass", "negative_damping"]


def negative_damping(structure: Structure) -> Matrix:
    """Return C_neg = -(7.49 M + 2.6e-5 K) [kg/s]: Guillen (1999), eqs. (5.2) and (5.22)."""
    return -(7.49 * structure.mass + 2.6e-5 * structure.stiffness)


def flutter_mass() -> tuple[Model, Matrix]:
    """Return the single mass of chapter V with its negative damping.

    Returns
    -------
    model : Model
        `single_dof` without damping and force.
    negative_damping : ndarray of float64, shape (1, 1)
        C_neg of the damping r C_neg [kg/s].

    References
    ----------
    Guillen (1999), Table 5.1.
    """
    mass = Structure(mass=[[944.6]], stiffness=[[2.4e7]], damping=[[0.0]], dofs=["mass"])
    return Model(mass, [damper("mass")], []), negative_damping(mass)


def flutter_beam(
    mode: int | None = None, reading: Literal["literal", "ordered", "first"] = "literal"
) -> tuple[Model, Matrix]:
    """Return the SNECMA beam of chapter V with its negative damping.

    Parameters
    ----------
    mode : int, optional
        The one mode that is negatively damped, counted from 0. Default: all three, and C = 0.
    reading : {"literal", "ordered", "first"}, optional
        Which modes have the coefficients 5.7892, 27.6267 and 12.0954 of (5.30), if one mode is
        damped negatively: modes 0, 1 and 2 as printed; modes 2, 1 and 0 as they follow from (5.22),
        the print being in reverse order; or the latter with the 12.0954 of "c_3" made negative
        whatever `mode`, which is that of mode 0.

    Returns
    -------
    model : Model
        With the positive damping of the other modes, without force.
    negative_damping : ndarray of float64, shape (3, 3)
        C_neg of the damping C + r C_neg [kg/s].

    References
    ----------
    Guillen (1999), eqs. (5.22) and (5.27) to (5.31); corrected: C = T^-T diag(c) T^-1, with
    eigenvectors of unit length.
    """
    free = snecma_structure()
    if mode is None:
        undamped = Structure(
            mass=free.mass, stiffness=free.stiffness, damping=np.zeros((3, 3)), dofs=free.dofs
        )
        return Model(undamped, [damper("damper")], []), negative_damping(free)
    choice(reading, "reading", ("literal", "ordered", "first"))
    number = whole_number(mode, "mode", largest=2)
    printed = np.array([5.7892, 27.6267, 12.0954])
    coefficients = printed if reading == "literal" else printed[::-1]
    if reading == "first":
        number = 0
    squares, shapes = np.linalg.eig(np.linalg.solve(free.mass, free.stiffness))
    shapes = shapes[:, np.argsort(squares)]
    shapes = shapes / np.linalg.norm(shapes, axis=0)
    inverse = np.linalg.inv(shapes)
    own = np.arange(3) == number
    positive = inverse.T @ np.diag(np.where(own, 0.0, coefficients)) @ inverse
    negative = inverse.T @ np.diag(np.where(own, -coefficients, 0.0)) @ inverse
    structure = Structure(
        mass=free.mass, stiffness=free.stiffness, damping=positive, dofs=free.dofs
    )
    return Model(structure, [damper("damper")], []), negative
