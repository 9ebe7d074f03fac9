"""The lines of input decks: keywords with their options, and the rows below them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import TypeAlias

from stickslip.io.numbers import real_field, whole_field
from stickslip.io.source import at_line, of_deck, require_included

_DEEPEST = 8
"""Files that name each other with *INCLUDE."""
_FLAGS = ("GENERATE", "UNSORTED", "INTERNAL")
"""Options without a value, as far as they stand with those that are read."""
_NAMED = {"NSET": "NSET", "ELSET": "ELSET", "SURFACE": "NAME", "ELEMENT": "TYPE"}
"""What a keyword must say."""

_INPUT = re.compile(r"""\bINPUT\s*=\s*("[^"]+"|'[^']+'|[^,\s][^,]*)""", re.I)
"""The file that a keyword names, in quotes if it has commas."""

_Line: TypeAlias = tuple[str, int, str]
"""Name of the file if it is an included one, number of the line, and what it says."""


class Row(list[str]):
    """The words of a line in capitals, blank ones left out, and where it stands."""

    def __init__(self, line: _Line) -> None:
        self.file, self.line, text = line
        plain = text.upper().replace('"', "").replace("'", "")
        self.fields = [word.strip() for word in plain.split(",")]
        super().__init__(word for word in self.fields if word)

    def whole(self) -> list[int]:
        """Return whole numbers."""
        with at_line(self.line, self.file):
            return [whole_field(word, signed=True) for word in self]

    def node(self) -> tuple[int, tuple[float, ...]]:
        """Return the number of a node and its coordinates, of which blank ones are 0."""
        with at_line(self.line, self.file):
            number, *place = self.fields
            made = tuple(real_field(one) if one else 0.0 for one in place[:3])
            return whole_field(number, signed=True), (*made, 0.0, 0.0, 0.0)[:3]


@dataclass(frozen=True)
class Block:
    """A keyword with its options and the rows below it, all in capitals but names of files."""

    keyword: str
    options: dict[str, str]
    rows: list[Row]


def blocks(file: Path) -> Iterator[Block]:
    """Give each keyword of a deck."""
    found: Block | None = None
    open_ended = False
    files = count()
    for line in _lines(file, 0, files):
        text = line[2]
        if text.startswith("*"):
            if found:
                yield _whole(found, file, files)
            found = Block(_keyword(text), _options(text), [])
            open_ended = text.endswith(",")
        elif found and open_ended and (more := _continued(text)):
            found.options.update(more)
            open_ended = text.endswith(",")
        elif found:
            open_ended = False
            found.rows.append(Row(line))
    if found:
        yield _whole(found, file, files)


def _whole(block: Block, file: Path, files: Iterator[int]) -> Block:
    """Return a block with the rows of the file that it names."""
    needed = _NAMED.get(block.keyword)
    if needed and needed not in block.options:
        raise ValueError(f"*{block.keyword}: {needed}= is missing")
    if block.keyword in ("NODE", *_NAMED) and "INPUT" in block.options:
        block.rows.extend(map(Row, _lines(file.parent / block.options["INPUT"], 1, files)))
    return block


def _options(text: str) -> dict[str, str]:
    """Return the options of a line behind its keyword."""
    pairs = (word.partition("=") for word in text.split(",")[1:] if word.strip())
    found = {key.strip().upper(): value.strip().strip("\"'") for key, _, value in pairs}
    return {key: value if key == "INPUT" else value.upper() for key, value in found.items()}


def _continued(text: str) -> dict[str, str] | None:
    """Return the options of a line that continues a keyword; None: it is a row of data."""
    words = [word.strip().upper() for word in text.split(",") if word.strip()]
    if all("=" in word or word in _FLAGS for word in words):
        return _options(f",{text}")
    return None


def _lines(file: Path, depth: int, files: Iterator[int]) -> Iterator[_Line]:
    """Give the lines of a deck, without comments, those of included files in their place."""
    if depth > _DEEPEST:
        raise ValueError("*INCLUDE: files include each other")
    require_included(file, files)
    for number, line in enumerate(of_deck(file.read_bytes()).split("\n"), 1):
        text = line.strip()
        if not text or text.startswith("**"):
            continue
        if text.startswith("*") and _keyword(text) == "INCLUDE":
            named = _INPUT.search(text)
            if named is None:
                raise ValueError("*INCLUDE: INPUT= is missing; write it on the same line")
            yield from _lines(file.parent / named[1].strip().strip("\"'"), depth + 1, files)
        else:
            yield file.name if depth else "", number, text


def _keyword(text: str) -> str:
    return text[1:].split(",")[0].strip().upper()
