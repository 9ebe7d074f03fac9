"""Motion from a start state, by the exact flow between events or by Runge-Kutta steps."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from stickslip.analyses.arguments import (
    Progress,
    observed_dofs,
    prepare,
    require_model,
    require_progress,
    require_time,
)
from stickslip.analyses.assumptions import transient_assumptions, turn_per_step
from stickslip.analyses.memory import require_numbers
from stickslip.checks import brief
from stickslip.errors import ModelError
from stickslip.interruption import Interruption, stopped
from stickslip.model import Model
from stickslip.model.model import refusal
from stickslip.model.state import State
from stickslip.results.transient import Transient, TransientArrays
from stickslip.settings.motion import TransientSettings
from stickslip.settings.settings import configured

if TYPE_CHECKING:
    from stickslip import _core

__all__ = ["transient"]

STABLE_TURN = 2.8
"""Largest angle per step at which the classical Runge-Kutta method is stable: sqrt(8), rounded."""

MOST_STEPS = 2_000_000
"""Steps per period from which on the core names the dof that asks for them."""

DROPPED = 16
"""Periods that the core keeps beyond twice the wanted ones before it drops any."""


@configured(TransientSettings, "omega", "periods", "scheme")
def transient(
    model: Model,
    settings: TransientSettings,
    *,
    start: State | Mapping[str, float] | None = None,
    observe: Iterable[str] | str | None = None,
    progress: Progress = None,
) -> Transient:
    """Motion from a start state under the forces at one frequency, period after period.

    Parameters
    ----------
    start : State or mapping of str to float, optional
        State at t = 0, or displacements of some degrees of freedom [m], the others and everything
        else zero. ``other.final`` continues another run. Default: rest.

    Returns
    -------
    Transient
        Time histories, and what follows from them. `status` says how the run ended.

    Raises
    ------
    ModelError
        If an argument is of the wrong type or outside its range, the result would not fit into
        the memory, or the Runge-Kutta steps are too long to be stable.
    Interrupted
        On Ctrl-C; its `result` holds the periods that had been computed.

    References
    ----------
    Guillen (1999), section 4.2 (Runge-Kutta integration with the corrected contact law of Table
    3.1). The exact flow is this package's.
    """
    require_model(model)
    require_time(model)
    dofs = observed_dofs(observe, model)
    require_progress(progress)
    _require_stable(model, settings)
    first = _start(model, start)
    _require_room(model, settings, dofs)
    prepare(model)
    with Interruption(progress) as watch:
        history = _solve(model, settings, dofs, first, watch)
        result = _result(model, settings, dofs, start, history)
        if result.interrupted:
            raise stopped("transient", f"{result.periods} of {settings.periods} periods", result)
        return watch.completed(result, "transient")


def _start(model: Model, start: object) -> State | None:
    if start is None:
        return None
    if isinstance(start, Mapping):
        return State(model, displacement=start)
    if not isinstance(start, State):
        raise ModelError(
            f"start: {brief(start)} is no state; give ss.State(model, ...), the final state of "
            "another run, or {dof: displacement}"
        )
    start.require_fit(model, "start")
    return start


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
    points = sum(contact.points for contact in model.contacts)
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


def _solve(
    model: Model,
    settings: TransientSettings,
    dofs: tuple[str, ...],
    start: State | None,
    progress: Progress,
) -> _core.History:
    from stickslip import _core

    try:
        return _core.transient(
            model.problem,
            settings,
            None if start is None else start.vector,
            np.array([model.structure.index(dof) for dof in dofs], dtype=np.int64),
            progress,
        )
    except ModelError:
        raise
    except ValueError as error:
        raise refusal(error, model) from error


def _result(
    model: Model,
    settings: TransientSettings,
    dofs: tuple[str, ...],
    start: object,
    history: _core.History,
) -> Transient:
    return Transient.of(
        history,
        model=model,
        settings=settings,
        dofs=dofs,
        arrays=TransientArrays.of(history),
        diagnostics=transient_assumptions(
            model, settings, dofs, start, settled=history.settled, unbounded=history.unbounded
        ),
    )
