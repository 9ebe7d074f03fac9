"""Faces of finite elements: those at the outside of a mesh, and those that lie on others."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike

from stickslip.checks import Matrix, as_list, brief, whole_array
from stickslip.errors import ModelError
from stickslip.fe.surface import CORNERS, Places, area_vectors, outward


def corner_keys(faces: Places) -> Places:
    """Return the corners of faces in ascending order, (m, 4), of triangles after a -1."""
    corners = faces[:, : 4 if faces.shape[1] in (4, 8) else 3]
    padded = np.full((len(faces), 4), -1)
    padded[:, 4 - corners.shape[1] :] = np.sort(corners, axis=1)
    padded[:, 1:][padded[:, 1:] == padded[:, :-1]] = -1
    return np.sort(padded, axis=1)


def uncovered(of_solids: Sequence[Places], shells: Sequence[Places]) -> list[Places]:
    """Return the faces that belong to one solid element only, and the shells on no other face."""
    every = [*of_solids, *shells]
    if not every:
        return []
    keys = np.vstack(list(map(corner_keys, every)))
    unique, first, place = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    place, count = place.ravel(), sum(map(len, of_solids))
    solids = np.bincount(place[:count], minlength=len(unique))
    quads, halves = _halves(unique)
    split = (solids[halves] == 1).sum(axis=1, where=halves >= 0) == 2
    covered = np.zeros(len(unique), dtype=bool)
    covered[halves[halves >= 0]] = covered[quads[split]] = True
    # Bricks on one side of such a quadrilateral, tetrahedra on the other.
    inside = split & (solids[quads] == 1)
    solids[quads[inside]] = 2
    solids[halves[inside][halves[inside] >= 0]] = 2
    kept = solids[place] == 1
    # The first face of several alike is one of a solid, if there is one.
    own = place[count:]
    kept[count:] = (first[own] == np.arange(count, len(keys))) & ~covered[own]
    # Corners of bricks that coincide make edges of faces.
    return _parted(every, kept & (keys[:, 1] >= 0))


def distinct(faces: Sequence[Places], points: Matrix) -> list[Places]:
    """Return faces without those that lie on another one of the same side."""
    given = [one for one in faces if one.size]
    if not given:
        return []
    keys = np.vstack(list(map(corner_keys, given)))
    normals = np.vstack([area_vectors(one, points) for one in given])
    unique, first, place = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    place = place.ravel()

    def turned(others: Places) -> Places:
        against = np.einsum("mi,mi->m", normals, normals[others]) < 0.0
        return np.asarray(against, dtype=np.int64)

    kept = np.zeros(len(keys), dtype=bool)
    kept[np.unique(2 * place + turned(first[place]), return_index=True)[1]] = True
    quads, halves = _halves(unique)
    quad, half = np.nonzero(halves >= 0)
    whole = np.full(len(unique), -1)
    whole[halves[quad, half]] = first[quads[quad]]
    on = whole[place]
    kept &= (on < 0) | (turned(on) == 1)
    return _parted(given, kept)


def _halves(keys: Places) -> tuple[Places, Places]:
    """Return which keys are quadrilaterals that triangles may lie on, (q,), and those triangles.

    The latter, (q, 4), lack one corner each; -1: there is no such triangle.
    """
    triangles = np.flatnonzero((keys[:, 0] < 0) & (keys[:, 1] >= 0))
    shared = np.isin(keys, keys[triangles, 1:]).sum(axis=1) >= 3
    quads = np.flatnonzero((keys[:, 0] >= 0) & shared)
    others = np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]])
    parts = keys[quads][:, others].reshape(-1, 3)
    rows = np.vstack([keys[triangles, 1:], parts])
    _, group = np.unique(rows, axis=0, return_inverse=True)
    group = group.ravel()
    triangle = np.full(len(rows), -1)
    triangle[group[: len(triangles)]] = triangles
    return quads, triangle[group[len(triangles) :]].reshape(-1, 4)


def _parted(faces: Sequence[Places], kept: np.ndarray) -> list[Places]:
    """Return the faces that are kept, in arrays as they were given."""
    ends = np.cumsum([len(one) for one in faces])[:-1]
    return [one[own] for one, own in zip(faces, np.split(kept, ends), strict=True)]


_QUADRILATERAL = [(0, 1), (1, 2), (2, 3), (3, 0)]
_TRIANGLE = [(0, 1), (1, 2), (2, 0)]
_EDGES: dict[str, list[tuple[int, int]]] = {
    "triangle": _TRIANGLE,
    "quad": _QUADRILATERAL,
    "tetra": [*_TRIANGLE, (0, 3), (1, 3), (2, 3)],
    "wedge": [*_TRIANGLE, (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
    "pyramid": [*_QUADRILATERAL, *((one, 4) for one in range(4))],
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
    "pyramid": [(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
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
    **dict.fromkeys(("pyramid", "pyramid13"), "pyramid"),
    **dict.fromkeys(("hexahedron", "hexahedron20"), "hexahedron"),
}
"""Kinds of elements, named as meshio does, and the shape of each."""
_SHELLS = ("triangle", "quad")
_SOLID = re.compile("(VTK_LAGRANGE_)?(tetra|pyramid|wedge|hexahedron)", re.I)


def node_count(kind: str) -> int:
    """Return the number of nodes of an element: of its corners, and of its edges if numbered so."""
    corners = 1 + max(map(max, _FACES[KINDS[kind]]))
    return corners if kind in _FACES else corners + len(_EDGES[KINDS[kind]])


def tables(given: Iterable[object]) -> Iterator[tuple[str, Places]]:
    """Give the elements of each kind, a table of the positions of their nodes."""
    for pair in given:
        parts = as_list(pair)
        if parts is None or len(parts) != 2:
            raise ModelError(f"mesh: cells: {brief(pair)} is no pair; give (kind, nodes)")
        kind, of = str(parts[0]), whole_array(parts[1], f"mesh: {parts[0]}", "positions of nodes")
        if kind in KINDS and of.ndim == 2 and of.size and of.shape[1] != node_count(kind):
            raise ModelError(
                f"mesh: {of.shape[1]} nodes for a {kind}; give {node_count(kind)} of each"
            )
        yield kind, of


def named_faces(name: str, given: Iterable[ArrayLike]) -> Iterator[Places]:
    """Give the faces of a surface, arrays by their number of nodes."""
    for one in given:
        faces = whole_array(one, f"mesh: surface {name}", "positions of the nodes of each face")
        if faces.size and (faces.ndim != 2 or faces.shape[1] not in CORNERS):
            raise ModelError(
                f"mesh: surface {name}: faces of shape {faces.shape}; give arrays of (m, k), with "
                "k = 3, 4, 6 or 8 nodes of each face"
            )
        yield faces


def outside(cells: Sequence[tuple[str, Places]], points: Matrix) -> list[Places]:
    """Return the faces that belong to one solid element only, and the shells on no solid.

    A shell on the face of a solid, with the same corners, or on half of it, would count its area
    twice.
    """
    strange = next((kind for kind, _ in cells if _SOLID.match(kind) and kind not in KINDS), None)
    if strange is not None:
        raise ModelError(
            f"mesh: faces of {strange} are not known, and those around it are not at the outside; "
            "mesh with elements whose nodes are at corners and edges"
        )
    known = [(kind, own) for kind, own in cells if kind in KINDS]
    solid = [(kind, own) for kind, own in known if KINDS[kind] not in _SHELLS]
    found = [
        faces
        for kind, own in solid
        for number in range(1, len(_FACES[KINDS[kind]]) + 1)
        for faces in [element_faces(kind, own, number, points)]
    ]
    return uncovered(found, [own for kind, own in known if KINDS[kind] in _SHELLS])


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


def keys_of(faces: Places) -> Iterator[tuple[int, ...]]:
    """Give what tells each face from others, whatever its order: its corners."""
    return map(tuple, corner_keys(faces).tolist())


def by_size(faces: Iterable[Places]) -> tuple[Places, ...]:
    """Return faces in one array for each number of nodes."""
    given = list(faces)
    sizes = sorted({one.shape[1] for one in given})
    return tuple(np.vstack([one for one in given if one.shape[1] == size]) for size in sizes)
