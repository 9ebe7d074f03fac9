"""Meshes from input decks: nodes, elements, sets and surfaces of CalculiX and Abaqus."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from stickslip.checks import MAX_SPARSE, brief, unknown
from stickslip.fe.faces import by_size, element_faces, face_count, keys_of, outside
from stickslip.fe.mesh import Mesh
from stickslip.fe.surface import Places, turned
from stickslip.io.deck_lines import Block, Row, blocks
from stickslip.io.numbers import whole_field
from stickslip.io.source import readable

_SOLIDS = {
    **dict.fromkeys((("C3D", 4), ("DC3D", 4)), "tetra"),
    **dict.fromkeys((("C3D", 10), ("DC3D", 10)), "tetra10"),
    ("C3D", 5): "pyramid",
    **dict.fromkeys((("C3D", 6), ("DC3D", 6), ("SC", 6)), "wedge"),
    **dict.fromkeys((("C3D", 15), ("DC3D", 15)), "wedge15"),
    **dict.fromkeys((("C3D", 8), ("DC3D", 8), ("SC", 8), ("CSS", 8)), "hexahedron"),
    **dict.fromkeys((("C3D", 20), ("DC3D", 20)), "hexahedron20"),
}
_SHELLS = {
    **dict.fromkeys((("S", 3), ("M3D", 3), ("STRI", 3)), "triangle"),
    **dict.fromkeys((("S", 6), ("M3D", 6), ("STRI", 65)), "triangle6"),
    **dict.fromkeys((("S", 4), ("M3D", 4)), "quad"),
    **dict.fromkeys((("S", 8), ("M3D", 8)), "quad8"),
}
_TYPE = re.compile("(DC3D|C3D|SC|CSS|STRI|S|M3D)([0-9]{1,2})")
"""Family and nodes of an element, which letters may follow: C3D8R."""
_GENERATE = ("NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM")
"""Keywords that make or move nodes and elements."""
_NODES = {
    **{"tetra": 4, "tetra10": 10, "pyramid": 5, "wedge": 6, "wedge15": 15, "hexahedron": 8},
    **{"hexahedron20": 20, "triangle": 3, "triangle6": 6, "quad": 4, "quad8": 8},
}
_MOST = MAX_SPARSE // 3
"""Members of a range, which is written in few characters: no model has more nodes."""


def read_deck(file: Path) -> Mesh:
    """Read nodes, elements, node sets and surfaces of a deck; see `read_mesh`."""
    with readable(file, "deck"):
        deck = _Deck()
        for block in blocks(file):
            deck.take(block)
        return deck.mesh()


@dataclass
class _Deck:
    """What has been read so far."""

    points: dict[int, tuple[float, ...]] = field(default_factory=dict)
    elements: dict[int, tuple[str, tuple[int, ...]]] = field(default_factory=dict)
    node_sets: dict[str, dict[int, None]] = field(default_factory=dict)
    element_sets: dict[str, dict[int, None]] = field(default_factory=dict)
    node_surfaces: dict[str, dict[int, None]] = field(default_factory=dict)
    surfaces: dict[str, list[tuple[str, str]]] = field(default_factory=dict)
    left_out: set[int] = field(default_factory=set)
    rotated: list[str] = field(default_factory=list)
    """Sets of nodes with directions of their own."""
    outer: set[tuple[int, ...]] | None = None
    """Faces at the outside by their corners, once they are needed."""

    def take(self, block: Block) -> None:
        """Take over what stands below a keyword."""
        keyword, options, rows = block.keyword, block.options, block.rows
        if keyword in ("PART", "INSTANCE"):
            raise ValueError(
                f"*{keyword}: write the deck without parts and instances (CAE: model attributes)"
            )
        if keyword in _GENERATE and (rows or keyword != "SYSTEM"):
            raise ValueError(f"*{keyword}: write all nodes, elements and coordinates out")
        if keyword == "NODE":
            self._nodes(options, rows)
        elif keyword == "ELEMENT":
            self._elements(options, rows)
        elif keyword == "NSET" and "ELSET" in options:
            self._nodes_of(options["NSET"], options["ELSET"])
        elif keyword == "NSET":
            _collect(self.node_sets, options["NSET"], options, rows)
        elif keyword == "ELSET":
            _collect(self.element_sets, options["ELSET"], options, rows)
        elif keyword == "SURFACE":
            self._surface(options, rows)
        elif keyword == "TRANSFORM" and "NSET" in options:
            self.rotated.append(options["NSET"])

    def _nodes(self, options: dict[str, str], rows: list[Row]) -> None:
        if options.get("SYSTEM", "R") != "R":
            raise ValueError("*NODE, SYSTEM: give rectangular coordinates")
        self.points.update(row.node() for row in rows)
        if "NSET" in options:
            self.node_sets.setdefault(options["NSET"], {}).update(
                (row.node()[0], None) for row in rows
            )

    def _nodes_of(self, name: str, elements: str) -> None:
        """Make a set of the nodes of a set of elements."""
        own = self.node_sets.setdefault(name, {})
        if elements not in self.element_sets:
            raise ValueError(f"set {name}: {unknown('ELSET', elements, self.element_sets)}")
        for number in self.element_sets[elements]:
            if number not in self.elements:
                raise ValueError(f"set {name}: element {number} {self._why(number)}")
            own.update(dict.fromkeys(self.elements[number][1]))

    def _elements(self, options: dict[str, str], rows: list[Row]) -> None:
        given = options["TYPE"]
        found = _TYPE.match(given)
        family = (found[1], int(found[2])) if found else ("", 0)
        kind = _SOLIDS.get(family) or _SHELLS.get(family)
        if kind is None and family[0] in {name for name, _ in _SOLIDS}:
            # The faces of its neighbours would count as the outside.
            raise ValueError(f"*ELEMENT, TYPE={given}: solids that are not known here")
        numbers = [number for row in rows for number in row.whole()]
        if kind is None:
            self.left_out.update(row.whole()[0] for row in rows)
        else:
            # An element may go on over several lines.
            size = 1 + _NODES[kind]
            if len(numbers) % size:
                raise ValueError(f"*ELEMENT, TYPE={given}: {len(numbers)} numbers; {size} each")
            for start in range(0, len(numbers), size):
                number, *nodes = numbers[start : start + size]
                self.elements[number] = kind, tuple(nodes)
                if "ELSET" in options:
                    self.element_sets.setdefault(options["ELSET"], {})[number] = None

    def _why(self, number: int) -> str:
        """Say why an element is not among those that are known."""
        return "has no faces here" if number in self.left_out else "is not there"

    def _surface(self, options: dict[str, str], rows: list[Row]) -> None:
        name = options["NAME"]
        if "COMBINE" in options:
            raise ValueError(f"surface {name}: COMBINE is not read; list its elements and faces")
        if options.get("TYPE", "ELEMENT") == "NODE":
            for row in rows:
                # The second of two words is an area in Abaqus.
                if len(row) == 2 and row[1] not in self.node_sets:
                    if row[1].isdecimal() and int(row[1]) in self.points:
                        raise ValueError(f"surface {name}: is {row[1]} a node? give one a line")
                    del row[1]
            # Names of sets are no names of surfaces: both may have one name, and other nodes.
            members = _members(self.node_sets, f"of surface {name}", {}, rows)
            self.node_surfaces.setdefault(name, {}).update(members)
        else:
            pairs = [(row[0], row[1] if len(row) > 1 else "") for row in rows]
            self.surfaces.setdefault(name, []).extend(pairs)

    def mesh(self) -> Mesh:
        """Return what was read."""
        if not self.points:
            raise ValueError("it has no *NODE")
        labels = np.array(list(self.points), dtype=np.int64)
        points = np.array([self.points[one] for one in labels.tolist()])
        if not np.isfinite(points).all():
            raise ValueError("a coordinate is not finite")
        place = {label: at for at, label in enumerate(labels.tolist())}
        cells: dict[str, list[tuple[int, ...]]] = {}
        row: dict[int, tuple[str, int]] = {}
        for number, (kind, nodes) in self.elements.items():
            try:
                positions = tuple(place[node] for node in nodes)
            except KeyError as missing:
                raise ValueError(f"element {number}: there is no node {missing}") from None
            row[number] = kind, len(cells.setdefault(kind, []))
            cells[kind].append(positions)
        arrays = {kind: np.array(one, dtype=np.int64) for kind, one in cells.items()}
        sets = {}
        for name, own in self.node_surfaces.items():
            if self.node_sets.setdefault(name, own).keys() != own.keys():
                raise ValueError(f"surface {name}: the set {name} has other nodes; rename one")
        for name, members in self.node_sets.items():
            lost = next((node for node in members if node not in place), None)
            if lost is not None:
                raise ValueError(f"node set {name}: there is no node {lost}")
            sets[name] = np.array([place[node] for node in members], dtype=np.int64)
        surfaces = {
            name: by_size(self._faces(name, given, row, arrays, points))
            for name, given in self.surfaces.items()
        }
        lost_set = next((name for name in self.rotated if name not in sets), None)
        if lost_set is not None:
            raise ValueError(f"*TRANSFORM: {unknown('set', lost_set, sets)}")
        local = np.concatenate([np.zeros(0, np.int64), *(sets[name] for name in self.rotated)])
        return Mesh(points, tuple(arrays.items()), labels, sets, surfaces, local)

    def _faces(
        self,
        name: str,
        given: Iterable[tuple[str, str]],
        row: dict[int, tuple[str, int]],
        cells: dict[str, Places],
        points: np.ndarray,
    ) -> Iterator[Places]:
        """Give the faces of a surface, of all elements of a kind with one face together."""
        chosen: dict[tuple[str, str], list[int]] = {}
        for which, side in given:
            if which.isdecimal():
                numbers: Iterable[int] = [whole_field(which)]
            elif which in self.element_sets:
                numbers = self.element_sets[which]
            else:
                raise ValueError(f"surface {name}: {unknown('ELSET', which, self.element_sets)}")
            for number in numbers:
                if number not in row:
                    raise ValueError(f"surface {name}: element {number} {self._why(number)}")
                kind, place = row[number]
                chosen.setdefault((kind, side), []).append(place)
        for (kind, side), rows in chosen.items():
            own = cells[kind][rows]
            if kind.startswith(("triangle", "quad")):
                faces = element_faces(kind, own, 1, points)
                if side not in ("", "S1", "SPOS", "S2", "SNEG"):
                    raise ValueError(f"surface {name}: shells have no face {brief(side)}")
                yield turned(faces) if side in ("S1", "SNEG") else faces
                continue
            if not side:
                yield from self._free(kind, own, cells, points)
                continue
            digit = side.removeprefix("S")
            if digit not in map(str, range(1, face_count(kind) + 1)):
                raise ValueError(f"surface {name}: {kind} has no face {brief(side)}; give S1, ...")
            yield element_faces(kind, own, int(digit), points)

    def _free(
        self, kind: str, own: Places, cells: dict[str, Places], points: np.ndarray
    ) -> Iterator[Places]:
        """Give the faces of solids at the outside, as Abaqus takes them where none is named."""
        if self.outer is None:
            every = outside(tuple(cells.items()), points)
            self.outer = {key for faces in every for key in keys_of(faces)}
        for number in range(1, face_count(kind) + 1):
            faces = element_faces(kind, own, number, points)
            yield faces[[key in self.outer for key in keys_of(faces)]]


def _collect(
    sets: dict[str, dict[int, None]], name: str, options: dict[str, str], rows: list[Row]
) -> None:
    """Add numbers, ranges, and members of other sets to a set."""
    sets.setdefault(name, {}).update(_members(sets, name, options, rows))


def _members(
    sets: dict[str, dict[int, None]], name: str, options: dict[str, str], rows: list[Row]
) -> dict[int, None]:
    """Return the numbers, ranges, and members of other sets that rows name."""
    own: dict[int, None] = {}
    for row in rows:
        if "GENERATE" in options:
            own.update(dict.fromkeys(_generated(name, row.whole())))
            continue
        for word in row:
            if word in sets:
                own.update(sets[word])
            elif word.lstrip("-").isdecimal():
                own[whole_field(word, signed=True)] = None
            else:
                raise ValueError(f"set {name}: {unknown('set', word, sets)}")
    return own


def _generated(name: str, numbers: list[int]) -> range:
    """Return the numbers from a first to a last one."""
    first, last, step = (*numbers, 1)[:3] if len(numbers) > 1 else (0, 0, 0)
    if step < 1 or len(numbers) > 3 or last < first:
        raise ValueError(f"set {name}: {brief(numbers)} is no range; give first, last, step")
    found = range(first, last + 1, step)
    if len(found) > _MOST:
        raise ValueError(f"set {name}: {first} to {last} are too many; at most {_MOST}")
    return found
