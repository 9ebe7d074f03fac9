"""Bodies that lie between blades: rigid or elastic, held by their contacts alone."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from stickslip.checks import brief, members, real_matrix, set_fields, text
from stickslip.errors import ModelError
from stickslip.model.structure import Structure
from stickslip.units import from_zero, physical_number

Sum: TypeAlias = dict[str, float]
"""Factors of degrees of freedom, whose sum is a displacement."""
Vector: TypeAlias = tuple[float, ...]

PLANAR, SPATIAL = ("x", "y", "rotation"), ("x", "y", "z", "rx", "ry", "rz")
"""Degrees of freedom of a rigid body in a plane and in space."""


@dataclass(frozen=True)
class Centrifugal:
    """The load of a mass m on a radius r at a speed W of rotation, m r W^2.

    Parameters
    ----------
    radius : float
        Distance of the centre of mass from the axis of rotation [m].
    speed : float
        Angular speed of rotation [rad/s].

    Raises
    ------
    ModelError
        If a number is negative or not finite.
    """

    radius: float
    speed: float

    def __post_init__(self) -> None:
        for name, unit in (("radius", "m"), ("speed", "rad/s")):
            number = from_zero(getattr(self, name), unit, f"centrifugal load: {name}")
            set_fields(self, **{name: number})

    def force(self, mass: float) -> float:
        """Return the load of a mass [N]."""
        return mass * self.radius * self.speed**2


@dataclass(frozen=True, init=False)
class ContactPoint:
    """A point of a body that touches another one.

    Parameters
    ----------
    normal : sequence of float
        Normal out of the body, in its axes, of any length above 0.
    position : sequence of float, optional
        Of a rigid body: where it lies, from the centre of mass [m]. Default: there.
    dofs : sequence of str, optional
        Of an elastic body instead: its degrees of freedom there, one per axis.

    Raises
    ------
    ModelError
        If normal and position have other than 2 or 3 numbers, or both a position and degrees of
        freedom are given.
    """

    normal: Vector
    position: Vector | None
    dofs: tuple[str, ...] | None

    def __init__(
        self,
        normal: Sequence[float],
        position: Sequence[float] | None = None,
        dofs: Sequence[str] | None = None,
    ) -> None:
        entry = "contact point"
        if position is not None and dofs is not None:
            raise ModelError(f"{entry}: position and dofs; give the dofs of an elastic body alone")
        set_fields(
            self,
            normal=_vector(normal, "", f"{entry}: normal"),
            position=None if position is None else _vector(position, "m", f"{entry}: position"),
            dofs=None
            if dofs is None
            else tuple(
                text(one, f"{entry}: dofs") for one in members(dofs, f"{entry}: dofs", "[...]")
            ),
        )
        for name in ("position", "dofs"):
            other = getattr(self, name)
            if other is not None and len(other) != len(self.normal):
                raise ModelError(
                    f"{entry}: {name} {brief(other)} for a normal of {len(self.normal)} numbers; "
                    "give as many"
                )


class Body(Protocol):
    """What a damper is made of."""

    @property
    def axes(self) -> int:
        """Number of axes: 2 in a plane, 3 in space."""

    @property
    def dofs(self) -> tuple[str, ...]:
        """Degrees of freedom."""

    @property
    def forces(self) -> Mapping[str, float]:
        """Static load by degree of freedom [N]."""

    def at(self, point: ContactPoint) -> list[Sum]:
        """Return the displacement of a point along each axis, a sum of degrees of freedom."""

    def structure(self) -> Structure:
        """Return the body by itself."""


@dataclass(frozen=True, init=False)
class RigidBody:
    """A rigid body: in a plane "x", "y" and "rotation", in space "x", "y", "z", "rx", "ry", "rz".

    Rotations are small, about the centre of mass, and positive from x to y (in space: about their
    axis). Without an inertia the body does not turn, and has no such degrees of freedom.

    Parameters
    ----------
    mass : float
        Mass [kg]. 0: the contacts alone decide how it moves.
    inertia : float, or array_like of shape (3, 3), optional
        Moment of inertia about the centre of mass [kg m2], in space the tensor.
    load : sequence of float
        Static force on it, along 2 axes in a plane, 3 in space [N].

    Raises
    ------
    ModelError
        If the mass is negative, the inertia negative or of another shape, or the load has other
        than 2 or 3 numbers.
    """

    mass: float
    inertia: Vector | None
    """Entries of the tensor, row by row."""
    load: Vector

    def __init__(
        self, mass: float, inertia: ArrayLike | None = None, *, load: Sequence[float] = (0.0, 0.0)
    ) -> None:
        entry = "rigid body"
        forces = _vector(load, "N", f"{entry}: load")
        turns = None if inertia is None else _inertia(inertia, len(forces))
        set_fields(self, mass=from_zero(mass, "kg", f"{entry}: mass"), load=forces, inertia=turns)

    @property
    def axes(self) -> int:
        """Number of axes: 2 in a plane, 3 in space."""
        return len(self.load)

    @property
    def dofs(self) -> tuple[str, ...]:
        """Degrees of freedom, those of its rotation last."""
        known = PLANAR if self.axes == 2 else SPATIAL
        return known[: self.axes] if self.inertia is None else known

    @property
    def forces(self) -> dict[str, float]:
        """Static load by degree of freedom [N]."""
        return dict(zip(self.dofs, self.load, strict=False))

    def at(self, point: ContactPoint) -> list[Sum]:
        """Return the displacement of a point along each axis: x + theta x r."""
        if point.dofs is not None or len(point.normal) != self.axes:
            raise ModelError(
                f"contact point with normal {brief(point.normal)}: a rigid body of {self.axes} axes"
                " has points with a normal of as many numbers, and a position"
            )
        r = np.array(point.position or (0.0,) * self.axes)
        if self.inertia is None and r.any():
            raise ModelError(
                f"contact point at {brief(point.position)}: a body that does not turn has no use "
                "for positions; give it an inertia, or leave the positions out"
            )
        columns = [*np.eye(self.axes)]
        if self.axes == 2:
            columns.append(np.array([-r[1], r[0]]))
        else:
            columns += [np.cross(axis, r) for axis in np.eye(3)]
        moved = zip(*columns[: len(self.dofs)], strict=True)
        return [
            {dof: float(one) for dof, one in zip(self.dofs, row, strict=True) if one}
            for row in moved
        ]

    def structure(self) -> Structure:
        """Return mass without stiffness."""
        size = len(self.dofs)
        mass = np.zeros((size, size))
        mass[: self.axes, : self.axes] = self.mass * np.eye(self.axes)
        if self.inertia is not None:
            mass[self.axes :, self.axes :] = np.reshape(self.inertia, (size - self.axes,) * 2)
        return Structure(mass, np.zeros_like(mass), dofs=self.dofs)


@dataclass(frozen=True, init=False, eq=False)
class FlexibleBody:
    """An elastic body, as component modes with its rigid-body modes kept make it.

    Parameters
    ----------
    structure : Structure
        The free body: see `craig_bampton`, whose kept degrees of freedom are those of the contact
        points. Modes held by the ground are no part of a damper.
    load : mapping of str to float, optional
        Static forces by degree of freedom [N].
    axes : int, optional
        2 in a plane, 3 in space.

    Raises
    ------
    ModelError
        If a degree of freedom is unknown, or a force not finite.
    """

    own: Structure
    forces: Mapping[str, float]
    axes: int

    def __init__(
        self, structure: Structure, load: Mapping[str, float] | None = None, *, axes: int = 2
    ) -> None:
        entry = "flexible body"
        if not isinstance(structure, Structure):
            raise ModelError(f"{entry}: structure {brief(structure)}; give ss.Structure(...)")
        if axes not in (2, 3):
            raise ModelError(f"{entry}: axes {brief(axes)}; give 2 in a plane, 3 in space")
        given = {} if load is None else load
        if not isinstance(given, Mapping):
            raise ModelError(f'{entry}: load {brief(load)}; write {{"y": 120.0}}')
        for dof in given:
            structure.index(dof)
        forces = {dof: physical_number(one, "N", f"{entry}: load") for dof, one in given.items()}
        set_fields(self, own=structure, forces=forces, axes=int(axes))

    @property
    def dofs(self) -> tuple[str, ...]:
        """Degrees of freedom."""
        return self.own.dofs

    def at(self, point: ContactPoint) -> list[Sum]:
        """Return the degrees of freedom of a point, one per axis."""
        if point.dofs is None or len(point.dofs) != self.axes:
            raise ModelError(
                f"contact point with normal {brief(point.normal)}: a flexible body of {self.axes} "
                "axes has points with as many dofs; give ContactPoint(normal, dofs=[...])"
            )
        for dof in point.dofs:
            self.own.index(dof)
        return [{dof: 1.0} for dof in point.dofs]

    def structure(self) -> Structure:
        """Return the body."""
        return self.own


def _vector(value: Iterable[object], unit: str, entry: str) -> Vector:
    given = members(value, entry, "[0.0, 1.0]")
    numbers = tuple(physical_number(one, unit, entry) for one in given)
    if len(numbers) not in (2, 3):
        raise ModelError(f"{entry}: {len(numbers)} numbers; give 2 in a plane, 3 in space")
    return numbers


def _inertia(value: ArrayLike, axes: int) -> Vector:
    entry = "rigid body: inertia"
    if axes == 2:
        return (from_zero(value, "kg*m^2", entry),)
    matrix = real_matrix(value, entry)
    if matrix.shape != (3, 3) or np.abs(matrix - matrix.T).max() > 1e-9 * np.abs(matrix).max():
        raise ModelError(f"{entry}: {brief(value)}; give a symmetric tensor, 3 x 3, in kg m2")
    if np.linalg.eigvalsh(matrix)[0] < 0.0:
        raise ModelError(f"{entry}: {brief(value)} is not positive; check its signs")
    return tuple(matrix.ravel().tolist())
