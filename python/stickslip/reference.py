"""Reference systems with published results, for tests, examples and comparisons.

Sources: J. Guillen, "Studies of the dynamics of dry-friction-damped blade assemblies" (University
of Michigan, 1999); M. Scheel, T. Weigele and M. Krack, "Challenging an experimental nonlinear modal
analysis method with a new strongly friction-damped structure", J. Sound Vib. 485 (2020) 115580; D.
Laxalde, F. Thouverez, J.-J. Sinou and J.-P. Lombard, "Qualitative analysis of forced response of
blisks with friction ring dampers", Eur. J. Mech. A/Solids 26 (2007) 676-687.
"""

from __future__ import annotations

from math import pi

import numpy as np

from stickslip.checks import Matrix
from stickslip.disk import BladedDisk, Coupling
from stickslip.model import Force, Jenkins, Model, StructuralDamper
from stickslip.model.structure import ModalDamping, Rayleigh, Structure, join

__all__ = [
    "DAMPER_SLIP_FORCE",
    "DAMPER_STIFFNESS",
    "RING_COUPLINGS",
    "SNECMA_LOADS",
    "beam_pair",
    "beam_ring",
    "damped_pair",
    "laxalde_blisk",
    "rubber_beam",
    "single_dof",
    "snecma_beam",
    "snecma_structure",
]

SNECMA_LOADS = (0.938, 2.188, 6.563, 16.563, 20.313, 25.0, 31.475, 38.438)
"""The eight excitation levels of Table 2.3 [N]."""

DAMPER_STIFFNESS = 2.4e7
"""Stiffness k_d of the damper of eq. (2.32) and Table 2.2 [N/m]."""

DAMPER_SLIP_FORCE = 246.048
"""Slip force F_d of the damper of eq. (2.32) and Table 2.2 [N]."""

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


def damped_pair(force: float = 35.0) -> Model:
    """Return two SNECMA beams joined by a structure-like damper, driven in opposition at the tips.

    Parameters
    ----------
    force : float, optional
        Amplitude of the force on either tip [N].

    Returns
    -------
    Model
        6 degrees of freedom "1.damper", "1.tip", ..., "2.mode"; the contact "structural" with four
        points, at "1.damper", "2.damper", "1.tip" and "2.tip", the last of which never slips.
        Stuck natural frequencies 541.2619, 1090.2088, 2026.5922, ... rad/s.

    References
    ----------
    Guillen (1999), section 6.4, eq. (6.26) and Table 6.3.
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
