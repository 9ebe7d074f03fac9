"""What a computation of limit cycles takes for granted, and what to look at before it is used."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stickslip.model import Model
from stickslip.results.diagnostic import Diagnostic, diagnostic, present
from stickslip.results.limit_cycles import CycleArrays
from stickslip.settings.cycles import MOST_HARMONICS, CycleSettings

if TYPE_CHECKING:
    from stickslip import _core

__all__ = ["cycle_assumptions"]


def cycle_assumptions(
    model: Model, settings: CycleSettings, arrays: CycleArrays, solution: _core.LimitCycles
) -> tuple[Diagnostic, ...]:
    """Say what limit cycles took for granted."""
    onset, omega = solution.onset
    dof = model.structure.dofs[solution.phase_dof]
    sides = zip(("sticking", "slipping"), solution.ends, strict=True)
    returned = any(end == "returned" for end, _ in solution.ends)
    return present(
        (
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
                "Motions are half-wave symmetric, x(t + T/2) = -x(t); cycles that break this "
                f"symmetry are not looked for. t = 0 is the maximum of {dof!r}.",
            ),
            any(force.amplitude for force in model.forces)
            and diagnostic("forces-ignored", "The forces of the model are left out."),
            *_stability(model, settings, arrays),
            *(
                _end(model, settings, arrays, end, float(value), side)
                for side, (end, value) in sides
            ),
            arrays.limit is None
            and not (solution.interrupted or returned)
            and diagnostic(
                "no-turn", "No turn: the branch does not turn in the range, and has one side alone."
            ),
            solution.jumps > 0
            and diagnostic(
                "branch-jumps",
                f"{solution.jumps} places were stepped over, at corners or between folds close to "
                "each other.",
                jumps=solution.jumps,
            ),
            settings.method == "newton" and _truncation(model, settings, arrays),
        )
    )


def _end(
    model: Model, settings: CycleSettings, arrays: CycleArrays, end: str, value: float, side: str
) -> Diagnostic | None:
    """Say why a side of the branch ends where it does."""
    at = f"{settings.followed} = {value:.6g}"
    match end:
        case "returned":
            return diagnostic(
                "branch-turned-back",
                f"Stalled: at {at} the walk turned back on itself, or closed a loop: no way ahead "
                "was found at a corner of the branch, which may go on to a farther limit. "
                f"{_remedy(model, settings, arrays)}",
                value=value,
            )
        case "stalled":
            return diagnostic(
                "branch-stalled",
                f"Stalled: the {side} side ends at {at}, where no continuation was found. "
                f"{_remedy(model, settings, arrays)}",
                side=side,
                value=value,
            )
        case "points":
            return diagnostic(
                "points-limit",
                f"The branch ends after {settings.max_points} points; raise max_points.",
                points=settings.max_points,
            )
        case "unbounded":
            return diagnostic(
                "unbounded-branch",
                f"The {side} side grows without bound towards {at}.",
                side=side,
                value=value,
            )
    return None


def _stability(
    model: Model, settings: CycleSettings, arrays: CycleArrays
) -> tuple[Diagnostic | bool, ...]:
    cause = None
    if model.travels:
        cause = "one sector of a wave has no motion of its own"
    elif not settings.stability:
        cause = "it was left out"
    if cause is not None:
        return (diagnostic("stability-undecided", f"Stability is not decided: {cause}."),)
    along = int((~arrays.closed & arrays.known).sum())
    unknown = int((~arrays.known).sum())
    return (
        along > 0
        and diagnostic(
            "multipliers",
            f"{along} points have no exact orbit nearby at their {settings.followed}: their "
            "multipliers are those of the exact flow along the harmonic balance.",
            points=along,
        ),
        unknown > 0
        and diagnostic(
            "stability-undecided",
            f"{unknown} points have no multipliers: their stability is not decided.",
            points=unknown,
        ),
    )


def _truncation(model: Model, settings: CycleSettings, arrays: CycleArrays) -> Diagnostic | None:
    size = np.abs(arrays.displacement).max(axis=1)
    share = arrays.error_estimate / np.maximum(size, 0.02 * size.max(axis=1, keepdims=True))
    worst = float(np.where(np.isnan(share), 0.0, share).max(initial=0.0))
    if not worst > settings.tolerance:
        return None
    return diagnostic(
        "truncation",
        f"The discarded harmonics could still change amplitudes by up to {worst:.1e}; "
        f"try {_finer(model, arrays)}.",
        share=worst,
    )


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
