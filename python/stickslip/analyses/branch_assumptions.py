"""What a curve says of itself where solutions need not be unique."""

from __future__ import annotations

import numpy as np

from stickslip import _core
from stickslip.analyses.texts import told
from stickslip.model import Model
from stickslip.results.arrays import STABILITY, Arrays
from stickslip.results.diagnostic import Diagnostic, present

_ENDS = {
    "returned": "branch-end/returned",
    "stalled": "branch-end/stalled",
    "points": "branch-end/points",
}


def branch_assumptions(
    model: Model, arrays: Arrays, solution: _core.Solution
) -> tuple[Diagnostic, ...]:
    """Say where a curve turns back, jumps or ends, and how much of it is unstable."""
    if not model.problem.laws_not_monotone:
        return ()
    omega, folds = arrays.omega, int(arrays.fold.sum())
    last = int(np.flatnonzero(np.append(arrays.further, True))[0]) - 1
    unstable = int((arrays.stability == STABILITY.index("unstable")).sum())
    unresolved = int(((arrays.stability == STABILITY.index("not decided")) & arrays.solved).sum())
    return present(
        (
            folds > 0 and told("folds", count=folds),
            unstable > 0 and told("unstable", points=unstable, _solved=int(arrays.solved.sum())),
            unresolved > 0 and told("stability-undecided/points", points=unresolved),
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
