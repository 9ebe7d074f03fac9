"""Beams with friction dampers, and the single mass; both also under negative damping."""

from __future__ import annotations

from math import pi
from typing import Literal

import numpy as np

from stickslip.checks import Matrix, choice, whole_number
from stickslip.model import Force, Jenkins, Model, StructuralDamper
from stickslip.model.damping import Rayleigh
from stickslip.model.structure import Structure, join

SNECMA_LOADS = (0.938, 2.188, 6.563, 16.563, 20.313, 25.0, 31.475, 38.438)
"""The eight excitation levels of Table 2.3 [N]."""

DAMPER_STIFFNESS = 2.4e7
"""Stiffness k_d of the damper of eq. (2.32) and Table 2.2 [N/m]."""

DAMPER_SLIP_FORCE = 246.048
"""Slip force F_d of the damper of eq. (2.32) and Table 2.2 [N]."""


def snecma_structure() -> Structure:
    """Return the SNECMA beam without its damper: Guillen (1999), eq. (2.32); Berthillier (1998).

    Its degrees of freedom are "damper" (deflection at the damper), "tip" (deflection at the tip)
    and "mode" (first mode with both fixed); natural frequencies 159.5927, 901.7589 and 2167.5410
    rad/s.
    """
    return Structure(
        mass=[
            [6.67959, 1.02115, 0.6343],
            [1.02115, 1.22168, 0.232108],
            [0.6343, 0.232108, 0.121809],
        ],
        stiffness=[
            [4.43203e6, -3.77514e5, 0.0],
            [-3.77514e5, 6.9626e4, 0.0],
            [0.0, 0.0, 1.85323e5],
        ],
        damping=Rayleigh(mass=7.49, stiffness=2.6e-5),
        dofs=["damper", "tip", "mode"],
    )


def snecma_beam(force: float = 20.313) -> Model:
    """Return the SNECMA beam with one damper to ground, driven at its tip.

    `force` is the amplitude of the force [N]; see `SNECMA_LOADS` for those of the dissertation.
    Stuck natural frequencies 225.6623, 1404.3759 and 3273.7922 rad/s.

    From Guillen (1999), eq. (2.32) and Table 2.3.
    """
    return Model(snecma_structure(), [damper("damper")], [Force("tip", force)])


def single_dof(force_ratio: float = 1.0) -> Model:
    """Return one mass on a spring with a damper to ground: Guillen (1999), Table 2.2.

    `force_ratio` is the force amplitude over the slip force of the damper, P / F_d. The degree of
    freedom is "mass"; natural frequencies 159.3976 rad/s slipping, 225.4222 stuck.
    """
    mass = Structure(mass=[[944.6]], stiffness=[[2.4e7]], damping=[[7700.0]], dofs=["mass"])
    return Model(mass, [damper("mass")], [Force("mass", force_ratio * DAMPER_SLIP_FORCE)])


def beam_pair(
    force: float = 20.313,
    *,
    phase: float = pi / 9,
    stiffness: float = 1e6,
    slip_force: float = 50.0,
) -> Model:
    """Return two SNECMA beams rubbing against each other at their tips.

    `force` is the amplitude of the force on either tip [N], ahead by `phase` on beam "2" [rad]: by
    default as engine order 2 on 36 blades. The contact between the tips, "tips", has the stiffness
    [N/m] and the slip force [N]; "damper-1" and "damper-2" to ground are as of `snecma_beam`. There
    are 6 degrees of freedom "1.damper", "1.tip", ..., "2.mode".
    """
    return Model(
        join({"1": snecma_structure(), "2": snecma_structure()}),
        [
            damper("1.damper", "damper-1"),
            damper("2.damper", "damper-2"),
            Jenkins("1.tip", "2.tip", stiffness=stiffness, slip_force=slip_force, name="tips"),
        ],
        [Force("1.tip", force), Force("2.tip", force, phase)],
    )


def damped_pair(force: float = 35.0) -> Model:
    """Return two SNECMA beams joined by a structure-like damper, driven in opposition at the tips.

    `force` is the amplitude of the force on either tip [N]. There are 6 degrees of freedom
    "1.damper", "1.tip", ..., "2.mode"; the contact "structural" has four points, at "1.damper",
    "2.damper", "1.tip" and "2.tip", the last of which never slips. Stuck natural frequencies
    541.2619, 1090.2088, 2026.5922, ... rad/s.

    From Guillen (1999), section 6.4, eq. (6.26) and Table 6.3.
    """
    damper = StructuralDamper(
        ["1.damper", "2.damper", "1.tip", "2.tip"],
        stiffness=[
            [2.88e7, -2.4e7, 0.0, -4.8e6],
            [-2.4e7, 2.64e7, -2.4e6, 0.0],
            [0.0, -2.4e6, 2.64e6, -2.4e5],
            [-4.8e6, 0.0, -2.4e5, 5.04e6],
        ],
        slip_forces=[24.6, 100.0, 246.05, np.inf],
    )
    return Model(
        join({"1": snecma_structure(), "2": snecma_structure()}),
        [damper],
        [Force("1.tip", force), Force("2.tip", force, phase=pi)],
    )


def damper(dof: str, name: str | None = None) -> Jenkins:
    """Return the damper of Table 2.2, from a degree of freedom to ground."""
    return Jenkins(dof, stiffness=DAMPER_STIFFNESS, slip_force=DAMPER_SLIP_FORCE, name=name)


def negative_damping(structure: Structure) -> Matrix:
    """Return C_neg = -(7.49 M + 2.6e-5 K) [kg/s]: Guillen (1999), eqs. (5.2) and (5.22)."""
    return -(7.49 * structure.mass + 2.6e-5 * structure.stiffness)


def flutter_mass() -> tuple[Model, Matrix]:
    """Return `single_dof` without damping and force, and C_neg of the damping r C_neg [kg/s].

    From Guillen (1999), Table 5.1.
    """
    mass = Structure(mass=[[944.6]], stiffness=[[2.4e7]], damping=[[0.0]], dofs=["mass"])
    return Model(mass, [damper("mass")], []), negative_damping(mass)


def flutter_beam(
    mode: int | None = None, reading: Literal["literal", "ordered", "first"] = "literal"
) -> tuple[Model, Matrix]:
    """Return the SNECMA beam of chapter V, without force, and C_neg of the damping C + r C_neg.

    C is the positive damping of the other modes [kg/s].

    Parameters
    ----------
    mode : int, optional
        The one mode that is negatively damped, counted from 0. Default: all three, and C = 0.
    reading : {"literal", "ordered", "first"}, optional
        Which modes have the coefficients 5.7892, 27.6267 and 12.0954 of (5.30), if one mode is
        damped negatively: modes 0, 1 and 2 as printed; modes 2, 1 and 0 as they follow from (5.22),
        the print being in reverse order; or the latter with the 12.0954 of "c_3" made negative
        whatever `mode`, which is that of mode 0.

    References
    ----------
    Guillen (1999), eqs. (5.22) and (5.27) to (5.31); corrected: C = T^-T diag(c) T^-1, with
    eigenvectors of unit length.
    """
    free = snecma_structure()
    if mode is None:
        undamped = Structure(free.mass, free.stiffness, None, free.dofs)
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
    structure = Structure(free.mass, free.stiffness, positive, free.dofs)
    return Model(structure, [damper("damper")], []), negative
