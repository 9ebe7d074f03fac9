"""Archives of ANSYS: the blocks of nodes, elements and components that CDWRITE writes."""

from __future__ import annotations

import re
from collections.abc import Container, Iterator
from dataclasses import dataclass, field
from itertools import accumulate

from stickslip.checks import brief
from stickslip.io.ansys_elements import most_nodes
from stickslip.io.numbers import real_field, whole_field

_PARTS = re.compile(r"([0-9]{0,2})([IEFGDA])([0-9]{1,2})(?:\.[0-9]+(?:E[0-9]+)?)?", re.I)
_HEAD = 11
"""Fields before the nodes of an element: attributes, how many nodes, the element's number."""
_SHORT_HEAD = 5
"""The same where a block is not one of SOLID: number, type, and three more attributes."""
_MOST = 60
"""Nodes of an element; a damaged count would join the elements that follow."""
_ARCHIVE = re.compile(
    r"^[ \t]*(?:NBLO[A-Z]*[ \t]*,[^\n]*\n[ \t]*\(|N,(?:R5\.[0-9]|UNBL)[^,\n]*,[ \t]*LOC)",
    re.I | re.M,
)
"""A block with the format of its lines: other programs name sets as they like."""
_NAME = 4
"""Characters by which commands are known."""
_TEXTS = ("/COM", "C***", "/TIT", "/STI")
"""Commands that take the rest of a line as it is."""
_ALONE = re.compile(r"\(|[-+]?[.0-9][-+.0-9ED,\s]*$", re.I)
"""A format, or numbers and nothing else: no command begins so."""
_WITH_LINES = re.compile(r"\*(?:VRE|VWR|PRE|MSG|MWR|CRE)|SECB|(?!NBL|EBL|CMBL|ETBL)[A-Z]*BL")
"""Commands that are passed over with such lines: RLBLOCK, *VWRITE."""


@dataclass
class Archive:
    """What has been read; everything by the numbers of the file."""

    nodes: dict[int, tuple[float, ...]] = field(default_factory=dict)
    rotated: list[int] = field(default_factory=list)
    """Nodes with a coordinate system of their own."""
    types: dict[int, int] = field(default_factory=dict)
    """The element of each type: 186 of SOLID186."""
    elements: dict[int, tuple[int, list[int]]] = field(default_factory=dict)
    """Type and nodes of each element."""
    components: dict[str, tuple[str, list[range]]] = field(default_factory=dict)
    """Each component: NODE or ELEM, and its members."""


def is_archive(text: str) -> bool:
    """Return whether a text has nodes as ANSYS writes them."""
    return _ARCHIVE.search(text) is not None


def parse_archive(text: str) -> Archive:
    """Read nodes, types, elements and components; other commands are passed over.

    References
    ----------
    ANSYS, Inc., "Mechanical APDL Programmer's Reference", "Coded Database File Commands".
    """
    reader = _Reader(text.split("\n"))
    for line in reader:
        try:
            for one in _commands(line):
                words = [word.strip() for word in one.split(",")]
                reader.take(words[0].upper(), words)
        except ValueError as error:
            # That in which it was found: within a block not the line of the command.
            raise ValueError(f"line {reader.number}: {error}") from error
    if not reader.made.nodes:
        hidden = re.search("^/DECRYPT", text, re.I | re.M)
        raise ValueError(
            f"it {'is encrypted' if hidden else 'has no NBLOCK'}; write it with CDWRITE"
        )
    return reader.made


@dataclass(frozen=True)
class _Format:
    """Fields of fixed width, as a line such as (3i9,6e21.13e3) says."""

    kinds: str
    """A letter for each field: I, or one of real numbers or texts."""
    ends: tuple[int, ...]

    @classmethod
    def parse(cls, written: str) -> _Format:
        text = written.strip().upper().replace(" ", "")
        found = [_PARTS.fullmatch(part) for part in text[1:-1].split(",")]
        if not (text.startswith("(") and text.endswith(")")) or None in found:
            raise ValueError(f"{brief(written.strip())} is no format of fields")
        parts = [(int(one[1] or 1), one[2], int(one[3])) for one in found if one]
        kinds = "".join(count * kind for count, kind, _ in parts)
        ends = tuple(accumulate(width for count, _, width in parts for _ in range(count)))
        if not ends or 0 in ends:
            raise ValueError(f"{brief(written.strip())} is no format of fields")
        return cls(kinds, ends)

    def cut(self, line: str) -> list[str]:
        """Return the fields of a line; those at its end may be blank."""
        body = line.rstrip()
        if len(body) > self.ends[-1]:
            raise ValueError(f"{body[:30]!r} is longer than its format")
        count = sum(end < len(body) for end in self.ends) + 1
        # Programs fill their fields to the end; editors may have taken blanks from there.
        if self.ends[count - 1] not in (len(body), len(line)):
            raise ValueError(f"the last number of {body[-30:]!r} is cut short")
        starts = (0, *self.ends)
        return [body[starts[at] : self.ends[at]].strip() for at in range(count)]

    def whole(self, line: str) -> list[int]:
        """Return the whole numbers of a line of nothing else; blank fields are 0."""
        return [whole_field(one, signed=True) if one else 0 for one in self.cut(line)]


class _Reader:
    """Goes through the lines from command to command."""

    def __init__(self, lines: list[str]) -> None:
        self.lines = lines
        self.number = 0
        """Of the line that was read last, from 1."""
        self.made = Archive()
        self.values: dict[str, str] = {}
        """Parameters, by which Workbench numbers its types."""
        self.type = 1
        self.last = ""
        """The command before."""

    def __iter__(self) -> Iterator[str]:
        while self.number < len(self.lines):
            yield self.next()

    def next(self) -> str:
        """Return the next line."""
        if self.number >= len(self.lines):
            raise ValueError("the file ends inside a block")
        self.number += 1
        return self.lines[self.number - 1]

    def take(self, command: str, words: list[str]) -> None:
        """Take over a command with the lines that belong to it."""
        line = ",".join(words)
        if command != "-1" and _ALONE.match(line):
            if not _WITH_LINES.match(self.last):
                raise ValueError(
                    f"{brief(line)} stands outside of a block; the line before is lost"
                )
            return
        self.last = command or self.last
        act = _COMMANDS.get(command[:_NAME])
        # Parameters may have names that begin alike: MOVE_X=3, FILL(2)=1.
        if act and command.lstrip("*/").isalnum() and command not in _OTHERS:
            act(self, [*words, *[""] * 8])

    def value(self, word: str) -> int | None:
        """Return a whole number, written as such or by a parameter; None: neither."""
        try:
            number = float(self.values.get(word.upper(), word))
        except ValueError:
            return None
        return int(number) if number.is_integer() and abs(number) < 2**53 else None

    def set(self, words: list[str]) -> None:
        """*SET, name, value."""
        self.values[words[1].upper()] = words[2]

    def element_type(self, words: list[str]) -> None:
        """ET, number, name of the element: 186 or SOLID186."""
        number, name = self.value(words[1]), re.search("[0-9]{1,4}$", words[2])
        if number is not None and name:
            self.made.types[number] = int(name[0])

    def element_types(self, words: list[str]) -> None:
        """ETBLOCK, highest number, how many: many ET."""
        limits = _Limits("type", *map(_count, words[1:3]))
        form = _Format.parse(self.next())
        for line in self.rows(limits):
            number, name = (*form.cut(line), "", "")[:2]
            self.made.types[limits.new(whole_field(number), ())] = whole_field(name)

    def current_type(self, words: list[str]) -> None:
        """TYPE, that of the elements which follow one by one."""
        self.type = self.value(words[1]) or 0

    def nodes(self, words: list[str]) -> None:
        """NBLOCK, fields, SOLID, highest number, how many."""
        limits = _Limits("node", *map(_count, words[3:5]))
        form = _Format.parse(self.next())
        whole = form.kinds.count("I")
        reals = form.kinds[whole:]
        if not whole or not reals or reals.strip("EFGD"):
            raise ValueError("the format is none of nodes: numbers, then coordinates")
        for line in self.rows(limits):
            fields = form.cut(line)
            if len(fields) < whole:
                raise ValueError(f"{line.strip()[:30]!r} is cut short")
            number = limits.new(whole_field(fields[0]), self.made.nodes)
            place = [real_field(one) if one else 0.0 for one in fields[whole:]]
            self.made.nodes[number] = (*place, 0.0, 0.0, 0.0)[:3]
            if any(place[3:6]):
                self.made.rotated.append(number)

    def elements(self, words: list[str]) -> None:
        """EBLOCK, fields, SOLID or not, highest number, how many."""
        limits = _Limits("element", *map(_count, words[3:5]))
        form = _Format.parse(self.next())
        solid = words[2].upper() == "SOLID"
        if set(form.kinds) != {"I"} or len(form.kinds) <= (_HEAD if solid else _SHORT_HEAD):
            raise ValueError("the format is none of elements: whole numbers")
        read = self.solid_element if solid else self.short_element
        for line in self.rows(limits):
            number, kind, nodes = read(form, form.whole(line))
            self.made.elements[limits.new(number, self.made.elements)] = kind, nodes

    def solid_element(self, form: _Format, head: list[int]) -> tuple[int, int, list[int]]:
        """Return number, type and nodes of an element that says how many nodes it has."""
        if len(head) <= _HEAD:
            raise ValueError("an element has no nodes")
        count, number, nodes = head[8], head[10], head[_HEAD:]
        if not 0 < count <= _MOST:
            raise ValueError(f"element {number} has {count} nodes")
        while len(nodes) < count:
            room, more = len(form.kinds), form.whole(self.next())
            if len(more) != min(room, count - len(nodes)) or len(nodes) < room - _HEAD:
                break
            nodes += more
        if len(nodes) != count:
            raise ValueError(f"element {number} does not have the {count} nodes that it announces")
        return number, head[1], nodes

    def short_element(self, form: _Format, head: list[int]) -> tuple[int, int, list[int]]:
        """Return number, type and nodes of an element whose type alone says how many it has."""
        number, kind, nodes = head[0], head[1], head[_SHORT_HEAD:]
        room = len(form.kinds) - _SHORT_HEAD
        if len(nodes) == room and most_nodes(self.made.types.get(kind, 0)) > room:
            nodes += form.whole(self.next())
        return number, kind, nodes

    def component(self, words: list[str]) -> None:
        """CMBLOCK, name, NODE or ELEMENT, how many numbers."""
        name, kind, announced = words[1].upper(), words[2].upper()[:4], whole_field(words[3])
        if name in self.made.components:
            raise ValueError(f"component {name} is given twice")
        form = _Format.parse(self.next())
        if kind not in ("NODE", "ELEM") or set(form.kinds) != {"I"}:
            raise ValueError(f"component {name} is neither of nodes nor of elements")
        numbers: list[int] = []
        while not self.at_end():
            numbers += form.whole(self.next())
        if len(numbers) != announced:
            raise ValueError(
                f"component {name}: {announced} numbers announced, {len(numbers)} present"
            )
        self.made.components[name] = kind, _members(name, numbers)

    def one_node(self, words: list[str]) -> None:
        """N: as the end of a block, and one by one; such nodes of loads are no part of a mesh."""
        if words[1].upper().startswith(("R5", "UNBL")) and "-1" not in words:
            raise ValueError(f"{words[0]}: one by one; write it with CDWRITE,,,,,,BLOCKED")

    def one_element(self, words: list[str]) -> None:
        """E and EN, which follow a TYPE."""
        self.one_node(words)
        if "-1" not in words and most_nodes(self.made.types.get(self.type, 0)):
            raise ValueError(f"{words[0]}: elements one by one; write it with CDWRITE")

    def change(self, words: list[str]) -> None:
        """NROTAT, NUMMRG and others act on what is selected, and that is not known here."""
        raise ValueError(f"{words[0].upper()} changes nodes or elements; write it with CDWRITE")

    def at_end(self) -> bool:
        """Return whether no line of numbers follows."""
        if self.number >= len(self.lines):
            return True
        start = self.lines[self.number].strip()
        return not start or start == "-1" or start[0].isalpha() or start[0] in "*/!"

    def rows(self, limits: _Limits) -> Iterator[str]:
        """Give the lines of a block; some take more by `next`."""
        read = 0
        while not self.at_end():
            read += 1
            yield self.next()
        limits.require(read, self.lines[self.number] if self.number < len(self.lines) else "")


@dataclass(frozen=True)
class _Limits:
    """What the head of a block says of its lines, where it says it."""

    what: str
    highest: int | None
    count: int | None

    def new(self, number: int, known: Container[int]) -> int:
        """Return the number of a line, which must be one of its own."""
        if number < 1:
            raise ValueError(f"{self.what} {number} is not one of 1, 2, ...")
        if number in known:
            raise ValueError(f"{self.what} {number} is given twice")
        # Many programs write how many there are in both places, or in the first.
        if self.highest and self.count not in (None, self.highest) and number > self.highest:
            raise ValueError(f"{self.what} {number} is above {self.highest}, announced as highest")
        return number

    def require(self, read: int, end: str) -> None:
        """Refuse a block of another number of lines, or one that does not end."""
        if self.count not in (None, read):
            raise ValueError(f"{self.count} {self.what}s announced, {read} present")
        # Components may follow the elements; without the end nothing shows that they are lost.
        needed = self.count is None or self.what == "element"
        if needed and "-1" not in [word.strip() for word in end.split(",")]:
            raise ValueError(f"the block of {self.what}s does not end; the file was cut short")


def _commands(line: str) -> list[str]:
    """Return the commands of a line, without what a ! makes a comment."""
    said = line.partition("!")[0]
    return [said] if said.strip().upper().startswith(_TEXTS) else said.split("$")


def _count(word: str) -> int | None:
    return whole_field(word) if word else None


def _members(name: str, numbers: list[int]) -> list[range]:
    """Return the members of a component; a negative number ends a range."""
    found: list[range] = []
    for number in numbers:
        if number > 0:
            found.append(range(number, number + 1))
            continue
        if not found or len(found[-1]) > 1 or -number <= found[-1].start:
            raise ValueError(f"component {name}: {number} ends no range")
        found[-1] = range(found[-1].start, 1 - number)
    return found


_COMMANDS = {
    "*SET": _Reader.set,
    "ET": _Reader.element_type,
    "ETBL": _Reader.element_types,
    "TYPE": _Reader.current_type,
    "NBLO": _Reader.nodes,
    "EBLO": _Reader.elements,
    "CMBL": _Reader.component,
    "N": _Reader.one_node,
    "E": _Reader.one_element,
    "EN": _Reader.one_element,
    **dict.fromkeys(("NROT", "NANG", "NORA", "NORL", "NMOD", "NSCA"), _Reader.change),
    **dict.fromkeys(("NUMM", "NUMC", "NGEN", "EGEN", "NSYM", "ESYM"), _Reader.change),
    **dict.fromkeys(("NDEL", "EDEL", "EMOD", "ENGE"), _Reader.change),
    **dict.fromkeys(("FILL", "MOVE", "UPCO", "UPGE", "TRAN"), _Reader.change),
}
"""What is done at each command, by the characters that tell it from others."""
_OTHERS = ("FILLDATA",)
"""Commands that begin as one of these, and act on results."""
