"""What curves and orbits say of themselves where solutions need not be unique or stable."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stickslip import _core
from stickslip.analyses.doubts import is_unique
from stickslip.analyses.texts import told
from stickslip.model import Model
from stickslip.results.arrays import STABILITY, UNIQUE, Arrays
from stickslip.results.diagnostic import Diagnostic, present
from stickslip.results.exact_response import OrbitArrays
from stickslip.results.stability import stability_of
from stickslip.settings.balance import ForcedSettings

_ENDS = {
    "returned": "branch-end/returned",
    "stalled": "branch-end/stalled",
    "points": "branch-end/points",
}


def branch_assumptions(
    model: Model, settings: ForcedSettings, arrays: Arrays, solution: _core.Solution
) -> tuple[Diagnostic, ...]:
    """Say where a curve turns back, jumps or ends, and how much of it is unstable."""
    if not model.problem.laws_not_monotone:
        unproved = bool(arrays.solved.any()) and not is_unique(model)
        return present((unproved and told("stability-undecided/unproved"),))
    omega, folds = arrays.omega, int(arrays.fold.sum())
    last = int(np.flatnonzero(np.append(arrays.further, True))[0]) - 1
    unstable = int((arrays.stability == STABILITY.index("unstable")).sum())
    return present(
        (
            folds > 0 and told("folds", count=folds),
            unstable > 0 and told("unstable", points=unstable, _solved=int(arrays.solved.sum())),
            _missed(arrays, np.array(STABILITY)[arrays.stability]),
            _undecided(model, settings, arrays),
            _jumps(arrays),
            _astray(arrays, solution.astray),
            _further(arrays, solution.cut),
            solution.end in _ENDS
            and told(
                _ENDS[solution.end],
                omega=float(omega[last]),
                points=last + 1,
                _start=omega[0],
            ),
        )
    )


def stability_of_orbits(model: Model, arrays: OrbitArrays) -> tuple[Diagnostic, ...]:
    """Say how many orbits are unstable, and of how many that is not decided, and why."""
    if model.travels:
        return (told("stability-undecided/wave"),)
    states = stability_of(arrays.multipliers, arrays.neutral, arrays.known)
    unstable = int((states == "unstable").sum())
    touching = int((arrays.solved & ~arrays.known).sum())
    neutral = int(((states == "not decided") & arrays.known).sum())
    of = {"_solved": int(arrays.solved.sum())}
    return present(
        (
            unstable > 0 and told("unstable", points=unstable, **of),
            _missed(arrays, states),
            touching > 0 and told("stability-undecided/touching", points=touching, **of),
            neutral > 0 and told("stability-undecided/neutral", points=neutral, **of),
        )
    )


def _missed(arrays: Arrays, states: NDArray[np.str_]) -> Diagnostic | None:
    """Say where bounds lack what lasts: the only motion found is unstable."""
    alone = arrays.unique == UNIQUE.index("yes")
    points = int((alone & (states == "unstable")).sum())
    return told("other-motion", points=points) if points else None


def _undecided(model: Model, settings: ForcedSettings, arrays: Arrays) -> Diagnostic | None:
    """Say at how many points of a curve stability is not decided, and why."""
    points = int(((arrays.stability == STABILITY.index("not decided")) & arrays.solved).sum())
    if not points:
        return None
    if model.travels:
        return told("stability-undecided/wave")
    if not settings.stability:
        return told("stability-undecided/left out")
    return told("stability-undecided/points", points=points, _solved=int(arrays.solved.sum()))


def _jumps(arrays: Arrays) -> Diagnostic | None:
    """Name the first jump of a sweep, and how many follow."""
    jumps = np.flatnonzero(arrays.jump)
    if not jumps.size:
        return None
    more = f", the first of {jumps.size} jumps" if jumps.size > 1 else ""
    return told("jump", jumps=int(jumps.size), _more=more, **_way(arrays, jumps[0]))


def _astray(arrays: Arrays, points: list[int]) -> Diagnostic | None:
    """Name the first step of a sweep that may have left the branch, and how many follow."""
    if not points:
        return None
    more = f", the first of {len(points)} such steps," if len(points) > 1 else ""
    return told("branch-unknown", steps=len(points), _more=more, **_way(arrays, points[0]))


def _way(arrays: Arrays, position: int) -> dict[str, float | str]:
    """Say where a step of a sweep lies that leads to a point."""
    before, after = arrays.omega[position - 1], arrays.omega[position]
    return {
        "low": float(min(before, after)),
        "high": float(max(before, after)),
        "_direction": "upward" if after > before else "downward",
    }


def _further(arrays: Arrays, cut: int) -> Diagnostic | None:
    """Name the first further branch, how many there are, and how many end inside the range."""
    begins = np.flatnonzero(arrays.further)
    if not begins.size:
        return None
    first = arrays.omega[begins[0] : [*begins, arrays.omega.size][1]]
    return told(
        "further-branches",
        count=int(begins.size),
        cut=cut,
        low=float(first.min()),
        high=float(first.max()),
        _branches="1 further branch" if begins.size == 1 else f"{begins.size} further branches",
        _cut=f" {cut} of them could not be followed to an end of the range." if cut else "",
        _first="it reaches" if begins.size == 1 else "the first reaches",
    )
