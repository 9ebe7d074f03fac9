"""The elements of ANSYS as those of meshes: bricks whose nodes coincide are wedges and others."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from stickslip.io.cells import Cells, Numbers, with_middles

_BRICKS = (5, 45, 46, 62, 64, 65, 69, 70, 73, 96, 97, 107, 164, 185, 190, 215, 278)
_BRICKS_20 = (89, 90, 95, 122, 186, 191, 216, 226, 231, 236, 239, 279)
_TETRAHEDRA = (72, 285)
_TETRAHEDRA_10 = (87, 92, 98, 123, 148, 168, 187, 217, 227, 232, 237, 240, 291)
_SHELLS = (28, 41, 43, 57, 63, 131, 143, 157, 163, 181)
_SHELLS_8 = (91, 93, 99, 132, 150, 281)
_ON_SURFACES = (22, 152, 154, 170, 173, 174)
"""Elements on the faces of others: surface effects, targets and contacts."""

_NODES = {
    **dict.fromkeys(_BRICKS, ("brick", 8)),
    **dict.fromkeys(_BRICKS_20, ("brick", 20)),
    **dict.fromkeys(_TETRAHEDRA, ("tetrahedron", 4)),
    **dict.fromkeys(_TETRAHEDRA_10, ("tetrahedron", 10)),
    **dict.fromkeys(_SHELLS, ("shell", 4)),
    **dict.fromkeys(_SHELLS_8, ("shell", 8)),
}
"""Family of an element by its number, and its most nodes."""

_CORNERS = {"brick": 8, "tetrahedron": 4, "shell": 4}
_KINDS: dict[str, tuple[list[int], list[int]]] = {
    "tetra": ([0, 1, 2, 4], [8, 9, 11, 16, 17, 18]),
    "pyramid": ([0, 1, 2, 3, 4], [*range(8, 12), *range(16, 20)]),
    "wedge": ([0, 1, 2, 4, 5, 6], [8, 9, 11, 12, 13, 15, 16, 17, 18]),
    "hexahedron": ([*range(8)], [*range(8, 20)]),
    "triangle": ([0, 1, 2], [4, 5, 7]),
    "quad": ([*range(4)], [*range(4, 8)]),
}
"""Corners and nodes between them of bricks and shells, for each shape that they can have."""


def most_nodes(element: int) -> int:
    """Return the most nodes of an element, 186 of SOLID186; 0: it is no part of meshes."""
    return _NODES.get(element, ("", 0))[1]


def is_shell(element: int) -> bool:
    """Return whether elements are faces themselves."""
    return element in _SHELLS or element in _SHELLS_8


def is_on_surface(element: int) -> bool:
    """Return whether elements lie on the faces of others."""
    return element in _ON_SURFACES


def cells_of(labels: Numbers, element: int, nodes: Iterable[list[int]]) -> Iterator[Cells]:
    """Give elements of one kind of ANSYS by their kinds in meshes."""
    family, most = _NODES[element]
    corners = _CORNERS[family]
    table = np.zeros((len(labels), most), np.int64)
    for row, own in enumerate(nodes):
        if not corners - (family == "shell") <= len(own) <= most:
            raise ValueError(f"element {labels[row]} has {len(own)} nodes, of type {element}")
        table[row, : len(own)] = own
    if family == "tetrahedron":
        yield from with_middles("tetra", labels, table[:, :4], table[:, 4:])
        return
    if family == "shell":
        table[:, 3] = np.where(table[:, 3] == 0, table[:, 2], table[:, 3])
    for kind, those in _shapes(table, family):
        first, between = _KINDS[kind]
        chosen = table[those]
        middles = chosen[:, between] if most > corners else chosen[:, :0]
        yield from with_middles(kind, labels[those], chosen[:, first], middles)


def _shapes(table: Numbers, family: str) -> Iterator[tuple[str, NDArray[np.bool_]]]:
    """Give each shape and which elements have it, by the corners that coincide."""
    same = table[:, 2] == table[:, 3]
    if family == "shell":
        yield from (("triangle", same), ("quad", ~same))
        return
    top = (table[:, 4:8] == table[:, 4:5]).all(axis=1)
    wedge = same & ~top & (table[:, 6] == table[:, 7])
    yield from (("tetra", same & top), ("pyramid", ~same & top), ("wedge", wedge))
    yield "hexahedron", ~(top | wedge)
