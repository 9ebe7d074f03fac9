"""The matrices that a study file names: of files, written out, or made by a damping law."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Self

import numpy as np
from pydantic import BeforeValidator, Discriminator, Field, Tag, model_validator

from stickslip.checks import MatrixLike, brief, close, file_path, is_file, unknown
from stickslip.errors import EntryError, ModelError
from stickslip.io import read_matrix
from stickslip.model.damping import DampingLaw, ModalDamping, Rayleigh
from stickslip.settings.entries import (
    Dof,
    ListOr,
    Many,
    Number,
    Omega,
    Rate,
    Ratio,
    Table,
    Text,
    Time,
)


class MatrixFile(Table):
    """A matrix of a file that holds several."""

    file: Text = Field(description="File, relative to the study file.", examples=["beam.mat"])
    key: Text | None = Field(
        default=None, description="Name of the matrix in the file.", examples=["M"]
    )


class RayleighTable(Table):
    """Damping proportional to mass and stiffness."""

    mass: Rate = Field(default=0.0, description="Factor on the mass matrix [1/s].", examples=[7.49])
    stiffness: Time = Field(
        default=0.0, description="Factor on the stiffness [s].", examples=[2.6e-5]
    )


class RayleighDamping(Table):
    """C = mass M + stiffness K."""

    rayleigh: RayleighTable


class ModalDampingTable(Table):
    """A damping ratio per mode of the structure without contacts."""

    modal: ListOr[Ratio, Ratio] = Field(
        description="One ratio for all modes, or one per mode.", examples=[0.001]
    )


def _matrix_form(value: object) -> str | None:
    if isinstance(value, str):
        return "<file>"
    if isinstance(value, list | tuple):
        return "<rows>"
    if isinstance(value, Mapping):
        return next((f"<{form}>" for form in ("rayleigh", "modal") if form in value), "<table>")
    forms = {MatrixFile: "<table>", RayleighDamping: "<rayleigh>", ModalDampingTable: "<modal>"}
    return next((form for table, form in forms.items() if isinstance(value, table)), None)


def _rows(value: object) -> object:
    widths = {len(row) for row in value if isinstance(row, list)} if isinstance(value, list) else {}
    if len(widths) > 1:
        raise EntryError("", " has rows of different lengths")
    for number, row in enumerate(value if isinstance(value, list) else [], 1):
        for place, entry in enumerate(row if isinstance(row, list) else [], 1):
            if isinstance(entry, str):
                raise EntryError(
                    "",
                    f"[{number}][{place}]: {brief(entry)} is not a number; give numbers alone, in "
                    "SI units or in those that 'units' in [structure] names, units = \"t-mm-s\"",
                )
    return value


def _damping(value: object) -> object:
    forms = ("rayleigh", "modal", "file")
    if isinstance(value, Mapping) and not value:
        raise EntryError("", " = {} is empty; write {rayleigh = ...} or {modal = ...}")
    if isinstance(value, Mapping) and not {*forms, "key"} & value.keys():
        raise EntryError("", f": {unknown('key', next(iter(value)), forms)}")
    return value


Rows = Annotated[Many[Many[Number]], BeforeValidator(_rows)]
_FileName = Annotated[Text, Tag("<file>")]
_FileTable = Annotated[MatrixFile, Tag("<table>")]
_InlineRows = Annotated[Rows, Tag("<rows>")]

MatrixSource = Annotated[
    _FileName | _FileTable | _InlineRows,
    Discriminator(
        _matrix_form,
        custom_error_type="matrix_form",
        custom_error_message="is neither a file name, nor {file = ..., key = ...}, nor rows",
    ),
]
DampingSource = Annotated[
    _FileName
    | _FileTable
    | _InlineRows
    | Annotated[RayleighDamping, Tag("<rayleigh>")]
    | Annotated[ModalDampingTable, Tag("<modal>")],
    Discriminator(
        _matrix_form,
        custom_error_type="matrix_form",
        custom_error_message=(
            "is neither a matrix, nor {rayleigh = {mass = ..., stiffness = ...}}, nor {modal = ...}"
        ),
    ),
    BeforeValidator(_damping),
]


class StructureTable(Table):
    """The linear structure."""

    mass: MatrixSource = Field(description="Mass matrix.", examples=["mass.mtx"])
    stiffness: MatrixSource = Field(description="Stiffness matrix.", examples=["stiffness.mtx"])
    damping: DampingSource | None = Field(
        default=None,
        description="Damping matrix, Rayleigh or modal damping; left out: none.",
        examples=[{"rayleigh": {"mass": 7.49, "stiffness": 2.6e-5}}, {"modal": 0.001}],
    )
    stiffening: MatrixSource | None = Field(
        default=None,
        description="K2 of K + W^2 (K2 - S) at the speed W: what centrifugal stress adds.",
        examples=["K2.mtx"],
    )
    softening: MatrixSource | None = Field(
        default=None, description="S, what the turning of the load takes away; left out: none."
    )
    speed: Omega | None = Field(
        default=None, description="Speed of rotation; left out: at rest.", examples=["3000 rpm"]
    )
    units: Text | None = Field(
        default=None,
        description="Mass, length and time of all matrices; left out: SI.",
        examples=["t-mm-s"],
    )
    dofs: Many[Dof] | None = Field(
        default=None,
        description="Names of the DOFs, row by row; left out: '0', '1', ...",
        examples=[["damper", "tip", "mode"]],
    )

    @model_validator(mode="after")
    def _require_stiffening(self) -> Self:
        if self.stiffening is None and self.softening is not None:
            raise ValueError("'softening' without 'stiffening'; give both")
        if self.stiffening is None and self.speed is not None:
            raise ValueError("'speed' without 'stiffening' changes nothing; give both, or none")
        return self


@contextmanager
def named(entry: str) -> Iterator[None]:
    """Say where the entry stands that is complained of."""
    try:
        yield
    except ModelError as error:
        raise ModelError(f"{entry}: {error.study}") from None


def damping_of(
    source: str | MatrixFile | Rows | RayleighDamping | ModalDampingTable | None,
    folder: Path,
) -> MatrixLike | DampingLaw | None:
    """Return a damping matrix or law."""
    match source:
        case None:
            return None
        case RayleighDamping(rayleigh=factor):
            return Rayleigh(mass=factor.mass, stiffness=factor.stiffness)
        case ModalDampingTable(modal=ratio):
            return ModalDamping(ratio)
        case source:
            return matrix_of(source, folder, "damping")


def matrix_of(source: str | MatrixFile | Rows, folder: Path, entry: str) -> MatrixLike:
    """Return a matrix that is written out, or of a file relative to a folder."""
    if isinstance(source, tuple):
        return np.array(source, dtype=np.float64)
    name, key = (source, None) if isinstance(source, str) else (source.file, source.key)
    path = folder / file_path(name, entry)
    if not is_file(path):
        place = path.parent.resolve()
        raise ModelError(f"{entry} = {brief(name)}: no such file in {place}{neighbour(path)}")
    with named(entry):
        return read_matrix(path, key)


def neighbour(path: Path) -> str:
    """Suggest the file of the folder whose name is nearest."""
    folder = path.parent
    if not folder.is_dir():
        return f"; there is no folder {folder} either"
    near = close(path.name, (file.name for file in folder.iterdir()), 0.75)
    return f"; did you mean '{near[0]}'?" if near else ""
