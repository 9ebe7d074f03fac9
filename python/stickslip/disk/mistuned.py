"""All sectors of a bladed disk together; they may differ."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import brief, members, unknown
from stickslip.disk.arguments import NEXT
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.disk.ring import Ring, SectorContact
from stickslip.errors import ModelError
from stickslip.model.contact import Contact
from stickslip.model.damping import makes_blocks
from stickslip.model.force import Force
from stickslip.model.model import Model
from stickslip.model.structure import Structure

if TYPE_CHECKING:
    from stickslip import _core

__all__ = ["MistunedDisk", "deviating"]


@dataclass(frozen=True, init=False, eq=False, repr=False)
class MistunedDisk(Model):
    """All sectors of a bladed disk, each with its own structure.

    Degrees of freedom, contacts and forces are those of the sectors 0, 1, ... one after the other:
    "0.tip", "1.tip", ..., contacts "0.jenkins", "1.jenkins", ... Made by `BladedDisk.mistuned`.

    Parameters
    ----------
    disk : BladedDisk
        The tuned disk: couplings, contacts and forces are its.
    blades : iterable of Structure
        The structure of each sector by itself.

    Attributes
    ----------
    structure, contacts, forces
        Of the whole, as in `Model`.
    disk : BladedDisk
        The tuned disk.
    blades : tuple of Structure
        The sectors.

    Raises
    ------
    ModelError
        If there is not one structure per sector, or one has other degrees of freedom than the disk.
    """

    disk: BladedDisk
    blades: tuple[Structure, ...]

    def __init__(self, disk: BladedDisk, blades: Iterable[Structure]) -> None:
        if not isinstance(disk, BladedDisk):
            raise ModelError(f"disk: {brief(disk)} is no BladedDisk; give ss.BladedDisk(...)")
        self._set(disk, _required(blades, disk), _contacts(disk), _forces(disk))

    def _set(
        self,
        disk: BladedDisk,
        blades: tuple[Structure, ...],
        contacts: Iterable[Contact],
        forces: Iterable[Force],
    ) -> None:
        object.__setattr__(self, "disk", disk)
        object.__setattr__(self, "blades", blades)
        super().__init__(_assembled(disk, blades), contacts, forces)

    def __repr__(self) -> str:
        sector = self.disk.structure
        return f"MistunedDisk({self.sectors} x {sector!r}, {len(self.contacts)} contact(s))"

    def __reduce__(self) -> tuple[object, ...]:
        return rebuilt, (self.disk, self.blades, self.contacts, self.forces)

    @property
    def sectors(self) -> int:
        """Number of sectors."""
        return self.disk.sectors

    def replaced(
        self, *, contacts: Iterable[Contact] | None = None, forces: Iterable[Force] | None = None
    ) -> MistunedDisk:
        """Return the disk with other contact parameters or forces; see `Model.replaced`.

        Raises
        ------
        ModelError
            If the contacts are not as many, or lie elsewhere.
        """
        return rebuilt(
            self.disk,
            self.blades,
            self.contacts if contacts is None else contacts,
            self.forces if forces is None else forces,
        )

    @cached_property
    def problem(self) -> _core.Problem:
        """The ring as the compiled core sees it, sector by sector, built once.

        Raises
        ------
        ModelError
            If the core refuses the numbers.
        """
        from stickslip import _core

        ring = self.ring
        contacts: list[list[_core.SectorContact]] = [[] for _ in range(self.sectors)]
        for one in ring.contacts:
            contacts[one.sector].append((one.law, one.own, one.next, one.parameters))
        forces = [
            [(harmonic, load[sector]) for harmonic, load in ring.loads]
            for sector in range(self.sectors)
        ]
        try:
            return _core.Problem.ring(
                (ring.mass, ring.mass_next),
                (ring.damping, ring.damping_next),
                (ring.stiffness, ring.stiffness_next),
                contacts,
                forces,
                ring.proportional,
            )
        except ValueError as error:
            raise ModelError(str(error)) from error

    @cached_property
    def ring(self) -> Ring:
        """The disk in numbers, sector by sector."""
        places = [self.disk.contact_rows(contact) for contact in self.disk.contacts]
        contacts = tuple(
            SectorContact(place // len(places), one.law, *places[place % len(places)], parameters)
            for place, one in enumerate(self.contacts)
            for parameters in [one.law_parameters()]
        )
        shape = self.sectors, len(self.disk.structure)
        loads = tuple((harmonic, load.reshape(shape)) for harmonic, load in self._loads())
        return _ring(self.disk, self.blades, contacts, loads)


def deviating(
    disk: BladedDisk,
    pattern: ArrayLike | None,
    mass: ArrayLike | None,
    structures: Iterable[Structure] | None,
) -> tuple[Structure, ...]:
    """Return the structure of each sector; see `BladedDisk.mistuned`."""
    if structures is not None:
        if pattern is not None or mass is not None:
            raise ModelError(
                "structures: given beside pattern or mass; put the deviations into the structures"
            )
        return members(structures, "structures", "structures=[...]")
    if pattern is None and mass is None:
        raise ModelError("pattern: missing; give one deviation per sector, 0 for none")
    sector = disk.structure
    stiffer = _deviations(pattern, "pattern", disk.sectors)
    heavier = _deviations(mass, "mass", disk.sectors)
    if not stiffer.any() and not heavier.any():
        return (sector,) * disk.sectors
    # A law makes new damping of the deviating matrices, a given matrix stays as it is.
    damping = sector.damping if sector.damping_law is None else sector.damping_law
    blades = (
        Structure((1.0 + m) * sector.mass, (1.0 + k) * sector.stiffness, damping, sector.dofs)
        for m, k in zip(heavier, stiffer, strict=True)
    )
    # Mass and stiffness deviate as wholes, which leaves the mode shapes as they are.
    return tuple(
        Structure.of_law(
            *(blade.mass, blade.stiffness, blade.damping, blade.dofs, blade.damping_law),
            proportional=sector.proportional,
        )
        for blade in blades
    )


def rebuilt(
    disk: BladedDisk,
    blades: Iterable[Structure],
    contacts: Iterable[Contact],
    forces: Iterable[Force],
) -> MistunedDisk:
    """Return a mistuned disk with contact parameters and forces of its own.

    Parameters
    ----------
    disk : BladedDisk
        The tuned disk.
    blades : iterable of Structure
        The structure of each sector.
    contacts : iterable of Contact
        As many as the disk has, at the same degrees of freedom, in the order of the sectors.
    forces : iterable of Force
        On the degrees of freedom "0.tip", ...

    Returns
    -------
    MistunedDisk
        The disk.

    Raises
    ------
    ModelError
        If the contacts are not as many, or lie elsewhere.
    """
    made = object.__new__(MistunedDisk)
    made._set(disk, tuple(blades), contacts, forces)
    expected = [contact.dofs for contact in _contacts(disk)]
    if [contact.dofs for contact in made.contacts] != expected:
        raise ModelError(
            f"contacts: {len(made.contacts)} for {len(expected)} of the disk, or elsewhere; change "
            "parameters only, or build another BladedDisk"
        )
    return made


def _contacts(disk: BladedDisk) -> tuple[Contact, ...]:
    return tuple(
        contact.moved(
            [_placed(dof, sector, disk.sectors) for dof in contact.dofs],
            f"{sector}.{contact.name}",
        )
        for sector in range(disk.sectors)
        for contact in disk.contacts
    )


def _forces(disk: BladedDisk) -> tuple[Force, ...]:
    return tuple(
        replace(force, dof=f"{sector}.{force.dof}")
        for sector in range(disk.sectors)
        for force in disk.forces_on(sector)
    )


def _placed(dof: str | None, sector: int, sectors: int) -> str | None:
    if dof is None:
        return None
    if dof.startswith(NEXT):
        return f"{(sector + 1) % sectors}.{dof.removeprefix(NEXT)}"
    return f"{sector}.{dof}"


def _assembled(disk: BladedDisk, blades: tuple[Structure, ...]) -> Structure:
    return _ring(disk, blades, (), ()).assembled(disk.structure.dofs)


def _ring(
    disk: BladedDisk,
    blades: tuple[Structure, ...],
    contacts: tuple[SectorContact, ...],
    loads: tuple[tuple[int, NDArray[np.complex128]], ...],
) -> Ring:
    parts = {}
    for name in ("mass", "damping", "stiffness"):
        blocks = getattr(disk.matrices, name)
        # What couplings add to the sectors themselves does not deviate.
        added = blocks.own - getattr(disk.structure, name)
        parts[name] = np.stack([getattr(blade, name) + added for blade in blades])
        parts[f"{name}_next"] = blocks.next
    names = ("mass", "damping", "stiffness")
    blocks = [*zip(*(parts[name] for name in names), strict=True)]
    if disk.couplings or disk.interface is not None:
        blocks.append(tuple(parts[f"{name}_next"] for name in names))
        known = makes_blocks(disk.structure.damping_law, blocks)
    else:
        known = all(blade.proportional for blade in blades)
    return Ring(**parts, contacts=contacts, loads=loads, proportional=known)


def _deviations(values: ArrayLike | None, entry: str, sectors: int) -> NDArray[np.float64]:
    if values is None:
        return np.zeros(sectors)
    try:
        given = np.asarray(values)
    except ValueError:
        raise ModelError(f"{entry}: a ragged list; give {sectors} deviations") from None
    if given.dtype.kind not in "fiu":
        raise ModelError(f"{entry}: {brief(values)} holds no real numbers; give ratios")
    if given.shape not in ((), (sectors,)):
        raise ModelError(
            f"{entry}: shape {given.shape} for {sectors} sectors; give ({sectors},), or one number"
        )
    row = np.array(np.broadcast_to(given, (sectors,)), dtype=np.float64)
    bad = np.flatnonzero(~(np.isfinite(row) & (row > -1.0)))
    if bad.size:
        raise ModelError(
            f"{entry}[{bad[0]}] is {row[bad[0]]:g}; give deviations above -1, 0.05 for 5 % more"
        )
    return row


def _required(blades: Iterable[Structure], disk: BladedDisk) -> tuple[Structure, ...]:
    given = members(blades, "structures", "structures=[...]")
    if len(given) != disk.sectors:
        raise ModelError(f"structures: {len(given)} for {disk.sectors} sectors; give one each")
    known = disk.structure.dofs
    for sector, blade in enumerate(given):
        if not isinstance(blade, Structure):
            raise ModelError(f"structures[{sector}]: {brief(blade)} is no Structure; give one")
        if blade.dofs != known:
            other = next((dof for dof in blade.dofs if dof not in known), None)
            reason = (
                f"{len(blade)} dofs for {len(known)} of the disk, or in another order"
                if other is None
                else unknown("dof", other, known)
            )
            raise ModelError(f"structures[{sector}]: {reason}")
    return given
