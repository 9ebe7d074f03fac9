"""Studies: a TOML file that holds a model and what to compute of it."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from stickslip.analyses.run import Progress
from stickslip.analyses.side_by_side import at_once, in_turn, whole
from stickslip.analyses.sweep import swept
from stickslip.checks import brief, file_path, is_file, is_reserved, vanished
from stickslip.errors import ModelError
from stickslip.memory import one_of
from stickslip.model import Model
from stickslip.model.notable import notable_dofs, physical_dofs
from stickslip.results.result import Result
from stickslip.settings.refusal import validated
from stickslip.study.analysis import level_name
from stickslip.study.assembly import at_speed_of, depends_on_speed, model_of
from stickslip.study.matrices import named, neighbour
from stickslip.study.tables import StudyTables

# tomllib takes hours for a key of 100 000 parts.
_DEEP = re.compile(r"(?<![\w.'\"-])(?:[\w'\"-]+[ \t]*\.[ \t]*){40}")
_LONGEST_NAME = 150
"""Bytes; file names have at most 255, with level, ending and marks of unfinished files."""


@dataclass(frozen=True)
class Case:
    """One curve of a study.

    Attributes
    ----------
    name : str
        Name of the study, with the level when there are several: ``"snecma-beam-20.313"``.
    level : float or None
        Factor on the forces that vary; None when the study has no levels.
    model : Model
        The model at that level.
    """

    name: str
    level: float | None
    model: Model


@dataclass(frozen=True)
class Study:
    """A model and what to compute of it, as read from a study file.

    Attributes
    ----------
    name : str
        Name of the study: its key `name`, or the name of the file, or of the folder of a
        ``study.toml``.
    tables : StudyTables
        The entries of the file, in SI units.
    model : Model
        The model with the forces as written.
    source : str
        Where it was read from; error messages begin with it.
    folder : Path
        What the files named in it are relative to.
    """

    name: str
    tables: StudyTables
    model: Model
    source: str
    folder: Path = Path()

    @classmethod
    def load(cls, path: str | Path) -> Study:
        """Read a study file, and the matrices it names.

        Parameters
        ----------
        path : str or Path
            TOML file with the tables ``[structure]``, ``[[contact]]``, ``[[damper]]``,
            ``[[force]]``, ``[disk]``, ``[[coupling]]``, ``[analysis]`` and ``[output]``; files
            named in it are relative to it.

        Returns
        -------
        Study
            The study, checked as far as can be without computing.

        Raises
        ------
        ModelError
            If the file is missing, is no TOML, has an unknown key, or any entry is refused.
        """
        path = file_path(path, "study file")
        if not is_file(path):
            raise ModelError(f"{path}: no such study file{neighbour(path)}")
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            raise ModelError(f"{path}: is not text in UTF-8; give a TOML study file") from None
        except OSError as error:
            raise ModelError(f"{path}: cannot be read ({error.strerror})") from None
        name = path.resolve().parent.name if path.stem == "study" else path.stem
        return cls.parse(text, folder=path.parent, source=str(path), name=name or "study")

    @classmethod
    def parse(
        cls, text: str, *, folder: str | Path = ".", source: str = "study", name: str = "study"
    ) -> Study:
        """Read a study from text.

        Parameters
        ----------
        text : str
            What would stand in the file.
        folder : str or Path, optional
            Where the matrix files are looked for.
        source : str, optional
            What error messages begin with.
        name : str, optional
            Name of the study, unless the text gives one.

        Returns
        -------
        Study
            As `load` reads it.
        """
        with named(source):
            tables = _read(text)
            analysis = tables.analysis.with_matrices(Path(folder))
            tables = tables.model_copy(update={"analysis": analysis})
            model = model_of(tables, Path(folder))
            _check_dofs(tables, model)
            _check_speed(tables)
            _check_name(tables.name or name)
        return cls(tables.name or name, tables, model, source, Path(folder))

    @property
    def cases(self) -> tuple[Case, ...]:
        """The curves of the study, one per level."""
        levels = self.tables.analysis.levels
        if levels is None:
            return (Case(self.name, None, self.model),)
        at_level = self.tables.analysis.at_level
        return tuple(
            Case(f"{self.name}-{level_name(level)}", level, at_level(self.model, level))
            for level in levels
        )

    @property
    def dofs(self) -> tuple[str, ...]:
        """The DOFs to tabulate and draw: of `[output]`, or else those with a force or a contact."""
        if self.tables.output.dofs is not None:
            return self.tables.output.dofs
        observed = self.tables.analysis.observed
        return notable_dofs(self.model, observed or physical_dofs(self.model))

    def models(self) -> tuple[Model, ...]:
        """Return the models, one per level."""
        return tuple(case.model for case in self.cases)

    def run(self, progress: Callable[[float], None] | None = None) -> Iterator[Result]:
        """Compute the results, in their order.

        Parameters
        ----------
        progress : callable, optional
            Called about ten times per second with the share of the study that is done, 0 to 1.

        Yields
        ------
        Result
            One per level, in the order of `cases`: a `ForcedResponse`, `ExactResponse` or
            `Transient`, as `[analysis]` asks.

        Raises
        ------
        ModelError
            The analysis refuses the model or its settings.
        Interrupted
            Ctrl-C; carries the part of the current curve that was done.
        """
        shown = self.tables.output.dofs or ()
        cases = self.cases
        threads = at_once(len(cases), alone=self._has_threads)

        def result_of(case: Case, part: Progress) -> Result:
            with named(self.source), one_of(len(cases), threads, together=False):
                return whole(lambda: self._result(case, part, shown))

        parts = [partial(result_of, case) for case in cases]
        yield from in_turn(parts, progress, alone=self._has_threads)

    @property
    def _has_threads(self) -> bool:
        """Whether the analysis has threads of its own."""
        return "threads" in type(self.tables.analysis).model_fields

    def _result(self, case: Case, progress: Progress, shown: Sequence[str]) -> Result:
        """Compute a case: one result, or the sweep that the study asks for."""
        analysis, keys = self.tables.analysis, self.tables.sweep

        def at_speed(speed: float) -> Model:
            model = model_of(at_speed_of(self.tables, speed), self.folder)
            return model if case.level is None else analysis.at_level(model, case.level)

        if keys is None:
            turns = analysis.of_speed and depends_on_speed(self.tables)
            return analysis.run(at_speed if turns else case.model, progress, shown)  # type: ignore[arg-type]
        models = at_speed if keys.speed is not None else case.model

        def compute(model: Model, part: Progress) -> Result:
            return analysis.run(model, part, shown)

        return swept(models, keys, compute, progress, alone=self._has_threads)


def json_schema() -> dict[str, object]:
    """Return the JSON schema of study files.

    Returns
    -------
    dict
        JSON schema (draft 2020-12) with which editors (Taplo, VS Code's Even Better TOML) complete
        and check a study file while it is written.
    """
    schema = StudyTables.model_json_schema(by_alias=True)
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **schema,
        "title": "stickslip study",
    }


def _read(text: str) -> StudyTables:
    text = text.removeprefix("\ufeff")
    if deep := _DEEP.search(text):
        line = text.count("\n", 0, deep.start()) + 1
        raise ModelError(f"line {line}: {brief(deep[0])}: keys nest too deep")
    try:
        content = tomllib.loads(text, parse_float=_real)
    except tomllib.TOMLDecodeError as error:
        raise ModelError(f"not valid TOML: {error}") from None
    except ModelError:
        raise
    except (ValueError, RecursionError):
        # Python reads integers of at most 4300 digits; lists nest without end.
        raise ModelError("not readable: a number is too long, or lists nest too deep") from None
    return validated(StudyTables, content)


def _real(text: str) -> float:
    number = float(text)
    if vanished(text, number) or (math.isinf(number) and "inf" not in text):
        size = "small" if number == 0.0 else "large"
        raise ModelError(
            f"{brief(text)} is too {size} for a number; write 0 or inf if that is meant"
        )
    return number


def _check_name(name: str) -> None:
    """Refuse a name that no result file can have, before anything is computed."""
    if is_reserved(name):
        raise ModelError(
            f"name = {brief(name)} is that of a device on Windows; give the study another 'name'"
        )
    if len(name.encode(errors="replace")) > _LONGEST_NAME:
        raise ModelError(
            f"name = {brief(name)} has more than {_LONGEST_NAME} bytes, too long for the names of "
            "result files; give the study a shorter 'name'"
        )


def _check_speed(tables: StudyTables) -> None:
    """Refuse a sweep of the speed that changes nothing, and any for what needs several speeds."""
    if tables.sweep is not None and tables.sweep.speed is not None and not depends_on_speed(tables):
        raise ModelError(
            "sweep: speed: nothing in the study changes with the speed of rotation; give "
            "'stiffening' in [structure], or leave out the sweep"
        )
    if tables.sweep is not None and tables.analysis.of_speed and depends_on_speed(tables):
        raise ModelError(
            f"sweep: a {tables.analysis.kind} makes the model anew at each speed, a sweep varies "
            "that of one speed; leave out [sweep], and write a study file per value"
        )


def _check_dofs(tables: StudyTables, model: Model) -> None:
    observed = tables.analysis.observed or physical_dofs(model)
    for key, names in tables.analysis.named_dofs.items():
        _check_names(f"analysis: {key}", names, model)
    _check_names("output: dofs", tables.output.dofs or (), model)
    for number, dof in enumerate(tables.output.dofs or (), 1):
        if dof not in observed:
            raise ModelError(
                f"output: dofs[{number}]: {brief(dof)} is not kept; add it to 'observe' in "
                "[analysis]"
            )


def _check_names(entry: str, names: Sequence[str], model: Model) -> None:
    first: dict[str, int] = {}
    key = entry.split()[-1]
    for number, name in enumerate(names, 1):
        with named(f"{entry}[{number}]"):
            model.structure.index(name)
            if first.setdefault(name, number) < number:
                raise ModelError(f"{brief(name)} is {key}[{first[name]}] too; name it once")
