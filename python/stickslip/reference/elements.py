"""Structures of finite elements."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from stickslip.checks import Matrix
from stickslip.model import Force, Jenkins, Model
from stickslip.model.damping import ModalDamping, Rayleigh
from stickslip.model.structure import Structure

BLADE_DAMPER_STIFFNESS = 1e6
"""Stiffness of the damper under the platform of `turbine_blade` [N/m]."""

BLADE_SLIP_FORCE = 1.3263
"""Slip force F_d0 that minimises the peak of the tip of `turbine_blade` [N]."""


_MASS = [[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]
_BENDING = [[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]]
"""Consistent mass of a beam element over 1/420 of its mass, and its stiffness over E I / h^3."""


def rubber_beam(force: float = 1.5, *, damping_ratio: float = 1e-3) -> Model:
    """Return a finite-element model of the RubBeR friction-damped beam.

    A clamped-free Euler-Bernoulli beam of 14 elements, with a Jenkins contact to ground at its
    6th node, counted from the clamped one, and a force at its tip.

    Parameters
    ----------
    force : float, optional
        Amplitude of the force at the tip [N]. From about 3.6 N on, friction alone no longer bounds
        the first resonance.
    damping_ratio : float, optional
        Modal damping of the free beam. The published model has none.

    Returns
    -------
    Model
        28 degrees of freedom "w2", "slope2", ..., "w15", "slope15": deflection [m] and slope [rad]
        of every node but the clamped one. Free 67.960, 425.903 and 1192.611 Hz, stuck 80.367,
        452.785 and 1204.175 Hz.

    References
    ----------
    Scheel, Weigele and Krack (2020); dimensions as in the examples of NLvib (Krack and Gross,
    "Harmonic balance for nonlinear vibration problems", Springer 2019).
    """
    nodes, length, height, width = 15, 0.710, 0.05, 0.06
    modulus, density = 210e9 * 0.6725, 7850.0
    area, inertia = width * height, width * height**3 / 12
    element = length / (nodes - 1)
    beam = Structure(
        mass=_beam_matrix(density * area * element / 420.0 * _element(_MASS, element), nodes),
        stiffness=_beam_matrix(modulus * inertia / element**3 * _element(_BENDING, element), nodes),
        damping=ModalDamping(damping_ratio),
        dofs=[f"{kind}{node}" for node in range(2, nodes + 1) for kind in ("w", "slope")],
    )
    contact = Jenkins("w6", stiffness=1e7, slip_force=15.0)
    return Model(beam, [contact], [Force(f"w{nodes}", force)])


def turbine_blade(slip_force: float = BLADE_SLIP_FORCE, load: float = 1.0) -> Model:
    """Return an open turbine blade, 18 component modes of a finite-element model.

    A twisted blade of nickel alloy, 110 mm high and 40 mm wide, with a platform, on a shank whose
    root is clamped: 60,000 degrees of freedom reduced to 2 constraint modes and 16 fixed-interface
    modes. It takes the place of the proprietary blade of the dissertation. A pressure that grows
    along the airfoil, 100 Pa at the tip, excites all degrees of freedom.

    `slip_force` is that of the damper under the platform [N], `load` a factor on the pressure. The
    degrees of freedom are "damper" (under the platform, across the row of blades), "tip" (trailing
    edge of the tip, same direction) and "mode-1", ..., "mode-16". The damping ratio is 5e-4 at 1600
    and 47,000 rad/s and lower between them.

    References
    ----------
    Guillen (1999), section 4.3; made by examples/turbine-blade/reduce.py.
    """
    with np.load(Path(__file__).parents[1] / "data" / "turbine_blade.npz") as shipped:
        mass, stiffness, force = shipped["mass"], shipped["stiffness"], shipped["force"]
    ratio, low, high = 5e-4, 1600.0, 47000.0
    damping = Rayleigh(
        mass=2.0 * ratio * low * high / (low + high), stiffness=2.0 * ratio / (low + high)
    )
    dofs = ["damper", "tip", *(f"mode-{mode}" for mode in range(1, 17))]
    damper = Jenkins("damper", stiffness=BLADE_DAMPER_STIFFNESS, slip_force=slip_force)
    forces = [Force(dof, load * value) for dof, value in zip(dofs, force.tolist(), strict=True)]
    return Model(Structure(mass, stiffness, damping, dofs), [damper], forces)


def _element(shape: list[list[int]], h: float) -> Matrix:
    """Return the matrix of a beam element of length h, whose slopes are counted in lengths."""
    scale = np.array([1.0, h, 1.0, h])
    return np.asarray(np.array(shape) * scale * scale[:, None], dtype=np.float64)


def _beam_matrix(element: Matrix, nodes: int) -> Matrix:
    """Assemble equal elements in a row and clamp the first node."""
    whole = np.zeros((2 * nodes, 2 * nodes))
    for node in range(nodes - 1):
        ends = slice(2 * node, 2 * node + 4)
        whole[ends, ends] += element
    return whole[2:, 2:]
