"""A family of models with one parameter: slip force, stiffness, or level of the forces."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Annotated, Any, Literal, TypeAlias

import numpy as np
from pydantic import Field, Strict, model_validator

from stickslip import _core
from stickslip.errors import EntryError, ModelError
from stickslip.model import Model, PointRef
from stickslip.model.contact import Contact
from stickslip.settings.entries import ONE_OF, NamedContact, Some
from stickslip.settings.ranges import Or
from stickslip.settings.settings import Settings
from stickslip.units import without_units

Parameter: TypeAlias = Literal[
    "slip_force",
    "stiffness",
    "level",
    "friction",
    "preload",
    "gap",
    "tangential_stiffness",
    "normal_stiffness",
]
Swept: TypeAlias = Literal[Parameter, "normal_load"]
"""What a sweep varies: the normal load of a slip force that is friction times load, too."""
COULOMB = frozenset({"friction", "preload", "gap", "tangential_stiffness", "normal_stiffness"})
"""Parameters of Coulomb contacts."""
UNITS: Mapping[Swept, str] = {
    "slip_force": "N",
    "stiffness": "N/m",
    "level": "1",
    "friction": "1",
    "preload": "N",
    "gap": "m",
    "tangential_stiffness": "N/m",
    "normal_stiffness": "N/m",
    "normal_load": "N",
}


def unit_of(parameter: str) -> str:
    """Return the unit in which a parameter is given, "" of a ratio, by the last part of its name.

    Of the damping law they are "damping.mass" and "damping.stiffness".
    """
    owner, _, name = parameter.rpartition(".")
    units = {"mass": "1/s", "stiffness": "s"} if owner == "damping" else UNITS
    unit = units.get(name, "1")  # type: ignore[call-overload]
    return "" if unit == "1" else str(unit)


Common = Annotated[Literal["value", "factor"], ONE_OF]

Contacts: TypeAlias = Iterable[PointRef] | PointRef
"""Contacts or points of contacts, or one of them."""

Chosen: TypeAlias = str | tuple[str, int]
"""A contact by its name, or one of its points."""


class ParameterMode(Settings):
    """How contacts share the value of a parameter."""

    common: Common = Field(
        default="value",
        description="Whether the contacts all take the value, or multiply their own by it. The "
        "stiffness of a structure-like damper is a matrix, and takes a factor alone.",
    )

    @model_validator(mode="before")
    @classmethod
    def _plain_factors(cls, data: object) -> object:
        """Refuse values with a unit where factors are meant."""
        # What is no text is refused behind: arrays of SciPy refuse to be compared with one.
        if not isinstance(data, Mapping) or not isinstance(data.get("common"), str):
            return data
        if data["common"] != "factor":
            return data
        return {key: _factors(one, key) if key in UNITS else one for key, one in data.items()}


_Contacts = Annotated[
    Contacts,
    Or(Some[NamedContact], "Contacts", "int, str, (contact, int), or iterable of these"),
]


class ContactKeys(ParameterMode):
    """Which contacts have a parameter in common."""

    contacts: _Contacts | None = Field(
        default=None,
        description="The contacts that take the value, or points of them as (contact, point). Of "
        "a contact with several points the slip forces that are finite, unless none is. Default: "
        "all contacts; of slip forces those that are finite, unless none is.",
    )


class Variation(ParameterMode):
    """What is varied."""

    parameter: Annotated[Swept, ONE_OF] = Field(
        description="A parameter of contacts, or a factor on the forces that vary."
    )
    contacts: Annotated[tuple[Chosen, ...], Strict(False)] = Field(
        default=(),
        description="Names of the contacts whose parameter it is, or points of them as (name, "
        "point); none for a level.",
    )
    other_unit: str = Field(
        default="",
        description="Unit of the parameter, if it is not that which other contacts have it in.",
    )

    @property
    def names(self) -> tuple[str, ...]:
        """What is varied in words: names of contacts, points as "structural[0]"."""
        return written(self.contacts)

    def varied(self, model: Model) -> _core.Varied:
        """Return the variation as the compiled core takes it; refuse a model without a contact."""
        return {
            "parameter": self.parameter,
            "contacts": [law for ref in self.contacts for law in _laws(model, ref)],
            "factor": self.common == "factor",
        }

    @property
    def unit(self) -> str:
        """Unit of the parameter."""
        if self.common == "factor":
            return "1"
        return self.other_unit or UNITS[self.parameter]

    @property
    def behind(self) -> str:
        """What stands behind a value in a text: the unit, or nothing of a ratio."""
        return "" if self.unit == "1" else f" {self.unit}"

    @property
    def heading(self) -> str:
        """The parameter with its unit, as tables are headed."""
        return self.parameter if self.unit == "1" else f"{self.parameter} [{self.unit}]"

    def apply(self, model: Model, value: float) -> Model:
        """Return the model at a value of the parameter, or at a factor; contacts may refuse it."""
        if self.parameter == "level":
            return model.scaled(force=value)

        return with_parameter(
            model, self.parameter, self.contacts, lambda own: self._at(value, own)
        )

    def _at(self, value: float, own: float) -> float:
        """Return what becomes of a value; what never slips does so under every factor."""
        if self.common == "value":
            return value
        return own if np.isinf(own) else value * own


def with_parameter(
    model: Model, parameter: str, contacts: Iterable[Chosen], of: Callable[[float], float]
) -> Model:
    """Return the model with other values of a parameter of contacts, or of points of them.

    `of` makes a value from what the contact has.
    """

    def changed(contact: Contact) -> Contact:
        chosen = [ref for ref in contacts if _name(ref) == contact.name]
        if not chosen:
            return contact
        values = list(contact.variable()[parameter])
        for ref in chosen:
            for point in range(len(values)) if isinstance(ref, str) else [ref[1]]:
                values[point] = of(values[point])
        return contact.adjusted(parameter, values)

    return model.replaced(contacts=[changed(contact) for contact in model.contacts])


def _factors(given: Any, entry: str) -> Any:
    """Return what is given, numbers, texts or a range, with texts read as plain factors."""
    if isinstance(given, Mapping):
        return {key: _factors(one, f"{entry}.{key}") for key, one in given.items()}
    try:
        return without_units(given, "", entry)
    except EntryError as error:
        raise ModelError(
            f"{error}, for common = 'factor' multiplies the contacts' own; leave it out to give "
            "values"
        ) from None


def one_of(keys: Settings, *names: Swept) -> Swept:
    """Return which of some keys is given: exactly one of them."""
    given = [name for name in names if getattr(keys, name) is not None]
    if len(given) != 1:
        got = f"{' and '.join(given)} are given" if given else "none is given"
        raise ModelError(f"{', '.join(names)}: {got}; give exactly one of them")
    return given[0]


def written(contacts: Iterable[Chosen]) -> tuple[str, ...]:
    """Return contacts, and points of them as "structural[0]"."""
    return tuple(ref if isinstance(ref, str) else f"{ref[0]}[{ref[1]}]" for ref in contacts)


def _name(ref: Chosen) -> str:
    return ref if isinstance(ref, str) else ref[0]


def _laws(model: Model, ref: Chosen) -> list[tuple[int, int | None]]:
    """Return the laws of the core that belong to a contact, each with a part of it or None."""
    number, point = located(model, ref)
    if not model.contacts[number].by_point:
        return [(model.law_index(number), point)]
    points = range(model.contacts[number].points) if point is None else [point]
    return [(model.law_index(number, one), None) for one in points]


def located(model: Model, ref: Chosen) -> tuple[int, int | None]:
    """Return the position of a contact, and of one of its points if one is meant."""
    return (model.contact_index(ref), None) if isinstance(ref, str) else model.slider(ref)
