"""Meshes from input decks: nodes, elements, sets and surfaces of CalculiX and Abaqus."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

import numpy as np

from stickslip.checks import MAX_SPARSE, brief, unknown
from stickslip.fe.faces import by_size, element_faces, face_count
from stickslip.fe.mesh import Mesh
from stickslip.fe.surface import Places, turned
from stickslip.io.numbers import real_field, whole_field
from stickslip.io.source import at_line, read_text, readable

_KINDS = {
    **dict.fromkeys((("C3D", 4), ("DC3D", 4)), "tetra"),
    **dict.fromkeys((("C3D", 10), ("DC3D", 10)), "tetra10"),
    ("C3D", 6): "wedge",
    ("C3D", 15): "wedge15",
    ("C3D", 8): "hexahedron",
    ("C3D", 20): "hexahedron20",
    **dict.fromkeys((("S", 3), ("M3D", 3)), "triangle"),
    **dict.fromkeys((("S", 6), ("M3D", 6)), "triangle6"),
    **dict.fromkeys((("S", 4), ("M3D", 4)), "quad"),
    **dict.fromkeys((("S", 8), ("M3D", 8)), "quad8"),
}
_NODES = {
    **{"tetra": 4, "tetra10": 10, "wedge": 6, "wedge15": 15, "hexahedron": 8},
    **{"hexahedron20": 20, "triangle": 3, "triangle6": 6, "quad": 4, "quad8": 8},
}
_MOST = MAX_SPARSE // 3
"""Members of a range, which is written in few characters: no model has more nodes."""
_DEEPEST = 8
"""Files that name each other with *INCLUDE."""


def read_deck(file: Path) -> Mesh:
    """Read nodes, elements, node sets and surfaces of a deck; see `read_mesh`."""
    with readable(file, "deck"):
        deck = _Deck()
        for keyword, options, rows in _blocks(_lines(file, 0)):
            deck.take(keyword, options, rows)
        return deck.mesh()


class _Row(list[str]):
    """The words of a line, and where it stands."""

    def __init__(self, words: Iterable[str], line: int, file: str) -> None:
        super().__init__(words)
        self.line, self.file = line, file

    def whole(self) -> list[int]:
        """Return whole numbers."""
        with at_line(self.line, self.file):
            return [whole_field(word, signed=True) for word in self]

    def node(self) -> tuple[int, tuple[float, ...]]:
        """Return the number of a node and its coordinates."""
        with at_line(self.line, self.file):
            number, *place = self
            return whole_field(number, signed=True), tuple(map(real_field, place[:3]))


@dataclass
class _Deck:
    """What has been read so far."""

    points: dict[int, tuple[float, ...]] = field(default_factory=dict)
    elements: dict[int, tuple[str, tuple[int, ...]]] = field(default_factory=dict)
    node_sets: dict[str, dict[int, None]] = field(default_factory=dict)
    element_sets: dict[str, dict[int, None]] = field(default_factory=dict)
    surfaces: dict[str, list[tuple[str, str]]] = field(default_factory=dict)
    left_out: set[int] = field(default_factory=set)

    def take(self, keyword: str, options: dict[str, str], rows: list[_Row]) -> None:
        """Take over what stands below a keyword."""
        if keyword in ("PART", "INSTANCE"):
            raise ValueError(f"*{keyword}: write the deck without parts and instances")
        if keyword == "NODE":
            self._nodes(options, rows)
        elif keyword == "ELEMENT":
            self._elements(options, rows)
        elif keyword == "NSET":
            _collect(self.node_sets, options["NSET"], options, rows)
        elif keyword == "ELSET":
            _collect(self.element_sets, options["ELSET"], options, rows)
        elif keyword == "SURFACE":
            self._surface(options, rows)

    def _nodes(self, options: dict[str, str], rows: list[_Row]) -> None:
        if options.get("SYSTEM", "R") != "R":
            raise ValueError("*NODE, SYSTEM: give rectangular coordinates")
        for row in rows:
            number, place = row.node()
            self.points[number] = (*place, 0.0, 0.0, 0.0)[:3]
        if "NSET" in options:
            self.node_sets.setdefault(options["NSET"], {}).update(
                (row.node()[0], None) for row in rows
            )

    def _elements(self, options: dict[str, str], rows: list[_Row]) -> None:
        given = options["TYPE"]
        stem = given[: len(given) - len(given.lstrip("DCSM"))]
        digits = given[len(stem) :]
        if digits.startswith("3D"):
            stem, digits = f"{stem}3D", digits[2:]
        count = "".join(one for one in digits[:2] if one in "0123456789")
        kind = _KINDS.get((stem, int(count or 0)))
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

    def _surface(self, options: dict[str, str], rows: list[_Row]) -> None:
        name = options["NAME"]
        if options.get("TYPE", "ELEMENT") == "NODE":
            _collect(self.node_sets, name, {}, rows)
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
        for name, members in self.node_sets.items():
            lost = next((node for node in members if node not in place), None)
            if lost is not None:
                raise ValueError(f"node set {name}: there is no node {lost}")
            sets[name] = np.array([place[node] for node in members], dtype=np.int64)
        surfaces = {
            name: by_size(self._faces(name, given, row, arrays, points))
            for name, given in self.surfaces.items()
        }
        return Mesh(points, tuple(arrays.items()), labels, sets, surfaces)

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
                    why = "has no faces here" if number in self.left_out else "is not there"
                    raise ValueError(f"surface {name}: element {number} {why}")
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
            digit = side.removeprefix("S")
            if digit not in map(str, range(1, face_count(kind) + 1)):
                raise ValueError(f"surface {name}: {kind} has no face {brief(side)}; give S1, ...")
            yield element_faces(kind, own, int(digit), points)


def _collect(
    sets: dict[str, dict[int, None]], name: str, options: dict[str, str], rows: list[_Row]
) -> None:
    """Add numbers, ranges, and members of other sets to a set."""
    own = sets.setdefault(name, {})
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


def _generated(name: str, numbers: list[int]) -> range:
    """Return the numbers from a first to a last one."""
    first, last, step = (*numbers, 1)[:3] if len(numbers) > 1 else (0, 0, 0)
    if step < 1 or len(numbers) > 3:
        raise ValueError(f"set {name}: {brief(numbers)} is no range; give first, last, step")
    found = range(first, last + 1, step)
    if len(found) > _MOST:
        raise ValueError(f"set {name}: {first} to {last} are too many; at most {_MOST}")
    return found


def _blocks(lines: Iterable[_Line]) -> Iterator[tuple[str, dict[str, str], list[_Row]]]:
    """Give each keyword with its options and the rows below it, all in capitals."""
    found: tuple[str, dict[str, str], list[_Row]] | None = None
    for file, number, line in lines:
        words = [word.strip().upper() for word in line.split(",")]
        if line.startswith("*"):
            if found:
                yield found
            pairs = (word.partition("=") for word in words[1:] if word)
            found = words[0][1:].strip(), {key.strip(): one.strip() for key, _, one in pairs}, []
            for key in _NAMED.get(found[0], ()):
                if key not in found[1]:
                    raise ValueError(f"*{found[0]}: {key}= is missing")
        elif found:
            found[2].append(_Row((word for word in words if word), number, file))
    if found:
        yield found


_NAMED = {"NSET": ("NSET",), "ELSET": ("ELSET",), "SURFACE": ("NAME",), "ELEMENT": ("TYPE",)}


_Line: TypeAlias = tuple[str, int, str]
"""Name of the file if it is an included one, number of the line, and what it says."""


def _lines(file: Path, depth: int) -> Iterator[_Line]:
    """Give the lines of a deck, without comments, those of included files in their place."""
    if depth > _DEEPEST:
        raise ValueError("*INCLUDE: files include each other")
    for number, line in enumerate(read_text(file, "latin-1").splitlines(), 1):
        text = line.strip()
        if not text or text.startswith("**"):
            continue
        if text.upper().replace(" ", "").startswith("*INCLUDE,INPUT="):
            yield from _lines(file.parent / text.partition("=")[2].strip().strip('"'), depth + 1)
        else:
            yield file.name if depth else "", number, text
