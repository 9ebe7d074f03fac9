"""Reference systems with published results, for tests, examples and comparisons.

Sources: J. Guillen, "Studies of the dynamics of dry-friction-damped blade assemblies" (University
of Michigan, 1999); M. Scheel, T. Weigele and M. Krack, "Challenging an experimental nonlinear modal
analysis method with a new strongly friction-damped structure", J. Sound Vib. 485 (2020) 115580; D.
Laxalde, F. Thouverez, J.-J. Sinou and J.-P. Lombard, "Qualitative analysis of forced response of
blisks with friction ring dampers", Eur. J. Mech. A/Solids 26 (2007) 676-687.
"""

from __future__ import annotations

from math import pi
from pathlib import Path
from typing import Literal

import numpy as np

from stickslip.checks import Matrix, choice, whole_number
from stickslip.disk import BladedDisk, Coupling
from stickslip.model import Force, Jenkins, Model
from stickslip.model.structure import ModalDamping, Rayleigh, Structure, join

__all__ = [
    "BLADE_DAMPER_STIFFNESS",
    "BLADE_SLIP_FORCE",
    "DAMPER_SLIP_FORCE",
    "DAMPER_STIFFNESS",
    "RING_COUPLINGS",
    "SNECMA_LOADS",
    "beam_pair",
    "beam_ring",
    "flutter_beam",
    "flutter_mass",
    "laxalde_blisk",
    "negative_damping",
    "rubber_beam",
    "single_dof",
    "snecma_beam",
    "snecma_structure",
    "turbine_blade",
]

SNECMA_LOADS = (0.938, 2.188, 6.563, 16.563, 20.313, 25.0, 31.475, 38.438)
"""The eight excitation levels of Table 2.3 [N]."""

DAMPER_STIFFNESS = 2.4e7
"""Stiffness k_d of the damper of eq. (2.32) and Table 2.2 [N/m]."""

DAMPER_SLIP_FORCE = 246.048
"""Slip force F_d of the damper of eq. (2.32) and Table 2.2 [N]."""

BLADE_DAMPER_STIFFNESS = 1e6
"""Stiffness of the damper under the platform of `turbine_blade` [N/m]."""

BLADE_SLIP_FORCE = 1.3263
"""Slip force F_d0 that minimises the peak of the tip of `turbine_blade` [N]."""

RING_COUPLINGS = (1e3, 3e3, 5e3, 6e3, 7e3, 1.2e4, 1e5)
"""Coupling stiffnesses between the tips of the ring of beams, Figs 4.20-4.22 [N/m]."""


def snecma_structure() -> Structure:
    """Return the SNECMA beam without its damper.

    Returns
    -------
    Structure
        Degrees of freedom "damper" (deflection at the damper), "tip" (deflection at the tip) and
        "mode" (first mode with both fixed). Natural frequencies 159.5927, 901.7589 and
        2167.5410 rad/s.

    References
    ----------
    Guillen (1999), eq. (2.32); Berthillier et al. (1998).
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

    Parameters
    ----------
    force : float, optional
        Amplitude of the force [N]; see `SNECMA_LOADS` for those of the dissertation.

    Returns
    -------
    Model
        3 degrees of freedom; stuck natural frequencies 225.6623, 1404.3759 and 3273.7922 rad/s.

    References
    ----------
    Guillen (1999), eq. (2.32) and Table 2.3.
    """
    return Model(snecma_structure(), [_damper("damper")], [Force("tip", force)])


def single_dof(force_ratio: float = 1.0) -> Model:
    """Return one mass on a spring with a damper to ground.

    Parameters
    ----------
    force_ratio : float, optional
        Force amplitude over the slip force of the damper, P / F_d.

    Returns
    -------
    Model
        Degree of freedom "mass"; natural frequencies 159.3976 rad/s slipping, 225.4222 stuck.

    References
    ----------
    Guillen (1999), Table 2.2.
    """
    mass = Structure(mass=[[944.6]], stiffness=[[2.4e7]], damping=[[7700.0]], dofs=["mass"])
    return Model(mass, [_damper("mass")], [Force("mass", force_ratio * DAMPER_SLIP_FORCE)])


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
    return Model(mass, [_damper("mass")], []), negative_damping(mass)


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
        return Model(undamped, [_damper("damper")], []), negative_damping(free)
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
    return Model(structure, [_damper("damper")], []), negative


def beam_pair(
    force: float = 20.313,
    *,
    phase: float = pi / 9,
    stiffness: float = 1e6,
    slip_force: float = 50.0,
) -> Model:
    """Return two SNECMA beams rubbing against each other at their tips.

    Parameters
    ----------
    force : float, optional
        Amplitude of the force on either tip [N].
    phase : float, optional
        Phase lead of the force on beam "2" [rad]. Default: engine order 2 on 36 blades.
    stiffness : float, optional
        Stiffness of the contact between the tips [N/m].
    slip_force : float, optional
        Slip force of the contact between the tips [N].

    Returns
    -------
    Model
        6 degrees of freedom "1.damper", "1.tip", ..., "2.mode"; contacts "damper-1" and "damper-2"
        to ground, as of `snecma_beam`, and "tips".
    """
    return Model(
        join({"1": snecma_structure(), "2": snecma_structure()}),
        [
            _damper("1.damper", "damper-1"),
            _damper("2.damper", "damper-2"),
            Jenkins("1.tip", "2.tip", stiffness=stiffness, slip_force=slip_force, name="tips"),
        ],
        [Force("1.tip", force), Force("2.tip", force, phase)],
    )


def beam_ring(
    sectors: int = 36, coupling: float = 1e5, engine_order: int = 2, force: float = 20.313
) -> BladedDisk:
    """Return a ring of SNECMA beams, coupled at their tips, each with its damper to ground.

    Parameters
    ----------
    sectors : int, optional
        Number of beams.
    coupling : float, optional
        Stiffness of the springs between neighbouring tips [N/m]; see `RING_COUPLINGS`.
    engine_order : int, optional
        Engine order of the forces on the tips: 2 for the tuned ring, 3 for the mistuned one.
    force : float, optional
        Amplitude of the force on every tip [N].

    Returns
    -------
    BladedDisk
        3 degrees of freedom and 1 contact per sector.

    References
    ----------
    Guillen (1999), section 4.5. The couplings have no damping there.
    """
    return BladedDisk(
        snecma_structure(),
        sectors,
        [Coupling("tip", stiffness=coupling)],
        [_damper("damper")],
        [Force("tip", force)],
        engine_order=engine_order,
    )


def laxalde_blisk(engine_order: int = 2, force: float = 1.0) -> BladedDisk:
    """Return the blisk of Laxalde et al.: 24 sectors of one disk and two blade masses.

    It has no friction contact of its own: friction rings act on "disk", added with
    ``blisk.replaced(contacts=[...])``.

    Parameters
    ----------
    engine_order : int, optional
        Engine order of the forces on the blades.
    force : float, optional
        Amplitude of the force on the outer mass of every blade [N].

    Returns
    -------
    BladedDisk
        Degrees of freedom "disk", "blade" and "tip", of 1.2, 0.35 and 0.25 kg. Nodal diameter 0:
        88.26374399, 249.31165161 and 619.34330474 Hz; 1: 169.3441295 Hz; 2: 189.3018526 Hz; 12:
        195.67605066 Hz.

    References
    ----------
    Laxalde, Thouverez, Sinou and Lombard (2007). Their damping of 1e-3 is viscous here, a ratio of
    1e-3 in the modes of a sector whose neighbours are at rest.
    """
    ground, ring, inner, outer = 6e5, 5e7, 1e6, 2e6
    mass = np.diag([1.2, 0.35, 0.25])
    stiffness = np.array(
        [
            [ground + inner, -inner, 0.0],
            [-inner, inner + outer, -outer],
            [0.0, -outer, outer],
        ]
    )
    held = stiffness + np.diag([2.0 * ring, 0.0, 0.0])
    sector = Structure.of_law(
        mass, stiffness, ModalDamping(1e-3).matrix(mass, held), ["disk", "blade", "tip"], None
    )
    return BladedDisk(
        sector,
        24,
        [Coupling("disk", stiffness=ring)],
        forces=[Force("tip", force)],
        engine_order=engine_order,
    )


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
        mass=_beam_matrix(density * area * element * _element_mass(element), nodes),
        stiffness=_beam_matrix(modulus * inertia / element**3 * _element_stiffness(element), nodes),
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

    Parameters
    ----------
    slip_force : float, optional
        Of the damper under the platform [N].
    load : float, optional
        Factor on the pressure.

    Returns
    -------
    Model
        Degrees of freedom "damper" (under the platform, across the row of blades), "tip" (trailing
        edge of the tip, same direction) and "mode-1", ..., "mode-16". The damping ratio is 5e-4 at
        1600 and 47,000 rad/s and lower between them.

    References
    ----------
    Guillen (1999), section 4.3; made by examples/turbine-blade/reduce.py.
    """
    with np.load(Path(__file__).parent / "data" / "turbine_blade.npz") as shipped:
        mass, stiffness, force = shipped["mass"], shipped["stiffness"], shipped["force"]
    ratio, low, high = 5e-4, 1600.0, 47000.0
    damping = Rayleigh(
        mass=2.0 * ratio * low * high / (low + high), stiffness=2.0 * ratio / (low + high)
    )
    dofs = ["damper", "tip", *(f"mode-{mode}" for mode in range(1, 17))]
    damper = Jenkins("damper", stiffness=BLADE_DAMPER_STIFFNESS, slip_force=slip_force)
    forces = [Force(dof, load * value) for dof, value in zip(dofs, force.tolist(), strict=True)]
    return Model(Structure(mass, stiffness, damping, dofs), [damper], forces)


def _damper(dof: str, name: str | None = None) -> Jenkins:
    return Jenkins(dof, stiffness=DAMPER_STIFFNESS, slip_force=DAMPER_SLIP_FORCE, name=name)


def _element_mass(h: float) -> Matrix:
    """Return the consistent mass of a beam element of length h, over its mass."""
    return (
        np.array(
            [
                [156.0, 22.0 * h, 54.0, -13.0 * h],
                [22.0 * h, 4.0 * h**2, 13.0 * h, -3.0 * h**2],
                [54.0, 13.0 * h, 156.0, -22.0 * h],
                [-13.0 * h, -3.0 * h**2, -22.0 * h, 4.0 * h**2],
            ]
        )
        / 420.0
    )


def _element_stiffness(h: float) -> Matrix:
    """Return the stiffness of a beam element of length h, over E I / h^3."""
    return np.array(
        [
            [12.0, 6.0 * h, -12.0, 6.0 * h],
            [6.0 * h, 4.0 * h**2, -6.0 * h, 2.0 * h**2],
            [-12.0, -6.0 * h, 12.0, -6.0 * h],
            [6.0 * h, 2.0 * h**2, -6.0 * h, 4.0 * h**2],
        ]
    )


def _beam_matrix(element: Matrix, nodes: int) -> Matrix:
    """Assemble equal elements in a row and clamp the first node."""
    whole = np.zeros((2 * nodes, 2 * nodes))
    for node in range(nodes - 1):
        ends = slice(2 * node, 2 * node + 4)
        whole[ends, ends] += element
    return whole[2:, 2:]
