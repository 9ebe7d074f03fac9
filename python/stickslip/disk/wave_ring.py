"""The sectors that a travelling wave tells apart: what its exact orbits are sought with.

A sector of a wave feels its neighbours, and has no motion of its own in time. With ``X_j`` for
sector j of n, engine order E and the period T, ``X_j(t) = X_0(t + j E T/n)``: after T/n every
sector is where another one began, so that the n-th part of a period decides the orbit. Sectors that
move alike are one, and with ``x(t + T/2) = -x(t)`` so are opposite ones.
"""

from __future__ import annotations

from math import gcd
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from stickslip.checks import Matrix
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.disk.cyclic import Blocks
from stickslip.errors import ModelError
from stickslip.model import Model

if TYPE_CHECKING:
    from stickslip import _core

__all__ = ["Rotation", "moving", "rotation_of", "wave_ring"]


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
    """Return the symmetry of the travelling wave of a disk.

    Parameters
    ----------
    disk : BladedDisk
        The disk.
    half_wave : bool
        Whether x(t + T/2) = -x(t).

    Returns
    -------
    Rotation
        Of as few sectors as the wave tells apart; of one if nothing ties sectors together.
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
    """Return a model as the compiled core follows it in time.

    Parameters
    ----------
    model : Model
        The model; of a tuned disk the sectors that its wave tells apart are followed.
    half_wave : bool
        Whether x(t + T/2) = -x(t).

    Returns
    -------
    (Problem, Rotation or None)
        The problem, and the symmetry of the wave if there is one.

    Raises
    ------
    ModelError
        If the forces on a disk make no single travelling wave, or the core refuses the numbers.
    """
    if not isinstance(model, BladedDisk):
        return model.problem, None
    rotation = rotation_of(model, half_wave=half_wave)
    return wave_ring(model, rotation), rotation


def wave_ring(disk: BladedDisk, rotation: Rotation) -> _core.Problem:
    """Return the sectors that a wave tells apart as the compiled core sees them.

    Raises
    ------
    ModelError
        If the forces make no single travelling wave, or the core refuses the numbers.
    """
    from stickslip import _core

    _ = disk.problem  # refuses forces that make no single wave
    size, count = len(disk.structure), rotation.sectors
    matrices = disk.matrices
    mass, damping, stiffness = (
        _assembled(blocks, rotation)
        for blocks in (matrices.mass, matrices.damping, matrices.stiffness)
    )
    contacts = []
    for sector in range(count):
        following, factor = _next(sector, rotation)
        for contact in disk.contacts:
            own, ahead = disk.contact_rows(contact)
            rows = np.zeros((contact.points, count * size))
            rows[:, _block(sector, size)] += own
            rows[:, _block(following, size)] += factor * ahead
            contacts.append((contact.law, rows, contact.law_parameters()))
    loads = {
        force.harmonic: np.zeros(count * size, dtype=np.complex128)
        for force in sorted(disk.forces, key=lambda one: one.harmonic)
    }
    for sector in range(count):
        for force in disk.forces_on(sector):
            place = sector * size + disk.structure.index(force.dof)
            loads[force.harmonic][place] += force.coefficient
    try:
        return _core.Problem(
            mass, damping, stiffness, contacts, list(loads.items()), matrices.proportional
        )
    except ValueError as error:
        raise ModelError(str(error)) from error


def _tied(disk: BladedDisk) -> bool:
    """Return whether anything ties a sector to the next one."""
    blocks = (disk.matrices.mass, disk.matrices.damping, disk.matrices.stiffness)
    return any(one.next.any() for one in blocks) or any(
        disk.contact_rows(contact)[1].any() for contact in disk.contacts
    )


def _next(sector: int, rotation: Rotation) -> tuple[int, float]:
    """Return the sector after one, and the factor of its motion."""
    if sector + 1 < rotation.sectors:
        return sector + 1, 1.0
    return 0, rotation.wrap


def _block(sector: int, size: int) -> slice:
    return slice(sector * size, (sector + 1) * size)


def _assembled(blocks: Blocks, rotation: Rotation) -> Matrix:
    size, count = len(blocks.own), rotation.sectors
    total = np.zeros((count * size, count * size))
    for sector in range(count):
        following, factor = _next(sector, rotation)
        own, ahead = _block(sector, size), _block(following, size)
        total[own, own] += blocks.own
        total[own, ahead] += factor * blocks.next
        total[ahead, own] += factor * blocks.next.T
    return total
