"""What a computation of limit cycles takes for granted, and what to look at before it is used."""

from __future__ import annotations

import numpy as np

from stickslip import _core
from stickslip.analyses.doubts import few_modes, structure_doubts
from stickslip.analyses.texts import told
from stickslip.model import Model
from stickslip.results.diagnostic import Diagnostic, present
from stickslip.results.limit_cycles import CycleArrays
from stickslip.results.stability import stability_of
from stickslip.settings.cycles import MOST_HARMONICS, CycleSettings


def cycle_assumptions(
    model: Model, settings: CycleSettings, arrays: CycleArrays, solution: _core.LimitCycles
) -> tuple[Diagnostic, ...]:
    """Say what limit cycles took for granted."""
    onset, omega = solution.onset
    dof = model.structure.dofs[solution.phase_dof]
    sides = zip(("sticking", "slipping"), solution.ends, strict=True)
    biased = model.problem.biased()
    ignored = any(force.amplitude and (force.harmonic or not biased) for force in model.forces)
    returned = any(end == "returned" for end, _ in solution.ends)
    return present(
        (
            told("onset/rest" if biased else "onset", mode=settings.mode, omega=omega, ratio=onset),
            told("half-wave/full" if biased else "half-wave", _dof=dof),
            ignored and told("forces-ignored/static" if biased else "forces-ignored"),
            *_stability(model, settings, arrays),
            *(
                _end(model, settings, arrays, end, float(value), side)
                for side, (end, value) in sides
            ),
            bool(settings.values)
            and not solution.interrupted
            and _missed(model, settings, arrays, solution),
            arrays.limit is None and not (solution.interrupted or returned) and told("no-turn"),
            solution.jumps > 0
            and told(
                "branch-jumps", jumps=solution.jumps, _remedy=_remedy(model, settings, arrays)
            ),
            settings.method == "newton" and _truncation(model, settings, arrays),
            *structure_doubts(model),
            few_modes(model, arrays.omega, forced=False),
        )
    )


_PARTIAL = ("returned", "stalled", "points")
"""Ends of a branch that may go on behind them."""


def _missed(
    model: Model, settings: CycleSettings, arrays: CycleArrays, solution: _core.LimitCycles
) -> Diagnostic | None:
    """Say at which of the values asked for there is no limit cycle, or none was found."""
    found = arrays.value
    missed = [value for value in settings.values or () if not np.isclose(found, value).any()]
    if not missed:
        return None
    shown = ", ".join(f"{value:.6g}" for value in missed[:5])
    more = ", ..." if len(missed) > 5 else ""
    about = {"points": len(missed), "_followed": settings.followed, "_at": shown + more}
    if solution.jumps > 0 or any(end in _PARTIAL for end, _ in solution.ends):
        return told("values-missed/incomplete", **about, _remedy=_remedy(model, settings, arrays))
    if any(
        end == "unbounded" and (settings.followed != "ratio" or missed[0] < value)
        for end, value in solution.ends
    ):
        return told("values-missed/unbounded", **about)
    return told("values-missed", **about)


def _end(
    model: Model, settings: CycleSettings, arrays: CycleArrays, end: str, value: float, side: str
) -> Diagnostic | None:
    """Say why a side of the branch ends where it does."""
    at = {"value": value, "_followed": settings.followed}
    remedy = _remedy(model, settings, arrays)
    match end:
        case "returned":
            return told("branch-turned-back", **at, _remedy=remedy)
        case "stalled":
            return told("branch-stalled", **at, side=side, _remedy=remedy)
        case "points":
            return told("points-limit", points=settings.max_points)
        case "unbounded":
            return told("unbounded-branch", **at, side=side)
    return None


def _stability(
    model: Model, settings: CycleSettings, arrays: CycleArrays
) -> tuple[Diagnostic | bool, ...]:
    if model.travels:
        return (told("stability-undecided/wave"),)
    if not settings.stability:
        return (told("stability-undecided/left out"),)
    along = int((~arrays.closed & arrays.known).sum())
    states = stability_of(arrays.multipliers, arrays.neutral, arrays.known)
    unknown = int((states == "not decided").sum())
    return (
        along > 0 and told("multipliers", points=along, _followed=settings.followed),
        unknown > 0 and told("stability-undecided", points=unknown),
    )


def _truncation(model: Model, settings: CycleSettings, arrays: CycleArrays) -> Diagnostic | None:
    size = np.abs(arrays.displacement[:, 1:]).max(axis=1, initial=0.0)
    largest = size.max(axis=1, keepdims=True, initial=0.0)
    share = arrays.error_estimate / np.maximum(size, 0.02 * largest)
    worst = float(np.where(np.isnan(share), 0.0, share).max(initial=0.0))
    if not worst > settings.tolerance:
        return None
    return told("truncation/cycles", share=worst, _finer=_finer(model, arrays))


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
