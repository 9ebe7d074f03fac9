"""The likelihood of a Weibull distribution of maxima, its greatest value and its profiles.

It is written in the form of generalised extreme values, of median m, spread d and k = 1/shape,
which stays well scaled where the limit recedes (k to 0): x_q = m + d (h(q) - h(1/2)),
h(q) = (1 - (-ln q)^k)/k, scale d/k, limit m + d (1/k - h(1/2)).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from stickslip.results.fields import Float

_SHAPES = (1.0, 500.0)
"""Bounds of the shape: below 1 the likelihood has no maximum; at 500 no limit can be told."""
_FAR = 1e4
"""Standard deviations beyond which an interval counts as open."""

_IMPOSSIBLE = 1e100
"""Stands for infinity, of which a simplex can take differences."""

_Trial = Callable[[NDArray[np.float64]], tuple[float, float, float]]


def _h(share: float, k: float) -> float:
    return float((1.0 - (-np.log(share)) ** k) / k) if share < 1.0 else 1.0 / k


def _surprise(data: Float, m: float, d: float, k: float) -> float:
    """Return minus the logarithm of the likelihood; immense outside the bounds."""
    if not (d > 0.0 and 1.0 / _SHAPES[1] <= k <= 1.0 / _SHAPES[0]):
        return _IMPOSSIBLE
    # ((b - x)/s) = 1 - k z
    inside = 1.0 - k * ((data - m) / d + _h(0.5, k))
    if not inside[-1] > 0.0:
        return _IMPOSSIBLE
    logs = np.log(inside)
    powers = np.exp(logs / k)
    return float(data.size * np.log(d) - (1.0 / k - 1.0) * logs.sum() + powers.sum())


def _least(data: Float, trial: _Trial, start: NDArray[np.float64]) -> tuple[float, Float]:
    """Return the least surprise over what `trial` makes of its unknowns, and where."""
    from scipy.optimize import minimize

    def surprise(at: NDArray[np.float64]) -> float:
        return _surprise(data, *trial(at))

    step = np.vstack([start, *(start + 0.1 * row for row in np.eye(start.size))])
    found = minimize(
        surprise,
        start,
        method="Nelder-Mead",
        options={"xatol": 1e-6, "fatol": 1e-8, "maxiter": 2000, "initial_simplex": step},
    )
    return float(found.fun), np.asarray(found.x)


def best_fit(data: Float) -> tuple[float, float, float]:
    """Return shape, scale and location of the greatest likelihood."""
    middle, spread = float(np.median(data)), float(data.std())

    def trial(at: NDArray[np.float64]) -> tuple[float, float, float]:
        return middle + spread * at[0], spread * np.exp(at[1]), np.exp(at[2])

    best = (np.inf, np.zeros(3))
    for k in (0.1, 0.5):
        # The limit must lie above the data.
        reach = (data[-1] - middle) / (1.0 / k - _h(0.5, k)) / spread
        start = np.array([0.0, np.log(max(0.8, 1.05 * reach)), np.log(k)])
        best = min(best, _least(data, trial, start), key=lambda one: one[0])
    # Once more from there: the simplex may have collapsed at a bound.
    m, d, k = map(float, trial(_least(data, trial, best[1])[1]))
    return 1.0 / k, d / k, m + d * (1.0 / k - float(_h(0.5, k)))


def interval(
    data: Float, best: tuple[float, float, float], confidence: float, of: str | float
) -> tuple[float, float]:
    """Return the interval of "shape", "scale" or the quantile of a probability up to 1."""
    m, d, k = _median_form(best)
    spread, allowed = float(data.std()), _allowed(data, best, confidence)
    # Unknowns beside what is held: median, spread and 1/shape, two of them.
    log_d, log_k = np.log(d / spread), np.log(k)

    def held(value: float, at: NDArray[np.float64]) -> tuple[float, float, float]:
        if of == "shape":
            return m + spread * at[0], spread * np.exp(at[1]), 1.0 / value
        if of == "scale":
            inverse = np.exp(at[1])
            return m + spread * at[0], value * inverse, inverse
        width, inverse = spread * np.exp(at[0]), np.exp(at[1])
        return value - width * (_h(float(of), inverse) - _h(0.5, inverse)), width, inverse

    start = {"shape": [0.0, log_d], "scale": [0.0, log_k]}.get(str(of), [log_d, log_k])
    logarithmic = isinstance(of, str)
    if isinstance(of, str):
        value = 1.0 / k if of == "shape" else d / k
    else:
        value = m + d * (_h(of, k) - _h(0.5, k))

    def excess(at: float, guess: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
        number = np.exp(at) if logarithmic else at
        least, where = _least(data, lambda free: held(number, free), guess)
        return least - allowed, where

    origin = float(np.log(value)) if logarithmic else float(value)
    step = (0.5 if logarithmic else spread) / np.sqrt(data.size)
    ends = [
        _end(excess, origin, sign * step, np.array(start), spread, logarithmic) for sign in (-1, 1)
    ]
    low, high = (float(np.exp(end)) if logarithmic else float(end) for end in ends)
    return (max(low, _SHAPES[0]) if of == "shape" else low), high


def _median_form(best: tuple[float, float, float]) -> tuple[float, float, float]:
    shape, scale, location = best
    k = 1.0 / shape
    return location - scale * k * (1.0 / k - _h(0.5, k)), scale * k, k


def _allowed(data: Float, best: tuple[float, float, float], confidence: float) -> float:
    """Return the surprise that is just not significantly more than the least."""
    from scipy.stats import chi2

    return _surprise(data, *_median_form(best)) + 0.5 * float(chi2.ppf(confidence, 1))


def excess_at_no_limit(data: Float, best: tuple[float, float, float], confidence: float) -> float:
    """Return by how much the largest shape is significantly worse than the best."""
    m, d, _ = _median_form(best)
    spread, k = float(data.std()), 1.0 / _SHAPES[1]

    def trial(at: NDArray[np.float64]) -> tuple[float, float, float]:
        return m + spread * at[0], spread * np.exp(at[1]), k

    least, _ = _least(data, trial, np.array([0.0, np.log(d / spread)]))
    return least - _allowed(data, best, confidence)


def _end(
    excess: Callable[[float, NDArray[np.float64]], tuple[float, NDArray[np.float64]]],
    origin: float,
    step: float,
    guess: NDArray[np.float64],
    spread: float,
    logarithmic: bool,
) -> float:
    """Return where the excess crosses zero on one side; infinite if it does so nowhere."""
    farthest = np.log(_FAR) if logarithmic else _FAR * spread
    inner, outer = origin, origin + step
    while True:
        over, where = excess(outer, guess)
        if over > 0.0:
            break
        inner, guess, step = outer, where, 1.7 * step
        outer = inner + step
        if abs(outer - origin) > farthest:
            return float(np.copysign(np.inf, step))
    for _ in range(40):
        if abs(outer - inner) <= 1e-4 * abs(outer - origin):
            break
        middle = 0.5 * (inner + outer)
        over, where = excess(middle, guess)
        if over > 0.0:
            outer = middle
        else:
            inner, guess = middle, where
    return 0.5 * (inner + outer)
