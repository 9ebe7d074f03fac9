"""A disk of equal blades, as one sector of a travelling wave."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi
from types import MappingProxyType
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import Matrix, brief, unknown, whole_number
from stickslip.disk.arguments import (
    ALL_SECTORS,
    NEXT,
    orders_of,
    require_couplings,
    require_interface,
    stranger,
)
from stickslip.disk.coupling import Coupling, Interface
from stickslip.disk.cyclic import CyclicMatrices
from stickslip.errors import ModelError
from stickslip.model.contact import Contact
from stickslip.model.force import Force
from stickslip.model.model import AnyMatrix, Model, PointRef, listed_items
from stickslip.model.structure import Structure

if TYPE_CHECKING:
    from stickslip import _core
    from stickslip.disk.mistuned import MistunedDisk
    from stickslip.disk.nodal_diameters import NodalDiameters

__all__ = ["BladedDisk"]


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

    Attributes
    ----------
    structure, contacts, forces
        Of sector 0, as in `Model`; contacts with their names.
    sectors, engine_order, engine_orders, couplings, interface
        As given.
    matrices : CyclicMatrices
        Mass, damping and stiffness of a sector among its neighbours.

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
        require_couplings(springs, structure)
        require_interface(interface, structure)
        values = {
            "sectors": whole_number(sectors, "sectors", smallest=2),
            "engine_order": whole_number(engine_order, "engine_order"),
            "engine_orders": MappingProxyType(orders_of(engine_orders)),
            "couplings": springs,
            "interface": interface,
            "matrices": CyclicMatrices.of(structure, springs, interface),
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)

    def __repr__(self) -> str:
        names = ", ".join(self.contact_names[:6]) + (", ..." if len(self.contacts) > 6 else "")
        return (
            f"BladedDisk({self.sectors} x {self.structure!r}, contacts=[{names}], "
            f"{len(self.forces)} force(s) of engine order {self.engine_order})"
        )

    def __reduce__(self) -> tuple[object, ...]:
        return _rebuilt, (
            self.structure,
            self.sectors,
            self.couplings,
            self.contacts,
            self.forces,
            self.engine_order,
            dict(self.engine_orders),
            self.interface,
        )

    def _require_dofs(self) -> None:
        own = self.structure.dofs
        taken = next((dof for dof in own if dof.startswith(NEXT)), None)
        if taken is not None:
            raise ModelError(
                f"structure: dof {brief(taken)}: names in '{NEXT}' are those of the next sector; "
                "give it another name"
            )
        known = self.neighbours.dofs
        for number, contact in enumerate(self.contacts, 1):
            entry = f"contact {number} ({brief(contact.name)})"
            for dof in contact.dofs:
                if dof is not None and dof not in known:
                    raise ModelError(f"{entry}: {stranger(dof, contact.dofs, own)}")
            if not any(dof in own for dof in contact.dofs):
                names = [dof.removeprefix(NEXT) for dof in contact.dofs if dof is not None]
                raise ModelError(
                    f"{entry}: it touches the next sector only; write "
                    f"{', '.join(map(brief, names))}"
                )
        for number, force in enumerate(self.forces, 1):
            bare = force.dof.removeprefix(NEXT)
            if force.dof not in own:
                if bare in own:
                    raise ModelError(
                        f"force {number}: {brief(force.dof)}: forces are those on sector 0, from "
                        f"which those on the others follow; write {brief(bare)}"
                    )
                raise ModelError(f"force {number}: {unknown('dof', force.dof, own)}")

    @cached_property
    def neighbours(self) -> Structure:
        """Names of the degrees of freedom of a sector and the next one; its matrices mean nothing.

        Contacts find their degrees of freedom in it.
        """
        own = self.structure.dofs
        size = 2 * len(own)
        names = [*own, *(NEXT + dof for dof in own)]
        return Structure(np.eye(size), np.zeros((size, size)), dofs=names)

    def contact_rows(self, contact: Contact) -> tuple[Matrix, Matrix]:
        """Return the two parts of B of u = B x_i + B' x_(i+1).

        Parameters
        ----------
        contact : Contact
            A contact of the disk.

        Returns
        -------
        own, next : ndarray of float64, shape (points, N)
            Parts on the sector itself and on the next one.
        """
        rows = contact.rows(self.neighbours)
        size = len(self.structure)
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
        delta = 2.0 * pi * self.diameter(harmonic) / self.sectors
        blocks = (self.matrices.mass, self.matrices.damping, self.matrices.stiffness)
        mass, damping, stiffness = (block.wave(delta) for block in blocks)
        return mass, damping, stiffness

    def forces_on(self, sector: int) -> tuple[Force, ...]:
        """Return the forces on a sector."""
        return tuple(
            replace(force, phase=force.phase + self.lead(sector, force.harmonic))
            for force in self.forces
        )

    def seen_from(self, sector: int) -> BladedDisk:
        """Return the disk with another sector as sector 0.

        Parameters
        ----------
        sector : int
            From 0 to n-1.

        Returns
        -------
        BladedDisk
            The same disk under forces ahead by those of the sector.

        Raises
        ------
        ModelError
            If there is no such sector.
        """
        number = whole_number(sector, "sector")
        if number >= self.sectors:
            raise ModelError(f"sector: {number}; there are {self.sectors}, 0 to {self.sectors - 1}")
        return self.replaced(forces=self.forces_on(number)) if number else self

    def replaced(
        self, *, contacts: Iterable[Contact] | None = None, forces: Iterable[Force] | None = None
    ) -> BladedDisk:
        """Return the disk with other contacts or forces; see `Model.replaced`."""
        return _rebuilt(
            self.structure,
            self.sectors,
            self.couplings,
            self.contacts if contacts is None else contacts,
            self.forces if forces is None else forces,
            self.engine_order,
            self.engine_orders,
            self.interface,
        )

    @cached_property
    def problem(self) -> _core.Problem:
        """One sector of the wave as the compiled core sees it, built once.

        Raises
        ------
        ModelError
            If the forces make no single travelling wave, or the core refuses the numbers.
        """
        self._require_one_wave()
        return self._wave_problem(self._loads())

    def mistuned(
        self,
        pattern: ArrayLike | None = None,
        *,
        mass: ArrayLike | None = None,
        structures: Iterable[Structure] | None = None,
    ) -> MistunedDisk:
        """Return the assembly of all sectors, which may differ.

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

        Returns
        -------
        MistunedDisk
            A `Model` with degrees of freedom "0.tip", "1.tip", ... and contacts "0.jenkins", ...

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

        Parameters
        ----------
        slipping : iterable of int, str or (int or str, int), optional
            The contact points that slip. Default: all.

        Returns
        -------
        NodalDiameters
            Frequencies with all contacts stuck, and with those points slipping.
        """
        from stickslip.disk.nodal_diameters import nodal_diameters

        return nodal_diameters(self, slipping)

    def frequencies(
        self, points: list[tuple[int, int]], nodal_diameter: int | None
    ) -> NDArray[np.float64]:
        """Return natural frequencies at a nodal diameter; see `natural_frequencies`."""
        if nodal_diameter is None:
            diameter = self.diameter(1)
        else:
            diameter = whole_number(nodal_diameter, "nodal_diameter")
        if diameter >= self.sectors:
            raise ModelError(
                f"nodal_diameter: {diameter}; {self.sectors} sectors have 0 to {self.sectors // 2}"
            )
        return self._unforced.natural_frequencies(points, diameter)

    @cached_property
    def _unforced(self) -> _core.Problem:
        return self._wave_problem([])

    def _wave_problem(self, loads: list[tuple[int, NDArray[np.complex128]]]) -> _core.Problem:
        from stickslip import _core

        contacts = [
            (contact.law, *self.contact_rows(contact), contact.law_parameters())
            for contact in self.contacts
        ]
        try:
            return _core.Problem.travelling_wave(
                self.matrices.mass,
                self.matrices.damping,
                self.matrices.stiffness,
                self.sectors,
                self.engine_order % self.sectors,
                contacts,
                loads,
                self.matrices.proportional,
            )
        except ValueError as error:
            raise ModelError(str(error)) from error

    def _require_one_wave(self) -> None:
        for number, force in enumerate(self.forces, 1):
            k, order = force.harmonic, self.order_of(force.harmonic)
            if (order - k * self.engine_order) % self.sectors:
                reason = (
                    f"force {number} at {brief(force.dof)}: harmonic {k} of engine order {order} "
                    f"does not travel with {k} x {self.engine_order} modulo {self.sectors} "
                    "sectors, so that the motion is no single wave; compute all sectors"
                )
                raise ModelError(f"{reason}, disk.mistuned(0)", study=f"{reason}, {ALL_SECTORS}")


def _rebuilt(
    structure: Structure,
    sectors: int,
    couplings: Iterable[Coupling],
    contacts: Iterable[Contact],
    forces: Iterable[Force],
    engine_order: int,
    engine_orders: Mapping[int, int],
    interface: Interface | None,
) -> BladedDisk:
    return BladedDisk(
        structure,
        sectors,
        couplings,
        contacts,
        forces,
        engine_order=engine_order,
        engine_orders=engine_orders,
        interface=interface,
    )
