"""Nastran's bulk data: its cards, in narrow, wide and free fields, over several lines."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from dataclasses import dataclass
from itertools import count
from pathlib import Path

from stickslip.io.source import at_line, of_deck, require_included

_HEAD, _TAIL = 8, 8
"""Columns of the name of a card, and of the mark of its continuation."""
_DEEPEST = 8
"""Files that name each other with INCLUDE."""


@dataclass(frozen=True)
class Card:
    """A card with its fields, those of continuations included."""

    line: int
    """Where it begins, from 1."""
    name: str
    fields: list[str]
    file: str = ""
    """Name of the file, if it is an included one."""


def bulk_cards(
    file: Path, names: Iterable[str], depth: int = 0, files: Iterator[int] | None = None
) -> Iterator[Card]:
    """Give each card of some names up to ENDDATA, those of included files in their place."""
    if depth > _DEEPEST:
        raise ValueError("INCLUDE: files include each other")
    files = files or count()
    require_included(file, files)
    wanted = (*names, "INCLUDE", "ENDDATA")
    own = file.name if depth else ""
    for card in cards(of_deck(file.read_bytes()).split("\n"), wanted):
        if card.name == "ENDDATA":
            return
        if card.name == "INCLUDE":
            with at_line(card.line, own):
                name = _included(card.fields[0])
            yield from bulk_cards(file.parent / name, names, depth + 1, files)
        else:
            yield Card(card.line, card.name, card.fields, own)


def cards(lines: Iterable[str], names: Container[str]) -> Iterator[Card]:
    """Give each card of some names."""
    found: Card | None = None
    mark = ""
    open_marks: dict[str, int] = {}
    for number, line in enumerate(lines, 1):
        text = line.partition("$")[0].expandtabs().rstrip()
        if not text:
            continue
        head = (text.partition(",")[0] if "," in text else text[:_HEAD]).strip()
        if head and head[0] not in "+*":
            if found:
                if not head[0].isalpha():
                    raise ValueError(f"line {text[:40]!r} is no card and continues none")
                open_marks[mark[1:].strip()] = found.line
                yield found
            name = head.rstrip("*").rstrip().upper()
            included = text.strip().upper().startswith("INCLUDE")
            if "," not in text and not included and name not in names:
                first, *more = name.split()
                if more and first.rstrip("*") in names:
                    raise ValueError(
                        f"line {number}: fields of {first} are separated by blanks; use commas"
                    )
            name = "INCLUDE" if included else name
            found = Card(number, name, []) if name in names else None
            if included and found:
                found.fields.append(text.strip()[len("INCLUDE") :])
                mark = ""
                continue
        else:
            own = head[1:].strip()
            if own and own != mark[1:].strip():
                # Marks may lead from anywhere to anywhere; numbers of lines look like them.
                if own in open_marks:
                    raise ValueError(
                        f"line {number}: {head!r} continues line {open_marks[own]}; write it there"
                    )
                if found and mark[1:]:
                    raise ValueError(f"line {number}: {head!r} does not continue {mark!r}")
        if found:
            fields, mark = _fields(text)
            found.fields.extend(fields)
        elif open_marks:
            mark = _mark(text)
    if found:
        yield found


def _mark(text: str) -> str:
    """Return the mark of the continuation of a line, whatever else it says."""
    if "," in text:
        words = text.split(",")
        count = 4 if "*" in words[0] else 8
        return "".join(words[count + 1 : count + 2]).strip()
    return text[_HEAD + 64 :].strip()


def _fields(text: str) -> tuple[list[str], str]:
    """Return the fields of a line with data, and the mark of its continuation."""
    wide = "*" in (text.partition(",")[0] if "," in text else text[:_HEAD])
    width, count = (16, 4) if wide else (8, 8)
    if "," in text:
        _, *words = map(str.strip, text.split(","))
        if any(words[count + 1 :]):
            raise ValueError(f"line {text[:40]!r} is longer than a card")
        words = [*words, *[""] * (count + 1)]
        return words[:count], words[count]
    end = _HEAD + width * count
    if len(text) > end + _TAIL:
        raise ValueError(f"line {text[:40]!r} is longer than a card")
    return [text[at : at + width].strip() for at in range(_HEAD, end, width)], text[end:].strip()


def _included(text: str) -> str:
    """Return the name of the file that an INCLUDE names, in quotes or not."""
    name = text.strip()
    if not name or name.count("'") + name.count('"') not in (0, 2):
        raise ValueError(f"INCLUDE: {name[:40]!r} is no name of a file on one line")
    return name.strip("\"'")
