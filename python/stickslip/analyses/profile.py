"""Intervals of parameters: by the covariance at the best fit, and by profiles of the misfit."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from stickslip.analyses.misfit import Evaluation, Misfit
from stickslip.results.fields import Bool, Float

_STEPS = 20
"""Steps to an end of an interval."""
_SETTLED = 1e-3
"""Share of the rise of the misfit within which an end is found."""
_WALK = 0.05
"""First step of a walk to an end, of the way from bound to bound."""
_CLOSE = 1e-4
"""Last step of such a walk."""
_NOTHING = 1e-150
"""Square of a scaled derivative that is none; its inverse is a number still."""


class Ends(NamedTuple):
    """The ends of the intervals of all parameters, scaled."""

    low: Float
    high: Float
    found: Bool
    """(k, 2) Whether the end was found; else it is that of the covariance, or a bound."""


def covariance(jacobian: Float, variance: float) -> Float:
    """Return the covariance of the scaled parameters, shape (k, k).

    Directions that the data do not touch have a variance of 1 / rounding, beyond any bound.
    """
    values, vectors = np.linalg.eigh(jacobian.T @ jacobian)
    least = max(values[-1], _NOTHING) * 1e-15
    found: Float = variance * (vectors / np.maximum(values, least)) @ vectors.T
    return found


def covariance_ends(best: Float, spread: Float, quantile: float) -> Ends:
    """Return the ends at so many standard deviations, within the bounds."""
    reach = quantile * np.sqrt(np.diag(spread))
    low, high = np.clip(best - reach, 0.0, 1.0), np.clip(best + reach, 0.0, 1.0)
    return Ends(low, high, np.stack([best - reach >= 0.0, best + reach <= 1.0], axis=1))


def profile_ends(
    misfit: Misfit, best: Float, variance: float, quantile: float, told: Callable[[float], None]
) -> Ends:
    """Return the ends at which the misfit, least over the other parameters, has risen by q^2 s^2.

    At an end the misfit is at its limit and stationary in all other parameters: these are k
    equations, solved by Newton's method with the Gauss-Newton matrix (Venzon and Moolgavkar 1988).
    A parameter that can go to its bound before ends there.

    Along a parameter that is open at one end the misfit is a valley, and the best fit may lie
    anywhere in it. The others may go farther at the closed end of the valley than beside the best
    fit, so that their ends are looked for from there as well.
    """
    count = best.size
    start = covariance_ends(best, covariance(misfit.at(best).jacobian, variance), quantile)
    limit = misfit.at(best).misfit + variance * quantile**2
    sides = [(place, sign) for place in range(count) for sign in (-1, 1)]
    ends: dict[tuple[int, int], _End | None] = {}
    for number, (place, sign) in enumerate(sides, 1):
        end = _newton_end(misfit, best, place, sign, limit, variance * quantile**2)
        ends[place, sign] = end or _walked_end(misfit, best, place, sign, limit)
        told(number / len(sides))
    beside = dict(ends)
    for valley, sign in sides:
        closed, other = beside[valley, sign], beside[valley, -sign]
        if closed is None or not closed.found or other is None or other.found:
            continue
        for place, side in sides:
            end = _newton_end(misfit, closed.at, place, side, limit, variance * quantile**2)
            known = ends[place, side]
            if end and (known is None or side * (end.at[place] - known.at[place]) > 0.0):
                ends[place, side] = end
    low, high, found = start.low.copy(), start.high.copy(), start.found.copy()
    for (place, sign), known in ends.items():
        if known is not None:
            (low if sign < 0 else high)[place] = known.at[place]
            found[place, (sign + 1) // 2] = known.found
    return Ends(low, high, found)


class _End(NamedTuple):
    """One end of the interval of a parameter."""

    at: Float
    """(k,) All parameters there."""
    found: bool
    """Whether it is no bound."""


def _newton_end(
    misfit: Misfit, start: Float, place: int, sign: int, limit: float, rise: float
) -> _End | None:
    """Return an end; None if Newton's method does not settle."""
    others = np.arange(start.size) != place
    at = start.copy()
    for step in range(_STEPS):
        here = misfit.at(at)
        if step and abs(here.misfit - limit) <= _SETTLED * rise:
            gradient = here.jacobian.T @ here.residuals
            if _decrement(here.jacobian[:, others], gradient[others]) <= _SETTLED * rise:
                return _End(at, True)
        at, stopped = _profile_step(here, at, place, sign, limit)
        if stopped:
            # The other parameters settle at the bound, where the misfit stays below the limit.
            here = misfit.at(at)
            if here.misfit <= limit:
                return _End(at, False)
    return None


def _walked_end(misfit: Misfit, best: Float, place: int, sign: int, limit: float) -> _End | None:
    """Return an end that is sought step by step from the best fit, where the misfit has kinks.

    None if the misfit is not below the limit beside the best fit.
    """
    others = np.arange(best.size) != place
    inside, step, moved = best.copy(), _WALK, False
    while step > _CLOSE:
        there = inside.copy()
        there[place] = np.clip(inside[place] + sign * step, 0.0, 1.0)
        least = misfit.at(there).misfit
        if others.any():
            least, there = misfit.least(there, others)
        if least > limit:
            step *= 0.5
            continue
        inside, moved = there, True
        if inside[place] in (0.0, 1.0):
            return _End(inside, False)
    return _End(inside, True) if moved else None


def _decrement(jacobian: Float, gradient: Float) -> float:
    """Return by how much the misfit would still fall in some parameters."""
    if not gradient.size:
        return 0.0
    step, *_ = np.linalg.lstsq(jacobian.T @ jacobian, gradient, rcond=1e-14)
    return float(gradient @ step)


def _profile_step(
    here: Evaluation, at: Float, place: int, sign: int, limit: float
) -> tuple[Float, bool]:
    """Return the next place on the way to an end, and whether it is a bound.

    With the other parameters at the least misfit of the quadratic model, that is
    m + 2 b d + a d^2 in the step d of this parameter.
    """
    others = np.arange(at.size) != place
    J, r = here.jacobian, here.residuals
    rest, own = J[:, others], J[:, place]
    back, *_ = np.linalg.lstsq(rest, r, rcond=1e-12)
    follow, *_ = np.linalg.lstsq(rest, own, rcond=1e-12)
    left, lone = r - rest @ back, own - rest @ follow
    m, b, a = float(left @ left), float(lone @ left), float(lone @ lone)
    root = b * b - a * (m - limit)
    if a <= 0.0 or root < 0.0:
        # The quadratic model nowhere reaches the limit: to the least misfit first.
        move = -b / a if a > 0.0 else float(sign)
    else:
        move = (-b + sign * np.sqrt(root)) / a
    step = np.zeros(at.size)
    step[place] = move
    step[others] = -back - follow * move
    longest = np.abs(step).max()
    step *= min(1.0, 0.3 / longest) if longest > 0.0 else 1.0
    there = np.clip(at + step, 0.0, 1.0)
    outward = sign * move > 0.0
    return there, bool(outward and there[place] in (0.0, 1.0))
