"""A family of models with one parameter: slip force, stiffness, or level of the forces."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np

from stickslip.analyses.arguments import Span
from stickslip.checks import brief, choice, listed, unknown, whole_number
from stickslip.errors import ModelError
from stickslip.model import ContactRef, Model, natural_frequencies
from stickslip.model.contact import Contact
from stickslip.results.arrays import Float

__all__ = [
    "PARAMETERS",
    "Common",
    "Parameter",
    "Variation",
    "chosen_contacts",
    "local_stiffness",
    "resonance_range",
]

Parameter: TypeAlias = Literal["slip_force", "stiffness", "level"]
Common: TypeAlias = Literal["value", "factor"]

PARAMETERS: tuple[Parameter, ...] = get_args(Parameter)
"""What can be varied: a parameter of the contacts, or a factor on all forces."""

MARGIN = 0.05
"""Share by which the range around a resonance reaches beyond its free and its stuck frequency."""


@dataclass(frozen=True, kw_only=True)
class Variation:
    """What is varied.

    Parameters
    ----------
    parameter : {"slip_force", "stiffness", "level"}
        A parameter of contacts, or a factor on all forces.
    contacts : tuple of str
        Names of the contacts whose parameter it is; none for a level.
    common : {"value", "factor"}
        Whether they all take the value, or multiply their own by it.

    Raises
    ------
    ModelError
        If a value is none of these.
    """

    parameter: Parameter
    contacts: tuple[str, ...] = ()
    common: Common = "value"

    def __post_init__(self) -> None:
        choice(self.parameter, "parameter", PARAMETERS)
        choice(self.common, "common", get_args(Common))
        object.__setattr__(self, "contacts", tuple(self.contacts))

    @property
    def unit(self) -> str:
        """Unit of the parameter."""
        if self.common == "factor":
            return "1"
        return {"slip_force": "N", "stiffness": "N/m", "level": "1"}[self.parameter]

    def apply(self, model: Model, value: float) -> Model:
        """Return the model at a value of the parameter.

        Parameters
        ----------
        model : Model
            The model as it is.
        value : float
            The value, or the factor.

        Returns
        -------
        Model
            A new model.

        Raises
        ------
        ModelError
            If a contact refuses the value.
        """
        if self.parameter == "level":
            return model.scaled(force=value)

        def changed(contact: Contact) -> Contact:
            if contact.name not in self.contacts:
                return contact
            own = contact.parameters()
            new = value * own[self.parameter] if self.common == "factor" else value
            parameters = {**own, self.parameter: new}
            return type(contact).from_parameters(contact.dofs, parameters, contact.name)

        return model.replaced(contacts=[changed(contact) for contact in model.contacts])


def chosen_contacts(
    contacts: Iterable[ContactRef] | ContactRef | None, parameter: Parameter, model: Model
) -> tuple[str, ...]:
    """Return the names of the contacts whose parameter is varied.

    Parameters
    ----------
    contacts : iterable of int or str, or None
        The contacts. Default: all that have the parameter; of slip forces those that are finite,
        unless none is.
    parameter : {"slip_force", "stiffness", "level"}
        What is varied.
    model : Model
        Whose contacts they are.

    Returns
    -------
    tuple of str
        None for a level.

    Raises
    ------
    ModelError
        If there is no such contact, or one without the parameter; if there is none at all.
    """
    if parameter == "level":
        if contacts is not None:
            raise ModelError("contacts: a level is no parameter of contacts; leave them out")
        return ()
    if contacts is None:
        able = [one for one in model.contacts if parameter in one.parameters()]
        slips = [one for one in able if one.parameters().get("slip_force", 0.0) < np.inf]
        chosen = slips if parameter == "slip_force" and slips else able
        if not chosen:
            raise ModelError(f"contacts: none of the model has a {parameter}; add one to the model")
        return tuple(str(one.name) for one in chosen)
    refs = [contacts] if isinstance(contacts, str | int) else contacts
    if not isinstance(refs, Iterable):
        raise ModelError(f"contacts: {brief(contacts)} is not a list of contacts")
    positions = [model.contact_index(ref) for ref in refs]
    if not positions:
        raise ModelError("contacts: empty; name at least one, or leave it out for all")
    for position in positions:
        known = model.contacts[position].parameters()
        if parameter not in known:
            name = model.contact_names[position]
            raise ModelError(f"contact {name!r}: {unknown('parameter', parameter, known)}")
    if len(set(positions)) < len(positions):
        names = [model.contact_names[position] for position in positions]
        raise ModelError(f"contacts: one is given more than once in {listed(names)}")
    return tuple(model.contact_names[position] for position in positions)


def resonance_range(model: Model, variation: Variation, mode: int, values: Float) -> Span:
    """Return the range of frequencies between the free and the stuck resonance of a mode.

    Parameters
    ----------
    model : Model
        The model.
    variation : Variation
        What is varied.
    mode : int
        The mode, counted from 0.
    values : ndarray of float64
        Values of the parameter; stiffnesses move the stuck frequency.

    Returns
    -------
    (float, float)
        From 5 % below the free natural frequency, or a twentieth of the stuck one if the free
        structure moves as a rigid body, to 5 % above the highest stuck one [rad/s]; both over the
        lowest harmonic of the forces.

    Raises
    ------
    ModelError
        If there is no such mode, or the structure has no resonance there.
    """
    count = len(model.structure)
    position = whole_number(mode, "mode")
    if position >= count:
        raise ModelError(f"mode: {position}; the structure has {count}, counted from 0")
    members = [model]
    if variation.parameter == "stiffness":
        members = [variation.apply(model, value) for value in (min(values), max(values))]
    stuck = max(float(natural_frequencies(one)[position]) for one in members)
    points = [
        (number, point)
        for number, contact in enumerate(model.contacts)
        for point in range(contact.points)
    ]
    free = float(natural_frequencies(model, points)[position])
    harmonic = min((force.harmonic for force in model.forces if force.harmonic), default=1)
    low = max((1.0 - MARGIN) * min(free, stuck), MARGIN * stuck) / harmonic
    high = (1.0 + MARGIN) * max(free, stuck) / harmonic
    if not 0.0 < low < high:
        raise ModelError(
            f"omega: mode {position} is a motion without stiffness even with all contacts stuck; "
            "give omega=(from, to)"
        )
    return low, high


def local_stiffness(model: Model, contacts: Iterable[str]) -> float:
    """Return the largest stiffness that the structure itself opposes to a force at a contact.

    Parameters
    ----------
    model : Model
        The model.
    contacts : iterable of str
        Names of contacts.

    Returns
    -------
    float
        Inverse static flexibility without any contact; where the structure is not grounded, the
        stiffness with all other degrees of freedom held [N/m].
    """
    structure = model.structure
    rows = np.concatenate(
        [model.contacts[model.contact_index(name)].rows(structure) for name in contacts]
    )
    held: Float = np.einsum("ij,jk,ik->i", rows, structure.stiffness, rows)
    try:
        moved = np.linalg.solve(structure.stiffness, rows.T)
        flexibility = np.einsum("ij,ji->i", rows, moved)
    except np.linalg.LinAlgError:
        return float(held.max())
    # Of a structure that is nearly free, rounding decides.
    known = (flexibility > 0.0) & (flexibility * held < 1e10)
    return float(np.where(known, 1.0 / np.where(known, flexibility, 1.0), held).max())
