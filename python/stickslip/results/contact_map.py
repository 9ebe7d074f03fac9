"""What an interface of many nodes does at one motion, node by node and in all."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal, Self, TypeAlias, get_args

import numpy as np

from stickslip.checks import brief, unknown
from stickslip.drawn import Drawn
from stickslip.errors import ModelError
from stickslip.fe.interface import ContactInterface
from stickslip.fe.vtu import write_vtu
from stickslip.model import ContactRef
from stickslip.model.contact import OPEN
from stickslip.results.contact_motion import ContactMotion
from stickslip.results.fields import Float
from stickslip.results.static_response import StaticResponse

MapField: TypeAlias = Literal[
    "pressure", "least_pressure", "greatest_pressure", "stick", "slip", "open", "work"
]
"""What a map has of every pair."""
FIELDS: tuple[str, ...] = get_args(MapField)
_CELLS = {3: "triangle", 4: "quad", 6: "triangle6", 8: "quad8"}


@dataclass(frozen=True, eq=False)
class ContactMap:
    """The state of every pair of an interface: pressure, stick, slip, opening, work."""

    interface: ContactInterface
    fields: Mapping[str, Float]
    """Values of the pairs by name, shape (n,): `pressure`, its mean over the period [Pa],
    `least_pressure` and `greatest_pressure` [Pa], `stick`, `slip` and `open`, shares of the period,
    and `work` lost to friction per cycle and area [J/m2]. At rest the pressures are one, the shares
    0 or 1, and no work is done."""

    plot = Drawn("contact_map")

    @classmethod
    def of(
        cls,
        interface: ContactInterface,
        result: ContactMotion | StaticResponse,
        contact: ContactRef = 0,
        index: int | None = None,
        *,
        samples: int = 256,
    ) -> Self:
        """Return the map of a motion, or of a structure at rest.

        Parameters
        ----------
        interface : ContactInterface
            Whose pairs the contact has.
        result : ForcedResponse, ExactResponse, StaticResponse or another with contacts
        contact : int or str, optional
            Position or name of the contact.
        index : int, optional
            Position of the motion in the result; needed but at rest.
        samples : int, optional
            Instants per period at which pressures are evaluated.

        Raises
        ------
        ModelError
            If the contact is not that of the interface, or the motion was not found.
        """
        number, _ = result.locate(contact)
        own = result.model.contacts[number]
        if own.points != interface.count or own.components != ("t1", "t2", "N"):
            raise ModelError(
                f"contact map: contact {result.model.contact_names[number]!r} has {own.points} "
                f"points, the interface {interface.count} pairs; give the contact made of it"
            )
        if isinstance(result, StaticResponse):
            force = result.contact_force(number)[None]
            state = own.states(force)[0]
            shares = (state == 1).astype(float), (state == OPEN).astype(float)
            work = np.zeros(interface.count)
        else:
            if index is None:
                raise ModelError("contact map: index is missing; give that of a motion")
            at = result.position(index)
            force = result.contact_force(number, at, samples).reshape(samples, -1, 3)
            shares = result.slip_fraction(number)[at], result.open_fraction(number)[at]
            work = result.dissipation(number)[at]
        if not np.isfinite(force).all():
            raise ModelError(
                f"contact map: motion {index} was not found; see the status of the result"
            )
        pressure = force[..., -1] / interface.areas
        slip, opened = shares
        values = pressure.mean(axis=0), pressure.min(axis=0), pressure.max(axis=0)
        stick = np.clip(1.0 - slip - opened, 0.0, 1.0)
        columns = (*values, stick, slip, opened, work / interface.areas)
        return cls(interface, MappingProxyType(dict(zip(FIELDS, columns, strict=True))))

    def __getitem__(self, field: str) -> Float:
        """Return the values of a field by its name."""
        if field not in self.fields:
            raise ModelError(f"contact map: {unknown('field', field, self.fields)}")
        return self.fields[field]

    def __repr__(self) -> str:
        return (
            f"ContactMap({self.interface.count} pairs: {self.slip_area:.3g} of "
            f"{self.interface.area:.3g} m2 slip, {self.open_area:.3g} m2 open, {self.work:.3g} J)"
        )

    @property
    def slip_area(self) -> float:
        """Area of the pairs that slip at some time of the period [m2]."""
        return float(self.interface.areas @ (self["slip"] > 0.0))

    @property
    def open_area(self) -> float:
        """Area of the pairs that are open at some time of the period [m2]."""
        return float(self.interface.areas @ (self["open"] > 0.0))

    @property
    def work(self) -> float:
        """Work that the interface loses to friction per cycle [J]."""
        return float(self.interface.areas @ self["work"])

    @property
    def normal_force(self) -> float:
        """Sum of the mean normal forces of the pairs [N]."""
        return float(self.interface.areas @ self["pressure"])

    def write_vtu(self, path: str | os.PathLike[str]) -> None:
        """Write faces and fields for ParaView, whole or not at all; meshio is needed.

        Nodes without a partner have nan.
        """
        surface = self.interface.surface
        fields = {name: self._on_surface(values) for name, values in self.fields.items()}
        cells = [(_CELLS[faces.shape[1]], faces) for faces in surface.faces]
        write_vtu(path, surface.points, cells, fields)

    def _on_surface(self, values: Float) -> Float:
        whole = np.full(len(self.interface.surface.labels), np.nan)
        whole[self.interface.places] = values
        return whole


def slip_area(interface: ContactInterface, result: ContactMotion, contact: ContactRef = 0) -> Float:
    """Return the area that slips at some time of the period, at every motion [m2], shape (n,).

    Parameters
    ----------
    interface, result, contact
        As of `ContactMap.of`.
    """
    slipping = np.asarray(result.slip_fraction(contact))
    if slipping.shape[1:] != (interface.count,):
        raise ModelError(
            f"slip area: contact {brief(contact)} does not have the {interface.count} pairs of the "
            "interface; give the contact made of it"
        )
    area: Float = np.where(
        np.isnan(slipping).any(axis=1), np.nan, (slipping > 0.0) @ interface.areas
    )
    return area
