"""The experiment on solvers: methods from good and poor starts, on the beam of chapter II."""

from __future__ import annotations

from functools import cache

import numpy as np

import stickslip as ss
from stickslip_reproduce.beam_orbits import EIGHT
from stickslip_reproduce.resolution import Resolution
from stickslip_reproduce.solvers import METHODS, Equations, Run, solve

OMEGA = (155.0, 170.0, 195.0, 220.0)
"""Its frequencies [rad/s]."""

HARMONICS = 15

POOR = ("rest", "beam without damper", "ten times too large")


@cache
def begins(resolution: Resolution) -> dict[str, np.ndarray]:
    """Return the coefficients at the starts of the experiment, shape (m, N_h + 1) each."""
    equations = experiment()
    one = np.zeros_like(equations.force)
    free = np.zeros_like(one)
    for place, (load, omega) in enumerate(equations.cases):
        harmonic = ss.single_harmonic(ss.reference.snecma_beam(load), [omega])
        one[place, 1] = harmonic.coefficients("damper")[0, 1]
    free[:, 1] = equations.force[:, 1] / equations.stiffness[:, 1]
    return dict(
        zip(("single harmonic", *POOR), (one, np.zeros_like(one), free, 10.0 * one), strict=True)
    )


@cache
def experiment() -> Equations:
    """Return the equations of the experiment."""
    return Equations([(load, omega) for load in EIGHT for omega in OMEGA], HARMONICS)


@cache
def runs(resolution: Resolution) -> tuple[Run, ...]:
    """Return every start by every method; the same at any resolution, as it takes seconds."""
    equations = experiment()
    return tuple(
        solve(equations, equations.vector(begin), method, start)
        for start, begin in begins(resolution).items()
        for method in METHODS
    )


def largest(method: str, resolution: Resolution) -> float:
    """Return the largest backward error of a method."""
    return max(row.backward_error for row in runs(resolution) if row.method == method)


def share(rows: tuple[Run, ...] | list[Run], method: str) -> float:
    """Return the share of runs that converge [%]."""
    chosen = [row for row in rows if row.method == method]
    return 100.0 * sum(row.converged for row in chosen) / sum(row.runs for row in chosen)


def order(method: str, resolution: Resolution) -> float:
    """Return the median order of convergence close to the solutions."""
    equations = experiment()
    solved = np.zeros_like(equations.force)
    for place, (load, omega) in enumerate(equations.cases):
        kept = ss.forced_response(ss.reference.snecma_beam(load), [omega], HARMONICS)
        solved[place] = kept.coefficients("damper")[0]
    near = solve(equations, 1.001 * equations.vector(solved), method, "near")
    orders = []
    for history in near.histories:
        steps = [size for size in history if size > 1e-13]
        if history[-1] < 1e-9 and len(steps) >= 3:
            first, second, third = np.log(steps[-3:])
            orders.append((third - second) / (second - first))
    return float(np.median(orders)) if orders else np.nan
