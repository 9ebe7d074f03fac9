"""Meshes from Nastran's bulk data: grid points, elements, and sets of grid points."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from stickslip.fe.mesh import Mesh
from stickslip.io.bulk_data import Card, bulk_cards
from stickslip.io.cells import Assembly, Cells, with_middles
from stickslip.io.numbers import real_field, whole_field
from stickslip.io.source import at_line

_SOLIDS: dict[str, tuple[str, int, list[int]]] = {
    "CTETRA": ("tetra", 4, [*range(6)]),
    # Of MSC Nastran and OptiStruct.
    **dict.fromkeys(("CPYRAM", "CPYRA"), ("pyramid", 5, [*range(8)])),
    "CPENTA": ("wedge", 6, [*range(3), *range(6, 9), *range(3, 6)]),
    "CHEXA": ("hexahedron", 8, [*range(4), *range(8, 12), *range(4, 8)]),
}
"""Kind, corners, and the order of the nodes between them; upright edges come before upper ones."""
_SHELLS: dict[str, tuple[str, int, list[int]]] = {
    **dict.fromkeys(("CTRIA3", "CTRIAR"), ("triangle", 3, [])),
    **dict.fromkeys(("CQUAD4", "CQUADR"), ("quad", 4, [])),
    "CTRIA6": ("triangle", 3, [*range(3)]),
    "CQUAD8": ("quad", 4, [*range(4)]),
}
_KINDS = _SOLIDS | _SHELLS
_MOST = 6
"""Fields of a grid point that are read; blank ones at the end need not be written."""
_ONE_LINE = 8
"""Fields of a grid point, which no second line continues."""
_OTHER_WORDS = {"SKIN", "EXCEPT", "BY"}
"""Words of sets that no THRU stands for."""


@dataclass
class _Bulk:
    """What has been read."""

    places: dict[int, tuple[float, ...]] = field(default_factory=dict)
    systems: dict[int, tuple[str, str]] = field(default_factory=dict)
    """Those of the coordinates and of the displacements of each grid point."""
    default: tuple[str, str] = ("", "")
    """The same where a GRID leaves them blank."""
    elements: dict[str, list[list[int]]] = field(default_factory=dict)
    """Number and nodes of the elements of each card; 0 for a node that is missing."""
    known: set[int] = field(default_factory=set)
    """Numbers of the elements."""
    sets: dict[str, list[range]] = field(default_factory=dict)
    unread: set[str] = field(default_factory=set)
    """Sets whose members are said in other words."""

    def take(self, card: Card) -> None:
        """Take over a card."""
        if card.name == "GRID":
            self._grid(card.fields)
        elif card.name == "GRDSET":
            _, cp, _, _, _, cd, *_ = *card.fields, *[""] * _MOST
            self.default = cp, cd
        elif card.name == "SET1":
            number, *words = card.fields
            name = f"SET1 {whole_field(number)}"
            if not _OTHER_WORDS.isdisjoint(map(str.upper, words)):
                self.unread.add(name)
                return
            own = self.sets.setdefault(name, [])
            own.extend(_members([one for one in words if one]))
        else:
            self._element(card.name, card.fields)

    def _grid(self, fields: list[str]) -> None:
        number, (_, *words) = whole_field(fields[0]), [*fields, *[""] * _MOST]
        if any(fields[_ONE_LINE:]):
            raise ValueError(f"GRID {number} goes on over a second line; a card is missing")
        place = tuple(real_field(one) if one else 0.0 for one in words[1:4])
        systems = words[0], words[4]
        if self.places.get(number, place) != place or self.systems.get(number, systems) != systems:
            raise ValueError(f"GRID {number} is given twice")
        self.places[number], self.systems[number] = place, systems

    def _element(self, name: str, fields: list[str]) -> None:
        _, corners, order = _KINDS[name]
        count = corners + len(order)
        number, nodes = fields[0], [*fields[2:], *[""] * count]
        if name in _SOLIDS and any(nodes[count:]):
            raise ValueError(f"{name} {number} has more than {count} nodes")
        if not all(nodes[:corners]):
            raise ValueError(f"{name} {number} has not {corners} corners")
        own = [whole_field(one) if one else 0 for one in (number, *nodes[:count])]
        if own[0] in self.known:
            raise ValueError(f"{name} {number}: an element of this number is given twice")
        self.known.add(own[0])
        self.elements.setdefault(name, []).append(own)

    def mesh(self) -> Mesh:
        """Return what was read."""
        if not self.places:
            raise ValueError("it has no GRID")
        rotated = []
        for number, own in self.systems.items():
            cp, cd = (one or other for one, other in zip(own, self.default, strict=True))
            if cp not in ("", "0"):
                raise ValueError(f"GRID {number}: its coordinates are those of system {cp}")
            if cd not in ("", "0"):
                rotated.append(number)
        made = Assembly(self.places, list(self._cells()))
        turned = [made.position[one] for one in rotated]
        return Mesh(made.points, made.by_kind, made.labels, self._sets(made), rotated=turned)

    def _cells(self) -> Iterator[Cells]:
        for name, rows in self.elements.items():
            kind, corners, order = _KINDS[name]
            table = np.array(rows)
            middles = table[:, 1 + corners :][:, order]
            yield from with_middles(kind, table[:, 0], table[:, 1 : 1 + corners], middles)

    def _sets(self, made: Assembly) -> dict[str, list[int]]:
        """Return the sets by the positions of their nodes; those of elements are left out."""
        place = made.position
        # A range may name more numbers than memory holds; one longer than the nodes has others.
        return {
            name: list(dict.fromkeys(place[one] for part in own for one in part))
            for name, own in self.sets.items()
            if own
            and name not in self.unread
            and all(len(part) <= len(place) and place.keys() >= set(part) for part in own)
        }


def read_bulk_mesh(file: Path) -> Mesh:
    """Read grid points, solids, shells and the sets SET1 of bulk data."""
    bulk = _Bulk()
    for card in bulk_cards(file, ("GRID", "GRDSET", "SET1", *_KINDS)):
        with at_line(card.line, card.file):
            bulk.take(card)
    return bulk.mesh()


def _members(words: list[str]) -> Iterator[range]:
    """Give the ranges of numbers of a list in which THRU stands for all between two."""
    at = 0
    while at < len(words):
        if at + 2 < len(words) and words[at + 1].upper() == "THRU":
            own = range(whole_field(words[at]), whole_field(words[at + 2]) + 1)
            if not own:
                raise ValueError(f"SET1: {words[at]} THRU {words[at + 2]} names nothing")
            yield own
            at += 3
        else:
            yield range(whole_field(words[at]), whole_field(words[at]) + 1)
            at += 1
