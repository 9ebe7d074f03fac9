"""What is computed with: a structure, its friction contacts and the forces on it.

Messages count contacts and forces from 1, as study files do, beside their names; positions in calls
count from 0.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence, Set
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain, count
from typing import Any, ClassVar, Self, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from stickslip import _core
from stickslip.checks import Matrix, brief, members, real_number, set_fields, unknown, whole_number
from stickslip.errors import ModelError
from stickslip.model.contact import Contact
from stickslip.model.contact_law import ContactLaw
from stickslip.model.damping import DampingLaw
from stickslip.model.force import Force
from stickslip.model.structure import Structure

_Item = TypeVar("_Item")
_Made = TypeVar("_Made")

ContactRef: TypeAlias = int | str
"""A contact: its position, counted from 0, or its name."""
PointRef: TypeAlias = ContactRef | tuple[ContactRef, int]
"""A contact point: (contact, point), or the contact alone where it has one point."""
AnyMatrix: TypeAlias = NDArray[np.float64] | NDArray[np.complex128]


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Model:
    """A structure with its friction contacts and the forces on it.

    Parameters
    ----------
    structure : Structure
        The linear part.
    contacts : iterable of Contact, optional
        Friction contacts. None is the linear structure. The unnamed are named by their law:
        "jenkins", "jenkins-2", ...
    forces : iterable of Force, optional
        Forces; those on the same degree of freedom and harmonic add up.

    Raises
    ------
    ModelError
        If a contact or force names a degree of freedom that the structure lacks, or two contacts
        have the same name.
    """

    travels: ClassVar[bool] = False
    """Whether it stands for a travelling wave, which has no motion of its own in time."""

    structure: Structure
    contacts: tuple[Contact, ...]
    forces: tuple[Force, ...]

    def __init__(
        self, structure: Structure, contacts: Iterable[Contact] = (), forces: Iterable[Force] = ()
    ) -> None:
        if not isinstance(structure, Structure):
            raise ModelError(
                f"structure: {brief(structure)} is not a Structure; give ss.Structure(...)"
            )
        set_fields(
            self,
            structure=structure,
            contacts=_named(listed_items(contacts, "contact", Contact)),
            forces=listed_items(forces, "force", Force),
        )
        self._require_dofs()

    def __repr__(self) -> str:
        return f"Model({self.structure!r}, {self._listed})"

    @property
    def _listed(self) -> str:
        names = ", ".join(self.contact_names[:6]) + (", ..." if len(self.contacts) > 6 else "")
        return f"contacts=[{names}], {len(self.forces)} force(s)"

    def __reduce__(self) -> tuple[object, ...]:
        # The compiled problem is rebuilt on the other side: it cannot be pickled.
        return _remade, (type(self), self._parts())

    def _parts(self) -> dict[str, Any]:
        """Return what the model is made of, as the arguments of its class."""
        return {"structure": self.structure, "contacts": self.contacts, "forces": self.forces}

    def _require_dofs(self) -> None:
        known = set(self._contact_dofs)
        for number, contact in enumerate(self.contacts, 1):
            entry = f"contact {number} ({brief(contact.name)})"
            for dof in contact.dofs:
                if dof is not None and dof not in known:
                    raise ModelError(f"{entry}: {self._unknown_dof(dof, contact)}")
        for number, force in enumerate(self.forces, 1):
            if force.dof not in self.structure.dofs:
                raise ModelError(f"force {number}: {self._unknown_force(force.dof)}")

    @property
    def _contact_dofs(self) -> tuple[str, ...]:
        """Degrees of freedom that contacts may act on."""
        return self.structure.dofs

    def _unknown_dof(self, dof: str, contact: Contact) -> str:
        reason = unknown("dof", dof, self.structure.dofs)
        return f"{reason} (the ground is None)" if dof == "ground" else reason

    def _unknown_force(self, dof: str) -> str:
        return unknown("dof", dof, self.structure.dofs)

    @property
    def contact_names(self) -> tuple[str, ...]:
        """Names of the contacts, in order."""
        return tuple(str(contact.name) for contact in self.contacts)

    @property
    def damping_law(self) -> DampingLaw | None:
        """What the damping was made of; None where it was given as a matrix."""
        return self.structure.damping_law

    def contact_index(self, contact: ContactRef) -> int:
        """Return the position of a contact, given by its position, counted from 0, or its name."""
        if isinstance(contact, str):
            if contact not in self.contact_names:
                raise ModelError(unknown("contact", contact, self.contact_names))
            return self.contact_names.index(contact)
        position = whole_number(contact, "contact")
        _require_position("contact", position, len(self.contacts), "the model")
        return position

    def point(self, point: PointRef) -> tuple[int, int]:
        """Return a contact point as positions of the contact, and of the point in it.

        It is given as (contact, point), the point counted from 0, or by the contact alone where
        that has one point.
        """
        return self._place(point, [contact.points for contact in self.contacts])

    def slider(self, slider: PointRef) -> tuple[int, int]:
        """Return a part of a contact that slips by itself as positions; see `point`.

        Elements in parallel count one by one, nodes as one in whatever directions they slip.
        """
        return self._place(slider, [one.sliders for one in self.contacts])

    def _place(self, point: PointRef, counts: Sequence[int]) -> tuple[int, int]:
        if isinstance(point, tuple | list):
            if len(point) != 2:
                raise ModelError(f"contact point {brief(point)}: write (contact, point)")
            contact = self.contact_index(point[0])
            owner = f"contact {brief(self.contact_names[contact])}"
            position = whole_number(point[1], f"{owner}: point")
            _require_position("point", position, counts[contact], owner)
            return contact, position
        contact = self.contact_index(point)
        if counts[contact] != 1:
            raise ModelError(
                f"contact {brief(point)}: it has {counts[contact]} points; write "
                f"({brief(point)}, 0)"
            )
        return contact, 0

    def scaled(self, *, force: float = 1.0, load: float = 1.0, slip_force: float = 1.0) -> Self:
        """Return the model at another level of excitation, static load or preload.

        `force` multiplies the amplitude of every force that varies, or of the static ones where
        none does; `load` the static ones, those of dampers included; `slip_force`, which is not
        negative, every slip force, of Coulomb contacts by their preload. Contacts that never slip
        stay so.
        """
        force = real_number(force, "factor on the forces")
        load = real_number(load, "factor on the static loads")
        slip_force = real_number(slip_force, "factor on the slip forces")
        if slip_force < 0.0:
            raise ModelError(f"factor on the slip forces: {slip_force:g} is negative; give >= 0")
        of_static = load if any(one.harmonic for one in self.forces) else load * force
        factors = [force if one.harmonic else of_static for one in self.forces]
        pairs = zip(self.forces, factors, strict=True)
        return self.replaced(
            contacts=[contact.scaled(slip_force) for contact in self.contacts],
            forces=[replace(one, amplitude=one.amplitude * factor) for one, factor in pairs],
        )

    def replaced(
        self, *, contacts: Iterable[Contact] | None = None, forces: Iterable[Force] | None = None
    ) -> Self:
        """Return the model, of the same kind and structure, with other contacts or forces."""
        changes = {"contacts": contacts, "forces": forces}
        return self._like(**{name: one for name, one in changes.items() if one is not None})

    def _like(self, **changes: Any) -> Self:
        """Return the model with some of its parts changed."""
        return type(self)(**self._parts() | changes)

    def with_structure(self, structure: Structure) -> Model:
        """Return the model with another structure of the same degrees of freedom."""
        return self._like(structure=structure)

    def matrices_at(self, harmonic: int) -> tuple[AnyMatrix, AnyMatrix, AnyMatrix]:
        """Return mass, damping and stiffness as a harmonic of the motion meets them, (N, N)."""
        structure = self.structure
        return structure.mass, structure.damping, structure.stiffness

    def diameter(self, harmonic: int) -> int | None:
        """Return the nodal diameter at which a harmonic meets a tuned disk; None of others."""
        return None

    def frequencies(
        self, points: list[tuple[int, int]], nodal_diameter: int | None
    ) -> NDArray[np.float64]:
        """Return natural frequencies with contact points slipping; see `natural_frequencies`."""
        if nodal_diameter is not None:
            raise ModelError(
                f"nodal_diameter: {brief(nodal_diameter)} of a model without sectors; leave it "
                "out, or give a BladedDisk"
            )
        return self.problem.natural_frequencies(self._slipping(points))

    @cached_property
    def problem(self) -> _core.Problem:
        """The model as the compiled core sees it: numbers without names, built once."""
        structure = self.structure
        return from_core(
            _core.Problem,
            structure.mass,
            structure.damping,
            structure.stiffness,
            self._each_core_contact(),
            self._loads(),
            structure.proportional,
        )

    def contact_rows(self, contact: Contact) -> tuple[Matrix, ...]:
        """Return B of a contact, one matrix per sector that it lies in: of a `Model` one."""
        return (contact.rows(self.structure),)

    def _core_contacts(self) -> list[Any]:
        """Return the contacts as the compiled core takes them."""
        return list(self._each_core_contact())

    def _each_core_contact(self) -> Iterator[Any]:
        """Return them one by one: rows of many contacts are no smaller than a matrix."""
        laws = (one.core_laws(*self.contact_rows(one)) for one in self.contacts)
        return chain.from_iterable(laws)

    def raise_own(self) -> None:
        """Raise what a law in Python raised while the core called it."""
        for contact in self._own_laws:
            contact.raise_own()

    def forget_own(self) -> None:
        """Let laws in Python forget what they have answered."""
        for contact in self._own_laws:
            contact.forget()

    @cached_property
    def _own_laws(self) -> tuple[ContactLaw, ...]:
        return tuple(one for one in self.contacts if isinstance(one, ContactLaw))

    def law_index(self, contact: int, point: int = 0) -> int:
        """Return the position among the laws of the core of that of a contact, or of its point."""
        before = sum(one.points if one.by_point else 1 for one in self.contacts[:contact])
        return before + point * self.contacts[contact].by_point

    def _slipping(self, points: Iterable[tuple[int, int]]) -> list[tuple[int, int]]:
        """Return the displacements along which points slip, as the core counts them."""
        return [
            (self.law_index(number, point), place.start + direction)
            for number, point in points
            for one in (self.contacts[number],)
            for place in (one.place(0 if one.by_point else point),)
            for direction in range(one.tangential)
        ]

    def _loads(self) -> list[tuple[int, NDArray[np.complex128]]]:
        """Sum the forces of each harmonic, in ascending harmonics."""
        loads = {
            harmonic: np.zeros(len(self.structure), dtype=np.complex128)
            for harmonic in sorted({force.harmonic for force in self.forces})
        }
        for force in self.forces:
            loads[force.harmonic][self.structure.index(force.dof)] += force.coefficient
        return list(loads.items())


def require_model(model: object) -> None:
    """Refuse what is no model."""
    if not isinstance(model, Model):
        raise ModelError(f"model: {brief(model)} is not a Model; give ss.Model(structure, ...)")


def listed_items(items: Iterable[_Item], entry: str, kind: type[object]) -> tuple[_Item, ...]:
    """Return the members of a list that must all be of one kind, which `entry` names."""
    listed = members(items, f"{entry}s", f"{entry}s=[...]")
    for number, item in enumerate(listed, 1):
        if not isinstance(item, kind):
            raise ModelError(
                f"{entry} {number}: {brief(item)} is no {entry}; give a {kind.__name__}"
            )
    return listed


def _named(contacts: tuple[Contact, ...]) -> tuple[Contact, ...]:
    """Name the unnamed by their law, past the names that are taken."""
    taken: dict[str, int] = {}
    for number, contact in enumerate(contacts, 1):
        if contact.name in taken:
            raise ModelError(
                f"contact {number} ({brief(contact.name)}): contact {taken[contact.name]} has this "
                "name already; give another name="
            )
        if contact.name is not None:
            taken[contact.name] = number
    free = {law: _free_names(law, taken.keys()) for law in {contact.law for contact in contacts}}
    return tuple(contact.named(contact.name or next(free[contact.law])) for contact in contacts)


def from_core(make: Callable[..., _Made], *arguments: Any) -> _Made:
    """Return what the compiled core makes; what it refuses is a `ModelError`."""
    try:
        return make(*arguments)
    except ModelError:
        raise
    except ValueError as error:
        raise ModelError(str(error)) from error


def _remade(kind: type[Model], parts: dict[str, Any]) -> Model:
    return kind(**parts)


def _free_names(law: str, taken: Set[str]) -> Iterator[str]:
    numbered = (f"{law}-{number}" for number in count(2))
    return (name for name in chain([law], numbered) if name not in taken)


def _require_position(kind: str, position: int, size: int, owner: str) -> None:
    if position >= size:
        places = ("none", "1, at position 0")[size] if size < 2 else f"{size}, at 0 to {size - 1}"
        raise ModelError(f"there is no {kind} at position {position}; {owner} has {places}")
