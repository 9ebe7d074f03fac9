"""Dampers as bodies: what they touch, between two structures or the sectors of a disk."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import pi
from typing import NamedTuple

import numpy as np

from stickslip.checks import brief, members, set_fields, text, unknown
from stickslip.damper.body import Body, ContactPoint, FlexibleBody, RigidBody, Sum
from stickslip.damper.neighbour import Neighbour, Touched
from stickslip.disk import BladedDisk, Coupling, Interface
from stickslip.disk.sector import NEXT
from stickslip.drawn import Drawn
from stickslip.errors import ModelError
from stickslip.model import Contact, Coulomb, Force, Model, Structure, join
from stickslip.model.nodes import Displacement
from stickslip.model.structure import side_by_side
from stickslip.units import from_zero

LEFT, RIGHT, DAMPER = "left", "right", "damper"


@dataclass(frozen=True, kw_only=True)
class Face:
    """A face of a body: points that touch the same neighbour, each with its share.

    Parameters
    ----------
    points : sequence of ContactPoint
        Where it touches, and the normals out of the body.
    to : str
        What it touches: "left", "right", or another body of the damper.
    friction : float
        Coefficient of friction.
    tangential_stiffness, normal_stiffness : float
        Stiffnesses of the face [N/m]; its points share them equally.
    gap : float, optional
        Distance from the neighbour [m], negative for an interference.
    body : str, optional
        The body whose face it is, by its name in the damper.
    against : sequence of ContactPoint, optional
        The same points as the other body has them; needed where that one turns, or is elastic.
    name : str, optional
        Of the contact. Default: `to`.
    """

    points: tuple[ContactPoint, ...]
    to: str
    friction: float
    tangential_stiffness: float
    normal_stiffness: float
    gap: float = 0.0
    body: str = "damper"
    against: tuple[ContactPoint, ...] | None = None
    name: str | None = None

    def __post_init__(self) -> None:
        for key in ("points", "against"):
            value = getattr(self, key)
            if value is None:
                continue
            points = members(value, f"face: {key}", "[ss.ContactPoint(...)]")
            if not points or not all(isinstance(one, ContactPoint) for one in points):
                raise ModelError(f"face: {key} {brief(value)}; give a list of ContactPoint")
            set_fields(self, **{key: points})
        if self.against is not None and len(self.against) != len(self.points):
            raise ModelError(
                f"face: {len(self.against)} points of the other body for {len(self.points)}; give "
                "as many"
            )


class Built(NamedTuple):
    """What a damper makes of a structure."""

    structure: Structure
    """The structure with the bodies, behind its own degrees of freedom."""
    contacts: list[Coulomb]
    """Contacts of the faces."""
    forces: list[Force]
    """Static loads of the bodies."""


class Damper(ABC):
    """A damper of one or several bodies between two neighbours, each held by contacts alone."""

    @property
    @abstractmethod
    def bodies(self) -> Mapping[str, Body]:
        """The bodies by name, which is the prefix of their degrees of freedom."""

    @property
    @abstractmethod
    def faces(self) -> tuple[Face, ...]:
        """Where they touch the neighbours, and each other."""

    plot = Drawn("damper_drawing")

    def between(
        self,
        left: Structure | None,
        right: Structure | None,
        *,
        left_dofs: Touched | None = None,
        right_dofs: Touched | None = None,
        forces: Iterable[Force] = (),
    ) -> Model:
        """Return two structures with the damper between them.

        Degrees of freedom are "left.x", ..., "right.y", "damper.x", ...; contacts are named after
        what they touch. The static load of the damper is among the forces.

        Parameters
        ----------
        left, right : Structure or None
            The neighbours; None is one that does not move.
        left_dofs, right_dofs : sequence of str
            Degrees of freedom at which they are touched, one per axis of the damper; or one such
            list per point of the face. Instead of a name a mapping of names to factors is a sum,
            as where the axes of the neighbour are turned.
        forces : iterable of Force, optional
            Further forces, on "left.x", ...

        Raises
        ------
        ModelError
            If a degree of freedom is unknown, or there is not one per axis.
        """
        given = {LEFT: (left, left_dofs), RIGHT: (right, right_dofs)}
        parts = {side: one for side, (one, _) in given.items() if one is not None}
        for side, one in parts.items():
            if not isinstance(one, Structure):
                raise ModelError(f"{side}: {brief(one)} is no Structure; give ss.Structure(...)")
        touched = {
            side: Neighbour.of(self._axes, side, dofs, one, f"{side}.")
            for side, (one, dofs) in given.items()
        }
        built = self._built(join(parts) if parts else None, touched)
        return Model(built.structure, built.contacts, [*built.forces, *forces])

    def inside(
        self,
        structure: Structure,
        *,
        left_dofs: Touched,
        right_dofs: Touched | None = None,
        forces: Iterable[Force] = (),
        contacts: Iterable[Contact] = (),
    ) -> Model:
        """Return a structure with the damper between two places of it.

        As `between`, but degrees of freedom of the structure keep their names. Without
        `right_dofs` the right neighbour does not move.
        """
        own = self.built(structure, left_dofs, right_dofs)
        return Model(own.structure, [*own.contacts, *contacts], [*own.forces, *forces])

    def built(
        self,
        structure: Structure,
        left_dofs: Touched,
        right_dofs: Touched | None,
        name: str = DAMPER,
    ) -> Built:
        """Return a structure with the damper in it, in parts; `name` is that of its bodies."""
        if not isinstance(structure, Structure):
            raise ModelError(f"structure: {brief(structure)} is no Structure; give ss.Structure")
        given = {LEFT: left_dofs, RIGHT: right_dofs}
        touched = {
            side: Neighbour.of(self._axes, side, dofs, None if dofs is None else structure, "")
            for side, dofs in given.items()
        }
        return self._built(structure, touched, name)

    def built_in_sector(
        self,
        sector: Structure,
        sectors: int,
        left_dofs: Touched,
        right_dofs: Touched,
        axes: str = "sector",
        name: str = DAMPER,
    ) -> Built:
        """Return a sector of a disk with the damper behind it, in parts; see `in_disk`."""
        if not isinstance(sector, Structure):
            raise ModelError(f"blade: {brief(sector)} is no Structure; give ss.Structure(...)")
        if axes not in ("sector", "parallel"):
            raise ModelError(f"axes: {unknown('axes', axes, ('sector', 'parallel'))}")
        half = pi / sectors if axes == "sector" else 0.0
        own = Neighbour.of(self._axes, LEFT, left_dofs, sector, "", half)
        ahead = Neighbour.of(self._axes, RIGHT, right_dofs, sector, NEXT, -half)
        return self._built(sector, {LEFT: own, RIGHT: ahead}, name)

    def in_disk(
        self,
        blade: Structure,
        sectors: int,
        *,
        left_dofs: Touched,
        right_dofs: Touched,
        engine_order: int,
        forces: Iterable[Force] = (),
        contacts: Iterable[Contact] = (),
        couplings: Iterable[Coupling] = (),
        axes: str = "sector",
        engine_orders: Mapping[int, int] | None = None,
        interface: Interface | None = None,
    ) -> BladedDisk:
        """Return a disk with a damper between each sector and the next one.

        A sector is the blade, whose degrees of freedom keep their names, with the damper behind it,
        "damper.x", ...: its left face touches the blade of the sector, its right face that of the
        next one.

        Parameters
        ----------
        blade : Structure
            A sector by itself, without the damper.
        sectors : int
            Number of sectors.
        left_dofs, right_dofs : sequence of str
            Degrees of freedom of the blade that the left face touches, and those of the next blade
            that the right face touches, as of `between`.
        engine_order : int
            Engine order of the forces.
        forces, contacts, couplings : iterable, optional
            Further ones; see `BladedDisk`.
        axes : str, optional
            "sector": every blade has its own axes, x along the circumference towards the next
            sector, y outwards, in space z along the axis of rotation; those of the damper are
            halfway between. "parallel": axes of blades and damper are taken for parallel.
        engine_orders, interface : optional
            As of `BladedDisk`; the interface is that of the blade.

        Raises
        ------
        ModelError
            As of `between`; or if the disk refuses something.
        """
        own = self.built_in_sector(blade, sectors, left_dofs, right_dofs, axes)
        return BladedDisk(
            own.structure,
            sectors,
            couplings,
            [*own.contacts, *contacts],
            [*own.forces, *forces],
            engine_order=engine_order,
            engine_orders=engine_orders,
            interface=widened(interface, len(own.structure)),
        )

    @property
    def _axes(self) -> int:
        (axes,) = {body.axes for body in self.bodies.values()}
        return axes

    def _built(
        self,
        structure: Structure | None,
        touched: Mapping[str, Neighbour | None],
        name: str = DAMPER,
    ) -> Built:
        """Return structure and bodies in one, with contacts and loads."""
        text(name, "damper: name")
        names = {one: _of_damper(one, name) for one in self.bodies}
        own = join({names[one]: body.structure() for one, body in self.bodies.items()})
        contacts = self._contacts(touched, names)
        if name != DAMPER:
            contacts = [one.named(f"{name}.{one.name}") for one in contacts]
        loads = [
            Force(f"{names[one]}.{dof}", load, harmonic=0)
            for one, body in self.bodies.items()
            for dof, load in body.forces.items()
            if load
        ]
        if structure is None:
            return Built(own, contacts, loads)
        both = side_by_side([structure, own], [*structure.dofs, *own.dofs])
        return Built(both, contacts, loads)

    def _contacts(
        self, touched: Mapping[str, Neighbour | None], names: Mapping[str, str]
    ) -> list[Coulomb]:
        known = [*self.bodies, *touched]
        made = []
        for number, face in enumerate(self.faces, 1):
            for name, among in ((face.body, list(self.bodies)), (face.to, known)):
                if name not in among:
                    raise ModelError(f"face {number}: {unknown('body', name, among)}")
            first = [self._at(face.body, point, names) for point in face.points]
            other: list[list[Sum]] | None
            if face.to in self.bodies:
                other = [self._at(face.to, point, names) for point in face.against or face.points]
            else:
                neighbour = touched[face.to]
                other = neighbour.at(len(first)) if neighbour else None
            made.append(_contact(face, first, other))
        return made

    def _at(self, body: str, point: ContactPoint, names: Mapping[str, str]) -> list[Sum]:
        sums = self.bodies[body].at(point)
        return [{f"{names[body]}.{dof}": factor for dof, factor in one.items()} for one in sums]


def _of_damper(body: str, name: str) -> str:
    """Return the name of a body in a damper of some name: "damper-2.left" of "damper.left"."""
    if name == DAMPER:
        return body
    part = body.removeprefix(DAMPER)
    return name + part if body != part and part[:1] in ("", ".") else f"{name}.{body}"


def widened(interface: Interface | None, size: int) -> Interface | None:
    """Return the interface of a blade as that of a sector which ends in further DOFs."""
    if interface is None:
        return None
    more = (0, size - len(interface))
    matrices = interface.stiffness, interface.mass, interface.damping
    return Interface(*(np.pad(one, (more, more)) for one in matrices))


def _contact(face: Face, first: list[list[Sum]], other: list[list[Sum]] | None) -> Coulomb:
    """Return the contact of a face."""
    count = len(first)
    ends = [[list(map(_name, node)) for node in one] for one in (first, other) if one is not None]
    return Coulomb(
        *(one if count > 1 else one[0] for one in ends),
        normal=[point.normal for point in face.points] if count > 1 else face.points[0].normal,
        friction=face.friction,
        tangential_stiffness=from_zero(face.tangential_stiffness, "N/m", "face: stiffness") / count,
        normal_stiffness=from_zero(face.normal_stiffness, "N/m", "face: stiffness") / count,
        gap=face.gap,
        name=face.name or face.to,
    )


def _name(one: Sum) -> Displacement:
    """Return the name of a degree of freedom, or a sum of several."""
    (dof, factor), *more = one.items()
    return dof if factor == 1.0 and not more else one


@dataclass(frozen=True, init=False, eq=False)
class BodyDamper(Damper):
    """A damper of any bodies and faces.

    Parameters
    ----------
    bodies : RigidBody or FlexibleBody, or mapping of str to them
        The body, named "damper"; or several by name.
    faces : sequence of Face
        Where they touch the neighbours "left" and "right", and each other.

    Raises
    ------
    ModelError
        If there is no body or face, bodies have other axes than others, or a name is unknown.
    """

    _bodies: Mapping[str, Body]
    _faces: tuple[Face, ...]

    def __init__(self, bodies: Body | Mapping[str, Body], faces: Iterable[Face]) -> None:
        named = bodies if isinstance(bodies, Mapping) else {"damper": bodies}
        for name, body in named.items():
            if not isinstance(body, RigidBody | FlexibleBody):
                raise ModelError(
                    f"damper: body {brief(name)} is {brief(body)}; give a RigidBody or FlexibleBody"
                )
            if name in (LEFT, RIGHT):
                raise ModelError(f"damper: body {brief(name)}: this is a side; name it otherwise")
        listed = members(faces, "damper: faces", "faces=[ss.Face(...)]")
        if not named or not listed or not all(isinstance(one, Face) for one in listed):
            raise ModelError("damper: give at least one body and a list of ss.Face(...)")
        if len({body.axes for body in named.values()}) > 1:
            raise ModelError("damper: bodies of 2 and of 3 axes; give all the same")
        set_fields(self, _bodies=dict(named), _faces=listed)

    @property
    def bodies(self) -> Mapping[str, Body]:
        """The bodies by name."""
        return self._bodies

    @property
    def faces(self) -> tuple[Face, ...]:
        """Where they touch."""
        return self._faces
