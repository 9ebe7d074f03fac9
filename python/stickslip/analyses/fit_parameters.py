"""The parameters of a fit: which numbers of models they are, and how they are scaled."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from stickslip.analyses.variation import chosen_contacts
from stickslip.checks import listed, unknown
from stickslip.errors import EntryError, ModelError
from stickslip.model import Model
from stickslip.model.contact import Contact, of_one_unit
from stickslip.model.damping import ModalDamping, Rayleigh
from stickslip.model.structure import Structure
from stickslip.results.fields import Float
from stickslip.settings.variation import (
    Chosen,
    Common,
    located,
    with_parameter,
    written,
)
from stickslip.units import without_units

DAMPING = "damping"
LEVEL = "level"
LOAD = "load"

_DAMPING_KEYS = {ModalDamping: ("ratio",), Rayleigh: ("mass", "stiffness")}


@dataclass(frozen=True)
class FitParameter:
    """A number that is fitted, between two bounds.

    Its name is "pad.friction"; "friction", of all contacts that have it; "damping.ratio",
    "damping.mass", "damping.stiffness", of the law of the structure's damping; "level", a factor on
    the forces that vary; "load", a factor on the static ones.
    """

    name: str
    low: float
    high: float

    @property
    def owner(self) -> str:
        """The contact, "damping", or nothing."""
        return self.name.rpartition(".")[0]

    @property
    def key(self) -> str:
        """The name of the parameter as its owner has it."""
        return self.name.rpartition(".")[2]

    @property
    def is_damping(self) -> bool:
        """Whether it belongs to the damping of the structure."""
        return self.owner == DAMPING

    @property
    def logarithmic(self) -> bool:
        """Whether its logarithm is fitted: of numbers that are above 0."""
        return self.low > 0.0

    def value(self, scaled: float) -> float:
        """Return the value of a number between 0 and 1."""
        if self.logarithmic:
            return float(self.low * (self.high / self.low) ** scaled)
        return self.low + (self.high - self.low) * scaled

    def scaled(self, value: float) -> float:
        """Return the number that a value stands for, 0 and 1 at the bounds."""
        if self.logarithmic:
            return float(np.log(value / self.low) / np.log(self.high / self.low))
        return (value - self.low) / (self.high - self.low)

    def rate(self, value: float) -> float:
        """Return the derivative of the value in the scaled number."""
        if self.logarithmic:
            return float(value * np.log(self.high / self.low))
        return self.high - self.low

    def require(self, model: Model) -> None:
        """Refuse a model that has no such parameter, or none that takes both bounds."""
        for value in (self.low, self.high):
            self.apply(model, value)

    def apply(self, model: Model, value: float) -> Model:
        """Return the model at a value of the parameter."""
        try:
            if self.name == LEVEL:
                return model.scaled(force=value)
            if self.name == LOAD:
                return _loaded(model, value)
            if self.is_damping:
                return model.with_structure(_damped(model.structure, self.key, value))
            return with_parameter(model, self.key, self._chosen(model), lambda _: value)
        except ModelError as error:
            raise ModelError(f"parameters: {self.name!r}: {error}") from None

    def _chosen(self, model: Model) -> tuple[Chosen, ...]:
        """Return the contacts that take its value: those that a damper curve would choose."""
        owners = [one for one in model.contacts if self.owner in ("", one.name)]
        if not owners:
            raise ModelError(unknown("contact", self.owner, [*model.contact_names, DAMPING]))
        having: Sequence[Contact] = [one for one in owners if self.key in one.adjustable()]
        if not having:
            known = dict.fromkeys(key for one in owners for key in one.adjustable())
            raise ModelError(unknown("parameter", self.key, known))
        having = of_one_unit(having, self.key)
        factors = [str(one.name) for one in having if self.key in one.factors]
        if 0 < len(factors) < len(having):
            values = [str(one.name) for one in having if self.key not in one.factors]
            raise ModelError(
                f"it is a factor on a matrix in {listed(factors)} and a value in {listed(values)}; "
                f"name one contact, as {f'{values[0]}.{self.key}'!r}"
            )
        common: Common = "factor" if factors else "value"
        return chosen_contacts(model, self.key, self.owner or None, common)

    def other_unit(self, model: Model) -> str:
        """Say what it is instead of a value in the unit of its name, "" if it is such a value."""
        if self.is_damping or self.name in (LEVEL, LOAD):
            return ""
        contact = model.contacts[located(model, self._chosen(model)[0])[0]]
        if self.key in contact.factors:
            return "a factor on a matrix"
        unit = contact.other_units.get(self.key, "")
        return f"in {unit}" if unit else ""

    def reached(self, model: Model) -> set[tuple[str, str]]:
        """Return what it sets in a model: contacts or their points, each with the parameter."""
        if self.is_damping or self.name in (LEVEL, LOAD):
            return {(self.owner, self.key)}
        return {(one, self.key) for one in written(self._chosen(model))}


def require_unit(model: Model, name: str, values: Iterable[object]) -> None:
    """Refuse values with a unit of a parameter that is a factor, or in another unit."""
    reason = FitParameter(name, 0.0, np.inf).other_unit(model)
    if not reason:
        return
    try:
        without_units(list(values), "", f"parameters[{name!r}]")
    except EntryError as error:
        raise ModelError(f"{error}, for it is {reason}") from None


def require_distinct(model: Model, names: Iterable[str], entry: str = "parameters") -> None:
    """Refuse two parameters that set the same number of a model."""
    found: dict[tuple[str, str], str] = {}
    for name in names:
        try:
            places = FitParameter(name, 0.0, np.inf).reached(model)
        except ModelError as error:
            raise ModelError(f"{entry}: {name!r}: {error}") from None
        for place in places:
            if place in found:
                raise ModelError(
                    f"{entry}: {found[place]!r} and {name!r} both set {'.'.join(place)!r}; "
                    "leave out one of them"
                )
            found[place] = name


def applied(model: Model, parameters: Sequence[FitParameter], values: Float) -> Model:
    """Return the model at values of all parameters."""
    for parameter, value in zip(parameters, values, strict=True):
        model = parameter.apply(model, float(value))
    return model


def _loaded(model: Model, factor: float) -> Model:
    if all(one.harmonic for one in model.forces):
        raise ModelError(
            "the model has no static load; give it a ss.Force(..., harmonic=0)",
            study="the model has no static load; give a [[force]] with harmonic = 0",
        )
    return model.scaled(load=factor)


def _damped(structure: Structure, key: str, value: float) -> Structure:
    law = structure.damping_law
    known = _DAMPING_KEYS.get(type(law), ()) if law is not None else ()
    if law is None or key not in known:
        made = "a matrix, which has no parameters" if law is None else type(law).__name__
        reason = unknown("parameter", key, known) if known else "give ModalDamping or Rayleigh"
        raise ModelError(f"the damping of the structure is {made}; {reason}")
    changed = replace(law, **{key: value})  # type: ignore[arg-type]
    damped = Structure(structure.mass, structure.stiffness, changed, structure.dofs)
    return damped.made_of(structure)
