"""The two linear limits of a friction-damped structure: every contact stuck, or every one free."""

from __future__ import annotations

from weakref import WeakKeyDictionary

import numpy as np

from stickslip.analyses.forced_response import forced_response
from stickslip.errors import ModelError
from stickslip.model import Model, natural_frequencies
from stickslip.model.damping import held_stiffness
from stickslip.model.structure import Structure
from stickslip.results.arrays import Measure
from stickslip.results.fields import Float

_POINTS = 400
# Points beside each resonance, so that a damping ratio down to 1e-4 still shows its peak.
_NEAR = np.geomspace(1e-6, 0.05, 30)
# Limits by (stuck, static), as long as their models live: their modes cost most of a drawing.
_KNOWN: WeakKeyDictionary[Model, dict[tuple[bool, bool], tuple[Model, Float]]] = WeakKeyDictionary()


def force_level(model: Model) -> float:
    """Return the largest amplitude among the harmonic forces [N]; 0 without any."""
    return max((abs(force.amplitude) for force in model.forces if force.harmonic), default=0.0)


def unit_level(model: Model) -> float:
    """Return the same, by which amplitudes are divided; refuse a model without any."""
    level = force_level(model)
    if level == 0.0:
        raise ModelError(
            'normalise: "force" needs a harmonic force, and a result has none; use None'
        )
    return level


def limit_model(model: Model, *, stuck: bool) -> Model:
    """Return the linear model with all contacts stuck, or none, as at small or large amplitude.

    Contacts of infinite slip force stick in both limits, those of zero slip force in none. They
    are part of its structure; of a `BladedDisk` they stay contacts, which never slip.
    """
    structure = model.structure
    held = (contact.linear_limit(stuck=stuck) for contact in model.contacts)
    sticking = [one for one in held if one is not None]
    if model.travels:
        # A contact between sectors has no place in the matrices of one: it never slips instead.
        return model.replaced(contacts=sticking)
    stiffness = held_stiffness(structure.stiffness, structure, sticking)
    linear = Structure(structure.mass, stiffness, structure.damping, structure.dofs)
    return Model(linear, forces=model.forces)


def limit_curve(
    model: Model, dof: str, span: tuple[float, float], measure: Measure, *, stuck: bool
) -> tuple[Float, Float]:
    """Return the response curve of a linear limit: frequencies [rad/s] and amplitudes [m].

    It is refused if the measure is "max" and a static load pushes the limit structure away.
    """
    linear, resonances = _linear(model, stuck=stuck, static=measure == "max")
    harmonics = max((force.harmonic for force in linear.forces), default=1) or 1
    omega = _frequencies(resonances, span)
    result = forced_response(linear, omega, harmonics, observe=[dof], max_harmonics=harmonics)
    return result.omega, result.amplitude(dof, measure)


def _linear(model: Model, *, stuck: bool, static: bool) -> tuple[Model, Float]:
    """Return the limit with its resonances [rad/s]; its modes are computed once per model."""
    known = _KNOWN.setdefault(model, {})
    if (stuck, static) not in known:
        linear = limit_model(model, stuck=stuck)
        if not static:
            # They move the mean only, and a free structure may have no equilibrium under them.
            dynamic = [force for force in linear.forces if force.harmonic]
            linear = linear.replaced(forces=dynamic)
        forced = sorted({force.harmonic for force in linear.forces if force.harmonic}) or [1]
        known[stuck, static] = (
            linear,
            np.concatenate(
                [natural_frequencies(linear, nodal_diameter=linear.diameter(k)) / k for k in forced]
            ),
        )
    return known[stuck, static]


def _frequencies(resonances: Float, span: tuple[float, float]) -> Float:
    low, high = span
    resonances = resonances[(resonances > low) & (resonances < high)]
    near = np.concatenate([1.0 - _NEAR, 1.0 + _NEAR])
    omega = np.union1d(np.linspace(low, high, _POINTS), np.outer(resonances, near).ravel())
    omega = omega[(omega >= low) & (omega <= high)]
    if resonances.size:
        # An undamped resonance has no amplitude.
        distance = np.abs(omega[:, None] / resonances - 1.0).min(axis=1)
        omega = omega[distance > 0.5 * _NEAR[0]]
    return np.asarray(omega, dtype=np.float64)
