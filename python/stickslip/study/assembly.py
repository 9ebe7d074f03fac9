"""The model that a study file describes: its structure, disk, dampers, contacts and forces."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from stickslip.analyses.design_map import spinning
from stickslip.checks import brief, real_matrix, unknown
from stickslip.damper.damper import Built, widened
from stickslip.disk import BladedDisk, Interface, cyclic_sector
from stickslip.disk.sector import NEXT, stranger
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.model.damping import ModalDamping
from stickslip.model.matrix_units import MatrixUnits
from stickslip.model.structure import Structure, coupled
from stickslip.study.contact_table import ContactTable
from stickslip.study.damper_table import LoadTable
from stickslip.study.disk_table import DiskTable, InterfaceTable
from stickslip.study.matrices import StructureTable, damping_of, matrix_of, named
from stickslip.study.tables import ForceTable, StudyTables


def model_of(tables: StudyTables, folder: Path) -> Model:
    """Return the model; the matrices' files are looked for in a folder."""
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


def depends_on_speed(tables: StudyTables) -> bool:
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
