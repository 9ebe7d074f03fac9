"""A study file whose numbers are moved: its text is what is computed, and what is exported."""

from __future__ import annotations

from collections.abc import Iterator, MutableMapping, Sequence
from pathlib import Path
from typing import Any

from stickslip.errors import ModelError
from stickslip.explore.knobs import LEVELS, Place, knobs_of
from stickslip.study import Study

KINDS = ("forced-response", "certify", "exact", "single-harmonic")
"""Analyses of which a response curve is the result."""

_MATRICES: tuple[Place, ...] = tuple(
    (*table, key)
    for table in (("structure",), ("disk", "interface"))
    for key in ("mass", "damping", "stiffness")
)


class Draft:
    """A study file with other numbers.

    Parameters
    ----------
    path : Path
        The study file.

    Attributes
    ----------
    study : Study
        The study as the file has it.
    knobs : tuple of Knob
        The numbers that can be moved.
    swept : bool
        Whether the file has a table ``[sweep]``, which is left out.

    Raises
    ------
    ModelError
        If the file is refused, or its analysis has no response curve.
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
