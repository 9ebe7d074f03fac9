"""The tables of a study file: what may stand in them, read strictly, refused in one line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from stickslip.errors import ModelError
from stickslip.model import Force
from stickslip.model.force import engine_order_forces
from stickslip.settings.entries import ONE_OF, Angle, Dof, Index, Many, Newtons, Some, Table
from stickslip.settings.sweep import SweepKeys
from stickslip.study.analysis import AnyAnalysis
from stickslip.study.contact_table import ContactTable
from stickslip.study.damper_table import DamperKind
from stickslip.study.disk_table import CouplingTable, DiskTable
from stickslip.study.matrices import StructureTable


class ForceTable(Table):
    """A harmonic force, amplitude cos(harmonic omega t + phase)."""

    dof: Dof = Field(
        description='The DOF it acts on; "*.tip" are those of all sectors of a structure, with an '
        "engine order."
    )
    amplitude: Newtons = Field(description="Amplitude.", examples=["20.3 N", 20.3])
    phase: Angle = Field(default=0.0, description="Phase.", examples=["90 deg"])
    harmonic: Index = Field(default=1, description="Multiple of omega; 0: a static load.")
    engine_order: Index | None = Field(
        default=None,
        description='Of dof = "*.tip": each sector is ahead of the one before by 2 pi E / n.',
    )

    @model_validator(mode="after")
    def _require_order(self) -> Self:
        if (self.engine_order is None) == ("*" in self.dof):
            raise ValueError(
                "'dof' with a star, \"*.tip\", and 'engine_order' belong together; give both, or "
                "neither"
            )
        return self

    @property
    def touched(self) -> tuple[str, ...]:
        """The DOFs it acts on."""
        return () if self.engine_order is not None else (self.dof,)

    def build(self, dofs: Sequence[str] = ()) -> list[Force]:
        """Return the force, or those on all sectors among some DOFs."""
        values = dict(self)
        order = values.pop("engine_order")
        if order is None:
            return [Force(**values)]
        dof = values.pop("dof")
        return engine_order_forces(dof, dofs=dofs, engine_order=order, **values)


class OutputTable(Table):
    """What is tabulated and drawn."""

    dofs: Some[Dof] | None = Field(
        default=None,
        description="DOFs tabulated and drawn; left out: those that carry a force or a contact.",
        examples=[["tip", "damper"]],
    )
    omega_unit: Annotated[Literal["rad/s", "Hz", "rpm"], ONE_OF] | None = Field(
        default=None,
        description="Unit of the frequency axis, of responses over the speed that of the speed; "
        "rpm of a disk are those of the rotor. Left out: rad/s; of responses over the speed rpm, "
        "of diagrams over speed or nodal diameter Hz.",
    )
    length_unit: Annotated[
        Literal["auto", "m", "mm", "um"],
        ONE_OF,
        # both the micro sign and the Greek letter
        BeforeValidator(lambda one: "um" if one in ("\u00b5m", "\u03bcm") else one),
    ] = Field(
        default="auto",
        description="Unit of the amplitudes; auto: that which suits the numbers.",
    )

    @property
    def frequency_unit(self) -> Literal["rad/s", "Hz", "rpm"]:
        """Unit of figures over the frequency."""
        return self.omega_unit or "rad/s"


class SweepTable(SweepKeys):
    """A parameter and its values: one result that knows them."""


# Something other than dots and blanks, so that it is no folder.
_SIGN = r'/\\:*?"<>|\x00-\x1f'
_FILE_NAME = rf"^[^{_SIGN}]*[^{_SIGN}.\s][^{_SIGN}]*$"


class StudyTables(Table):
    """A study: a structure with contacts and forces, and what to compute of it."""

    name: Annotated[str, Field(pattern=_FILE_NAME)] | None = Field(
        default=None, description="Name of the result files; left out: that of the study file."
    )
    description: str = Field(default="", description="What is studied, for the reader.")
    structure: StructureTable = Field(description="The linear structure.")
    contact: Many[ContactTable] = Field(default=(), description="The friction contacts.")
    damper: Many[DamperKind] = Field(
        default=(), description="Dampers as bodies, with contacts and loads of their own."
    )
    force: Many[ForceTable] = Field(default=(), description="The forces.")
    disk: DiskTable | None = Field(
        default=None,
        description="Makes the structure a sector of a bladed disk; left out: it is the whole.",
    )
    coupling: Many[CouplingTable] = Field(
        default=(),
        description="Springs between two DOFs; of a disk, between neighbouring sectors.",
    )
    analysis: AnyAnalysis = Field(description="What to compute.")
    sweep: SweepTable | None = Field(
        default=None,
        description="Computes the analysis along a parameter; left out: of the model as written.",
    )
    output: OutputTable = Field(default=OutputTable(), description="What to tabulate and draw.")

    @model_validator(mode="after")
    def _require_disk(self) -> Self:
        ends = [coupling.other for coupling in self.coupling]
        if self.disk is None and None in ends:
            raise ModelError(
                f"coupling {ends.index(None) + 1}: there are no sectors to couple; add the table "
                "[disk], or name the 'other' DOF of the structure"
            )
        turned = ["axes" in damper.model_fields_set for damper in self.damper]
        if self.disk is None and any(turned):
            raise ModelError(
                f"damper {turned.index(True) + 1}: axes = "
                f"'{self.damper[turned.index(True)].axes}' says how the sectors of a disk stand; "
                "add the table [disk], or leave it out"
            )
        tuned = self.disk is not None and self.disk.mistuning is None
        if self.analysis.kind == "flutter-map" and not tuned:
            raise ModelError(
                "analysis: a flutter-map is of a tuned disk; add the table [disk], without "
                "'mistuning'"
            )
        if self.analysis.kind == "mistuning-study" and not tuned:
            raise ModelError(
                "analysis: a mistuning-study makes its disks of a tuned one; add the table [disk], "
                "without 'mistuning'"
            )
        return self

    @model_validator(mode="after")
    def _require_distinct_names(self) -> Self:
        names = [contact.name for contact in self.contact]
        for number, name in enumerate(names):
            if name is not None and name in names[:number]:
                raise ModelError(
                    f"contact {number + 1}: name = '{name}' is that of contact "
                    f"{names.index(name) + 1} too; give another name"
                )
        return self
