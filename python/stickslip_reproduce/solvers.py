"""The solvers that section 3.4 compares, as printed, on the equations (3.22) of the SNECMA beam.

Written out here, as the package has one linear solver: the contact law, Newton's and Broyden's
method, and what keeps the factors of the Jacobian. Many cases are solved beside each other.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

import stickslip as ss
from stickslip_reproduce.resolution import Float

__all__ = ["CONVERGED", "METHODS", "Equations", "Overshooting", "Run", "solve"]

SAMPLES = 256
MOST, MOST_NEWTON = 100, 40
"""Iterations after which a run has not converged."""

CONVERGED = 1e-9
"""Norm of the residual over that of the force."""

LOST = 1e8
"""Norm of the residual over that of the force at which a run is given up."""

STEP = 1e-7
"""Step of the finite differences, over the size of the unknown or of the slip displacement."""


class Equations:
    """Equations (3.22) of the beam at the damper, for many loads and frequencies.

    Parameters
    ----------
    cases : sequence of (float, float)
        Load [N] and angular frequency [rad/s] of each case.
    harmonics : int
        Highest harmonic kept, N_h; there are n = 2 N_h + 1 unknowns.
    """

    def __init__(self, cases: Sequence[tuple[float, float]], harmonics: int) -> None:
        beam = ss.reference.snecma_structure()
        self.cases, self.harmonics = list(cases), harmonics
        orders = np.arange(harmonics + 1)
        count = len(self.cases)
        self.stiffness = np.zeros((count, harmonics + 1), complex)
        """Reduced dynamic stiffness by harmonic [N/m]."""
        self.force = np.zeros((count, harmonics + 1), complex)
        for place, (load, omega) in enumerate(self.cases):
            for order in orders:
                turn = order * omega
                dynamic = beam.stiffness - turn**2 * beam.mass + 1j * turn * beam.damping
                receptance = np.linalg.inv(dynamic)
                self.stiffness[place, order] = 1.0 / receptance[0, 0]
                if order == 1:
                    self.force[place, 1] = load * receptance[0, 1] / receptance[0, 0]
        self.size = np.linalg.norm(self.vector(self.force), axis=1)

    def vector(self, coefficients: np.ndarray) -> Float:
        """Return real unknowns (X_0^c, X_1^c, X_1^s, ...) of complex coefficients."""
        parts = np.empty((len(coefficients), 2 * self.harmonics + 1))
        parts[:, 0] = coefficients[:, 0].real
        parts[:, 1::2], parts[:, 2::2] = coefficients[:, 1:].real, -coefficients[:, 1:].imag
        return parts

    def coefficients(self, vector: Float) -> np.ndarray:
        """Return complex coefficients of real unknowns."""
        found = np.zeros((len(vector), self.harmonics + 1), complex)
        found[:, 0] = vector[:, 0]
        found[:, 1:] = vector[:, 1::2] - 1j * vector[:, 2::2]
        return found

    def residual(self, vector: Float, cases: np.ndarray) -> Float:
        """Return F of (3.22) for unknowns of shape (m, n) of the cases of shape (m,)."""
        moved = self.coefficients(vector)
        force = self.transmitted(moved)
        return self.vector(self.stiffness[cases] * moved + force - self.force[cases])

    def transmitted(self, moved: np.ndarray) -> np.ndarray:
        """Return the coefficients of the force of the damper."""
        return _transmitted(moved)

    def jacobian(self, vector: Float, cases: np.ndarray) -> Float:
        """Return finite differences of F, shape (m, n, n)."""
        count, unknowns = vector.shape
        slip = ss.reference.DAMPER_SLIP_FORCE / ss.reference.DAMPER_STIFFNESS
        step = STEP * np.maximum(np.abs(vector).max(axis=1), slip)
        moved = vector[:, None, :] + step[:, None, None] * np.eye(unknowns)
        base = self.residual(vector, cases)
        ends = self.residual(moved.reshape(-1, unknowns), np.repeat(cases, unknowns))
        slopes = (ends.reshape(count, unknowns, unknowns) - base[:, None, :]) / step[:, None, None]
        return np.ascontiguousarray(slopes.transpose(0, 2, 1))


def _samples(moved: np.ndarray) -> Float:
    """Return displacements at the instants of a period, shape (SAMPLES, m), of coefficients."""
    spectrum = np.zeros((len(moved), SAMPLES // 2 + 1), complex)
    spectrum[:, : moved.shape[1]] = moved
    spectrum[:, 1:] /= 2.0
    return np.fft.irfft(spectrum * SAMPLES, SAMPLES, axis=1).T


def _harmonics(period: Float, kept: int) -> np.ndarray:
    """Return the coefficients of a period of forces, shape (m, kept)."""
    found = np.fft.rfft(period.T, axis=1)[:, :kept] / SAMPLES
    found[:, 1:] *= 2.0
    return found


def _transmitted(moved: np.ndarray) -> np.ndarray:
    """Return the coefficients of the force of the damper, marched through two periods."""
    stiffness, limit = ss.reference.DAMPER_STIFFNESS, ss.reference.DAMPER_SLIP_FORCE
    displacement = _samples(moved)
    change = stiffness * (displacement - np.roll(displacement, 1, axis=0))
    force = np.clip(stiffness * displacement[-1], -limit, limit)
    period = np.empty_like(displacement)
    for _ in range(2):
        for place, step in enumerate(change):
            # np.clip checks more than these two.
            now = np.add(force, step, out=period[place])
            np.maximum(now, -limit, out=now)
            force = np.minimum(now, limit, out=now)
    return _harmonics(period, moved.shape[1])


class Overshooting(Equations):
    """The same equations with the force by Procedure 2, which finds slip one step late.

    Parameters
    ----------
    cases, harmonics
        As of `Equations`.
    corrected : bool
        Whether (6.21) puts a slipping contact on its limit.
    """

    def __init__(
        self, cases: Sequence[tuple[float, float]], harmonics: int, *, corrected: bool
    ) -> None:
        super().__init__(cases, harmonics)
        self.corrected = corrected

    def transmitted(self, moved: np.ndarray) -> np.ndarray:
        """Return the coefficients of the force, marched through three periods."""
        stiffness, limit = ss.reference.DAMPER_STIFFNESS, ss.reference.DAMPER_SLIP_FORCE
        displacement = _samples(moved)
        change = stiffness * (displacement - np.roll(displacement, 1, axis=0))
        force = np.zeros(displacement.shape[1])
        slips = np.zeros(force.shape, bool)
        period = np.empty_like(displacement)
        before = change[-1]
        for _ in range(3):
            for place, step in enumerate(change):
                slips &= step * before > 0.0
                held = np.copysign(limit, force) if self.corrected else force
                force = np.where(slips, held, force + step)
                slips |= np.abs(force) >= limit
                before = step
                period[place] = force
        return _harmonics(period, moved.shape[1])


class Factors(NamedTuple):
    """How the Jacobian is kept: begun from a matrix, changed by u v^T, and solved with."""

    begin: Callable[[Float], tuple[Float, ...]]
    change: Callable[[tuple[Float, ...], Float, Float], tuple[Float, ...]]
    solve: Callable[[tuple[Float, ...], Float], Float]


def _qr_begin(matrix: Float) -> tuple[Float, ...]:
    from scipy.linalg import qr

    q, r = qr(matrix)
    return np.asarray(q, np.float64), np.asarray(r, np.float64)


def _qr_change(kept: tuple[Float, ...], u: Float, v: Float) -> tuple[Float, ...]:
    from scipy.linalg import qr_update

    q, r = qr_update(kept[0], kept[1], u, v, check_finite=False)
    return np.asarray(q, np.float64), np.asarray(r, np.float64)


def _qr_solve(kept: tuple[Float, ...], right: Float) -> Float:
    from scipy.linalg import solve_triangular

    q, r = kept
    return np.asarray(solve_triangular(r, q.T @ right, check_finite=False))


def _lu_begin(matrix: Float) -> tuple[Float, ...]:
    from scipy.linalg import lu

    swaps, lower, upper = lu(matrix)
    return swaps, lower, upper


def _lu_change(kept: tuple[Float, ...], u: Float, v: Float) -> tuple[Float, ...]:
    """Change both factors by Bennett's algorithm, the pivots staying as they are."""
    swaps, lower, upper = kept[0], kept[1].copy(), kept[2].copy()
    left, right = swaps.T @ u, v.copy()
    for place in range(len(left)):
        pivot = upper[place, place]
        changed = pivot + left[place] * right[place]
        if changed == 0.0 or pivot == 0.0:
            return swaps, np.full_like(lower, np.nan), upper
        below = slice(place + 1, None)
        row, column = upper[place, below].copy(), lower[below, place].copy()
        first, second = left[place], right[place]
        upper[place, place] = changed
        upper[place, below] = row + first * right[below]
        left[below] -= first * column
        lower[below, place] = column + second * left[below] / changed
        right[below] -= second * row / pivot
        left[below] *= pivot / changed
    return swaps, lower, upper


def _lu_solve(kept: tuple[Float, ...], right: Float) -> Float:
    from scipy.linalg import solve_triangular

    swaps, lower, upper = kept
    half = solve_triangular(
        lower, swaps.T @ right, lower=True, unit_diagonal=True, check_finite=False
    )
    return np.asarray(solve_triangular(upper, half, check_finite=False))


QR = Factors(_qr_begin, _qr_change, _qr_solve)
LU = Factors(_lu_begin, _lu_change, _lu_solve)


class Method(NamedTuple):
    """A solver: how it gets the next Jacobian, and in which factors."""

    factors: Factors
    newton: bool = False
    """A new Jacobian by differences at every step, instead of Broyden's update."""
    norm: int = 2
    """Power of the norm in (3.33): 2, or 1 as printed."""


METHODS = {
    "Newton, LU": Method(LU, newton=True),
    "Newton, QR": Method(QR, newton=True),
    "Broyden, LU updated": Method(LU),
    "Broyden, QR updated": Method(QR),
    "Broyden, QR, norm as printed": Method(QR, norm=1),
}


class Run(NamedTuple):
    """What became of the cases from one kind of start by one method."""

    method: str
    start: str
    runs: int
    converged: int
    iterations: float
    """Mean of the runs that converged."""
    backward_error: float
    """Largest of any linear solution: |A s + F| / (|A| |s| + |F|)."""
    histories: list[list[float]]
    """Norms of the residual over that of the force, by run and iteration."""


def solve(equations: Equations, begin: Float, method: str, start: str) -> Run:
    """Solve every case from its start.

    Parameters
    ----------
    equations : Equations
        What is solved.
    begin : ndarray of float64, shape (m, n)
        Unknowns at the start.
    method : str
        A name in `METHODS`.
    start : str
        How the start is called.
    """
    factors, newton, norm = METHODS[method]
    everywhere = np.arange(len(begin))
    vector = begin.copy()
    matrix = equations.jacobian(vector, everywhere)
    kept = [factors.begin(one) for one in matrix]
    residual = equations.residual(vector, everywhere)
    histories = [[float(one)] for one in np.linalg.norm(residual, axis=1) / equations.size]
    worst = 0.0
    active = everywhere
    with np.errstate(all="ignore"):
        for _ in range(MOST_NEWTON if newton else MOST):
            sizes = np.array([histories[case][-1] for case in active])
            active = active[(sizes > CONVERGED) & (sizes < LOST)]
            if not active.size:
                break
            step = np.array([factors.solve(kept[case], -residual[case]) for case in active])
            for case, one in zip(active, step, strict=True):
                left = np.linalg.norm(matrix[case] @ one + residual[case])
                whole = np.linalg.norm(matrix[case]) * np.linalg.norm(one)
                share = left / (whole + np.linalg.norm(residual[case]))
                worst = max(worst, float(share)) if np.isfinite(share) else np.inf
            vector[active] += step
            now = equations.residual(vector[active], active)
            if newton:
                matrix[active] = equations.jacobian(vector[active], active)
            for place, case in enumerate(active):
                size = float(np.linalg.norm(now[place]) / equations.size[case])
                histories[case].append(size if np.isfinite(size) else LOST)
                if not np.isfinite(size):
                    continue
                if newton:
                    kept[case] = factors.begin(matrix[case])
                    continue
                # The old residual and the step cancel but for the truth of the old matrix.
                change = (now[place] - residual[case]) - matrix[case] @ step[place]
                change /= np.linalg.norm(step[place]) ** norm
                matrix[case] += np.outer(change, step[place])
                kept[case] = factors.change(kept[case], change, step[place])
            residual[active] = now
    done = [history for history in histories if history[-1] <= CONVERGED]
    mean = float(np.mean([len(history) - 1 for history in done])) if done else np.nan
    return Run(method, start, len(begin), len(done), mean, worst, histories)
