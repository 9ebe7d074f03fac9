"""The sectors that a travelling wave tells apart, by which its exact orbits are sought.

A sector of a wave feels its neighbours, and has no motion of its own in time. With ``X_j`` for
sector j of n, engine order E and the period T, ``X_j(t) = X_0(t + j E T/n)``: after T/n every
sector is where another one began, so that the n-th part of a period decides the orbit. Sectors that
move alike are one, and with ``x(t + T/2) = -x(t)`` so are opposite ones.
"""

from __future__ import annotations

from math import gcd
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip import _core
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.disk.coupling import Blocks, assembled
from stickslip.model.model import Model, from_core


class Rotation(NamedTuple):
    """A symmetry in space and time: ``X_j(t + T/parts) = sign X_(j+shift)(t)``."""

    sectors: int
    """Number of sectors that are told apart."""
    shift: int
    """Sectors by which the motion has moved on."""
    wrap: float
    """``X_(j+sectors) = wrap X_j``."""
    sign: float
    """1 or -1."""
    parts: int
    """Parts of the period."""


def rotation_of(disk: BladedDisk, *, half_wave: bool) -> Rotation:
    """Return the symmetry of the travelling wave of a disk, of as few sectors as it tells apart.

    `half_wave` says whether x(t + T/2) = -x(t). If nothing ties sectors together, one is enough.
    """
    order = disk.engine_order % disk.sectors if _tied(disk) else 0
    common = gcd(order, disk.sectors)
    sectors, order = disk.sectors // common, order // common
    # The sector that is ahead by T/sectors.
    ahead = pow(order, -1, sectors)
    if not half_wave:
        return Rotation(sectors, ahead, 1.0, 1.0, sectors)
    if sectors % 2 == 0:
        return Rotation(sectors // 2, ahead, -1.0, 1.0, sectors)
    shift = ahead * ((1 - sectors) // 2) % sectors
    return Rotation(sectors, shift, 1.0, -1.0, 2 * sectors)


def moving(model: Model, *, half_wave: bool) -> tuple[_core.Problem, Rotation | None]:
    """Return a model as the compiled core follows it in time, and the symmetry of its wave, if any.

    Of a tuned disk the sectors that its wave tells apart are followed; see `rotation_of`.
    """
    if not isinstance(model, BladedDisk):
        return model.problem, None
    rotation = rotation_of(model, half_wave=half_wave)
    return wave_ring(model, rotation), rotation


def wave_ring(
    disk: BladedDisk, rotation: Rotation, flow: NDArray[np.float64] | None = None
) -> _core.Problem:
    """Return the sectors that a wave tells apart as the compiled core sees them.

    `flow` is a further damping of all their DOFs [kg/s], of any symmetry.
    """
    _ = disk.problem  # refuses forces that make no single wave
    size, count = len(disk.structure), rotation.sectors
    matrices = (disk.matrices.mass, disk.matrices.damping, disk.matrices.stiffness)
    mass, damping, stiffness = (
        assembled(Blocks(np.array([one.own] * count), one.next), rotation.wrap) for one in matrices
    )
    if flow is not None:
        damping = damping + flow
    contacts = []
    loads = {k: np.zeros((count, size), np.complex128) for k, _ in disk._loads()}
    for sector in range(count):
        following = (sector + 1) % count
        for law, own, ahead, parameters in disk._core_contacts():
            rows = np.zeros((len(own), count, size))
            rows[:, sector] += own
            rows[:, following] += ahead if following else rotation.wrap * ahead
            contacts.append((law, rows.reshape(len(own), -1), parameters))
        for force in disk.forces_on(sector):
            loads[force.harmonic][sector, disk.structure.index(force.dof)] += force.coefficient
    forces = [(harmonic, load.ravel()) for harmonic, load in loads.items()]
    proportional = disk.matrices.proportional and flow is None
    return from_core(_core.Problem, mass, damping, stiffness, contacts, forces, proportional)


def _tied(disk: BladedDisk) -> bool:
    """Return whether anything ties a sector to the next one."""
    blocks = (disk.matrices.mass, disk.matrices.damping, disk.matrices.stiffness)
    return any(one.next.any() for one in blocks) or any(
        disk.contact_rows(contact)[1].any() for contact in disk.contacts
    )
