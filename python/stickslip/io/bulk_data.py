"""Nastran's bulk data: its cards, and what the reader of meshes does not tell of them.

That is numbers and sets of nodes.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from stickslip.io.numbers import real_field, whole_field
from stickslip.io.source import at_line, plain

_HEAD, _TAIL = 8, 8
"""Columns of the name of a card, and of the mark of its continuation."""


@dataclass(frozen=True)
class Bulk:
    """Numbers of the nodes in the order of the file, and the members of each set."""

    numbers: list[int]
    sets: dict[str, list[range]]

    def node_sets(self) -> dict[str, list[int]]:
        """Return the sets by the positions of their nodes; of elements they are none."""
        place = {number: at for at, number in enumerate(self.numbers)}
        # A range may name more numbers than memory holds; one longer than the nodes has others.
        return {
            name: [place[one] for part in own for one in part]
            for name, own in self.sets.items()
            if own and all(len(part) <= len(place) and place.keys() >= set(part) for part in own)
        }


def read_bulk(file: Path) -> Bulk:
    """Read the entries GRID and SET1 of bulk data."""
    numbers: list[int] = []
    sets: dict[str, list[range]] = {}
    lines = plain(file.read_bytes(), "latin-1").splitlines()
    for card in cards(lines, ("GRID", "SET1")):
        with at_line(card.line):
            number, *words = card.fields
            if card.name == "GRID":
                numbers.append(whole_field(number))
                for place in words[1:4]:
                    real_field(place or "0")
                if words[0] not in ("", "0"):
                    raise ValueError(
                        f"GRID {number}: its coordinates are those of system {words[0]}"
                    )
            else:
                own = sets.setdefault(f"SET1 {whole_field(number)}", [])
                own.extend(_members([one for one in words if one]))
    return Bulk(numbers, sets)


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


@dataclass(frozen=True)
class Card:
    """A card with its fields, those of continuations included."""

    line: int
    """Where it begins, from 1."""
    name: str
    fields: list[str]


def cards(lines: Iterable[str], names: Container[str]) -> Iterator[Card]:
    """Give each card of some names."""
    found: Card | None = None
    for number, line in enumerate(lines, 1):
        text = line.partition("$")[0].expandtabs().rstrip()
        if not text:
            continue
        head = (text.partition(",")[0] if "," in text else text[:_HEAD]).strip()
        if head and head[0] not in "+*":
            if found:
                if not head[0].isalpha():
                    raise ValueError(f"line {text[:40]!r} is no card and continues none")
                yield found
            name = head.rstrip("*").rstrip().upper()
            found = Card(number, name, []) if name in names else None
        if found:
            found.fields.extend(_fields(text))
    if found:
        yield found


def _fields(text: str) -> list[str]:
    """Return the fields of a line with data, without its name and the mark of a continuation."""
    if "," in text:
        _, *words = map(str.strip, text.split(","))
        if any(words[9:]):
            raise ValueError(f"line {text[:40]!r} is longer than a card")
        return [*words, *[""] * 8][:8]
    width, count = (16, 4) if "*" in text[:_HEAD] else (8, 8)
    if len(text) > _HEAD + width * count + _TAIL:
        raise ValueError(f"line {text[:40]!r} is longer than a card")
    return [text[at : at + width].strip() for at in range(_HEAD, _HEAD + width * count, width)]
