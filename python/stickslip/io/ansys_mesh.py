"""The mesh in an archive of ANSYS, its components as sets of nodes and surfaces."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from functools import cached_property

import numpy as np

from stickslip.fe.faces import by_size, element_faces, face_count, keys_of, outside
from stickslip.fe.mesh import Mesh
from stickslip.fe.surface import Places
from stickslip.io.ansys_elements import Cells, cells_of, is_on_surface, is_shell, most_nodes
from stickslip.io.archive import Archive


def mesh_of_archive(archive: Archive) -> Mesh:
    """Return what was read as a mesh.

    Components of nodes are sets of nodes. Those of shells, and of elements that all lie on faces at
    the outside of solids, are surfaces.
    """
    blocks = [block for block in _blocks(archive) if block.labels.size]
    made = _Places(archive, blocks)
    made.require_whole_faces()
    sets, surfaces = {}, {}
    for name, (kind, members) in archive.components.items():
        if kind == "NODE":
            numbers = _members(name, "node", members, archive.nodes)
            sets[name] = np.array([made.position[one] for one in numbers], np.int64)
        elif found := made.surface(_members(name, "element", members, archive.elements)):
            surfaces[name] = found
    kinds = dict.fromkeys(kind for kind, _ in made.cells)
    cells = tuple((kind, np.vstack([o for k, o in made.cells if k == kind])) for kind in kinds)
    turned = [made.position[one] for one in archive.rotated]
    return Mesh(made.points, cells, made.labels, sets, surfaces, turned)


class _Places:
    """Nodes and elements by positions."""

    def __init__(self, archive: Archive, blocks: list[Cells]) -> None:
        self.archive, self.blocks = archive, blocks
        self.labels = np.fromiter(archive.nodes, np.int64, len(archive.nodes))
        self.points = np.array(list(archive.nodes.values()))
        self.cells = [(block.kind, self.of_block(block)) for block in blocks]

    @cached_property
    def position(self) -> dict[int, int]:
        """Of each node, by its number."""
        return {number: at for at, number in enumerate(self.archive.nodes)}

    def of_block(self, block: Cells) -> Places:
        """Return the positions of the nodes of elements."""
        order = np.argsort(self.labels)
        known = self.labels[order]
        at = np.searchsorted(known, block.nodes).clip(max=len(known) - 1)
        lost = np.argwhere(known[at] != block.nodes)
        if lost.size:
            row, column = lost[0]
            raise ValueError(
                f"element {block.labels[row]}: there is no node {block.nodes[row, column]}"
            )
        found: Places = order[at]
        return found

    def require_whole_faces(self) -> None:
        """Refuse faces at the outside with some of the nodes between their corners.

        Inside a body such elements lead from linear to quadratic ones, and have no contact.
        """
        partly = [at for at, block in enumerate(self.blocks) if block.partly]
        if not partly:
            return
        outer = {key for faces in outside(self.cells, self.points) for key in keys_of(faces)}
        for at in partly:
            kind, own = self.cells[at]
            for number in range(1, face_count(kind) + 1):
                keys = keys_of(element_faces(kind, own, number, self.points))
                for label, key in zip(self.blocks[at].labels, keys, strict=True):
                    if key in outer:
                        raise ValueError(
                            f"element {label}, at the outside, has some midside nodes, not all"
                        )

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
    for part in members:
        # A damaged range may have more numbers than memory holds: the first unknown one ends it.
        for number in part:
            if number not in known:
                raise ValueError(
                    f"component {name}: there is no {what} {number}; ALLSEL before CDWRITE"
                )
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
