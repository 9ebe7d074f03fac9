"""Elements as programs give them: by their numbers and those of their nodes, some left out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip.fe.faces import element_faces, face_count, keys_of, outside
from stickslip.fe.surface import Places

Numbers: TypeAlias = NDArray[np.int64]
_QUADRATIC = {
    **{"tetra": "tetra10", "pyramid": "pyramid13", "wedge": "wedge15"},
    **{"hexahedron": "hexahedron20", "triangle": "triangle6", "quad": "quad8"},
}


@dataclass(frozen=True)
class Cells:
    """Elements of one kind of a mesh, by their numbers and those of their nodes."""

    kind: str
    labels: Numbers
    nodes: Numbers
    partly: bool = False
    """Whether they have some of the nodes between their corners, which are left out here."""


def with_middles(kind: str, labels: Numbers, corners: Numbers, middles: Numbers) -> Iterator[Cells]:
    """Give elements with all, without any, and with some of the nodes between their corners.

    A node 0 is missing.
    """
    ordered = np.sort(corners, axis=1)
    odd = np.flatnonzero((ordered[:, 0] < 1) | (ordered[:, 1:] == ordered[:, :-1]).any(axis=1))
    if odd.size:
        raise ValueError(
            f"element {labels[odd[0]]}: corners coincide as in no wedge, pyramid or tetrahedron"
        )
    there = middles != 0
    some, whole = there.any(axis=1), there.all(axis=1)
    if middles.shape[1]:
        yield Cells(_QUADRATIC[kind], labels[whole], np.hstack([corners, middles])[whole])
        partly = some & ~whole
        yield Cells(kind, labels[partly], corners[partly], partly=True)
    yield Cells(kind, labels[~some], corners[~some])


class Assembly:
    """The nodes and elements of a model by positions."""

    def __init__(self, nodes: dict[int, tuple[float, ...]], blocks: list[Cells]) -> None:
        self.numbers = nodes.keys()
        self.labels = np.fromiter(nodes, np.int64, len(nodes))
        self.points = np.array(list(nodes.values())).reshape(-1, 3)
        self.blocks = [block for block in blocks if block.labels.size]
        order = np.argsort(self.labels)
        self.cells = [(block.kind, self._places(block, order)) for block in self.blocks]
        self._require_whole_faces()

    @cached_property
    def position(self) -> dict[int, int]:
        """Of each node, by its number."""
        return {number: at for at, number in enumerate(self.numbers)}

    @property
    def by_kind(self) -> tuple[tuple[str, Places], ...]:
        """All elements of each kind, as a mesh has them."""
        kinds = dict.fromkeys(kind for kind, _ in self.cells)
        return tuple((kind, np.vstack([o for k, o in self.cells if k == kind])) for kind in kinds)

    def _places(self, block: Cells, order: Places) -> Places:
        """Return the positions of the nodes of elements."""
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

    def _require_whole_faces(self) -> None:
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
