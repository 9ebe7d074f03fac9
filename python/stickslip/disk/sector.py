"""A sector of a disk among its neighbours: its parts, and what ties it to the next one."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi
from types import MappingProxyType
from typing import Any, Self

import numpy as np

from stickslip.checks import Matrix, brief, listed, set_fields, unknown, whole_number
from stickslip.disk.coupling import CyclicMatrices, Interface
from stickslip.errors import ModelError
from stickslip.model.contact import Contact
from stickslip.model.coupling import Coupling
from stickslip.model.force import Force
from stickslip.model.model import Model, listed_items
from stickslip.model.structure import Structure

NEXT = "next."
"""Prefix of the degrees of freedom of the next sector, in contacts between two sectors."""

_PREVIOUS = "prev."
"""What may be written by mistake for those of the sector before, which no name reaches."""


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Sector(Model):
    """A sector of a disk with what ties it to the next one, and the forces on all sectors."""

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

    def at_order(self, engine_order: int) -> Self:
        """Return the disk under forces of another engine order.

        Raises ModelError if forces of other harmonics have engine orders of their own.
        """
        if self.engine_orders:
            raise ModelError(
                f"engine_order: the forces of harmonics {listed([*map(str, self.engine_orders)])} "
                "have orders of their own, engine_orders; build a disk for each order"
            )
        return self._like(engine_order=engine_order)

    def lead(self, sector: int, harmonic: int) -> float:
        """Return by how much a harmonic of the forces on a sector is ahead of sector 0 [rad]."""
        turns = self.order_of(harmonic) * sector % self.sectors
        return 2.0 * pi * turns / self.sectors

    def forces_on(self, sector: int) -> tuple[Force, ...]:
        """Return the forces on a sector."""
        return tuple(
            replace(force, phase=force.phase + self.lead(sector, force.harmonic))
            for force in self.forces
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
