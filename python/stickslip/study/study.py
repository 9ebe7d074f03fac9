"""Studies: a TOML file that holds a model and what to compute of it."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from stickslip.analyses.arguments import loaded_dofs, physical_dofs
from stickslip.analyses.design_map import spinning
from stickslip.analyses.run import Progress, share
from stickslip.analyses.sweep import swept
from stickslip.checks import brief, file_path, is_file, is_reserved, real_matrix, unknown, vanished
from stickslip.damper.damper import Built, widened
from stickslip.disk import BladedDisk, Interface, cyclic_sector
from stickslip.disk.sector import NEXT, stranger
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.model.matrix_units import MatrixUnits
from stickslip.model.structure import ModalDamping, Structure, coupled
from stickslip.results.result import Result
from stickslip.settings.refusal import refusal
from stickslip.study.analysis import level_name
from stickslip.study.disk_table import DiskTable, InterfaceTable
from stickslip.study.matrices import StructureTable, damping_of, matrix_of, named, neighbour
from stickslip.study.tables import ContactTable, ForceTable, LoadTable, StudyTables

_SHOWN_DOFS = 4
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
        Factor on every force; None when the study has no levels.
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
            model = _model(tables, Path(folder))
            _check_dofs(tables, model)
            _check_name(tables.name or name)
        return cls(tables.name or name, tables, model, source, Path(folder))

    @property
    def cases(self) -> tuple[Case, ...]:
        """The curves of the study, one per level."""
        levels = self.tables.analysis.levels
        if levels is None:
            return (Case(self.name, None, self.model),)
        return tuple(
            Case(f"{self.name}-{level_name(level)}", level, self.model.scaled(force=level))
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
        """Compute the results, one after the other.

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
        cases = self.cases
        shown = self.tables.output.dofs or ()
        for number, case in enumerate(cases):
            part = share(progress, number / len(cases), (number + 1) / len(cases))
            with named(self.source):
                result = self._result(case, part, shown)
            yield result

    def _result(self, case: Case, progress: Progress, shown: Sequence[str]) -> Result:
        """Compute a case: one result, or the sweep that the study asks for."""
        analysis, keys = self.tables.analysis, self.tables.sweep

        def at_speed(speed: float) -> Model:
            model = _model(at_speed_of(self.tables, speed), self.folder)
            return model if case.level is None else model.scaled(force=case.level)

        if keys is None:
            turns = analysis.of_speed and _turns(self.tables)
            return analysis.run(at_speed if turns else case.model, progress, shown)  # type: ignore[arg-type]
        models = at_speed if keys.speed is not None else case.model
        return swept(models, keys, lambda model, part: analysis.run(model, part, shown), progress)


def notable_dofs(model: Model, observed: Sequence[str]) -> tuple[str, ...]:
    """Choose the DOFs to show when none are named.

    Parameters
    ----------
    model : Model
        What was computed.
    observed : sequence of str
        The DOFs whose motion is known.

    Returns
    -------
    tuple of str
        Up to four that carry a force or a contact, in this order, or else the first ones.
    """
    notable = [dof for dof in loaded_dofs(model) if dof in observed]
    return tuple(notable or observed)[:_SHOWN_DOFS]


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

    try:
        return StudyTables.model_validate(content)
    except ValidationError as error:
        raise refusal(error) from None


def _real(text: str) -> float:
    number = float(text)
    if vanished(text, number) or (math.isinf(number) and "inf" not in text):
        size = "small" if number == 0.0 else "large"
        raise ModelError(
            f"{brief(text)} is too {size} for a number; write 0 or inf if that is meant"
        )
    return number


def _model(tables: StudyTables, folder: Path) -> Model:
    with named("structure"):
        structure = _structure(tables.structure, folder)
    if tables.disk is not None:
        return _disk(tables, tables.disk, structure, folder)
    structure = coupled(structure, [coupling.build() for coupling in tables.coupling])
    structure, contacts, forces = _with_dampers(tables, structure)
    _check_parts(tables, structure)
    return Model(
        structure,
        contacts=[*contacts, *(contact.build() for contact in tables.contact)],
        forces=[*forces, *(one for force in tables.force for one in force.build(structure.dofs))],
    )


def _with_dampers(tables: StudyTables, structure: Structure) -> Built:
    """Return the structure, or the sector of a disk, with the bodies of all dampers."""
    whole = Built(structure, [], [])
    for number, table in enumerate(tables.damper, 1):
        name = table.name or ("damper" if number == 1 else f"damper-{number}")
        ends = table.left_dofs, table.right_dofs
        with named(f"damper {number}"):
            damper = table.build()
            if tables.disk is None:
                own = damper.built(whole.structure, *ends, name)
            else:
                own = damper.built_in_sector(
                    whole.structure, tables.disk.sectors, *ends, table.axes, name
                )
        whole = Built(own.structure, [*whole.contacts, *own.contacts], [*whole.forces, *own.forces])
    return whole


def _check_parts(tables: StudyTables, structure: Structure) -> None:
    """Say in which contact or force a DOF or a number is wrong."""
    parts: list[tuple[str, ForceTable | ContactTable]] = [
        *((f"contact {number}", contact) for number, contact in enumerate(tables.contact, 1)),
        *((f"force {number}", force) for number, force in enumerate(tables.force, 1)),
    ]
    for entry, part in parts:
        with named(entry):
            _check_touched(part, structure.dofs, between_sectors=tables.disk is not None)
            if isinstance(part, ForceTable):
                part.build(structure.dofs)
            else:
                part.build()


def _check_touched(
    part: ForceTable | ContactTable,
    own: Sequence[str],
    *,
    between_sectors: bool,
) -> None:
    """Refuse a DOF that the structure, or the next sector at a contact, does not have."""
    contact = not isinstance(part, ForceTable)
    for dof in part.touched:
        bare = dof.removeprefix(NEXT)
        if dof in own or (contact and between_sectors and bare in own):
            continue
        if contact and between_sectors:
            raise ModelError(stranger(dof, part.touched, own))
        reason = unknown("dof", dof, own)
        if contact and dof == "ground":
            reason += ' (a contact to the ground has dof = "..." alone)'
        elif contact and bare in own:
            reason += " (the next sector is that of a [disk])"
        elif bare in own:
            reason = (
                f"{brief(dof)}: forces are those on sector 0, from which those on the others "
                f"follow; write {brief(bare)}"
            )
        raise ModelError(reason)


def _disk(tables: StudyTables, table: DiskTable, structure: Structure, folder: Path) -> Model:
    """Return the tuned disk of which the structure is a sector, or the mistuned one."""
    interface = None
    if table.boundary:
        with named("disk"):
            structure, interface = cyclic_sector(structure, table.boundary)
    if table.interface is not None:
        with named("disk: interface"):
            interface = _interface(table.interface, folder, tables.structure.units, structure.dofs)
    structure, contacts, forces = _with_dampers(tables, structure)
    _check_parts(tables, structure)
    with named("disk"):
        disk = BladedDisk(
            structure,
            table.sectors,
            [coupling.build() for coupling in tables.coupling],
            [*contacts, *(contact.build() for contact in tables.contact)],
            [*forces, *(one for force in tables.force for one in force.build(structure.dofs))],
            engine_order=table.engine_order,
            engine_orders=table.engine_orders,
            interface=widened(interface, len(structure)),
        )
        if table.mistuning is None:
            return disk
        return disk.mistuned(table.mistuning.values(table.sectors))


def _interface(
    table: InterfaceTable, folder: Path, units: str | None, dofs: Sequence[str]
) -> Interface:
    stiffness = matrix_of(table.stiffness, folder, "stiffness")
    mass = None if table.mass is None else matrix_of(table.mass, folder, "mass")
    damping = damping_of(table.damping, folder)
    if isinstance(damping, ModalDamping):
        raise ModelError(
            "damping: modes belong to the whole disk; give a matrix or {rayleigh = ...}"
        )
    return Interface(stiffness, mass, damping, units=units, dofs=dofs)


def _turns(tables: StudyTables) -> bool:
    """Return whether the model depends on the speed of rotation."""
    loads = (one.load for one in tables.damper)
    return tables.structure.stiffening is not None or any(
        isinstance(load, LoadTable) for load in loads
    )


def at_speed_of(tables: StudyTables, speed: float) -> StudyTables:
    """Return the tables at another speed of rotation, of the structure and of damper loads."""
    structure = tables.structure.model_copy(update={"speed": speed})
    dampers = [
        one.model_copy(update={"load": one.load.model_copy(update={"speed": speed})})
        if isinstance(one.load, LoadTable)
        else one
        for one in tables.damper
    ]
    return tables.model_copy(update={"structure": structure, "damper": tuple(dampers)})


def _structure(table: StructureTable, folder: Path) -> Structure:
    mass = matrix_of(table.mass, folder, "mass")
    stiffness = matrix_of(table.stiffness, folder, "stiffness")
    damping = damping_of(table.damping, folder)
    structure = Structure(mass, stiffness, damping, table.dofs, units=table.units)
    if table.stiffening is None:
        return structure
    added: dict[str, Any] = {
        key: matrix_of(source, folder, key)
        for key, source in (("stiffening", table.stiffening), ("softening", table.softening))
        if source is not None
    }
    if table.units is not None:
        units = MatrixUnits.of(table.units)
        added = {
            key: units.in_si(real_matrix(one, key), "mass", structure.dofs)
            for key, one in added.items()
        }
    return spinning(structure, **added)(table.speed or 0.0)


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
