"""Limit cycles that a nonlinear mode alone gives (Krack 2015).

Under the damping C + r C_neg a motion of the mode repeats itself where what the negative damping
feeds per period is what structure and contacts take,

    r(a) = -2 zeta(a) omega(a) sum_k k^2 X_k^H M X_k / sum_k k^2 X_k^H C_neg X_k .
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stickslip.results.arrays import Bool, Complex, Float, constant
from stickslip.results.mode_shapes import Mode, ModeMotions, ModeShapes, left_out


@dataclass(frozen=True, eq=False)
class SynthesizedCycles(ModeMotions):
    """Limit cycles of a single nonlinear mode.

    Attributes
    ----------
    ratio : ndarray of float64, shape (n,)
        Factor r on the negative damping, as it was asked for, once per limit cycle.
    omega : ndarray of float64, shape (n,)
        Angular frequencies [rad/s].
    modal_amplitude : ndarray of float64, shape (n,)
        Modal amplitudes [m kg^(1/2)], rising at every ratio.
    stable : ndarray of bool, shape (n,)
        Whether small changes of the amplitude die out; other modes are not looked at.
    error_indicator : ndarray of float64, shape (n,)
        What the mode leaves out, relative to the amplitude: the displacements by which the full
        equations do not hold, and the error of the damping, over the slope of ln r(a) in ln a.
        Above 0.01 compute the limit cycles directly.
    """

    ratio: Float
    stable: Bool

    def __repr__(self) -> str:
        return (
            f"SynthesizedCycles({self.ratio.size} limit cycles of mode {self.mode.settings.mode})"
        )


def synthesized_cycles(mode: Mode, negative: Float, ratio: Float) -> SynthesizedCycles:
    """Return the limit cycles of a mode under a negative damping, shape (N, N) [kg/s]."""
    shapes, mass = ModeShapes(mode), mode.model.structure.mass
    grid = shapes.grid
    natural, damping = shapes.scalars(grid)
    series = shapes.displacement(grid)
    orders = np.arange(series.shape[1]) ** 2

    def work(matrix: Float) -> Float:
        each: Complex = np.einsum(
            "k,aki,ij,akj->a", orders, series.conj(), matrix, series, optimize=True
        )
        return each.real

    fed = -work(negative)
    needed = 2.0 * damping * natural * work(mass) / fed
    rise = np.gradient(needed, np.log(grid))
    places, ratios, sizes = [], [], []
    for one in ratio.tolist():
        above = needed >= one
        for at in np.flatnonzero(above[:-1] != above[1:]).tolist():
            share = (one - needed[at]) / (needed[at + 1] - needed[at])
            places.append(at)
            ratios.append(one)
            sizes.append(grid[at] * (grid[at + 1] / grid[at]) ** share)
    amplitude, known = np.array(sizes), np.array(ratios)
    omega, own = shapes.scalars(amplitude)

    def acting(n: int, order: int, x: Complex) -> Complex:
        force: Complex = 1j * order * omega[n] * known[n] * (negative @ x)
        return force

    moved, along = left_out(
        mode,
        amplitude,
        omega,
        np.ones(amplitude.size, np.complex128),
        acting,
        lambda n: known[n] * negative,
    )
    feed = 2.0 * own * omega**2
    balance = moved + along / (feed * amplitude) + shapes.damping_error(amplitude)
    error = moved + balance * known / np.abs(rise[places])
    # Where the matrix feeds nothing but takes, a motion that needs more of it has too little.
    arrays = omega, amplitude, error, known, (fed * rise)[places] > 0.0
    return SynthesizedCycles(mode, *(constant(np.array(one)) for one in arrays))
