"""A disk of equal blades, as one sector of a travelling wave."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import Matrix, brief, set_fields, unknown, whole_number
from stickslip.disk.coupling import Coupling, CyclicMatrices, Interface
from stickslip.errors import ModelError
from stickslip.model.contact import Contact
from stickslip.model.force import Force
from stickslip.model.model import AnyMatrix, Model, PointRef, from_core, listed_items
from stickslip.model.structure import Structure

if TYPE_CHECKING:
    from stickslip import _core
    from stickslip.disk.mistuned import MistunedDisk
    from stickslip.disk.waves import NodalDiameters

ALL_SECTORS = "mistuning = {deviation = 0.0} in [disk]"
"""How study files ask for all sectors of a tuned disk."""

NEXT = "next."
"""Prefix of the degrees of freedom of the next sector, in contacts between two sectors."""

_PREVIOUS = "prev."
"""What may be written by mistake for those of the sector before, which no name reaches."""


@dataclass(frozen=True, init=False, eq=False, repr=False)
class BladedDisk(Model):
    """A disk of n equal sectors under forces of an engine order.

    It is a `Model` of sector 0. In the steady state every sector moves as the one before it, ahead
    by the time in which the forces come round by one sector; one sector with these phases is the
    whole disk, exactly, friction between sectors included. Harmonic k meets the disk at nodal
    diameter k E mod n.

    Parameters
    ----------
    structure : Structure
        A sector by itself. Its damping law sees neither couplings nor interface.
    sectors : int
        Number n of sectors, at least 2.
    couplings : iterable of Coupling, optional
        Springs between neighbouring sectors, also from sector n-1 to 0.
    contacts : iterable of Contact, optional
        Friction contacts of each sector: ``Jenkins("damper", ...)`` to ground, ``Jenkins("a", "b",
        ...)`` inside the sector, ``Jenkins("tip", "next.tip", ...)`` to the next sector.
    forces : iterable of Force, optional
        Forces on sector 0. Those on sector i are ahead by 2 pi E_k i / n, E_k being the engine
        order of their harmonic k.
    engine_order : int
        Engine order E, not negative; n - E runs the other way round.
    engine_orders : mapping of int to int, optional
        Engine orders E_k of forces by their harmonic k. Default: k E, a pattern of pressure that
        stands still while the disk turns. Others than k E modulo n are no single travelling wave:
        only ``mistuned(0)`` computes those.
    interface : Interface, optional
        Blocks of cyclic matrices that couple each sector to the next.

    Raises
    ------
    ModelError
        If a number is outside its range; if a coupling, contact or force names a degree of freedom
        that the sector lacks; if the interface has another size than the structure; if a contact
        touches the next sector only.

    Examples
    --------
    >>> import stickslip as ss
    >>> blade = ss.Structure(mass=[[1.0]], stiffness=[[4.0e4]], dofs=["tip"])
    >>> ring = ss.Coupling("tip", stiffness=1e3)
    >>> disk = ss.BladedDisk(blade, sectors=12, couplings=[ring], engine_order=2)
    >>> ss.natural_frequencies(disk, nodal_diameter=6).round(3)
    array([209.762])
    """

    travels: ClassVar[bool] = True

    sectors: int
    engine_order: int
    engine_orders: Mapping[int, int]
    couplings: tuple[Coupling, ...]
    interface: Interface | None
    matrices: CyclicMatrices
    """Mass, damping and stiffness of a sector among its neighbours."""

    def __init__(
        self,
        structure: Structure,
        sectors: int,
        couplings: Iterable[Coupling] = (),
        contacts: Iterable[Contact] = (),
        forces: Iterable[Force] = (),
        *,
        engine_order: int,
        engine_orders: Mapping[int, int] | None = None,
        interface: Interface | None = None,
    ) -> None:
        super().__init__(structure, contacts, forces)
        springs = listed_items(couplings, "coupling", Coupling)
        _require_couplings(springs, structure)
        _require_interface(interface, structure)
        set_fields(
            self,
            sectors=whole_number(sectors, "sectors", smallest=2),
            engine_order=whole_number(engine_order, "engine_order"),
            engine_orders=MappingProxyType(_orders(engine_orders)),
            couplings=springs,
            interface=interface,
            matrices=CyclicMatrices.of(structure, springs, interface),
        )

    def __repr__(self) -> str:
        return (
            f"BladedDisk({self.sectors} x {self.structure!r}, {self._listed} of engine order "
            f"{self.engine_order})"
        )

    def _parts(self) -> dict[str, Any]:
        return super()._parts() | {
            "sectors": self.sectors,
            "couplings": self.couplings,
            "engine_order": self.engine_order,
            "engine_orders": dict(self.engine_orders),
            "interface": self.interface,
        }

    @property
    def _contact_dofs(self) -> tuple[str, ...]:
        return self.neighbours.dofs

    def _unknown_dof(self, dof: str, contact: Contact) -> str:
        return stranger(dof, contact.dofs, self.structure.dofs)

    def _unknown_force(self, dof: str) -> str:
        bare = dof.removeprefix(NEXT)
        if bare not in self.structure.dofs:
            return super()._unknown_force(dof)
        return (
            f"{brief(dof)}: forces are those on sector 0, from which those on the others follow; "
            f"write {brief(bare)}"
        )

    def _require_dofs(self) -> None:
        own = self.structure.dofs
        taken = next((dof for dof in own if dof.startswith(NEXT)), None)
        if taken is not None:
            raise ModelError(
                f"structure: dof {brief(taken)}: names in '{NEXT}' are those of the next sector; "
                "give it another name"
            )
        super()._require_dofs()
        for number, contact in enumerate(self.contacts, 1):
            if not any(dof in own for dof in contact.dofs):
                names = [dof.removeprefix(NEXT) for dof in contact.dofs if dof is not None]
                raise ModelError(
                    f"contact {number} ({brief(contact.name)}): it touches the next sector only; "
                    f"write {', '.join(map(brief, names))}"
                )

    @cached_property
    def neighbours(self) -> Structure:
        """A sector and the next one, in whose degrees of freedom contacts find theirs.

        Its matrices mean nothing.
        """
        own = self.structure.dofs
        size = 2 * len(own)
        names = [*own, *(NEXT + dof for dof in own)]
        return Structure(np.eye(size), np.zeros((size, size)), dofs=names)

    def contact_rows(self, contact: Contact) -> tuple[Matrix, ...]:
        """Return the two parts of B of u = B x_i + B' x_(i+1), (n_u, N) each."""
        rows, size = contact.rows(self.neighbours), len(self.structure)
        return np.ascontiguousarray(rows[:, :size]), np.ascontiguousarray(rows[:, size:])

    def order_of(self, harmonic: int) -> int:
        """Return the engine order of the forces of a harmonic."""
        return self.engine_orders.get(harmonic, harmonic * self.engine_order)

    def lead(self, sector: int, harmonic: int) -> float:
        """Return by how much a harmonic of the forces on a sector is ahead of sector 0 [rad]."""
        turns = self.order_of(harmonic) * sector % self.sectors
        return 2.0 * pi * turns / self.sectors

    def diameter(self, harmonic: int) -> int:
        """Return the nodal diameter at which a harmonic of the motion meets the disk, 0 to n-1."""
        return harmonic * self.engine_order % self.sectors

    def matrices_at(self, harmonic: int) -> tuple[AnyMatrix, AnyMatrix, AnyMatrix]:
        """Return mass, damping and stiffness as a harmonic of the motion meets them, complex."""
        mass, damping, stiffness = self.matrices.wave(self.angle(self.diameter(harmonic)))
        return mass, damping, stiffness

    def angle(self, diameter: int) -> float:
        """Return by how much a wave of a nodal diameter is ahead from sector to sector [rad]."""
        return 2.0 * pi * diameter / self.sectors

    def forces_on(self, sector: int) -> tuple[Force, ...]:
        """Return the forces on a sector."""
        return tuple(
            replace(force, phase=force.phase + self.lead(sector, force.harmonic))
            for force in self.forces
        )

    def seen_from(self, sector: int) -> BladedDisk:
        """Return the disk, under forces ahead by those of a sector from 0 to n-1, as from there."""
        number = whole_number(sector, "sector")
        if number >= self.sectors:
            raise ModelError(f"sector: {number}; there are {self.sectors}, 0 to {self.sectors - 1}")
        return self.replaced(forces=self.forces_on(number)) if number else self

    @cached_property
    def problem(self) -> _core.Problem:
        """One sector of the wave as the compiled core sees it, built once; forces must make one."""
        for number, force in enumerate(self.forces, 1):
            k, order = force.harmonic, self.order_of(force.harmonic)
            if (order - k * self.engine_order) % self.sectors:
                reason = (
                    f"force {number} at {brief(force.dof)}: harmonic {k} of engine order {order} "
                    f"does not travel with {k} x {self.engine_order} modulo {self.sectors} "
                    "sectors, so that the motion is no single wave; compute all sectors"
                )
                raise ModelError(f"{reason}, disk.mistuned(0)", study=f"{reason}, {ALL_SECTORS}")
        return self._wave_problem(self._loads())

    def mistuned(
        self,
        pattern: ArrayLike | None = None,
        *,
        mass: ArrayLike | None = None,
        structures: Iterable[Structure] | None = None,
    ) -> MistunedDisk:
        """Return the assembly of all sectors, which may differ: a `Model`.

        Its degrees of freedom are "0.tip", "1.tip", ..., its contacts "0.jenkins", ...

        Parameters
        ----------
        pattern : array_like, shape (n,), or float, optional
            Deviations of stiffness: that of sector i is (1 + pattern[i]) times that of the
            structure. Couplings and interface do not deviate. A damping law makes the damping anew,
            a damping matrix stays. 0 is the tuned assembly.
        mass : array_like, shape (n,), or float, optional
            Deviations of mass, likewise.
        structures : iterable of Structure, optional
            Instead of both: one sector structure each, with the same degrees of freedom.

        Raises
        ------
        ModelError
            If there is not one entry per sector, a deviation is not above -1, a structure has other
            degrees of freedom, or nothing or too much is given.
        """
        from stickslip.disk.mistuned import MistunedDisk, deviating

        return MistunedDisk(self, deviating(self, pattern, mass, structures))

    def nodal_diameters(self, slipping: Iterable[PointRef] | None = None) -> NodalDiameters:
        """Return the natural frequencies at all nodal diameters, stuck and slipping.

        `slipping` are the contact points that slip, as of `natural_frequencies`. Default: all.
        """
        from stickslip.disk.waves import nodal_diameters

        return nodal_diameters(self, slipping)

    def frequencies(
        self, points: list[tuple[int, int]], nodal_diameter: int | None
    ) -> NDArray[np.float64]:
        """Return natural frequencies at a nodal diameter; see `natural_frequencies`."""
        diameter = self.diameter(1)
        if nodal_diameter is not None:
            diameter = whole_number(nodal_diameter, "nodal_diameter")
        if diameter >= self.sectors:
            raise ModelError(
                f"nodal_diameter: {diameter}; {self.sectors} sectors have 0 to {self.sectors // 2}"
            )
        return self._unforced.natural_frequencies(self._slipping(points), diameter)

    @cached_property
    def _unforced(self) -> _core.Problem:
        return self._wave_problem([])

    def _wave_problem(self, loads: list[tuple[int, NDArray[np.complex128]]]) -> _core.Problem:
        from stickslip import _core

        return from_core(
            _core.Problem.travelling_wave,
            self.matrices.mass,
            self.matrices.damping,
            self.matrices.stiffness,
            self.sectors,
            self.engine_order % self.sectors,
            self._core_contacts(),
            loads,
            self.matrices.proportional,
        )


def _orders(orders: Mapping[int, int] | None) -> dict[int, int]:
    """Return engine orders by harmonic, checked."""
    if orders is None:
        return {}
    if not isinstance(orders, Mapping):
        raise ModelError(
            f"engine_orders: {brief(orders)} is no mapping; write {{harmonic: engine order}}"
        )
    return {
        whole_number(harmonic, "engine_orders: harmonic", smallest=1): whole_number(
            order, f"engine_orders[{brief(harmonic)}]"
        )
        for harmonic, order in orders.items()
    }


def _require_couplings(couplings: tuple[Coupling, ...], structure: Structure) -> None:
    """Refuse couplings at degrees of freedom that the sector lacks."""
    for number, coupling in enumerate(couplings, 1):
        for dof in coupling.ends:
            if dof in structure.dofs:
                continue
            bare = dof.removeprefix(NEXT).removeprefix(_PREVIOUS)
            if bare in structure.dofs:
                raise ModelError(
                    f"coupling {number}: {brief(dof)}: its second end is in the next sector anyway;"
                    f" write {brief(bare)}"
                )
            raise ModelError(f"coupling {number}: {unknown('dof', dof, structure.dofs)}")


def stranger(dof: str, dofs: Iterable[str | None], own: Sequence[str]) -> str:
    """Word a degree of freedom of a contact that neither the sector nor the next one has.

    `dofs` are all of the contact, `own` those of the sector. For the sector before: the contact as
    that sector sees it.
    """
    bare = dof.removeprefix(_PREVIOUS)
    if bare == dof or bare not in own:
        return unknown("dof", dof, [*own, *(NEXT + one for one in own)])
    seen = [
        one.removeprefix(_PREVIOUS) if one.startswith(_PREVIOUS) else NEXT + one
        for one in dofs
        if one is not None
    ]
    return (
        f"unknown dof {brief(dof)}: contacts lead from a sector to the next one; write this one as "
        f"it stands in the sector before, with the dofs {', '.join(map(brief, seen))}"
    )


def _require_interface(interface: Interface | None, structure: Structure) -> None:
    """Refuse an interface that does not fit the sector."""
    if interface is None:
        return
    if not isinstance(interface, Interface):
        raise ModelError(
            f"interface: {brief(interface)} is no Interface; write ss.Interface(stiffness=K1)"
        )
    if len(interface) != len(structure):
        raise ModelError(
            f"interface: {len(interface)} x {len(interface)} for a sector of {len(structure)} "
            "dofs; give blocks of the size of its matrices"
        )
