"""What a computation of limit cycles takes for granted, and what to look at before it is used."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stickslip.analyses.cycle_settings import CycleSettings
from stickslip.model import Model
from stickslip.results.cycle_arrays import CycleArrays

if TYPE_CHECKING:
    from stickslip import _core

__all__ = ["cycle_assumptions"]


_REMEDIES = {
    "newton": "Keep other harmonics, or use method='exact'.",
    "exact": (
        "Contacts may begin or cease to slip at several places at once there; use method='newton'."
    ),
}


def cycle_assumptions(
    model: Model, settings: CycleSettings, arrays: CycleArrays, solution: _core.LimitCycles
) -> tuple[str, ...]:
    """Return the assumptions of limit cycles, one text each."""
    onset, omega = solution.onset
    dof = model.structure.dofs[solution.phase_dof]
    texts = [
        f"Mode {settings.mode}, stuck at {omega:.6g} rad/s, loses its damping at r = {onset:.6g} "
        "with all contacts stuck: its limit cycles begin there.",
        "Motions are half-wave symmetric, x(t + T/2) = -x(t); cycles that break this symmetry are "
        f"not looked for. t = 0 is the maximum of {dof!r}.",
    ]
    if any(force.amplitude for force in model.forces):
        texts.append("The forces of the model are left out.")
    if model.travels:
        texts.append("Stability is not decided: one sector of a wave has no motion of its own.")
    elif not settings.stability:
        texts.append("Stability is not decided: it was left out.")
    side = ("sticking", "slipping")
    for name, (end, value) in zip(side, solution.ends, strict=True):
        if end == "returned":
            texts.append(
                f"Stalled: at {settings.followed} = {value:.6g} the walk turned back on itself, or "
                "closed a loop: no way ahead was found at a corner of the branch, which may go on "
                "to a farther limit; try method='newton' with more harmonics, or 'exact'."
            )
        if end == "stalled":
            texts.append(
                f"Stalled: the {name} side ends at {settings.followed} = {value:.6g}, where no "
                f"continuation was found. {_REMEDIES[settings.method]}"
            )
        if end == "points":
            texts.append(f"The branch ends after {settings.max_points} points; raise max_points.")
        if end == "unbounded":
            texts.append(
                f"The {name} side grows without bound towards {settings.followed} = {value:.6g}."
            )
    returned = any(end == "returned" for end, _ in solution.ends)
    if arrays.limit is None and not solution.interrupted and not returned:
        texts.append("No turn: the branch does not turn in the range, and has one side alone.")
    if solution.jumps:
        texts.append(
            f"{solution.jumps} places were stepped over, at corners or between folds close to each "
            "other."
        )
    if settings.stability and not model.travels:
        along = int((~arrays.closed & arrays.known).sum())
        unknown = int((~arrays.known).sum())
        if along:
            texts.append(
                f"{along} points have no exact orbit nearby at their {settings.followed}: their "
                "multipliers are those of the exact flow along the harmonic balance."
            )
        if unknown:
            texts.append(f"{unknown} points have no multipliers: their stability is not decided.")
    if settings.method == "newton":
        size = np.abs(arrays.displacement).max(axis=1)
        share = arrays.error_estimate / np.maximum(size, 0.02 * size.max(axis=1, keepdims=True))
        worst = float(np.where(np.isnan(share), 0.0, share).max(initial=0.0))
        if worst > settings.tolerance:
            texts.append(
                f"The discarded harmonics could still change amplitudes by up to {worst:.1e}; keep "
                "more harmonics, or use method='exact'."
            )
    return tuple(texts)
