"""Checks of the arguments of analyses: lists of numbers, degrees of freedom, preload."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from stickslip.calls import outside
from stickslip.checks import brief, unknown
from stickslip.disk.bladed_disk import ALL_SECTORS
from stickslip.errors import ModelError
from stickslip.model import ContactLaw, Model, natural_frequencies
from stickslip.model.notable import loaded_dofs, massless_dofs, physical_dofs
from stickslip.model.state import State
from stickslip.results.fields import Int
from stickslip.settings.balance import BalanceKeys, HarmonicSettings, ObserveKeys
from stickslip.settings.entries import Residual


def require_time(model: Model) -> None:
    """Refuse one sector of a travelling wave, which has no motion of its own in time."""
    if model.travels:
        reason = "one sector of a travelling wave, which has no motion of its own in time"
        raise ModelError(
            f"model: a tuned BladedDisk is {reason}; give all sectors, disk.mistuned(0)",
            study=f"disk: a tuned disk is {reason}; compute all sectors, {ALL_SECTORS}",
        )


def require_lowest(model: Model, mode: int) -> None:
    """Refuse the lowest mode where the structure is statically unstable with all contacts stuck."""
    if not mode and not model.travels and model.structure.unstable_dof is not None:
        natural_frequencies(model)


def require_onset(model: Model) -> None:
    """Refuse laws in Python alone: they do not say where their slip, and limit cycles, begin."""
    slipping = [one for one in model.contacts if one.slips]
    own = [one for one in slipping if isinstance(one, ContactLaw)]
    if own and len(own) == len(slipping):
        reason = (
            f"contact {own[0].name!r}: the law {own[0].law!r} is written in Python and does not "
            "say at which force it begins to slip, from where limit cycles are followed"
        )
        raise ModelError(
            f"{reason}; take them of a mode, nonlinear_modes(model, ...).limit_cycles("
            "negative_damping, ratio)"
        )


def driving_dofs(
    model: Model, dofs: tuple[str, ...], outputs: Iterable[str] | str, *, named: bool
) -> Int:
    """Return the positions among `dofs` of those that automatic harmonics and steps follow.

    All, if they were named; else the outputs and those with a force or a contact. None are all.
    Those without mass move with kinks, which ask for far more harmonics than what they press on.
    """
    shown = {outputs} if isinstance(outputs, str) else set(outputs)
    for name in sorted(shown - set(dofs)):
        raise ModelError(f"outputs: {unknown('dof', name, dofs)}")
    followed = set() if named else shown | (set(loaded_dofs(model)) - set(massless_dofs(model)))
    driving = [position for position, dof in enumerate(dofs) if dof in followed]
    return np.array(driving, dtype=np.int64)


def observed_dofs(keys: ObserveKeys, model: Model) -> tuple[str, ...]:
    """Return the degrees of freedom to observe, by default all but modal coordinates."""
    if keys.observe is None:
        return physical_dofs(model)
    return known_dofs(keys.observe, "observe", "dof", model)


def warn_of_effort(keys: BalanceKeys, model: Model, dofs: tuple[str, ...]) -> None:
    """Say before long work begins that it is long: every named modal coordinate has to converge."""
    modal = set(dofs) - set(physical_dofs(model))
    several = isinstance(keys.omega, tuple) or keys.omega.size > 1
    if modal and model.contacts and several and keys.fixed_harmonics is None:
        warnings.warn(
            f"observe names modal coordinates, {len(modal)} of them: with harmonics='auto' each "
            "has to meet the tolerance at every point, which may take a hundred times as long; "
            "leave them out of the curve, and compute the one point that needs them with a number "
            "of harmonics",
            stacklevel=outside(),
        )


def known_dofs(names: Iterable[str], entry: str, kind: str, model: Model) -> tuple[str, ...]:
    """Return names of degrees of freedom that the model has."""
    known = model.structure.dofs
    for name in names:
        if name not in known:
            raise ModelError(f"{entry}: {unknown(kind, name, known)}")
    return tuple(names)


def columns_of(dofs: Iterable[str], model: Model) -> Int:
    """Return the positions of degrees of freedom in the structure."""
    return np.array([model.structure.index(dof) for dof in dofs], dtype=np.int64)


def points_of(model: Model) -> int:
    """Return the number of relative displacements at the contacts."""
    return sum(contact.displacements for contact in model.contacts)


def highest_harmonic(model: Model) -> int:
    """Return the highest harmonic of the forces, at least 1."""
    return max((1, *(force.harmonic for force in model.forces)))


def state_of(model: Model, start: object, entry: str) -> State:
    """Return a start as a state of the model; displacements alone are one, too."""
    if isinstance(start, Mapping):
        return State(model, displacement=start)
    if not isinstance(start, State):
        raise ModelError(
            f"{entry}: {brief(start)} is no state; give ss.State(model, ...), the final state of "
            "another run, or {dof: displacement}"
        )
    start.require_fit(model, entry)
    return start


def require_forced(model: Model, settings: HarmonicSettings) -> None:
    """Refuse to leave out the harmonic of a force."""
    highest = settings.highest
    for position, force in enumerate(model.forces, start=1):
        if force.harmonic > highest and force.amplitude:
            raise ModelError(
                f"{settings.bound}: {highest} would leave out force {position} at {force.dof!r}, "
                f"of harmonic {force.harmonic}; give at least {force.harmonic}, or drop the force"
            )


def require_held(model: Model, residual: Residual | None) -> None:
    """Refuse a static load that nothing, or only contacts of prescribed mean force, would hold.

    Refused as well is a residual force where no contact could hold it: dampers of several points
    hold what they built up.
    """
    if (
        not isinstance(residual, str)
        and residual
        and model.contacts
        and all(contact.points > 1 for contact in model.contacts)
    ):
        raise ModelError(
            f"residual: {residual:g} N is for contacts of one point, and the model has none; "
            "leave it out"
        )
    static = [
        (n, one)
        for n, one in enumerate(model.forces, start=1)
        if not one.harmonic and one.amplitude
    ]
    if not static:
        return
    position, force = static[0]
    entry = f"force {position} at {force.dof!r}: a static load of {force.amplitude:g} N"
    if model.problem.static_singular:
        raise ModelError(
            f"{entry} on a structure that moves freely even with all contacts stuck; ground the "
            "structure or leave the static load out"
        )
    load = np.zeros(len(model.structure))
    for _, force in static:
        load[model.structure.index(force.dof)] += force.amplitude
    friction = any(contact.slips for contact in model.contacts)
    prescribed = friction and residual != "from_rest" and bool(load.any())
    _, _, stiffness = model.matrices_at(0)
    if prescribed and not _holds(stiffness.real, load):
        raise ModelError(
            f"{entry} rests on contacts alone, whose mean force residual={residual!r} prescribes; "
            'use residual="from_rest" or ground the structure'
        )


def _holds(stiffness: NDArray[np.float64], load: NDArray[np.float64]) -> bool:
    """Whether a stiffness matrix has an equilibrium under a load."""
    try:
        displacement = np.linalg.solve(stiffness, load)
    except np.linalg.LinAlgError:
        return False
    # A singular matrix that rounding made regular answers with a displacement of no digits.
    rounding = np.finfo(np.float64).eps * np.linalg.norm(stiffness) * np.linalg.norm(displacement)
    return bool(rounding < 1e-3 * np.linalg.norm(load))
