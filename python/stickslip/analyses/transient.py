"""Motion from a start state, by the exact flow between events or by Runge-Kutta steps."""

from __future__ import annotations

import math

import numpy as np

from stickslip import _core
from stickslip.analyses.arguments import (
    columns_of,
    observed_dofs,
    points_of,
    require_time,
    state_of,
)
from stickslip.analyses.assumptions import transient_assumptions, turn_per_step
from stickslip.analyses.mass_scaling import mass_scaled, pace_refused
from stickslip.analyses.run import Progress, Run, refusals
from stickslip.errors import ModelError
from stickslip.memory import require_numbers
from stickslip.model import Model
from stickslip.results.transient import Transient, TransientArrays
from stickslip.settings.motion import TransientKeys, TransientSettings
from stickslip.settings.settings import configured

STABLE_TURN = 2.8
"""Largest angle per step at which the classical Runge-Kutta method is stable: sqrt(8), rounded."""

MOST_STEPS = 2_000_000
"""Steps per period from which on the core names the dof that asks for them."""

DROPPED = 16
"""Periods that the core keeps beyond twice the wanted ones before it drops any."""


@configured(TransientKeys, "omega", "periods", "scheme")
def transient(model: Model, settings: TransientKeys, *, progress: Progress = None) -> Transient:
    """Motion from a start state under the forces at one frequency, period after period.

    Returns
    -------
    Transient
        Time histories, and what follows from them. `status` says how the run ended.

    Raises
    ------
    ModelError
        If the Runge-Kutta steps are too long to be stable.

    References
    ----------
    Guillen (1999), section 4.2 (Runge-Kutta integration with the corrected contact law of Table
    3.1). The exact flow is this package's.
    """
    require_time(model)
    dofs = observed_dofs(settings, model)
    kept = TransientSettings.of(**settings.part(TransientSettings))
    given, omega = model, np.array([kept.omega])
    model, scaling = mass_scaled(given, omega, kept.mass_scaling)
    _require_stable(model, kept)
    start = settings.start
    first = None if start is None else state_of(model, start, "start").vector
    _require_room(model, kept, dofs)
    with Run("transient", progress, model) as run:
        with pace_refused(given, omega, kept.mass_scaling), refusals(model):
            history = _core.transient(model.problem, kept, first, columns_of(dofs, model), run)
        result = Transient.of(
            history,
            model=model,
            settings=kept,
            dofs=dofs,
            arrays=TransientArrays.of(history),
            diagnostics=(
                *scaling,
                *transient_assumptions(model, kept, dofs, start, history),
            ),
        )
        return run.ended(result, f"{result.periods} of {kept.periods} periods")


def _require_stable(model: Model, settings: TransientSettings) -> None:
    """Refuse Runge-Kutta steps in which the fastest stuck motion would grow without bound."""
    turn = turn_per_step(model, settings)
    needed = math.ceil(settings.steps * turn / STABLE_TURN)
    if settings.steps < needed < MOST_STEPS:
        raise ModelError(
            f"steps: {settings.steps} Runge-Kutta steps per period are unstable: the highest stuck "
            f"natural frequency turns by {turn:.3g} rad in one, and may by {STABLE_TURN:g}; give "
            f"at least {needed}"
        )


def _require_room(model: Model, settings: TransientSettings, dofs: tuple[str, ...]) -> None:
    points = points_of(model)
    loads = 2 * settings.steps * len(model.structure) if settings.scheme == "rk4" else 0
    require_numbers(loads, f"the load at {settings.steps} steps per period", "give fewer steps")
    kept = min(settings.keep or settings.periods, settings.periods)
    rows = kept * settings.samples + 1
    each = 2 * len(model.structure) + points + 2 * len(dofs) + 1
    row = 1 + 2 * len(dofs) + 2 * points
    # Periods that are not to be kept are dropped a number of them at once.
    held = min(2 * kept + DROPPED, settings.periods) * settings.samples + 1
    whole = (settings.periods + 1) * each
    require_numbers(
        rows * row + whole,
        f"the result of {rows} instants, {len(dofs)} dofs and {settings.periods} periods",
        "name fewer dofs with observe=[...], or keep fewer periods with keep=...",
        core=held * row + whole,
    )
