"""A study file whose numbers are moved: its text is what is computed, and what is exported.

Its sliders say which numbers these are, and how far they move.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, MutableMapping, Sequence
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any, TypeAlias

from stickslip.errors import ModelError
from stickslip.study import Study
from stickslip.units import parted

Place: TypeAlias = tuple[str | int, ...]
"""Keys and positions that lead to an entry of a study file."""

LEVELS: Place = ("analysis", "levels")

_UNITS = {
    "slip_force": "N",
    "slip_forces": "N",
    "friction": "",
    "preload": "N",
    "normal_load": "N",
    "stiffness": "N/m",
    "tangential_stiffness": "N/m",
    "normal_stiffness": "N/m",
    "gap": "m",
    "mass": "kg",
    "load": "N",
    "radius": "m",
    "speed": "rad/s",
    "angle": "rad",
}
"""What is moved of contacts, dampers and couplings, with the unit of plain numbers."""
_TABLES = ("contact", "damper", "coupling")
_PARTS = 4
"""Entries of a list that have a slider each; of longer ones none has."""
MOST = 40
"""Sliders of a page."""
_DECADES = 100.0
"""Factor by which a slider moves a positive number up and down."""


@dataclass(frozen=True)
class Knob:
    """A number of a study file that is moved."""

    group: str
    """The table it belongs to, for the reader."""
    label: str
    place: Place
    value: float
    """As the file has it, in its unit."""
    unit: str
    text: bool
    """Whether number and unit are written as one text."""
    low: float
    high: float
    log: bool

    def entry(self, value: float) -> float | str | list[float]:
        """Return what stands in the file for a value."""
        if self.place == LEVELS:
            return [value]
        return f"{value:.12g} {self.unit}" if self.text else value


def knobs_of(content: Mapping[str, Any], levels: Sequence[float]) -> tuple[Knob, ...]:
    """Return the sliders of the entries of a study file, at most `MOST` of them.

    That of the level comes first, and starts at the middle one.
    """
    level = sorted(levels)[len(levels) // 2]
    first = _knob("forces", "level", LEVELS, level, "", text=False)
    return tuple([first, *_of_tables(content), *_static_loads(content)][:MOST])


def _of_tables(content: Mapping[str, Any]) -> Iterator[Knob]:
    for table in _TABLES:
        for number, entries in enumerate(content.get(table, [])):
            name = entries.get("name", entries.get("law", entries.get("kind", "")))
            group = f"{table} {number + 1}" + (f" ({name})" if name else "")
            yield from _numbers(group, entries, (table, number))


def _static_loads(content: Mapping[str, Any]) -> Iterator[Knob]:
    for number, force in enumerate(content.get("force", [])):
        if force.get("harmonic") == 0:
            place = ("force", number, "amplitude")
            yield from _number(f"force {number + 1}", "static load", place, force["amplitude"], "N")


def _numbers(group: str, entries: Mapping[str, Any], place: Place) -> Iterator[Knob]:
    for key, value in entries.items():
        if key not in _UNITS:
            continue
        label, unit = key.replace("_", " "), _UNITS[key]
        if entries.get("law") == "cubic" and key == "stiffness":
            unit = "N/m^3"
        if isinstance(value, Mapping):
            yield from _numbers(f"{group}: {label}", value, (*place, key))
        elif isinstance(value, list):
            for part, one in enumerate(value if len(value) <= _PARTS else []):
                yield from _number(group, f"{label} {part + 1}", (*place, key, part), one, unit)
        else:
            yield from _number(group, label, (*place, key), value, unit)


def _number(group: str, label: str, place: Place, value: object, unit: str) -> Iterator[Knob]:
    """Give the slider of an entry, unless it is none that can be moved: infinite, or a matrix."""
    text = isinstance(value, str)
    if isinstance(value, str):
        value, unit = parted(value)
    if isinstance(value, int | float) and isfinite(value):
        yield _knob(group, label, place, float(value), unit, text=text)


def _knob(group: str, label: str, place: Place, value: float, unit: str, *, text: bool) -> Knob:
    low, high, log = _range(str(place[-1]), value, unit)
    return Knob(group, label, place, value, unit, text, low, high, log)


def _range(key: str, value: float, unit: str) -> tuple[float, float, bool]:
    """Return the ends of a slider, and whether it moves by factors."""
    size = abs(value)
    if key == "friction":
        top = 100.0 if unit == "%" else 1.0
        return 0.0, max(top, 2.0 * value), False
    if key == "angle":
        return 0.0, 90.0 if unit.startswith("deg") else 1.57, False
    if value > 0.0 and key != "gap":
        return value / _DECADES, value * _DECADES, True
    reach = 2.0 * size or 1.0
    return (-reach, reach, False) if key in ("gap", "load", "stiffness") else (0.0, reach, False)


KINDS = ("forced-response", "certify", "exact", "single-harmonic")
"""Analyses of which a response curve is the result."""

_MATRICES: tuple[Place, ...] = tuple(
    (*table, key)
    for table in (("structure",), ("disk", "interface"))
    for key in ("mass", "damping", "stiffness", "stiffening", "softening")
)


class Draft:
    """A study file with other numbers; refused if its analysis has no response curve.

    `study` is as the file has it, `knobs` are the numbers that can be moved, and `swept` says
    whether the file has a table ``[sweep]``, which is left out.
    """

    def __init__(self, path: Path) -> None:
        import tomlkit
        from tomlkit.exceptions import TOMLKitError

        self.study = Study.load(path)
        kind = self.study.tables.analysis.kind
        if kind not in KINDS:
            raise ModelError(
                f"{path}: [analysis] kind = '{kind}' has no response curve to explore; known: "
                f"{', '.join(KINDS)}"
            )
        self._folder = path.resolve().parent
        try:
            self._file = tomlkit.parse(path.read_text(encoding="utf-8").removeprefix("\ufeff"))
        except TOMLKitError as error:
            raise ModelError(f"{path}: cannot be edited ({error})") from None
        self.knobs = knobs_of(self._file.unwrap(), self.study.tables.analysis.levels or (1.0,))
        # a page shows one curve: that of the sliders
        self.swept = self._file.pop("sweep", None) is not None
        if "levels" in self._file["analysis"]:
            _put(self._file, LEVELS, [self.knobs[0].value])
        self._written = {knob.place: _at(self._file, knob.place) for knob in self.knobs}

    def text(self, values: Sequence[float]) -> str:
        """Return the study file with other numbers, one per knob, in the unit of each."""
        import tomlkit

        for knob, value in zip(self.knobs, values, strict=True):
            # what was not moved stands as it was written
            own = self._written[knob.place]
            _put(self._file, knob.place, own if value == knob.value else knob.entry(value))
        return tomlkit.dumps(self._file)

    def exported(self, values: Sequence[float]) -> str:
        """Return the same for another folder: matrix files are named with their whole path."""
        import tomlkit

        file = tomlkit.parse(self.text(values))
        for place in _file_names(file):
            _put(file, place, str(self._folder / str(_at(file, place))))
        if "name" in file:
            file["name"] = self.name
        return tomlkit.dumps(file)

    @property
    def name(self) -> str:
        """Name of what is exported: results of the study itself stay."""
        return f"{self.study.name}-explored"

    def parsed(self, text: str) -> Study:
        """Return the study of a text."""
        source = Path(self.study.source).name
        return Study.parse(text, folder=self._folder, source=source, name=self.study.name)


def _at(file: Any, place: Place) -> Any:
    """Return an entry of a file; None if there is none."""
    for key in place:
        try:
            file = file[key]
        except (KeyError, IndexError, TypeError):
            return None
    return file


def _put(file: Any, place: Place, value: object) -> None:
    owner = _at(file, place[:-1])
    if value is not None:
        owner[place[-1]] = value
    elif place[-1] in owner:
        del owner[place[-1]]


def _file_names(file: MutableMapping[str, Any]) -> Iterator[Place]:
    for place in _MATRICES:
        entry = _at(file, place)
        if isinstance(entry, str):
            yield place
        elif isinstance(entry, MutableMapping) and "file" in entry:
            yield (*place, "file")
