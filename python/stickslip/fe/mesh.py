"""Finite-element meshes: nodes by their numbers, elements, and what is named of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import Matrix, brief, unknown
from stickslip.errors import ModelError
from stickslip.fe.solid import Solid
from stickslip.fe.surface import Places, Surface, outward

Part: TypeAlias = str | NDArray[np.bool_]
"""A surface or a set of nodes by its name, or which nodes of the mesh it has."""

_QUADRILATERAL = [(0, 1), (1, 2), (2, 3), (3, 0)]
_TRIANGLE = [(0, 1), (1, 2), (2, 0)]
_EDGES: dict[str, list[tuple[int, int]]] = {
    "triangle": _TRIANGLE,
    "quad": _QUADRILATERAL,
    "tetra": [*_TRIANGLE, (0, 3), (1, 3), (2, 3)],
    "wedge": [*_TRIANGLE, (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
    "hexahedron": [
        *_QUADRILATERAL,
        *((one + 4, other + 4) for one, other in _QUADRILATERAL),
        *((one, one + 4) for one in range(4)),
    ],
}
"""Edges of elements, in the order in which the nodes at their middles are numbered."""
_FACES: dict[str, list[tuple[int, ...]]] = {
    "triangle": [(0, 1, 2)],
    "quad": [(0, 1, 2, 3)],
    "tetra": [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)],
    "wedge": [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)],
    "hexahedron": [
        *((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1)),
        *((1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
    ],
}
"""Corners of the faces of elements, in the order of Abaqus' S1, S2, ..."""
KINDS = {
    **dict.fromkeys(("triangle", "triangle6"), "triangle"),
    **dict.fromkeys(("quad", "quad8"), "quad"),
    **dict.fromkeys(("tetra", "tetra10"), "tetra"),
    **dict.fromkeys(("wedge", "wedge15"), "wedge"),
    **dict.fromkeys(("hexahedron", "hexahedron20"), "hexahedron"),
}
"""Kinds of elements, named as meshio does, and the shape of each."""
_SHELLS = ("triangle", "quad")


@dataclass(frozen=True, eq=False)
class Mesh:
    """Nodes, elements and named parts of a finite-element model, as `read_mesh` returns them."""

    labels: Places
    """Numbers of the nodes in the model, shape (n,)."""
    points: Matrix
    """Coordinates [m], shape (n, 3)."""
    cells: tuple[tuple[str, Places], ...]
    """Elements: their kind, as meshio names it, and the positions of their nodes, (m, k)."""
    node_sets: Mapping[str, Places] = field(default_factory=dict)
    """Positions of the nodes of each set."""
    surfaces: Mapping[str, tuple[Places, ...]] = field(default_factory=dict)
    """Faces of each surface, arrays of positions, (m, k), by their number of nodes."""

    def __repr__(self) -> str:
        elements = sum(len(cells) for _, cells in self.cells)
        named = [*self.surfaces, *self.node_sets]
        return f"Mesh({len(self.labels)} nodes, {elements} elements, parts {named})"

    @classmethod
    def of_solid(cls, solid: Solid) -> Mesh:
        """Return the mesh of a `Solid`, whose nodes are numbered from 1 as in its `dofs`."""
        count = len(solid.nodes)
        return cls(np.arange(1, count + 1), solid.nodes, (("hexahedron20", solid.elements),))

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
                return Surface.of(self.labels, self.points, self.surfaces[part], entry)
            if part not in self.node_sets:
                names = [*self.surfaces, *self.node_sets]
                raise ModelError(f"mesh: {unknown('surface or node set', part, names)}")
            among = np.zeros(len(self.labels), dtype=bool)
            among[self.node_sets[part]] = True
        else:
            entry, among = "surface", np.asarray(part)
            if among.dtype != bool or among.shape != self.labels.shape:
                raise ModelError(
                    f"surface: {brief(part)}; give a name, or True and False for the "
                    f"{len(self.labels)} nodes, as points[:, 2] == 0.0"
                )
        whole = [
            faces[among[faces[:, : 4 if faces.shape[1] in (4, 8) else 3]].all(axis=1)]
            for faces in self._outside
        ]
        return Surface.of(self.labels, self.points, whole, entry)

    @cached_property
    def _outside(self) -> list[Places]:
        """Faces that belong to one solid element only, and all shells."""
        solid = [(kind, cells) for kind, cells in self.cells if KINDS[kind] not in _SHELLS]
        found = [
            faces
            for kind, cells in solid
            for number in range(1, len(_FACES[KINDS[kind]]) + 1)
            for faces in [element_faces(kind, cells, number, self.points)]
        ]
        keys = np.vstack([_keys(faces) for faces in found] or [np.zeros((0, 4), np.int64)])
        _, place, times = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
        single = times[place.ravel()] == 1
        ends = np.cumsum([len(faces) for faces in found])[:-1]
        kept = [f[one] for f, one in zip(found, np.split(single, ends), strict=True)]
        shells = [cells for kind, cells in self.cells if KINDS[kind] in _SHELLS]
        return kept + shells


def element_faces(kind: str, cells: Places, number: int, points: Matrix) -> Places:
    """Return the faces of one number, from 1, of elements, (m, k), their normals outward."""
    shape = KINDS[kind]
    corners = _FACES[shape][number - 1]
    order = list(corners)
    if cells.shape[1] > 1 + max(map(max, _FACES[shape])):
        middle = {frozenset(edge): place for place, edge in enumerate(_EDGES[shape])}
        first = 1 + max(map(max, _FACES[shape]))
        edges = zip(corners, (*corners[1:], corners[0]), strict=True)
        order += [first + middle[frozenset(edge)] for edge in edges]
    faces = cells[:, order]
    return faces if shape in _SHELLS else outward(faces, points, points[cells].mean(axis=1))


def face_count(kind: str) -> int:
    """Return the number of faces of an element."""
    return len(_FACES[KINDS[kind]])


def _keys(faces: Places) -> Places:
    """Return the corners of faces in ascending order, (m, 4), of triangles after a -1."""
    corners = faces[:, : 4 if faces.shape[1] in (4, 8) else 3]
    padded = np.full((len(faces), 4), -1)
    padded[:, 4 - corners.shape[1] :] = corners
    return np.sort(padded, axis=1)


def mesh_of(value: object, entry: str) -> Mesh:
    """Return a mesh, of a `Solid` its own."""
    if isinstance(value, Solid):
        return Mesh.of_solid(value)
    if not isinstance(value, Mesh):
        raise ModelError(f"{entry}: {brief(value)} is no mesh; give ss.read_mesh(...) or a Solid")
    return value


def by_size(faces: Iterable[Places]) -> tuple[Places, ...]:
    """Return faces in one array for each number of nodes."""
    given = list(faces)
    sizes = sorted({one.shape[1] for one in given})
    return tuple(np.vstack([one for one in given if one.shape[1] == size]) for size in sizes)
