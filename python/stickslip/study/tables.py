"""The tables of a study file: what may stand in them, read strictly, refused in one line."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Sequence
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
from pydantic import (
    BeforeValidator,
    Field,
    Strict,
    Tag,
    model_validator,
)

from stickslip.checks import brief
from stickslip.damper import (
    Centrifugal,
    CylinderDamper,
    Damper,
    SplitDamper,
    StripDamper,
    WedgeDamper,
)
from stickslip.errors import EntryError, ModelError
from stickslip.model import (
    BoucWen,
    Coulomb,
    Cubic,
    Force,
    Iwan,
    Jenkins,
    Masing,
    ParallelJenkins,
    Stop,
    StructuralDamper,
)
from stickslip.model.contact import Contact
from stickslip.model.force import engine_order_forces
from stickslip.settings.entries import (
    ONE_OF,
    Angle,
    CubicStiffness,
    Dof,
    Friction,
    Index,
    Inertia,
    Length,
    ListOr,
    Many,
    Mass,
    Newtons,
    NormalLoad,
    Number,
    Omega,
    SlipForce,
    Some,
    StiffnessValue,
    Table,
    Text,
    chosen_by,
)
from stickslip.settings.sweep import SweepKeys
from stickslip.study.analysis import AnalysisTable, ByKind
from stickslip.study.disk_table import CouplingTable, DiskTable
from stickslip.study.matrices import Rows, StructureTable


def _two_dofs(value: object) -> object:
    if isinstance(value, list) and len(value) != 2:
        raise EntryError(
            "",
            f" = {brief(value)} names {len(value)} dofs; give two, or write dof = ... for a "
            "contact to ground",
        )
    return value


def _length_unit(value: object) -> object:
    # both the micro sign and the Greek letter
    return "um" if value in ("\u00b5m", "\u03bcm") else value


# ------------------------------------------------------------------------ [[contact]], [[force]]


Nodes = Some[ListOr[Dof, Dof]]
"""The DOFs of a node, or one such list per node."""


class LawTable(Table):
    """A contact: the values of its law, by their names there."""

    makes: ClassVar[Callable[..., Contact]]

    name: Text | None = Field(default=None, description="Name; left out: that of the law.")

    @property
    def ends(self) -> tuple[object, ...]:
        """What the law takes by position."""
        return self.touched

    @property
    @abstractmethod
    def touched(self) -> tuple[str, ...]:
        """The DOFs it acts on."""

    def build(self) -> Contact:
        """Return the contact."""
        values = {key: value for key, value in self if key not in ("law", "dof", "dofs")}
        return type(self).makes(*self.ends, **values)


class EndsTable(LawTable):
    """A contact of one relative displacement: to ground, or between two DOFs."""

    dof: Dof | None = Field(
        default=None, description="The DOF, for a contact to ground.", examples=["tip"]
    )
    dofs: Annotated[tuple[Dof, Dof], Strict(False), BeforeValidator(_two_dofs)] | None = Field(
        default=None,
        description="The two DOFs, for a contact between them.",
        examples=[["left.tip", "right.tip"]],
    )

    @model_validator(mode="after")
    def _require_one_place(self) -> Self:
        if (self.dof is None) == (self.dofs is None):
            raise ValueError(
                "give either 'dof', for a contact to ground, or 'dofs', the two it lies between"
            )
        if self.dofs is not None and self.dofs[0] == self.dofs[1]:
            raise ValueError(
                f"both ends at dof {brief(self.dofs[0])}; name another, or write dof = "
                f"{brief(self.dofs[0])} for a contact to ground"
            )
        return self

    @property
    def touched(self) -> tuple[str, ...]:
        """The DOFs it acts on."""
        return self.dofs or ((self.dof,) if self.dof is not None else ())


class JenkinsTable(EndsTable):
    """A Jenkins element: a spring in series with a Coulomb slider."""

    makes = Jenkins
    law: Literal["jenkins"] = Field(description="Friction law.")
    stiffness: StiffnessValue = Field(description="Contact stiffness k_d.")
    slip_force: SlipForce | None = Field(
        default=None, description="Slip limit F_d; inf: it never slips."
    )
    friction: Friction | None = Field(
        default=None, description="Instead: coefficient of friction of the slip force mu N."
    )
    normal_load: NormalLoad | None = Field(default=None, description="Normal load N beside it.")

    @model_validator(mode="after")
    def _require_slip_force(self) -> Self:
        if self.slip_force is None and self.friction is None and self.normal_load is None:
            raise ValueError("'slip_force' is missing; give it, or 'friction' and 'normal_load'")
        return self


class ParallelJenkinsTable(EndsTable):
    """Jenkins elements in parallel on one displacement: the discrete Iwan model."""

    makes = ParallelJenkins
    law: Literal["parallel-jenkins"] = Field(description="Friction law.")
    stiffness: Some[StiffnessValue] = Field(
        description="Stiffness of each element.", examples=[["1e5 N/m", 2e5]]
    )
    slip_forces: Some[SlipForce] = Field(
        description="Slip limit of each element; inf: it never slips.", examples=[["5 N", 20]]
    )


class IwanTable(EndsTable):
    """Segalman's four-parameter Iwan model: microslip up to gross slip."""

    makes = Iwan
    law: Literal["iwan"] = Field(description="Friction law.")
    stiffness: StiffnessValue = Field(description="Stiffness K_T at rest.")
    slip_force: SlipForce = Field(description="Force F_S of gross slip; inf: it never slips.")
    chi: Number = Field(description="Exponent of the distribution, above -1 and at most 0.")
    beta: Number = Field(default=0.0, description="Weight of the elements that slip last.")


class MasingTable(EndsTable):
    """A contact by its backbone, the force of its first loading."""

    makes = Masing
    law: Literal["masing"] = Field(description="Friction law.")
    stiffness: StiffnessValue | None = Field(
        default=None, description="Stiffness at rest; left out: that of a table's first row."
    )
    slip_force: SlipForce | None = Field(
        default=None, description="Force never exceeded; left out: that of a table's last row."
    )
    backbone: Annotated[Literal["exponential", "shear-layer"], ONE_OF] | None = Field(
        default=None, description="Shape; left out: the table of displacement and force."
    )
    shear_lag: Number | None = Field(
        default=None, description="sqrt(k / EA) L of a shear layer, which needs it."
    )
    displacement: Some[Length] | None = Field(
        default=None,
        description="Displacements of a tabulated backbone.",
        examples=[["1 um", 5e-6]],
    )
    force: Some[SlipForce] | None = Field(
        default=None, description="As many forces.", examples=[["20 N", 70]]
    )

    def build(self) -> Masing:
        """Return the contact."""
        table = () if None in (self.displacement, self.force) else (self.displacement, self.force)
        if (self.backbone is None) == (not table):
            raise ModelError(
                "give either 'backbone', the name of a shape, or 'displacement' and 'force'"
            )
        values = {
            key: getattr(self, key) for key in ("stiffness", "slip_force", "shear_lag", "name")
        }
        return Masing(*self.touched, backbone=self.backbone or table, **values)  # type: ignore[arg-type]


class BoucWenTable(EndsTable):
    """The Bouc-Wen law: hysteresis by one differential equation."""

    makes = BoucWen
    law: Literal["bouc-wen"] = Field(description="Friction law.")
    stiffness: StiffnessValue = Field(description="Stiffness at rest.")
    slip_force: SlipForce = Field(description="Force that it comes near.")
    exponent: Number = Field(default=1.0, description="Sharpness n of the knee, at least 1.")
    beta: Number = Field(default=0.5, description="Share of the term with the direction, 0.5 to 1.")


class StopTable(EndsTable):
    """An elastic stop: a spring that works once a gap has closed."""

    makes = Stop
    law: Literal["stop"] = Field(description="Contact law.")
    stiffness: StiffnessValue = Field(description="Stiffness k of the closed stop.")
    gap: Length = Field(
        description="Gap at rest; a negative one is an interference.", examples=["0.2 mm", 1e-3]
    )


class CubicTable(EndsTable):
    """A cubic spring, f = k u^3."""

    makes = Cubic
    law: Literal["cubic"] = Field(description="Contact law.")
    stiffness: CubicStiffness = Field(
        description="Coefficient k; a negative one softens.", examples=["1e9 N/m^3", -2e5]
    )


class CoulombTable(LawTable):
    """A Coulomb contact of one node, or of many, whose normal load may vary and vanish."""

    makes = Coulomb
    law: Literal["coulomb"] = Field(description="Friction law.")
    dofs: Nodes = Field(
        description="The DOFs of the node, 3 in space, 2 in a plane, or the tangential ones alone; "
        "or a list of such lists, one per node.",
        examples=[["pad.x", "pad.y", "pad.z"]],
    )
    other: Nodes | None = Field(
        default=None,
        description="As many DOFs of the other body; left out: the ground.",
        examples=[["disk.x", "disk.y", "disk.z"]],
    )
    normal: ListOr[ListOr[Number, Number], Number] | None = Field(
        default=None,
        description="Normal out of the first body into the other, or one per node; left out: the "
        "normal load is constant.",
        examples=[[0.0, 0.0, 1.0]],
    )
    friction: ListOr[Friction, Friction] = Field(description="Coefficient of friction.")
    tangential_stiffness: ListOr[StiffnessValue, StiffnessValue] = Field(
        description="Stiffness k_t of a node while it sticks."
    )
    normal_stiffness: ListOr[StiffnessValue, StiffnessValue] | None = Field(
        default=None, description="Stiffness k_n of a node while it is closed."
    )
    preload: ListOr[NormalLoad, NormalLoad] | None = Field(
        default=None, description="Normal force of a node without motion."
    )
    gap: ListOr[Length, Length] | None = Field(
        default=None,
        description="Instead: distance between the bodies, negative for an interference; left out: "
        "0.",
    )

    @property
    def ends(self) -> tuple[object, ...]:
        """What the law takes by position."""
        return (self.dofs,)

    @property
    def touched(self) -> tuple[str, ...]:
        """The DOFs it acts on."""
        ends = [self.dofs, *([self.other] if self.other else [])]
        return tuple(dof for end in ends for one in end for dof in _listed(one))


def _listed(node: str | tuple[str, ...]) -> tuple[str, ...]:
    return (node,) if isinstance(node, str) else node


_GROUND = "ground"
"""What a file calls the ground: it has no empty entries."""


class StructuralTable(LawTable):
    """A structure-like damper: a massless elastic body with several slipping contacts."""

    makes = StructuralDamper
    law: Literal["structural"] = Field(description="Friction law.")
    dofs: Some[Dof] = Field(
        description="The DOF that each contact touches; 'ground' is the ground.",
        examples=[["left.tip", "right.tip", "ground"]],
    )
    stiffness: Rows = Field(
        description="Stiffness of the damper by itself, row by row [N/m].",
        examples=[[[2e6, -2e6], [-2e6, 2e6]]],
    )
    slip_forces: Many[SlipForce] = Field(
        description="Slip limit of each contact; inf: it never slips.",
        examples=[["25 N", 1e3]],
    )

    @property
    def ends(self) -> tuple[object, ...]:
        """What the law takes by position."""
        return ([None if dof == _GROUND else dof for dof in self.dofs],)

    @property
    def touched(self) -> tuple[str, ...]:
        """The DOFs it acts on."""
        return tuple(dof for dof in self.dofs if dof != _GROUND)


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


ContactTable = Annotated[
    Annotated[JenkinsTable, Tag("<jenkins>")]
    | Annotated[ParallelJenkinsTable, Tag("<parallel-jenkins>")]
    | Annotated[IwanTable, Tag("<iwan>")]
    | Annotated[MasingTable, Tag("<masing>")]
    | Annotated[BoucWenTable, Tag("<bouc-wen>")]
    | Annotated[StructuralTable, Tag("<structural>")]
    | Annotated[CoulombTable, Tag("<coulomb>")]
    | Annotated[StopTable, Tag("<stop>")]
    | Annotated[CubicTable, Tag("<cubic>")],
    chosen_by(
        "law",
        "jenkins",
        "parallel-jenkins",
        "iwan",
        "masing",
        "bouc-wen",
        "structural",
        "coulomb",
        "stop",
        "cubic",
    ),
]
"""Each further friction law joins this union with a table of its own."""


# ------------------------------------------------------------------------------------ [[damper]]


class LoadTable(Table):
    """The load of a mass on a turning disk, m r W^2."""

    radius: Length = Field(description="Distance of the centre of mass from the axis of rotation.")
    speed: Omega = Field(description="Speed of rotation.")


class DamperTable(Table):
    """A damper as a body, between two places of the structure or two sectors of the disk."""

    makes: ClassVar[Callable[..., Damper]]

    name: Text | None = Field(
        default=None, description="Prefix of its DOFs; left out: damper, damper-2, ..."
    )
    left_dofs: Some[ListOr[Dof, Dof]] = Field(
        description="DOFs that its left face touches, x and y; or one such list per point.",
        examples=[["left.x", "left.y"]],
    )
    right_dofs: Some[ListOr[Dof, Dof]] = Field(
        description="DOFs that its right face touches; of a disk those of the next sector.",
        examples=[["right.x", "right.y"]],
    )
    axes: Annotated[Literal["sector", "parallel"], ONE_OF] = Field(
        default="sector",
        description="Of a disk: whether each sector has axes of its own, or all are parallel.",
    )
    mass: Mass = Field(description="Mass.")
    friction: ListOr[Friction, Friction] = Field(
        description="Coefficient of friction, of both faces or (left, right)."
    )
    tangential_stiffness: ListOr[StiffnessValue, StiffnessValue] = Field(
        description="Tangential stiffness of a face."
    )
    normal_stiffness: ListOr[StiffnessValue, StiffnessValue] = Field(
        description="Normal stiffness of a face."
    )
    load: Newtons | LoadTable = Field(
        description="Static load along +y, or the radius and speed that make it.",
        examples=["120 N", {"radius": "0.3 m", "speed": "9000 rpm"}],
    )
    gap: ListOr[Length, Length] = Field(
        default=0.0, description="Gap of a face, negative for an interference."
    )

    def build(self) -> Damper:
        """Return the damper."""
        left_out = {"kind", "name", "left_dofs", "right_dofs", "axes", "load", "angle"}
        values = {key: value for key, value in self if key not in left_out}
        load = self.load
        if isinstance(load, LoadTable):
            load = Centrifugal(load.radius, load.speed)  # type: ignore[assignment]
        angle = getattr(self, "angle", None)
        if angle is not None:
            values["angle"] = (
                tuple(np.rad2deg(angle).tolist())
                if isinstance(angle, tuple)
                else (float(np.rad2deg(angle)))
            )
        return type(self).makes(load=load, **values)


class AngledTable(DamperTable):
    """A damper between two inclined faces."""

    angle: ListOr[Angle, Angle] = Field(
        description="Angle between the normal of a face and the load, of both or (left, right).",
        examples=["30 deg", ["40 deg", "20 deg"]],
    )


class WedgeTable(AngledTable):
    """A wedge; with two angles a cottage roof."""

    makes = WedgeDamper
    kind: Literal["wedge"] = Field(description="Kind of damper.")


class CylinderTable(AngledTable):
    """A cylinder that slides and rolls."""

    makes = CylinderDamper
    kind: Literal["cylinder"] = Field(description="Kind of damper.")
    cylinder_radius: Length = Field(description="Radius of the cylinder.")
    inertia: Inertia | None = Field(
        default=None, description="Moment of inertia; left out: of a full cylinder."
    )


class SplitTable(AngledTable):
    """A wedge of two halves that rub on each other."""

    makes = SplitDamper
    kind: Literal["split"] = Field(description="Kind of damper.")


class StripTable(DamperTable):
    """A strip between a platform (left) and the disk below (right)."""

    makes = StripDamper
    kind: Literal["strip"] = Field(description="Kind of damper.")


DamperKind = Annotated[
    Annotated[WedgeTable, Tag("<wedge>")]
    | Annotated[CylinderTable, Tag("<cylinder>")]
    | Annotated[SplitTable, Tag("<split>")]
    | Annotated[StripTable, Tag("<strip>")],
    chosen_by("kind", "wedge", "cylinder", "split", "strip"),
]


# ------------------------------------------------------------------------------------- the file


class OutputTable(Table):
    """What is tabulated and drawn."""

    dofs: Some[Dof] | None = Field(
        default=None,
        description="DOFs tabulated and drawn; left out: those that carry a force or a contact.",
        examples=[["tip", "damper"]],
    )
    omega_unit: Annotated[Literal["rad/s", "Hz", "rpm"], ONE_OF] = Field(
        default="rad/s",
        description="Unit of the frequency axis; rpm of a disk are those of the rotor.",
    )
    length_unit: Annotated[
        Literal["auto", "m", "mm", "um"], ONE_OF, BeforeValidator(_length_unit)
    ] = Field(
        default="auto",
        description="Unit of the amplitudes; auto: that which suits the numbers.",
    )


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
    analysis: Annotated[AnalysisTable, ByKind()] = Field(description="What to compute.")
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
