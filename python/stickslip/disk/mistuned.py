"""All sectors of a bladed disk together; they may differ."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _core
from stickslip.checks import Matrix, brief, members, set_fields, unknown
from stickslip.disk.coupling import MATRICES, Blocks, CyclicMatrices, assembled
from stickslip.disk.sector import NEXT, Sector
from stickslip.errors import ModelError
from stickslip.model.contact import Contact
from stickslip.model.damping import DampingLaw, ModalDamping, Rayleigh, makes_blocks
from stickslip.model.force import Force
from stickslip.model.model import Model, from_core
from stickslip.model.structure import Structure
from stickslip.units import without_units


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
    contacts, forces : iterable, optional
        Others than those of the disk: contacts as many, at the same degrees of freedom, in the
        order of the sectors; forces on "0.tip", ...

    Raises
    ------
    ModelError
        If there is not one structure per sector, or one has other degrees of freedom than the disk;
        if the contacts are not as many, or lie elsewhere.
    """

    disk: Sector
    blades: tuple[Structure, ...]

    def __init__(
        self,
        disk: Sector,
        blades: Iterable[Structure],
        contacts: Iterable[Contact] | None = None,
        forces: Iterable[Force] | None = None,
    ) -> None:
        if not isinstance(disk, Sector):
            raise ModelError(f"disk: {brief(disk)} is no BladedDisk; give ss.BladedDisk(...)")
        sectors = _required(blades, disk)
        set_fields(self, disk=disk, blades=sectors)
        own = _contacts(disk)
        super().__init__(
            _ring(disk, sectors, (), ()).assembled(disk.structure.dofs).made_of(*sectors),
            own if contacts is None else contacts,
            _forces(disk) if forces is None else forces,
        )
        if [one.dofs for one in self.contacts] != [one.dofs for one in own]:
            raise ModelError(
                f"contacts: {len(self.contacts)} for {len(own)} of the disk, or elsewhere; change "
                "parameters only, or build another BladedDisk"
            )

    def __repr__(self) -> str:
        sector = self.disk.structure
        return f"MistunedDisk({self.sectors} x {sector!r}, {len(self.contacts)} contact(s))"

    def _parts(self) -> dict[str, Any]:
        names = ("disk", "blades", "contacts", "forces")
        return {name: getattr(self, name) for name in names}

    def at_order(self, engine_order: int) -> Self:
        """Return the assembly under forces of another engine order; see `BladedDisk.at_order`."""
        disk = self.disk.at_order(engine_order)

        def turned(force: Force) -> Force:
            sector = int(force.dof.partition(".")[0])
            before, now = (one.lead(sector, force.harmonic) for one in (self.disk, disk))
            return replace(force, phase=force.phase + now - before)

        return self._like(disk=disk, forces=[turned(force) for force in self.forces])

    @property
    def damping_law(self) -> DampingLaw | None:
        """What the damping of a sector was made of."""
        return self.disk.damping_law

    def with_structure(self, structure: Structure) -> Model:
        """Return a plain `Model` with another structure of all sectors."""
        return Model(structure, self.contacts, self.forces)

    @property
    def sectors(self) -> int:
        """Number of sectors."""
        return self.disk.sectors

    @cached_property
    def problem(self) -> _core.Problem:
        """The ring as the compiled core sees it, sector by sector, built once."""
        ring = self.ring
        contacts: list[list[_core.SectorContact]] = [[] for _ in range(self.sectors)]
        for one in ring.contacts:
            contacts[one.sector].append(one[1:])
        return from_core(
            _core.Problem.ring,
            ring.mass,
            ring.damping,
            ring.stiffness,
            contacts,
            ring.loads_by_sector(),
            ring.proportional,
        )

    @cached_property
    def ring(self) -> Ring:
        """The disk in numbers, sector by sector."""
        places = [self.disk.contact_rows(contact) for contact in self.disk.contacts]
        contacts: list[SectorContact] = []
        for number, one in enumerate(self.contacts):
            sector, place = divmod(number, len(places))
            contacts += [SectorContact(sector, *law) for law in one.core_laws(*places[place])]
        shape = self.sectors, len(self.disk.structure)
        loads = tuple((harmonic, load.reshape(shape)) for harmonic, load in self._loads())
        return _ring(self.disk, self.blades, tuple(contacts), loads)


def deviating(
    disk: Sector,
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
    made = []
    for m, k in zip(heavier, stiffer, strict=True):
        matrices = (1.0 + m) * sector.mass, (1.0 + k) * sector.stiffness
        blade = Structure(*matrices, damping, sector.dofs)
        # Mass and stiffness deviate as wholes, which leaves the mode shapes as they are.
        set_fields(blade, proportional=blade.proportional or sector.proportional)
        made.append(blade.made_of(sector))
    return tuple(made)


def _contacts(disk: Sector) -> tuple[Contact, ...]:
    return tuple(
        contact.moved(
            [_placed(dof, sector, disk.sectors) for dof in contact.dofs],
            f"{sector}.{contact.name}",
        )
        for sector in range(disk.sectors)
        for contact in disk.contacts
    )


def _forces(disk: Sector) -> tuple[Force, ...]:
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


def _ring(
    disk: Sector,
    blades: tuple[Structure, ...],
    contacts: tuple[SectorContact, ...],
    loads: tuple[tuple[int, NDArray[np.complex128]], ...],
) -> Ring:
    parts = {}
    for name in MATRICES:
        tuned = getattr(disk.matrices, name)
        # What couplings add to the sectors themselves does not deviate.
        added = tuned.own - getattr(disk.structure, name)
        own = np.stack([getattr(blade, name) + added for blade in blades])
        parts[name] = Blocks(own, tuned.next)
    if disk.couplings or disk.interface is not None:
        sectors, between = zip(*parts.values(), strict=True)
        known = makes_blocks(disk.structure.damping_law, [*zip(*sectors, strict=True), between])
    else:
        known = all(blade.proportional for blade in blades)
    return Ring(**parts, proportional=known, contacts=contacts, loads=loads)


def tuned_disk(disk: Sector) -> _core.TunedDisk:
    """Return what makes many mistuned disks of a tuned one in the compiled core.

    Its method `mistuned` makes what ``disk.mistuned(pattern).problem`` is, to rounding.
    """
    sector, matrices = disk.structure, disk.matrices
    law, nothing = sector.damping_law, np.zeros_like(sector.mass)
    # Damping that stays, that goes with the stiffness, and that with its root: given ratios go with
    # the natural frequencies.
    constant, proportional, root = np.array(sector.damping), nothing, nothing
    if isinstance(law, Rayleigh):
        constant, proportional = law.mass * sector.mass, law.stiffness * sector.stiffness
    elif isinstance(law, ModalDamping):
        if law.stuck:
            raise ModelError(
                "damping: ModalDamping(..., stuck=...) of sectors that deviate is no multiple of "
                "that of the tuned one; give Structure the matrix structure.damping, which stays, "
                "a ratio without stuck, or compute disk.mistuned(pattern) one by one"
            )
        constant, root = nothing, constant
    return from_core(
        _core.TunedDisk,
        matrices.mass.own,
        sector.stiffness,
        matrices.stiffness.own - sector.stiffness,
        (constant + (matrices.damping.own - sector.damping), proportional, root),
        (matrices.mass.next, matrices.damping.next, matrices.stiffness.next),
        disk._core_contacts(),
        MistunedDisk(disk, (sector,) * disk.sectors).ring.loads_by_sector(),
        matrices.proportional,
    )


def _deviations(values: ArrayLike | None, entry: str, sectors: int) -> NDArray[np.float64]:
    if values is None:
        return np.zeros(sectors)
    try:
        given = np.asarray(without_units(values, "", entry))
    except ValueError as error:
        if isinstance(error, ModelError):
            raise
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


def _required(blades: Iterable[Structure], disk: Sector) -> tuple[Structure, ...]:
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


class SectorContact(NamedTuple):
    """A contact of one sector in numbers."""

    sector: int
    """Sector it belongs to."""
    law: str
    """Name of the law, as the compiled core knows it."""
    own: Matrix
    """(n_u, N) Part of B on the sector itself."""
    next: Matrix
    """(n_u, N) Part of B on the next sector."""
    parameters: Mapping[str, float | list[float]]
    """Parameters of the law."""


@dataclass(frozen=True, eq=False)
class Ring(CyclicMatrices):
    """A mistuned disk in numbers, n sectors of N degrees of freedom each.

    The blocks of the sectors are (n, N, N). In the whole matrices sector i takes the rows i N to
    (i + 1) N - 1; the block between a sector and the next one is the same everywhere.
    """

    contacts: tuple[SectorContact, ...]
    """All contacts, those of sector 0 first."""
    loads: tuple[tuple[int, NDArray[np.complex128]], ...]
    """Harmonics in ascending order, each with the forces on all sectors, (n, N) [N]."""

    def loads_by_sector(self) -> list[list[tuple[int, NDArray[np.complex128]]]]:
        """Return the loads on each sector, by harmonics."""
        return [[(k, load[sector]) for k, load in self.loads] for sector in range(self.sectors)]

    @property
    def sectors(self) -> int:
        """Number of sectors."""
        return len(self.mass.own)

    def assembled(self, dofs: Sequence[str]) -> Structure:
        """Return the whole as one structure; "tip" of sector 3 is named "3.tip"."""
        return Structure.of_law(
            mass=assembled(self.mass),
            stiffness=assembled(self.stiffness),
            damping=assembled(self.damping),
            dofs=[f"{sector}.{dof}" for sector in range(self.sectors) for dof in dofs],
            law=None,
            proportional=self.proportional,
        )
