"""Fast modes slowed by mass that moves with them alone, so that a motion takes longer steps."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from stickslip import _core
from stickslip.analyses.texts import told
from stickslip.checks import Matrix, brief
from stickslip.errors import ModelError
from stickslip.model.configurations import natural_frequencies
from stickslip.model.damping import eigen_pencil
from stickslip.model.model import Model
from stickslip.model.pace import TooFast, too_fast
from stickslip.model.structure import Structure
from stickslip.results.diagnostic import Diagnostic
from stickslip.results.fields import Float

_ROUNDING = 0.1
"""Share of the tolerance that rounding of the added mass may take."""
_CHANGES = 4
"""Changes of stick and slip of a contact in a period: what they set ringing may add up."""
_SLOWEST = 32.0
"""Lowest frequency of slowed modes, over those of the forces: higher harmonics are small."""
_SPREAD = 1.25
"""Highest frequency of slowed modes over their lowest: equal ones would lose their shapes."""
_TOLERANCES = (1e-5, 1e-4, 1e-3, 1e-2, 1e-1)
"""Tolerances that are advised where motions are too fast."""
_NEAR = 10.0
"""Stuck modes are looked at up to this many times the frequencies of the forces."""


def mass_scaled(
    model: Model, omega: Float, tolerance: float | None
) -> tuple[Model, tuple[Diagnostic, ...]]:
    """Return a model of which modes are as slow as a tolerance allows, and what was done.

    Modes much faster than the excitation follow the forces as springs do. Each of them takes mass
    that moves in its own shape, M + M φ (ω_j²/ω_c² - 1) φ^T M, until it has the frequency ω_c: its
    flexibility remains, and other modes feel nothing of it.

    The changes that are estimated, for forces at the frequencies `omega` [rad/s]:

    - Where a contact sticks or slips, its force changes its rate by up to k ω U. This sets a mode
      ringing by φ φ^T k U / ω_j² times ω/ω_c.
    - Under a force of harmonic h its inertia answers by (h ω/ω_c)² of its flexibility.
    - The inertia shifts the resonances of the structure with stuck contacts.

    References
    ----------
    L. Olovsson, K. Simonsson, M. Unosson, "Selective mass scaling for explicit finite element
    analyses", International Journal for Numerical Methods in Engineering 63 (2005) 1436; here the
    modes themselves are what is selected.

    Raises
    ------
    ModelError
        If the model has sectors, or a degree of freedom without mass.
    """
    if tolerance is None:
        return model, ()
    structure = model.structure
    if type(model) is not Model:
        raise ModelError(
            f"mass_scaling: {brief(model)} has sectors, whose modes are those of the ring; leave "
            "it out"
        )
    massless = ~structure.mass.any(axis=1)
    if massless.any():
        dof = structure.dofs[int(massless.argmax())]
        raise ModelError(
            f"mass_scaling: dof {brief(dof)} has no mass; condense it, or leave mass_scaling out"
        )
    squared, shapes = eigen_pencil(structure.stiffness, structure.mass)
    # Rigid motions have hardly any stiffness: a place that they do not move is not moved by them.
    modes = np.sqrt(np.maximum(squared, np.finfo(np.float64).tiny))
    harmonics = sorted({force.harmonic for force in model.forces} - {0})
    frequencies = np.outer(harmonics, omega).ravel()
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        least = _ringing(model, shapes, modes, frequencies.max(initial=0.0)) / tolerance
        least = np.maximum(least, np.sqrt(_inertia(model, shapes, modes, frequencies) / tolerance))
    least = np.maximum(
        least, modes[-1] * np.sqrt(np.finfo(np.float64).eps / (_ROUNDING * tolerance))
    )
    least = np.maximum(least, _SLOWEST * frequencies.max(initial=0.0))
    # What is the fastest motion once the fastest, the two fastest, ... modes are slowed.
    left = np.maximum(_SPREAD * least, np.append(modes[-2::-1], 0.0))
    slowed, fastest = float(left.min()), float(modes[-1])
    fast = modes > slowed
    count = int(fast.sum())
    if not count:
        return model, (told("mass-scaling/none", tolerance=tolerance),)
    spread = np.linspace(1.0 / _SPREAD, 1.0, count)
    change = tolerance * float(least[count - 1]) * _SPREAD / slowed
    scaled = _slowed(structure, shapes[:, fast], modes[fast], slowed * spread)
    said = told("mass-scaling", modes=count, fastest=fastest, slowed=slowed, change=change)
    return model.with_structure(scaled), (said,)


@contextmanager
def pace_refused(model: Model, omega: Float, tolerance: float | None) -> Iterator[None]:
    """Say of a motion that is too fast to follow what scaled mass can do about it.

    `model` is the one that was given; `omega` and `tolerance` those of `mass_scaled`.
    """
    try:
        yield
    except ModelError as error:
        if not isinstance(error.__cause__, _core.TooFastError):
            raise
        found = TooFast(*error.__cause__.args)
        larger = _that_helps(model, omega, tolerance, found)
        raise too_fast(found, model, tolerance, larger) from error.__cause__


def _that_helps(
    model: Model, omega: Float, tolerance: float | None, found: TooFast
) -> float | None:
    """Return a larger tolerance with which a motion is slow enough to follow, if there is one."""
    if type(model) is not Model or not model.structure.mass.any(axis=1).all():
        return None
    larger = (one for one in _TOLERANCES if tolerance is None or one > tolerance)
    rates = ((one, _rate(mass_scaled(model, omega, one)[0])) for one in larger)
    return next((one for one, rate in rates if rate <= found.most * found.omega), None)


def _rate(model: Model) -> float:
    """Return the fastest rate of free motions [1/s], as the core reckons it."""
    structure = model.structure
    _, shapes = eigen_pencil(structure.stiffness, structure.mass)
    decay = float(np.linalg.norm(shapes.T @ structure.damping @ shapes))
    return float(natural_frequencies(model)[-1]) + decay


def _ringing(model: Model, shapes: Matrix, modes: Float, omega: float) -> Float:
    """Return ω_c times how far the fastest, the two fastest, ... modes ring at changes of state."""
    pairs = [(one.rows(model.structure) @ shapes, one.stuck_stiffness) for one in model.contacts]
    if not pairs:
        return np.zeros(modes.size)
    # Forces of all points at once, each for a displacement of one.
    forces = sum(np.abs(stiffness).sum(axis=1) @ np.abs(rows) for rows, stiffness in pairs)
    each = np.vstack([np.abs(rows) for rows, _ in pairs]) * forces / modes**2
    ringing: Float = np.cumsum(each[:, ::-1], axis=1).max(axis=0)
    return _CHANGES * omega * ringing


def _inertia(model: Model, shapes: Matrix, modes: Float, frequencies: Float) -> Float:
    """Return ω_c² times what the inertia of the fastest, the two fastest, ... modes changes."""
    structure, changes = model.structure, np.zeros(modes.size)
    if not frequencies.size:
        return changes
    highest = frequencies.max()
    for force in model.forces:
        row = shapes[structure.index(force.dof)] ** 2
        fast = np.cumsum((row / modes**2)[::-1])
        slow = np.cumsum(row / np.maximum(modes, highest) ** 2)
        changes = np.fmax(changes, highest**2 * fast / np.append(slow[-2::-1], 0.0))
    stuck = structure.stiffness + sum(
        (rows.T @ one.stuck_stiffness @ rows)
        for one in model.contacts
        for rows in (one.rows(structure),)
    )
    squared, motions = eigen_pencil(stuck, structure.mass)
    near = squared <= (_NEAR * highest) ** 2
    squared, motions = squared[near, None], motions[:, near]
    damping = np.einsum("ij,ij->j", motions, structure.damping @ motions)[:, None]
    distance = np.abs(squared - frequencies**2 + 1j * damping * frequencies)
    gain = (frequencies**2 / distance).max(axis=1)
    moved = (shapes.T @ structure.mass @ motions) ** 2 * modes[:, None] ** 2
    shifts: Float = (np.cumsum(moved[::-1], axis=0) * gain).max(axis=1, initial=0.0)
    return np.fmax(changes, shifts)


def _slowed(structure: Structure, shapes: Matrix, modes: Float, slowed: Float) -> Structure:
    """Return the structure with these modes slowed to other frequencies."""
    momenta = structure.mass @ shapes
    added = (momenta * ((modes / slowed) ** 2 - 1.0)) @ momenta.T
    return Structure.of_law(
        structure.mass + added,
        structure.stiffness,
        structure.damping,
        structure.dofs,
        None,
        structure.proportional,
    )
