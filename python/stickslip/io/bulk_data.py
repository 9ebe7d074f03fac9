"""What the reader of meshes does not tell of Nastran's bulk data: numbers and sets of nodes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from stickslip.io.source import plain

_WIDTHS = {False: 8, True: 16}
"""Columns of a field, in small and in large format."""


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
    for name, fields in _entries(lines):
        if name == "GRID":
            numbers.append(int(fields[0]))
            system = fields[1] if len(fields) > 1 else ""
            if system not in ("", "0"):
                raise ValueError(f"GRID {fields[0]}: its coordinates are those of system {system}")
        elif name == "SET1":
            own = sets.setdefault(f"SET1 {int(fields[0])}", [])
            own.extend(_members([one for one in fields[1:] if one]))
    return Bulk(numbers, sets)


def _members(words: list[str]) -> Iterator[range]:
    """Give the ranges of numbers of a list in which THRU stands for all between two."""
    at = 0
    while at < len(words):
        if at + 2 < len(words) and words[at + 1].upper() == "THRU":
            own = range(int(words[at]), int(words[at + 2]) + 1)
            if not own:
                raise ValueError(f"SET1: {words[at]} THRU {words[at + 2]} names nothing")
            yield own
            at += 3
        else:
            yield range(int(words[at]), int(words[at]) + 1)
            at += 1


def _entries(lines: list[str]) -> Iterator[tuple[str, list[str]]]:
    """Give each entry of the two kinds with its fields, those of continuations included."""
    found: tuple[str, list[str]] | None = None
    for line in lines:
        text = line.partition("$")[0].rstrip()
        if not text:
            continue
        head, fields = _fields(text)
        if head.startswith(("+", "*")) or not head:
            if found:
                found[1].extend(fields)
            continue
        if found:
            yield found
        name = head.rstrip("*").upper()
        found = (name, fields) if name in ("GRID", "SET1") else None
    if found:
        yield found


def _fields(text: str) -> tuple[str, list[str]]:
    """Return the first field of a line and those with data, without the mark of a continuation."""
    if "," in text:
        head, *fields = (word.strip() for word in text.split(","))
        return head, fields[:8]
    text = text.expandtabs(8)
    head = text[:8].strip()
    wide = head.endswith("*") or head.startswith("*")
    width = _WIDTHS[wide]
    return head, [text[at : at + width].strip() for at in range(8, min(len(text), 72), width)]
