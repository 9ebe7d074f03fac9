"""The table [structure] of a study file: matrices of files or written out, and damping laws."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

from pydantic import BeforeValidator, Discriminator, Field, Tag

from stickslip.checks import unknown
from stickslip.errors import EntryError
from stickslip.settings.entries import (
    Dof,
    ListOr,
    Many,
    Number,
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
    dofs: Many[Dof] | None = Field(
        default=None,
        description="Names of the DOFs, row by row; left out: '0', '1', ...",
        examples=[["damper", "tip", "mode"]],
    )
