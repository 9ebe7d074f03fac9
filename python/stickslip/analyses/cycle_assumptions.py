"""What a computation of limit cycles takes for granted, and what to look at before it is used."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stickslip.model import Model
from stickslip.results.diagnostic import Diagnostic, diagnostic
from stickslip.results.limit_cycles import CycleArrays
from stickslip.settings.cycles import MOST_HARMONICS, CycleSettings

if TYPE_CHECKING:
    from stickslip import _core

__all__ = ["cycle_assumptions"]


def cycle_assumptions(
    model: Model, settings: CycleSettings, arrays: CycleArrays, solution: _core.LimitCycles
) -> tuple[Diagnostic, ...]:
    """Return what is to be known of limit cycles."""
    onset, omega = solution.onset
    dof = model.structure.dofs[solution.phase_dof]
    told = [
        diagnostic(
            "onset",
            f"Mode {settings.mode}, stuck at {omega:.6g} rad/s, loses its damping at "
            f"r = {onset:.6g} with all contacts stuck: its limit cycles begin there.",
            mode=settings.mode,
            omega=omega,
            ratio=onset,
        ),
        diagnostic(
            "half-wave",
            "Motions are half-wave symmetric, x(t + T/2) = -x(t); cycles that break this symmetry "
            f"are not looked for. t = 0 is the maximum of {dof!r}.",
        ),
    ]
    if any(force.amplitude for force in model.forces):
        told.append(diagnostic("forces-ignored", "The forces of the model are left out."))
    if model.travels:
        told.append(
            diagnostic(
                "stability-undecided",
                "Stability is not decided: one sector of a wave has no motion of its own.",
            )
        )
    elif not settings.stability:
        told.append(diagnostic("stability-undecided", "Stability is not decided: it was left out."))
    side = ("sticking", "slipping")
    for name, (end, value) in zip(side, solution.ends, strict=True):
        if end == "returned":
            told.append(
                diagnostic(
                    "branch-turned-back",
                    f"Stalled: at {settings.followed} = {value:.6g} the walk turned back on "
                    "itself, or closed a loop: no way ahead was found at a corner of the branch, "
                    f"which may go on to a farther limit. {_remedy(model, settings, arrays)}",
                    value=value,
                )
            )
        if end == "stalled":
            told.append(
                diagnostic(
                    "branch-stalled",
                    f"Stalled: the {name} side ends at {settings.followed} = {value:.6g}, where no "
                    f"continuation was found. {_remedy(model, settings, arrays)}",
                    side=name,
                    value=value,
                )
            )
        if end == "points":
            told.append(
                diagnostic(
                    "points-limit",
                    f"The branch ends after {settings.max_points} points; raise max_points.",
                    points=settings.max_points,
                )
            )
        if end == "unbounded":
            told.append(
                diagnostic(
                    "unbounded-branch",
                    f"The {name} side grows without bound towards {settings.followed} = "
                    f"{value:.6g}.",
                    side=name,
                    value=value,
                )
            )
    returned = any(end == "returned" for end, _ in solution.ends)
    if arrays.limit is None and not solution.interrupted and not returned:
        told.append(
            diagnostic(
                "no-turn", "No turn: the branch does not turn in the range, and has one side alone."
            )
        )
    if solution.jumps:
        told.append(
            diagnostic(
                "branch-jumps",
                f"{solution.jumps} places were stepped over, at corners or between folds close to "
                "each other.",
                jumps=solution.jumps,
            )
        )
    if settings.stability and not model.travels:
        along = int((~arrays.closed & arrays.known).sum())
        unknown = int((~arrays.known).sum())
        if along:
            told.append(
                diagnostic(
                    "multipliers",
                    f"{along} points have no exact orbit nearby at their {settings.followed}: "
                    "their multipliers are those of the exact flow along the harmonic balance.",
                    points=along,
                )
            )
        if unknown:
            told.append(
                diagnostic(
                    "stability-undecided",
                    f"{unknown} points have no multipliers: their stability is not decided.",
                    points=unknown,
                )
            )
    if settings.method == "newton":
        size = np.abs(arrays.displacement).max(axis=1)
        share = arrays.error_estimate / np.maximum(size, 0.02 * size.max(axis=1, keepdims=True))
        worst = float(np.where(np.isnan(share), 0.0, share).max(initial=0.0))
        if worst > settings.tolerance:
            told.append(
                diagnostic(
                    "truncation",
                    f"The discarded harmonics could still change amplitudes by up to {worst:.1e}; "
                    f"try {_finer(model, arrays)}.",
                    share=worst,
                )
            )
    return tuple(told)


def _remedy(model: Model, settings: CycleSettings, arrays: CycleArrays) -> str:
    """Return what to do about a branch that ends early: what has not been done already."""
    if settings.method == "exact":
        return (
            "Follow it by harmonic balance, method='newton', which rounds the corners of exact "
            "orbits off."
        )
    return f"Try {_finer(model, arrays)}."


def _finer(model: Model, arrays: CycleArrays) -> str:
    """Return what is more accurate than a harmonic balance with the harmonics kept."""
    kept = int(arrays.harmonics.max(initial=0))
    ways = [f"more harmonics than the {kept} kept"] if kept < MOST_HARMONICS else []
    # One sector of a wave has no motion in time.
    return " or ".join(ways + ([] if model.travels else ["method='exact'"]))
