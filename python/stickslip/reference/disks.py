"""Bladed disks."""

from __future__ import annotations

import numpy as np

from stickslip.disk import BladedDisk, Coupling
from stickslip.model import Force
from stickslip.model.damping import ModalDamping
from stickslip.model.structure import Structure
from stickslip.reference.beams import damper, snecma_structure

RING_COUPLINGS = (1e3, 3e3, 5e3, 6e3, 7e3, 1.2e4, 1e5)
"""Coupling stiffnesses between the tips of the ring of beams, Figs 4.20-4.22 [N/m]."""


def beam_ring(
    sectors: int = 36, coupling: float = 1e5, engine_order: int = 2, force: float = 20.313
) -> BladedDisk:
    """Return a ring of SNECMA beams, coupled at their tips, each with its damper to ground.

    The springs between neighbouring tips have the stiffness `coupling` [N/m], see `RING_COUPLINGS`,
    and no damping. The engine order of the forces on the tips, of amplitude `force` [N], is 2 for
    the tuned ring and 3 for the mistuned one. From Guillen (1999), section 4.5.
    """
    return BladedDisk(
        snecma_structure(),
        sectors,
        [Coupling("tip", stiffness=coupling)],
        [damper("damper")],
        [Force("tip", force)],
        engine_order=engine_order,
    )


def laxalde_blisk(engine_order: int = 2, force: float = 1.0) -> BladedDisk:
    """Return the blisk of Laxalde et al.: 24 sectors of one disk and two blade masses.

    It has no friction contact of its own: friction rings act on "disk", added with
    ``blisk.replaced(contacts=[...])``.

    `force` is the amplitude of the force on the outer mass of every blade [N]. The degrees of
    freedom are "disk", "blade" and "tip", of 1.2, 0.35 and 0.25 kg. Nodal diameter 0: 88.26374399,
    249.31165161 and 619.34330474 Hz; 1: 169.3441295 Hz; 2: 189.3018526 Hz; 12: 195.67605066 Hz.

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
