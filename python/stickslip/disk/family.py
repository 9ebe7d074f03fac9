"""A tuned disk as the compiled core takes it to make many mistuned ones of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stickslip.checks import Matrix
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.errors import ModelError
from stickslip.model.damping import ModalDamping, Rayleigh
from stickslip.model.structure import Structure

if TYPE_CHECKING:
    from stickslip import _core

__all__ = ["family"]


def family(disk: BladedDisk) -> _core.TunedDisk:
    """Return what makes mistuned disks without Python.

    Parameters
    ----------
    disk : BladedDisk
        The tuned disk.

    Returns
    -------
    TunedDisk
        Its method `mistuned` makes what ``disk.mistuned(pattern).problem`` is, to rounding.

    Raises
    ------
    ModelError
        If the core refuses the numbers.
    """
    from stickslip import _core

    sector, matrices = disk.structure, disk.matrices
    constant, proportional, root = _damping(sector)
    places = [disk.contact_rows(contact) for contact in disk.contacts]
    contacts = [
        (contact.law, *rows, contact.law_parameters())
        for contact, rows in zip(disk.contacts, places, strict=True)
    ]
    loads = disk.mistuned(0.0).ring.loads
    forces = [[(k, load[number]) for k, load in loads] for number in range(disk.sectors)]
    try:
        return _core.TunedDisk(
            matrices.mass.own,
            sector.stiffness,
            matrices.stiffness.own - sector.stiffness,
            (constant + (matrices.damping.own - sector.damping), proportional, root),
            (matrices.mass.next, matrices.damping.next, matrices.stiffness.next),
            contacts,
            forces,
            matrices.proportional,
        )
    except ValueError as error:
        raise ModelError(str(error)) from error


def _damping(sector: Structure) -> tuple[Matrix, Matrix, Matrix]:
    """Return the damping that stays, that goes with the stiffness, and that with its root.

    Given damping ratios go with the natural frequencies, hence with the root of the stiffness.
    """
    law, nothing = sector.damping_law, np.zeros_like(sector.mass)
    if isinstance(law, Rayleigh):
        return law.mass * sector.mass, law.stiffness * sector.stiffness, nothing
    if isinstance(law, ModalDamping):
        return nothing, nothing, np.array(sector.damping)
    return np.array(sector.damping), nothing, nothing
