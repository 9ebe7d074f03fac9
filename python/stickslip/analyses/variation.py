"""A family of models with one parameter: slip force, stiffness, or level of the forces."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from operator import methodcaller
from typing import Any, TypeAlias

import numpy as np

from stickslip.checks import as_list, brief, listed, unknown
from stickslip.disk.mistuned import MistunedDisk
from stickslip.errors import ModelError
from stickslip.model import Model, PointRef, natural_frequencies
from stickslip.model.configurations import every_point
from stickslip.model.contact import Contact, of_one_unit
from stickslip.results.fields import Float
from stickslip.settings.entries import Span
from stickslip.settings.variation import (
    Chosen,
    Common,
    ContactKeys,
    Contacts,
    Swept,
    Variation,
    located,
    written,
)

MARGIN = 0.05
"""Share by which the range around a resonance reaches beyond its free and its stuck frequency."""


Known: TypeAlias = Callable[[Contact], Mapping[str, tuple[float, ...]]]
"""The parameters of a contact that can be varied: what is `adjustable`, or `variable` in sweeps."""
_ADJUSTABLE: Known = methodcaller("adjustable")


def variation_of(
    model: Model, parameter: Swept, keys: ContactKeys, known: Known = _ADJUSTABLE
) -> Variation:
    """Return the variation of a parameter of contacts, or of points of them."""
    chosen = chosen_contacts(model, parameter, keys.contacts, keys.common, known)
    owners = [model.contacts[located(model, ref)[0]] for ref in chosen]
    units = {one.other_units.get(parameter, "") for one in owners}
    if len(units) > 1 and keys.common == "value":
        raise ModelError(
            f"contacts: the {parameter} of {listed(written(chosen))} has several units; name "
            'contacts of one, or give common="factor"'
        )
    own = min(units, default="")
    return Variation.of(parameter=parameter, contacts=chosen, common=keys.common, other_unit=own)


def chosen_contacts(
    model: Model,
    parameter: str,
    contacts: Contacts | None,
    common: Common,
    known: Known = _ADJUSTABLE,
) -> tuple[Chosen, ...]:
    """Return the contacts whose parameter is varied, by name, or points of them; None are all."""
    if parameter == "level":
        if contacts is not None:
            raise ModelError("contacts: a level is no parameter of contacts; leave them out")
        return ()
    if contacts is None:
        return _all_contacts(parameter, model, common, known)
    point = isinstance(contacts, tuple) and [type(part) for part in contacts] == [str, int]
    one = isinstance(contacts, str | int) or point
    given: tuple[Any, ...] | None = (contacts,) if one else as_list(contacts)
    if given is None:
        raise ModelError(f"contacts: {brief(contacts)} is not a list of contacts")
    if not given:
        raise ModelError("contacts: empty; name at least one, or leave it out for all")
    chosen = [one for ref in given for one in _chosen(ref, parameter, model, common, known)]
    if len(set(chosen)) < len(chosen):
        names = written(chosen)
        raise ModelError(f"contacts: one is given more than once in {listed(names)}")
    return tuple(chosen)


def _all_contacts(parameter: str, model: Model, common: Common, known: Known) -> tuple[Chosen, ...]:
    """Return the contacts that have the parameter; of slip forces those that are finite, if any."""
    able = [one for one in model.contacts if parameter in known(one)]
    if not able:
        names = dict.fromkeys(name for one in model.contacts for name in known(one))
        has = f"they have {listed(list(names))}" if names else "add one to the model"
        raise ModelError(f"contacts: none of the model has a {parameter}; {has}")
    taking = [one for one in able if common == "factor" or parameter not in one.factors]
    if not taking:
        raise _without_value(str(able[0].name), parameter)
    taking = taking if common == "factor" else list(of_one_unit(taking, parameter))
    slips = [one for one in taking if min(known(one)[parameter]) < np.inf]
    chosen = slips if parameter == "slip_force" and slips else taking
    return tuple(ref for one in chosen for ref in _points(one, parameter, known))


def _chosen(
    ref: PointRef, parameter: str, model: Model, common: Common, known: Known
) -> tuple[Chosen, ...]:
    """Return the contact that is meant, or the points of it that have a value each."""
    position, point = model.slider(ref) if isinstance(ref, tuple | list) else (ref, None)
    contact = model.contacts[model.contact_index(position)]
    own, name = known(contact), str(contact.name)
    if parameter not in own:
        raise ModelError(f"contact {name!r}: {unknown('parameter', parameter, own)}")
    if parameter in contact.factors and common == "value":
        raise _without_value(name, parameter)
    if point is None:
        return _points(contact, parameter, known)
    if len(own[parameter]) == contact.sliders:
        return (name,) if len(own[parameter]) == 1 else ((name, point),)
    raise ModelError(
        f"contact {name!r}: its {parameter} is that of the whole contact; name it without a point"
    )


def _points(contact: Contact, parameter: str, known: Known) -> tuple[Chosen, ...]:
    """Return a contact, or its points if each has a value; those that are finite, if any."""
    own, name = known(contact)[parameter], str(contact.name)
    if len(own) == 1:
        return (name,)
    finite = [point for point, value in enumerate(own) if np.isfinite(value)]
    return tuple((name, point) for point in finite or range(len(own)))


def _without_value(name: str, parameter: str) -> ModelError:
    return ModelError(
        f"contact {name!r}: its {parameter} is that of several parts, which takes no value; "
        'common="factor" multiplies it'
    )


def resonance_range(model: Model, variation: Variation, mode: int, values: Float) -> Span:
    """Return the range of frequencies between the free and the stuck resonance of a mode.

    From 5 % below the free natural frequency, or a twentieth of the stuck one if the free structure
    moves as a rigid body, to 5 % above the highest stuck one [rad/s]; both over the lowest harmonic
    of the forces, at the nodal diameter at which it meets a tuned disk. Of a mistuned disk a mode
    is that of every blade. `values` of a stiffness move the stuck frequency.
    """
    members = [model]
    if variation.parameter.endswith("stiffness"):
        members = [variation.apply(model, value) for value in (min(values), max(values))]
    harmonic = min((force.harmonic for force in model.forces if force.harmonic), default=1)
    stuck = [_of_mode(one, mode, harmonic) for one in members]
    free = _of_mode(model, mode, harmonic, every_point(model))
    every = np.concatenate([*stuck, free])
    low = max((1.0 - MARGIN) * every.min(), MARGIN * np.max(stuck)) / harmonic
    high = (1.0 + MARGIN) * every.max() / harmonic
    if not 0.0 < low < high:
        reason = (
            f"omega: mode {mode} is a motion without stiffness even with all contacts stuck; give"
        )
        raise ModelError(
            f"{reason} omega=(from, to)", study=f"{reason} omega = {{from = ..., to = ...}}"
        )
    return low, high


def _of_mode(model: Model, mode: int, harmonic: int, slipping: Iterable[PointRef] = ()) -> Float:
    """Return the natural frequency of a mode [rad/s]; of a mistuned disk those of all blades."""
    found = natural_frequencies(model, slipping, nodal_diameter=model.diameter(harmonic))
    blades = len(model.blades) if isinstance(model, MistunedDisk) else 1
    if (mode + 1) * blades > found.size:
        raise ModelError(f"mode: {mode}; the structure has {found.size // blades}, counted from 0")
    return found[mode * blades : (mode + 1) * blades]


def local_stiffness(model: Model, contacts: Iterable[Chosen]) -> float:
    """Return the largest stiffness that the structure itself opposes to a force at a contact [N/m].

    It is the inverse static flexibility without any contact; where the structure is not grounded,
    the stiffness with all other degrees of freedom held.
    """
    stiffness = model.structure.stiffness
    chosen = [model.contact_rows(model.contacts[located(model, ref)[0]]) for ref in contacts]
    # A contact between sectors of a disk has rows on both.
    parts = [np.concatenate(rows) for rows in zip(*chosen, strict=True)]
    held: Float = sum(np.einsum("ij,jk,ik->i", rows, stiffness, rows) for rows in parts)
    try:
        flexibility = sum(
            np.einsum("ij,ji->i", rows, np.linalg.solve(stiffness, rows.T)) for rows in parts
        )
    except np.linalg.LinAlgError:
        return float(held.max())
    # Of a structure that is nearly free, rounding decides.
    known = (flexibility > 0.0) & (flexibility * held < 1e10)
    return float(np.where(known, 1.0 / np.where(known, flexibility, 1.0), held).max())
