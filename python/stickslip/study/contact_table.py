"""`[[contact]]` of a study file: a table for each law, with the values that the law takes."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from typing import Annotated, ClassVar, Literal, Self

from pydantic import BeforeValidator, Field, Strict, model_validator

from stickslip.checks import brief
from stickslip.errors import EntryError, ModelError
from stickslip.model import (
    BoucWen,
    Coulomb,
    Cubic,
    Iwan,
    Jenkins,
    Masing,
    ParallelJenkins,
    Stop,
    StructuralDamper,
)
from stickslip.model.contact import Contact
from stickslip.settings.entries import (
    ONE_OF,
    ByKey,
    CubicStiffness,
    Dof,
    Friction,
    Length,
    ListOr,
    Many,
    NormalLoad,
    Number,
    SlipForce,
    Some,
    StiffnessValue,
    Table,
    Text,
)
from stickslip.study.matrices import Rows


def _two_dofs(value: object) -> object:
    if isinstance(value, list) and len(value) != 2:
        raise EntryError(
            "",
            f" = {brief(value)} names {len(value)} dofs; give two, or write dof = ... for a "
            "contact to ground",
        )
    return value


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
    exponent: Number = Field(default=1.0, description="Sharpness n of the knee, from 1 to 1000.")
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


ContactTable = Annotated[
    LawTable,
    ByKey(
        "law",
        JenkinsTable,
        ParallelJenkinsTable,
        IwanTable,
        MasingTable,
        BoucWenTable,
        StructuralTable,
        CoulombTable,
        StopTable,
        CubicTable,
    ),
]
"""Each further friction law joins these with a table of its own."""
