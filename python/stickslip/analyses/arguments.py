"""Checks of the arguments of analyses: frequencies, degrees of freedom, preload."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import brief, text, unknown
from stickslip.disk.bladed_disk import ALL_SECTORS
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.settings.balance import HarmonicSettings
from stickslip.settings.entries import Residual, Span, span_of

__all__ = [
    "Progress",
    "driving_dofs",
    "grid_of",
    "loaded_dofs",
    "observed_dofs",
    "physical_dofs",
    "prepare",
    "require_forced",
    "require_held",
    "require_model",
    "require_progress",
    "require_time",
]

_MODAL = re.compile(r"(.*\.)?mode-\d+")

Progress: TypeAlias = Callable[[float], None] | None


def require_model(model: object) -> None:
    """Refuse what is no `Model`."""
    if not isinstance(model, Model):
        raise ModelError(f"model: {brief(model)} is not a Model; give ss.Model(structure, ...)")


def prepare(model: Model) -> None:
    """Decompose a model while Ctrl-C still ends an analysis at any line: nothing is lost yet."""
    _ = model.problem


def require_time(model: Model) -> None:
    """Refuse one sector of a travelling wave, which has no motion of its own in time."""
    if model.travels:
        reason = "one sector of a travelling wave, which has no motion of its own in time"
        raise ModelError(
            f"model: a tuned BladedDisk is {reason}; give all sectors, disk.mistuned(0)",
            study=f"disk: a tuned disk is {reason}; compute all sectors, {ALL_SECTORS}",
        )


def require_progress(progress: object) -> None:
    """Refuse what cannot be told how far a run is."""
    if progress is not None and not callable(progress):
        raise ModelError(
            f"progress: {brief(progress)} cannot be called; give a function of a fraction"
        )


def grid_of(omega: ArrayLike | Span) -> NDArray[np.float64] | Span:
    """Tell a range from a grid, and return either checked."""
    if isinstance(omega, tuple) and len(omega) == 2:
        return span_of(omega, "omega")
    try:
        values = np.asarray(omega)
    except ValueError:
        raise ModelError("omega: a ragged list; give one list of frequencies in rad/s") from None
    if values.dtype.kind not in "fiu":
        shown = repr(omega) if values.size < 5 else f"an array of {values.dtype}"
        raise ModelError(f"omega: {shown} holds no real numbers; give frequencies in rad/s")
    if values.ndim != 1:
        remedy = f"write [{values:g}]" if values.ndim == 0 else "give one list of frequencies"
        raise ModelError(f"omega: shape {values.shape} instead of (n,); {remedy}")
    if not values.size:
        raise ModelError("omega: empty; give at least one frequency in rad/s")
    grid = np.array(values, dtype=np.float64)
    bad = np.flatnonzero(~(np.isfinite(grid) & (grid > 0.0)))
    if bad.size:
        raise ModelError(
            f"omega[{bad[0]}] is {grid[bad[0]]:g}; give finite frequencies above 0 rad/s"
        )
    return grid


def physical_dofs(model: Model) -> tuple[str, ...]:
    """Return the degrees of freedom that are no modal coordinates; all if there are no others.

    Modal coordinates are known by the names that `craig_bampton` gives them, "mode-1", ..., also
    behind the name of a part or a sector.
    """
    dofs = model.structure.dofs
    return tuple(dof for dof in dofs if not _MODAL.fullmatch(dof)) or dofs


def loaded_dofs(model: Model) -> tuple[str, ...]:
    """Return the degrees of freedom with a force or a contact, each once."""
    loaded = [force.dof for force in model.forces]
    touching = [dof for contact in model.contacts for dof in contact.dofs if dof]
    return tuple(dict.fromkeys((*loaded, *touching)))


def driving_dofs(
    model: Model,
    dofs: tuple[str, ...],
    observe: Iterable[str] | str | None,
    outputs: Iterable[str] | str,
) -> NDArray[np.int64]:
    """Return the positions among `dofs` of those that automatic harmonics and steps follow.

    All, if they were named; else the outputs and those with a force or a contact. None are all.
    """
    named = {outputs} if isinstance(outputs, str) else set(outputs)
    for name in sorted(named - set(dofs)):
        raise ModelError(f"outputs: {unknown('dof', name, dofs)}")
    followed = named | set(loaded_dofs(model)) if observe is None else set()
    driving = [position for position, dof in enumerate(dofs) if dof in followed]
    return np.array(driving, dtype=np.int64)


def observed_dofs(observe: Iterable[str] | str | None, model: Model) -> tuple[str, ...]:
    """Return the degrees of freedom to observe, each known and named once.

    By default those with a meaning of their own: all but the modal coordinates of a reduction.
    """
    known = model.structure.dofs
    if observe is None:
        return physical_dofs(model)
    if not isinstance(observe, Iterable):
        raise ModelError(f"observe: {brief(observe)} is not a list of names; write [{known[0]!r}]")
    names = (observe,) if isinstance(observe, str) else tuple(observe)
    if not names:
        raise ModelError("observe: no dof; name at least one, or leave it out for all")
    for position, name in enumerate(names):
        text(name, f"observe[{position}]")
        if name not in known:
            raise ModelError(f"observe: {unknown('dof', name, known)}")
        if name in names[:position]:
            raise ModelError(f"observe: {name!r} is given more than once; name each dof once")
    return tuple(map(str, names))


def require_forced(model: Model, settings: HarmonicSettings) -> None:
    """Refuse to leave out the harmonic of a force."""
    highest = settings.highest
    for position, force in enumerate(model.forces, start=1):
        if force.harmonic > highest and force.amplitude:
            raise ModelError(
                f"{settings.bound}: {highest} would leave out force {position} at {force.dof!r}, "
                f"of harmonic {force.harmonic}; give at least {force.harmonic}, or drop the force"
            )


def require_held(model: Model, residual: Residual) -> None:
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
    prescribed = bool(model.contacts) and residual != "from_rest" and bool(load.any())
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
