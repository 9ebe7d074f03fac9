"""The experiment on solvers: methods from good and poor starts, on the beam of chapter II."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import numpy as np

import stickslip as ss
from stickslip_reproduce.beam_orbits import EIGHT
from stickslip_reproduce.resolution import Float, Resolution
from stickslip_reproduce.solvers import CONVERGED, METHODS, Equations, Run, solve

OMEGA = (155.0, 170.0, 195.0, 220.0)
"""Its frequencies [rad/s]."""

HARMONICS = 15

MOST_CHORD = 40
"""Iterations of the Newton-Chord method."""

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


@cache
def solved() -> tuple[Float, Float]:
    """Return the unknowns at the solutions, shape (m, n), and the slip fractions there."""
    equations = experiment()
    found = np.zeros_like(equations.force)
    slips = np.zeros(len(found))
    for place, (load, omega) in enumerate(equations.cases):
        kept = ss.forced_response(ss.reference.snecma_beam(load), [omega], HARMONICS)
        found[place] = kept.coefficients("damper")[0]
        slips[place] = kept.slip_fraction((0, 0))[0]
    return equations.vector(found), slips


def order(method: str, resolution: Resolution) -> float:
    """Return the median order of convergence close to the solutions."""
    near = solve(experiment(), 1.001 * solved()[0], method, "near")
    return _order(near.histories)


def order_of_chord() -> float:
    """Return the same for the Newton-Chord method (3.26): the Jacobian of the start throughout."""
    equations = experiment()
    every = np.arange(len(equations.cases))
    vector = 1.001 * solved()[0]
    matrix = equations.jacobian(vector, every)
    histories = []
    for _ in range(MOST_CHORD):
        residual = equations.residual(vector, every)
        histories.append(np.linalg.norm(residual, axis=1) / equations.size)
        vector -= np.linalg.solve(matrix, residual[:, :, None])[:, :, 0]
    # A run ends where rounding begins.
    ends = [[*one[one > CONVERGED], *one[one <= CONVERGED][:1]] for one in np.array(histories).T]
    return _order(ends)


def _order(histories: Sequence[Sequence[float]]) -> float:
    orders = []
    for history in histories:
        steps = [size for size in history if size > 1e-13]
        if history[-1] < 1e-9 and len(steps) >= 3:
            first, second, third = np.log(steps[-3:])
            orders.append((third - second) / (second - first))
    return float(np.median(orders)) if orders else np.nan
