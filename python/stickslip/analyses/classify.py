"""What becomes of a free motion from a given start."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from stickslip import _core
from stickslip.analyses.arguments import (
    columns_of,
    observed_dofs,
    points_of,
    require_time,
    state_of,
)
from stickslip.analyses.assumptions import free_assumptions
from stickslip.analyses.run import Progress, Run, refusals
from stickslip.checks import brief
from stickslip.errors import Interrupted, ModelError
from stickslip.memory import require_numbers
from stickslip.model import Model, Structure, natural_frequencies
from stickslip.model.state import State
from stickslip.results.fate_arrays import Motion, Reason
from stickslip.results.fields import Float, Int
from stickslip.results.motion_class import MotionArrays, MotionClass
from stickslip.settings.motion import ClassifyKeys, ClassifySettings, TransientSettings
from stickslip.settings.settings import configured

TAIL = 512
"""Slow periods of the motion that are kept for its spectrum."""

SAMPLES = 8
"""Instants per period of the highest stuck mode, twice what its third harmonic would need."""

RIGID = 1e-5
"""Natural frequencies below this share of the highest are rigid-body motion."""


@configured(ClassifyKeys)
def classify(
    model: Model,
    start: State | Mapping[str, float],
    settings: ClassifyKeys,
    *,
    progress: Progress = None,
) -> MotionClass:
    """Find out what becomes of a free motion from a start.

    It decays if no contact slips any more and the stuck structure is damped; it is unbounded once
    negative damping does more work than friction, which is bounded by the slip forces, could take
    at that size; it has settled if it repeats itself over 32 periods to the tolerance and the
    closing error is falling; it is aperiodic if it does none of this to the end of the span while
    its size stays as it is. What is still changing there is undecided, with the cause. The first
    two hold for ever: they are bounds, not observations.

    Parameters
    ----------
    model : Model
        Structure and contacts, its damping as it is at the ratio in question; see `destabilised`.
        Its forces play no part.
    start : State or mapping of str to float
        State at t = 0, or displacements of some degrees of freedom [m], the others, velocities and
        contact forces zero.

    Returns
    -------
    MotionClass
        The class, the mode, and the spectrum of what the motion has come to.

    Raises
    ------
    ModelError
        If the model is a travelling wave, or nothing in it oscillates.
    Interrupted
        It is undecided.

    References
    ----------
    Guillen (1999), section 5.4.1, there by Runge-Kutta steps from eight starts, and growth or
    change of amplitude judged by eye. Ferri and Dowell (1985) on free motions of several modes.
    """
    alone = free(model)
    dofs = observed_dofs(settings, alone)
    kept = ClassifySettings.of(**settings.part(ClassifySettings))
    first = state_of(alone, start, "start").vector[None]
    omega, samples = _tail_grid(alone, len(dofs))
    columns = columns_of(dofs, alone)
    with Run("classification", progress, alone) as run:
        fates = fates_of(alone, first, kept, 1, run)
        tail, interrupted = _tail(alone, fates, omega, samples, columns, run)
        amplitude = fates.columns["amplitude"][:, columns]
        arrays = MotionArrays.of(fates, start=first, amplitude=amplitude, tail=tail)
        result = MotionClass(
            model=alone,
            dofs=dofs,
            settings=kept,
            arrays=arrays,
            step=2.0 * np.pi / omega / samples,
            interrupted=interrupted,
            timings={"total": fates.seconds},
            counters={"events": int(arrays.events.sum())},
            diagnostics=free_assumptions(model, kept, [start]),
        )
        if interrupted:
            raise Interrupted(
                "classification interrupted; the result of this exception is undecided", result
            )
        return run.completed(result, "classification")


def free(model: Model) -> Model:
    """Return a model without its forces, if its motion in time can be followed."""
    require_time(model)
    # The whole of a mistuned disk has the same matrices, and a motion in time needs no ring.
    return Model(model.structure, model.contacts)


def fates_of(
    model: Model, starts: Float, settings: ClassifySettings, threads: int, progress: Progress
) -> _core.Fates:
    """Let the core follow motions from starts, shape (n, 2 N + n_p)."""
    with refusals(model):
        return _core.fates(model.problem, starts, settings, threads, progress)


def _tail_grid(model: Model, observed: int) -> tuple[float, int]:
    """Return the lowest stuck frequency and the samples per period of it, if they fit."""
    stuck = natural_frequencies(model)
    swinging = stuck[stuck > RIGID * stuck[-1]]
    if not swinging.size:
        raise ModelError("model: no motion of the stuck structure oscillates; ground the structure")
    samples = max(64, math.ceil(SAMPLES * float(stuck[-1] / swinging[0])))
    require_numbers(
        TAIL * samples * (2 * observed + 2 * points_of(model)),
        f"the motion of {TAIL * samples} instants and {observed} dofs, {SAMPLES} instants per "
        f"period of the highest stuck mode, {stuck[-1] / swinging[0]:.2g} times the lowest,",
        f"condense dof {brief(_fastest(model.structure))} statically, which moves fastest, or "
        "name fewer dofs with observe=[...]",
    )
    return float(swinging[0]), samples


def _tail(
    model: Model, fates: _core.Fates, omega: float, samples: int, columns: Int, run: Run
) -> tuple[Float, bool]:
    """Return the motion from its last state on, and whether the run was interrupted."""
    reason = list(Reason)[int(fates.columns["reason"][0])]
    unknown = reason in (Reason.CONTRADICTION, Reason.INTERRUPTED, Reason.CRAWLING)
    if fates.interrupted or unknown or reason.motion in (Motion.UNBOUNDED, Motion.DECAYING):
        return np.zeros((0, len(columns))), fates.interrupted
    with refusals(model):
        history = _core.transient(
            model.problem,
            TransientSettings(omega=omega, periods=TAIL, samples=samples),
            fates.columns["final"][0],
            columns,
            lambda _: run.heed(),
        )
    return history.columns["displacement"][1:], history.interrupted


def _fastest(structure: Structure) -> str:
    """Return the dof that moves fastest while all others are held."""
    with np.errstate(divide="ignore", invalid="ignore"):
        rates = np.diagonal(structure.stiffness) / np.diagonal(structure.mass)
    return structure.dofs[int(np.nanargmax(rates))]
