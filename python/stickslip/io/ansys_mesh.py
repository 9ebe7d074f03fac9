"""The mesh in an archive of ANSYS, its components as sets of nodes and surfaces."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from functools import cached_property

import numpy as np

from stickslip.fe.faces import by_size, keys_of, outside
from stickslip.fe.mesh import Mesh
from stickslip.fe.surface import Places
from stickslip.io.ansys_elements import cells_of, is_on_surface, is_shell, most_nodes
from stickslip.io.archive import Archive
from stickslip.io.cells import Assembly, Cells


def mesh_of_archive(archive: Archive) -> Mesh:
    """Return what was read as a mesh.

    Components of nodes are sets of nodes. Those of shells, and of elements that all lie on faces at
    the outside of solids, are surfaces.
    """
    made = _Components(archive, list(_blocks(archive)))
    sets, surfaces = {}, {}
    for name, (kind, members) in archive.components.items():
        if kind == "NODE":
            numbers = _members(name, "node", members, archive.nodes)
            sets[name] = np.array([made.position[one] for one in numbers], np.int64)
        elif found := made.surface(_members(name, "element", members, archive.elements)):
            surfaces[name] = found
    turned = [made.position[one] for one in archive.rotated]
    return Mesh(made.points, made.by_kind, made.labels, sets, surfaces, turned)


class _Components(Assembly):
    """A model whose elements may make surfaces."""

    def __init__(self, archive: Archive, blocks: list[Cells]) -> None:
        super().__init__(archive.nodes, blocks)
        self.archive = archive

    def surface(self, numbers: list[int]) -> tuple[Places, ...] | None:
        """Return the faces of a component of elements; None: it is no surface."""
        kinds = {self.archive.types[self.archive.elements[number][0]] for number in numbers}
        if all(map(is_shell, kinds)):
            chosen = set(numbers)
            own = zip(self.blocks, self.cells, strict=True)
            return by_size(
                cells[np.isin(block.labels, list(chosen))]
                for block, (_, cells) in own
                if not chosen.isdisjoint(block.labels.tolist())
            )
        if not all(map(is_on_surface, kinds)):
            return None
        found: dict[int, list[Places]] = {}
        for number in numbers:
            face = self.outer.get(self.corners(self.archive.elements[number][1]))
            if face is None:
                return None
            found.setdefault(len(face), []).append(face)
        return tuple(np.array(found[size]) for size in sorted(found))

    @cached_property
    def outer(self) -> dict[tuple[int, ...], Places]:
        """The faces at the outside of solids, their normals outward, by their corners."""
        shells = ("triangle", "quad", "triangle6", "quad8")
        solids = [one for one in self.cells if one[0] not in shells]
        every = (faces for faces in outside(solids, self.points))
        return {
            key: face for faces in every for key, face in zip(keys_of(faces), faces, strict=True)
        }

    def corners(self, nodes: list[int]) -> tuple[int, ...]:
        """Return the corners of an element on a surface as those of faces are ordered."""
        # Surface effects may have one node more, away from the surface.
        count = 3 if len(nodes) in (3, 6) else 4
        own = sorted({self.position.get(node, -1) for node in nodes[:count]})
        return (-1, *own) if len(own) == 3 else tuple(own)


def _members(name: str, what: str, members: Iterable[range], known: Collection[int]) -> list[int]:
    """Return the members of a component, which must all be there."""
    found: list[int] = []
    advice = "ALLSEL before CDWRITE" + (", or it was made by N" if what == "node" else "")
    for part in members:
        # A damaged range may have more numbers than memory holds: the first unknown one ends it.
        for number in part:
            if number not in known:
                raise ValueError(f"component {name}: there is no {what} {number}; {advice}")
            found.append(number)
    return found


def _blocks(archive: Archive) -> Iterable[Cells]:
    """Give the elements of meshes, those of each type together."""
    of_types: dict[int, list[int]] = {}
    for number, (kind, _) in archive.elements.items():
        of_types.setdefault(kind, []).append(number)
    for kind, numbers in of_types.items():
        if kind not in archive.types:
            raise ValueError(
                f"element {numbers[0]}: no ET says what type {kind} is; write it with CDWRITE,DB"
            )
        if most_nodes(archive.types[kind]):
            nodes = (archive.elements[number][1] for number in numbers)
            yield from cells_of(np.array(numbers, np.int64), archive.types[kind], nodes)
