"""`[[damper]]` of a study file: dampers as bodies."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field

from stickslip.damper import (
    Centrifugal,
    CylinderDamper,
    Damper,
    SplitDamper,
    StripDamper,
    WedgeDamper,
)
from stickslip.settings.entries import (
    ONE_OF,
    Angle,
    ByKey,
    Dof,
    Friction,
    Inertia,
    Length,
    ListOr,
    Mass,
    Newtons,
    Omega,
    Some,
    StiffnessValue,
    Table,
    Text,
)


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
    DamperTable, ByKey("kind", WedgeTable, CylinderTable, SplitTable, StripTable)
]
