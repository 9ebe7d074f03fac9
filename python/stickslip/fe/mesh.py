"""Meshes of other programs: where nodes are, and fields on them for ParaView."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import (
    brief,
    members,
    real_array,
    set_fields,
    unknown,
    whole_array,
    whole_number,
)
from stickslip.errors import ModelError
from stickslip.fe.faces import distinct, named_faces, outside, tables
from stickslip.fe.reduced_modes import natural_modes
from stickslip.fe.reduction import Reduction
from stickslip.fe.solid import Solid
from stickslip.fe.surface import Places, Surface
from stickslip.fe.vtu import write_vtu
from stickslip.results.arrays import Measure, amplitude_of
from stickslip.results.forced_response import ForcedResponse
from stickslip.units import physical_number

Part: TypeAlias = str | NDArray[np.bool_]
"""A surface or a set of nodes by its name, or which nodes of the mesh it has."""
_NAME = re.compile(r"(\d{1,18})\.([1-6])")


class Relative(Protocol):
    """What leads back from displacements between bodies, as a contact interface does."""

    def absolute(self, values: ArrayLike, dofs: Iterable[str]) -> NDArray[Any]:
        """Return the displacements of the bodies."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """Nodes with their numbers, and the elements between them.

    Parameters
    ----------
    nodes : array_like of float, shape (n, 3)
        Coordinates, in the unit of the mesh.
    cells : sequence of (str, array_like of int, shape (elements, nodes of one))
        Elements by their kind, in the names and the order of meshio; nodes are counted from 0.
    numbers : array_like of int, shape (n,), optional
        Numbers of the nodes, as names of degrees of freedom have them. Default: 1, 2, ...
    node_sets : mapping of str to array_like of int, optional
        Nodes of each set, counted from 0.
    surfaces : mapping of str to sequence of array_like of int, optional
        Faces of each surface, arrays of nodes counted from 0, (m, k), by their number of nodes.
    rotated : array_like of int, optional
        Nodes, counted from 0, whose displacements have directions of their own, not x, y and z.
        What needs x, y and z refuses them.

    Raises
    ------
    ModelError
        If a coordinate is not finite, an element has a node that is not there, an element or a
        face has another number of nodes than its kind, or a number is given twice.
    """

    nodes: NDArray[np.float64]
    cells: tuple[tuple[str, NDArray[np.int64]], ...]
    numbers: NDArray[np.int64]
    node_sets: Mapping[str, Places]
    surfaces: Mapping[str, tuple[Places, ...]]
    rotated: Places

    def __init__(
        self,
        nodes: ArrayLike,
        cells: Sequence[tuple[str, ArrayLike]] = (),
        numbers: ArrayLike | None = None,
        node_sets: Mapping[str, ArrayLike] | None = None,
        surfaces: Mapping[str, Sequence[ArrayLike]] | None = None,
        rotated: ArrayLike = (),
    ) -> None:
        places = real_array(nodes, "mesh: nodes", "three coordinates each")
        if places.ndim != 2 or places.shape[1] != 3 or not places.size:
            raise ModelError(f"mesh: nodes of shape {places.shape}; give three coordinates each")
        if not np.isfinite(places).all():
            raise ModelError("mesh: a coordinate is not finite")
        count = len(places)
        known = (
            np.arange(1, count + 1)
            if numbers is None
            else whole_array(numbers, "mesh: numbers", "one per node")
        )
        if known.shape != (count,) or np.unique(known).size < count:
            raise ModelError(
                f"mesh: {known.size} numbers, {np.unique(known).size} of them different, for "
                f"{count} nodes; give numbers=, one per node"
            )
        elements = tuple(tables(members(cells, "mesh: cells", "[(kind, nodes), ...]")))
        for kind, of in elements:
            if of.ndim != 2 or ((of < 0) | (of >= count)).any():
                raise ModelError(f"mesh: a {kind} has a node that is not among the {count}")
        sets = {
            name: whole_array(own, f"mesh: node set {name}", "positions of nodes")
            for name, own in (node_sets or {}).items()
        }
        faces = {name: tuple(named_faces(name, own)) for name, own in (surfaces or {}).items()}
        turned = whole_array(rotated, "mesh: rotated", "positions of nodes")
        parts = [*sets.items(), *((n, f) for n, many in faces.items() for f in many)]
        for name, own in [*parts, ("rotated", turned)]:
            if ((own < 0) | (own >= count)).any():
                raise ModelError(f"mesh: {name} has a node that is not among the {count}")
        set_fields(self, nodes=places, cells=elements, numbers=known)
        set_fields(self, node_sets=sets, surfaces=faces, rotated=turned)

    def __repr__(self) -> str:
        named = [*self.surfaces, *self.node_sets]
        parts = f", parts {named}" if named else ""
        elements = sum(len(of) for _, of in self.cells)
        return f"Mesh({len(self.nodes)} nodes, {elements} elements{parts})"

    @classmethod
    def of_solid(cls, solid: Solid) -> Mesh:
        """Return the mesh of a `Solid`, whose nodes are numbered from 1 as in its `dofs`."""
        count = len(solid.nodes)
        return cls(solid.nodes, (("hexahedron20", solid.elements),), np.arange(1, count + 1))

    def surface(self, part: Part) -> Surface:
        """Return a surface by its name, or that on a set of nodes.

        Parameters
        ----------
        part : str or ndarray of bool, shape (n,)
            Name of a surface or of a set of nodes, or True for the nodes that belong to it. Of
            nodes: all faces at the outside that have all their corners among them.

        Raises
        ------
        ModelError
            If there is no such part, or it has no faces.
        """
        if isinstance(part, str):
            entry = f"surface {brief(part)}"
            if part in self.surfaces:
                return self._surface_of(self.surfaces[part], entry)
            if part not in self.node_sets:
                names = [*self.surfaces, *self.node_sets]
                raise ModelError(f"mesh: {unknown('surface or node set', part, names)}")
            among = np.zeros(len(self.numbers), dtype=bool)
            among[self.node_sets[part]] = True
        else:
            entry, among = "surface", np.zeros(0)
            with suppress(ValueError):
                # Rows of unequal length.
                among = np.asarray(part)
            if among.dtype != bool or among.shape != self.numbers.shape:
                raise ModelError(
                    f"surface: {brief(part)}; give a name, or True and False for the "
                    f"{len(self.numbers)} nodes, as nodes[:, 2] == 0.0"
                )
        whole = [
            faces[among[faces[:, : 4 if faces.shape[1] in (4, 8) else 3]].all(axis=1)]
            for faces in outside(self.cells, self.nodes)
        ]
        return self._surface_of(whole, entry)

    def node_at(self, point: ArrayLike, within: float | str | None = None) -> int:
        """Return the number of the node nearest to a point.

        Parameters
        ----------
        point : array_like of float, shape (3,)
            Coordinates, in the unit of the mesh.
        within : float or str, optional
            How far away the node may be, as a text with its unit of a mesh in m. Default: any
            distance.

        Raises
        ------
        ModelError
            If no node is that near.
        """
        place = real_array(point, "point", "three coordinates")
        if place.shape != (3,) or not np.isfinite(place).all():
            raise ModelError(f"point: {brief(point)} has not three finite coordinates")
        distances = np.linalg.norm(self.nodes - place, axis=1)
        nearest = int(distances.argmin())
        reach = np.inf if within is None else physical_number(within, "m", "within")
        if distances[nearest] > reach:
            raise ModelError(
                f"point: the node nearest to {place.tolist()} is {self.numbers[nearest]}, "
                f"{distances[nearest]:.3g} away; allow more than within={reach:g}, or look at the "
                "unit of the mesh"
            )
        return int(self.numbers[nearest])

    def dof_at(self, point: ArrayLike, direction: int, within: float | str | None = None) -> str:
        """Return the degree of freedom of the node nearest to a point, "node.direction".

        `direction` is 1, 2 or 3, of rotations 4, 5 or 6; see `node_at`.
        """
        way = whole_number(direction, "direction", smallest=1, largest=6)
        number = self.node_at(point, within)
        self._require_global(np.flatnonzero(self.numbers == number), "point")
        return f"{number}.{way}"

    def field(self, dofs: Iterable[str], values: ArrayLike) -> NDArray[Any]:
        """Return displacements at the nodes, shape (n, 3).

        Parameters
        ----------
        dofs : iterable of str
            Names "node.direction"; rotations are left out, and what is not named is 0, as of
            clamped nodes.
        values : array_like, shape (N,)
            Displacement of each, real or complex.

        Raises
        ------
        ModelError
            If a name is another, a node is not in the mesh, or the lengths differ.
        """
        moved, names = np.asarray(values), list(dofs)
        if moved.shape != (len(names),):
            raise ModelError(f"field: shape {moved.shape} for {len(names)} dofs; give one of each")
        if moved.dtype.kind not in "biufc":
            raise ModelError(f"field: {brief(values)} are no numbers; give displacements")
        nodes, ways = self._places(names)
        self._require_global(nodes, "field")
        made = np.zeros((len(self.nodes), 3), moved.dtype)
        kept = ways < 3
        made[nodes[kept], ways[kept]] = moved[kept]
        return made

    def modes(
        self,
        reduction: Reduction,
        count: int = 6,
        springs: Mapping[str, float] | None = None,
        relative: Relative | None = None,
    ) -> dict[str, NDArray[np.float64]]:
        """Return the natural modes of a reduced structure as fields, for `write_vtu`.

        `springs` to ground at boundary degrees of freedom [N/m] are added: stuck dampers. Shapes
        are mass-normalised, (n, 3). `relative` is as of `motion`.
        """
        names = _rows_of(reduction)
        squares, shapes = natural_modes(reduction, springs)
        wanted = whole_number(count, "count", smallest=1, largest=squares.size)
        hertz = np.sqrt(np.clip(squares[:wanted], 0.0, None)) / (2.0 * np.pi)
        moved = reduction.recover(shapes[:, :wanted].T)
        if relative is not None:
            moved = relative.absolute(moved, names)
        return {
            f"mode {number} at {frequency:.6g} Hz": self.field(names, shape)
            for number, (frequency, shape) in enumerate(zip(hertz, moved, strict=True), 1)
        }

    def motion(
        self,
        response: ForcedResponse,
        index: int,
        reduction: Reduction | None = None,
        measure: Measure = "half_range",
        relative: Relative | None = None,
    ) -> dict[str, NDArray[np.float64]]:
        """Return a point of a response as fields, for `write_vtu`.

        They are the amplitude of each component and the fundamental, real and imaginary part, of
        the displacement, shape (n, 3) [m]; and at the nodes of contacts, elsewhere not-a-number,
        the share of the period that they slip and the work that they dissipate [J], shape (n,).
        A contact between two nodes is at both, with half of its work at each; a node with several
        has the largest share and the sum of the works.

        Parameters
        ----------
        response : ForcedResponse
            With all degrees of freedom observed: ``observe=model.structure.dofs``.
        index : int
            Position of the point.
        reduction : Reduction, optional
            What leads to all degrees of freedom. Default: those of the model are all, with names
            "node.direction".
        measure : {"half_range", "max", "fundamental"}, optional
            Of the amplitude.
        relative : ContactInterface, optional
            Whose `relative` the model has: the first nodes of its pairs move by what the others do,
            and what the model has of them. Its contacts are at the first nodes.
        """
        dofs = response.model.structure.dofs
        if response.dofs != tuple(dofs):
            raise ModelError(
                "response: not all degrees of freedom were observed; compute it with "
                "observe=model.structure.dofs"
            )
        if reduction is not None and tuple(dofs) != reduction.dofs:
            raise ModelError("reduction: the response has other degrees of freedom than it")
        count = len(response.omega)
        point = whole_number(index, "index", smallest=-count, largest=count - 1)
        series = response.arrays.displacement[point]
        names = tuple(dofs) if reduction is None else _rows_of(reduction)
        whole: Any = series if reduction is None else reduction.recover(series)
        if relative is not None:
            whole = relative.absolute(whole, names)
        first = self.field(names, whole[1])
        return {
            "displacement amplitude": self.field(names, amplitude_of(whole.T.copy(), measure)),
            "displacement fundamental real": first.real,
            "displacement fundamental imag": first.imag,
            **self._contacts(response, point, reduction),
        }

    def write_vtu(self, path: str | os.PathLike[str], fields: Mapping[str, ArrayLike]) -> None:
        """Write mesh and nodal fields for ParaView, whole or not at all.

        `fields` are real values at the nodes by name, shape (n,) or (n, 3). The package meshio is
        needed.
        """
        write_vtu(path, self.nodes, self.cells, fields)

    def _surface_of(self, faces: Iterable[Places], entry: str) -> Surface:
        made = Surface.of(self.numbers, self.nodes, distinct(list(faces), self.nodes), entry)
        self._require_global(np.flatnonzero(np.isin(self.numbers, made.labels)), entry)
        return made

    def _require_global(self, nodes: Places, entry: str) -> None:
        """Refuse nodes whose displacements are not along x, y and z."""
        wrong = np.intersect1d(nodes, self.rotated)
        if wrong.size:
            raise ModelError(
                f"{entry}: node {self.numbers[wrong[0]]} has directions of its own, not x, y and "
                "z; give it those of the model before matrices and mesh are written"
            )

    def _contacts(
        self, response: ForcedResponse, point: int, reduction: Reduction | None
    ) -> dict[str, NDArray[np.float64]]:
        """Return slip and dissipation at the nodes of contacts."""
        slip, work = (np.full(len(self.nodes), np.nan) for _ in range(2))
        model = response.model
        for number, contact in enumerate(model.contacts):
            rows = contact.rows(model.structure).reshape(contact.points, -1, len(response.dofs))
            moved = np.asarray(rows.any(axis=1))
            told = response.slip_fraction(number)[point], response.dissipation(number)[point]
            for ends, share, lost in zip(moved, *told, strict=True):
                touched = [response.dofs[place] for place in np.flatnonzero(ends)]
                if reduction is not None:
                    full = _rows_of(reduction)
                    kept = [one for one in touched if one in reduction.boundary]
                    touched = [full[reduction.rows[reduction.boundary.index(one)]] for one in kept]
                nodes = np.unique(self._places(touched)[0])
                part = lost / max(len(nodes), 1)
                slip[nodes] = np.fmax(slip[nodes], share)
                work[nodes] = np.where(np.isnan(work[nodes]), part, work[nodes] + part)
        return {"slip fraction": slip, "dissipation": work} if model.contacts else {}

    def _places(self, names: Sequence[str]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return nodes and directions of degrees of freedom, both counted from 0."""
        found = [_NAME.fullmatch(name) for name in names]
        for name, match in zip(names, found, strict=True):
            if match is None:
                raise ModelError(f"dof {brief(name)}: it names no node; names are node.direction")
        numbers = np.array([int(match[1]) for match in found if match], np.int64)
        ways = np.array([int(match[2]) - 1 for match in found if match], np.int64)
        order = np.argsort(self.numbers)
        places = np.searchsorted(self.numbers, numbers, sorter=order).clip(max=len(order) - 1)
        nodes = order[places]
        strange = numbers[self.numbers[nodes] != numbers]
        if strange.size:
            raise ModelError(
                f"node {strange[0]}: it is not in the mesh of {len(self.nodes)} nodes; read the "
                "mesh of the same model, or give numbers="
            )
        return nodes, ways


def mesh_of(value: object, entry: str) -> Mesh:
    """Return a mesh, of a `Solid` its own."""
    if isinstance(value, Solid):
        return Mesh.of_solid(value)
    if not isinstance(value, Mesh):
        raise ModelError(f"{entry}: {brief(value)} is no mesh; give ss.read_mesh(...) or a Solid")
    return value


def _rows_of(reduction: Reduction) -> tuple[str, ...]:
    if reduction.row_names is None:
        raise ModelError("reduction: its rows have no names; give dofs= to craig_bampton")
    return reduction.row_names
