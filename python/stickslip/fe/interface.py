"""Interfaces of two meshes, node to node: what a contact of many nodes is made of."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import Matrix, brief, listed, members, text, unknown
from stickslip.errors import ModelError
from stickslip.fe.mesh import Mesh, Part, mesh_of
from stickslip.fe.solid import Solid
from stickslip.fe.sparse import symmetric_sparse
from stickslip.fe.surface import Places, Surface
from stickslip.model.coulomb import Coulomb
from stickslip.units import physical_number

if TYPE_CHECKING:
    from stickslip.results.static_response import StaticResponse

_ENTRY = "interface"
_FACING = -0.5
"""Cosine between the normals of two nodes up to which they face each other."""
_REACH = 0.5
"""Tolerance by default, in shortest edges."""
_WAYS = (1, 2, 3)


@dataclass(frozen=True, eq=False)
class ContactInterface:
    """Two surfaces paired node to node, or one surface on the ground.

    Made by `from_surfaces`. Pairs are in the order of the nodes of the first surface.
    """

    surface: Surface
    """The first surface, whose faces and areas are those of the interface."""
    places: Places
    """Position in `surface` of the first node of each pair, shape (n,)."""
    first: Places
    """Numbers of the nodes of the first body, shape (n,)."""
    other: Places | None
    """Numbers of the nodes of the other body, shape (n,); None: the ground."""
    areas: Matrix
    """Area of each pair, that of its first node [m2], shape (n,)."""
    normals: Matrix
    """Unit normals out of the first body, shape (n, 3)."""
    gap: Matrix
    """Distance of the nodes along the normal [m], negative for an interference, shape (n,)."""
    unpaired: tuple[Places, Places]
    """Numbers of the nodes of both surfaces without a partner."""
    names: tuple[str, str] = ("", "")
    """Names of the bodies, which begin the names of their degrees of freedom: "upper.12.1"."""

    def __repr__(self) -> str:
        left = " and ".join(str(one.size) for one in self.unpaired)
        return f"ContactInterface({self.count} pairs, {self.area:.4g} m2, {left} nodes unpaired)"

    @classmethod
    def from_surfaces(
        cls,
        mesh: Mesh | Solid,
        surface: Part,
        other_mesh: Mesh | Solid | None = None,
        other_surface: Part | None = None,
        *,
        tolerance: float | None = None,
        names: Sequence[str] = ("", ""),
        partial: bool = False,
    ) -> Self:
        """Pair the nodes of two surfaces.

        Two nodes are a pair if each is the nearest one of the other. The normal is the mean of
        those of both nodes by their areas.

        Parameters
        ----------
        mesh, surface : Mesh or Solid, str or ndarray of bool
            First body, and its surface: see `Mesh.surface`.
        other_mesh, other_surface : optional
            Those of the other body; the same mesh where one model holds both. Default: the ground,
            without a gap.
        tolerance : float, optional
            Largest distance of the nodes of a pair [m]. Default: half of the shortest edge of both
            surfaces.
        names : sequence of str, optional
            Names of the two bodies where they are structures of their own, as in `ss.join`.
        partial : bool, optional
            Leave nodes of the first surface that have no partner without contact, instead of
            refusing them. Those of the other surface always are.

        Raises
        ------
        ModelError
            If a surface does not exist, nodes find no partner, or surfaces do not face each other.

        Examples
        --------
        >>> import numpy as np, stickslip as ss
        >>> from stickslip.fe import Mesh
        >>> square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]) * 0.01
        >>> cells = (("quad", np.array([[0, 1, 2, 3]])),)
        >>> mesh = Mesh(square, cells, np.array([11, 12, 13, 14]))
        >>> pad = ss.ContactInterface.from_surfaces(mesh, np.ones(4, dtype=bool))
        >>> pad
        ContactInterface(4 pairs, 0.0001 m2, 0 and 0 nodes unpaired)
        >>> pad.first_dofs[:3]
        ('11.1', '11.2', '11.3')
        """
        first = mesh_of(mesh, f"{_ENTRY}: mesh").surface(surface)
        own = members(names, f"{_ENTRY}: names", 'names=("upper", "lower")')
        if len(own) != 2 or not all(isinstance(one, str) for one in own):
            raise ModelError(
                f"{_ENTRY}: names {brief(names)}; give two, of the first and the other"
            )
        bodies = own[0], own[1]
        nobody = np.zeros(0, dtype=np.int64)
        if (other_mesh is None) != (other_surface is None):
            raise ModelError(f"{_ENTRY}: give other_mesh and other_surface, or neither")
        if other_mesh is None or other_surface is None:
            every = np.arange(len(first.labels))
            still = np.zeros(len(every))
            away = nobody, nobody
            return cls(
                first, every, first.labels, None, first.areas, first.normals, still, away, bodies
            )
        second = mesh_of(other_mesh, f"{_ENTRY}: other_mesh").surface(other_surface)
        reach = _REACH * min(first.shortest_edge, second.shortest_edge)
        if tolerance is not None:
            reach = physical_number(tolerance, "m", f"{_ENTRY}: tolerance")
            if reach <= 0.0:
                raise ModelError(f"{_ENTRY}: tolerance {reach:g} m must be positive")
        here, there = _pairs(first.points, second.points, reach)
        _require_bodies(first, second, here, there, bodies)
        alone = (
            np.delete(first.labels, here),
            np.delete(second.labels, there),
        )
        if alone[0].size and not partial:
            raise ModelError(
                f"{_ENTRY}: {alone[0].size} of {len(first.labels)} nodes of the first surface have "
                f"no partner within {reach:.3g} m: {listed([str(one) for one in alone[0]])}; match "
                "the meshes, raise tolerance, or give partial=True to leave them without contact"
            )
        normals = _normals(first, second, here, there)
        gap = np.einsum("ni,ni->n", normals, second.points[there] - first.points[here])
        numbers, others = first.labels[here], second.labels[there]
        areas = first.areas[here]
        return cls(first, here, numbers, others, areas, normals, gap, alone, bodies)

    @property
    def count(self) -> int:
        """Number n of pairs."""
        return len(self.first)

    @property
    def area(self) -> float:
        """Area of all pairs [m2]."""
        return float(self.areas.sum())

    @property
    def points(self) -> Matrix:
        """Coordinates of the first nodes [m], shape (n, 3)."""
        return self.surface.points[self.places]

    @property
    def first_dofs(self) -> tuple[str, ...]:
        """Degrees of freedom of the first body, node by node, as its own model names them."""
        return tuple(f"{node}.{way}" for node in self.first for way in _WAYS)

    @property
    def other_dofs(self) -> tuple[str, ...]:
        """Those of the other body; none of them at the ground."""
        nodes = () if self.other is None else self.other
        return tuple(f"{node}.{way}" for node in nodes for way in _WAYS)

    @property
    def dofs(self) -> tuple[str, ...]:
        """All degrees of freedom, with the names of the bodies: what a reduction has to keep."""
        return _named(self.first_dofs, self.names[0]) + _named(self.other_dofs, self.names[1])

    def contact(
        self,
        *,
        friction: float | Sequence[float],
        tangential_stiffness: float | Sequence[float],
        normal_stiffness: float | Sequence[float],
        pressure: float | Sequence[float] | None = None,
        gap: float | Sequence[float] | None = None,
        relative: bool = False,
        name: str | None = None,
    ) -> Coulomb:
        """Return the contact of all pairs.

        Parameters
        ----------
        friction : float or sequence of float
            Coefficient of friction, of all pairs or of each.
        tangential_stiffness, normal_stiffness : float or sequence of float
            Stiffness of an area [N/m3].
        pressure : float or sequence of float, optional
            Pressure without motion, which is in equilibrium [Pa]: see `pressure`.
        gap : float or sequence of float, optional
            Instead: distance [m]. Default: that of the nodes, `gap`.
        relative : bool, optional
            The model is one of `relative`: the degrees of freedom of the first body are those of
            the displacements between both.
        name : str, optional
            By which results refer to it. Default: "coulomb".

        Raises
        ------
        ModelError
            If a number is negative, not one per pair, or both pressure and gap are given.
        """
        if pressure is not None and gap is not None:
            raise ModelError(f"{_ENTRY}: pressure and gap; give one of the two")
        behind = self.gap.tolist() if gap is None and pressure is None else gap
        ends = [
            np.array(_named(dofs, body)).reshape(-1, 3).tolist()
            for dofs, body in zip((self.first_dofs, self.other_dofs), self.names, strict=True)
        ]
        return Coulomb(
            ends[0],
            None if relative or self.other is None else ends[1],
            normal=self.normals,
            friction=_listed(friction),
            tangential_stiffness=_listed(tangential_stiffness),
            normal_stiffness=_listed(normal_stiffness),
            preload=_listed(pressure),
            gap=_listed(behind),
            areas=self.areas.tolist(),
            name=name,
        )

    def pressure(self, result: StaticResponse, contact: int | str = 0) -> Matrix:
        """Return the pressure at rest, shape (n,) [Pa]: normal forces over areas."""
        forces = np.asarray(result.contact_force(contact))
        if forces.shape != (self.count, 3):
            raise ModelError(
                f"{_ENTRY}: contact {brief(contact)} has forces of shape {forces.shape}; give the "
                f"contact of the {self.count} pairs"
            )
        pressure: Matrix = forces[:, -1] / self.areas
        return pressure

    def relative(self, value: object, dofs: Iterable[str]) -> Any:
        """Return mass, stiffness or a load of one model in displacements between the bodies.

        The degrees of freedom of the first nodes become x_first - x_other; all others stay, so that
        the names do: S^T A S and S^T f of x = S x'. A reduction then keeps `first_dofs` alone, half
        as many, and its fixed modes are those of the bonded interface. `absolute` leads back.

        Parameters
        ----------
        value : scipy.sparse array or matrix, or array_like, shape (N, N) or (N,)
            A symmetric matrix, or forces on all degrees of freedom.
        dofs : iterable of str
            Names of the N rows.

        Returns
        -------
        scipy.sparse.csc_array, shape (N, N), or ndarray, shape (N,)

        Raises
        ------
        ModelError
            If the interface is on the ground, or a degree of freedom is missing.
        """
        from scipy.sparse import coo_array, eye_array, issparse

        size, ends = self._ends(dofs)
        follows = coo_array((np.ones(ends.shape[1]), (ends[0], ends[1])), shape=(size, size))
        change = (eye_array(size) + follows).tocsc()
        if not issparse(value) and np.ndim(np.asarray(value)) == 1:
            load = np.asarray(value)
            if load.shape != (size,):
                raise ModelError(f"load: {load.size} forces for {size} dofs; give one each")
            return change.T @ load
        matrix, _ = symmetric_sparse(value, "matrix")
        if matrix.shape[0] != size:
            raise ModelError(f"dofs: {size} names for {matrix.shape[0]} rows; give one each")
        return (change.T @ matrix @ change).tocsc()

    def absolute(self, values: ArrayLike, dofs: Iterable[str]) -> NDArray[Any]:
        """Return the motion of a model of `relative` in displacements of both bodies, x = S x'.

        Parameters
        ----------
        values : array_like, shape (..., N)
            Displacements, real or complex: those of the first nodes are x_first - x_other.
        dofs : iterable of str
            Names of the N degrees of freedom.

        Raises
        ------
        ModelError
            If the interface is on the ground, or a degree of freedom is missing.
        """
        moved, (size, ends) = np.array(values), self._ends(dofs)
        if moved.shape[-1:] != (size,):
            raise ModelError(f"absolute: shape {moved.shape} for {size} dofs; give one of each")
        moved[..., ends[0]] += moved[..., ends[1]]
        return moved

    def _ends(self, dofs: Iterable[str]) -> tuple[int, Places]:
        """Return how many rows a model has, and those of both bodies, (2, 3 n)."""
        if self.other is None:
            raise ModelError(f"{_ENTRY}: on the ground displacements are relative already")
        rows = {text(name, "dofs"): row for row, name in enumerate(dofs)}
        lost = next((one for one in self.dofs if one not in rows), None)
        if lost is not None:
            raise ModelError(f"{_ENTRY}: {unknown('dof', lost, rows)}")
        return len(rows), np.array([rows[one] for one in self.dofs]).reshape(2, -1)


def _pairs(first: Matrix, second: Matrix, reach: float) -> tuple[Places, Places]:
    """Return positions of nodes that are nearest to each other, in the order of the first."""
    from scipy.spatial import cKDTree

    distance, nearest = map(np.asarray, cKDTree(second).query(first))
    back = np.asarray(cKDTree(first).query(second)[1])
    here = np.flatnonzero((back[nearest] == np.arange(len(first))) & (distance <= reach))
    if not here.size:
        raise ModelError(
            f"{_ENTRY}: no two nodes lie within {reach:.3g} m, the nearest are "
            f"{distance.min():.3g} m apart; check units and surfaces, or raise tolerance"
        )
    return here, np.asarray(nearest[here], dtype=np.int64)


def _require_bodies(
    first: Surface, second: Surface, here: Places, there: Places, bodies: tuple[str, str]
) -> None:
    """Refuse a node that is paired with itself, or is in pairs of its own surface."""
    same = np.flatnonzero(first.labels[here] == second.labels[there])
    if same.size and bodies[0] == bodies[1]:
        raise ModelError(
            f"{_ENTRY}: node {first.labels[here][same[0]]} would be paired with itself; separate "
            'the bodies in the mesh, or give two models their names=("upper", "lower")'
        )


def _normals(first: Surface, second: Surface, here: Places, there: Places) -> Matrix:
    """Return unit normals out of the first surface, the means of both by their areas."""
    own, facing = first.normals[here], second.normals[there]
    cosine = np.einsum("ni,ni->n", own, facing)
    wrong = int(cosine.argmax())
    if cosine[wrong] > _FACING:
        raise ModelError(
            f"{_ENTRY}: the surfaces do not face each other at nodes {first.labels[here[wrong]]} "
            f"and {second.labels[there[wrong]]}: the cosine of their normals is "
            f"{cosine[wrong]:.2f}, not about -1; name the sides that touch"
        )
    mean = own * first.areas[here, None] - facing * second.areas[there, None]
    normals: Matrix = mean / np.linalg.norm(mean, axis=1, keepdims=True)
    return normals


def _named(dofs: Sequence[str], body: str) -> tuple[str, ...]:
    return tuple(f"{body}.{dof}" for dof in dofs) if body else tuple(dofs)


def _listed(value: ArrayLike | None) -> Any:
    """Return numbers of pairs as a list, one number as it is."""
    return value.tolist() if isinstance(value, np.ndarray) else value
