"""Faces of finite elements, and those at the outside of a mesh."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from stickslip.checks import Matrix, as_list, brief, whole_array
from stickslip.errors import ModelError
from stickslip.fe.overlap import corner_keys, uncovered
from stickslip.fe.surface import Places, outward

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


def tables(given: Iterable[object]) -> Iterator[tuple[str, Places]]:
    """Give the elements of each kind, a table of the positions of their nodes."""
    for pair in given:
        parts = as_list(pair)
        if parts is None or len(parts) != 2:
            raise ModelError(f"mesh: cells: {brief(pair)} is no pair; give (kind, nodes)")
        yield str(parts[0]), whole_array(parts[1], f"mesh: {parts[0]}", "positions of nodes")


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
