"""How far predictions lie from measurements, and how the intervals of parameters follow."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np

from stickslip.analyses.arguments import highest_harmonic
from stickslip.analyses.fit_parameters import FitParameter
from stickslip.analyses.prediction import Prediction
from stickslip.model import Model
from stickslip.model.measurement import Measured
from stickslip.results.arrays import Bool, Float
from stickslip.settings.balance import HarmonicSettings

_STEPS = 20
"""Steps to an end of an interval."""
_SETTLED = 1e-3
"""Share of the rise of the misfit within which an end is found."""
_FAR = 2.0
"""Longest step, in standard deviations of the distance to the end."""


class Evaluation:
    """The misfit at one place; derivatives are made when asked for."""

    def __init__(
        self, predictions: Sequence[Prediction], measured: Sequence[Measured], rates: Float
    ) -> None:
        self.predictions = tuple(predictions)
        self._measured, self._rates = tuple(measured), rates
        pairs = zip(self.predictions, self._measured, strict=True)
        self.residuals: Float = np.concatenate(
            [(one.values - test.observed) / test.deviation for one, test in pairs]
        )
        """(m,) Prediction less measurement, over the standard deviation."""
        self.misfit = float(self.residuals @ self.residuals)
        """Sum of the squares."""

    @cached_property
    def jacobian(self) -> Float:
        """(m, k) Derivatives of the residuals in the scaled parameters."""
        pairs = zip(self.predictions, self._measured, strict=True)
        return np.concatenate(
            [one.slopes * self._rates / test.deviation[:, np.newaxis] for one, test in pairs]
        )


class Misfit:
    """The misfit of measurements, at parameters that are scaled to 0 to 1.

    `look` is called before every evaluation; it may raise.
    """

    def __init__(
        self,
        measured: Sequence[Measured],
        model: Model,
        parameters: Sequence[FitParameter],
        settings: HarmonicSettings,
        look: Callable[[], None],
    ) -> None:
        self.measured, self.model = tuple(measured), model
        self.parameters, self.settings = tuple(parameters), settings
        self.evaluations = 0
        self._look = look
        self._last: tuple[Float, Evaluation] | None = None

    @property
    def noise_known(self) -> bool:
        """Whether standard deviations are known."""
        return self.measured[0].noise_known

    @property
    def expected(self) -> float:
        """Misfit up to which a model fits within the noise, with a factor of two to spare."""
        return 2.0 * sum(test.observed.size for test in self.measured)

    def coarse(self, harmonics: int) -> Misfit:
        """Return the same misfit with few harmonics."""
        most = max(highest_harmonic(test.model or self.model) for test in self.measured)
        kept = min(max(harmonics, most), self.settings.highest)
        settings = self.settings.model_copy(update={"harmonics": kept})
        return Misfit(self.measured, self.model, self.parameters, settings, self._look)

    def values(self, scaled: Float) -> Float:
        """Return the values of the parameters."""
        pairs = zip(self.parameters, scaled, strict=True)
        return np.array([one.value(float(at)) for one, at in pairs])

    def at(self, scaled: Float) -> Evaluation:
        """Return residuals and their derivatives."""
        if self._last is not None and np.array_equal(self._last[0], scaled):
            return self._last[1]
        self._look()
        self.evaluations += 1
        values = self.values(scaled)
        rates = np.array([p.rate(float(v)) for p, v in zip(self.parameters, values, strict=True)])
        found = [
            Prediction(test, self.model, self.parameters, values, self.settings)
            for test in self.measured
        ]
        made = Evaluation(found, self.measured, rates)
        self._last = np.array(scaled), made
        return made


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
    least = max(values[-1], 1e-300) * 1e-15
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
    """
    start = covariance_ends(best, covariance(misfit.at(best).jacobian, variance), quantile)
    least = misfit.at(best).misfit
    ends, found = np.stack([start.low, start.high]), start.found.copy()
    count = best.size
    for place in range(count):
        for side in range(2):
            end = _profile_end(misfit, best, place, 2 * side - 1, least, variance * quantile**2)
            if end is not None:
                ends[side, place], found[place, side] = end
            told((2 * place + side + 1) / (2 * count))
    return Ends(ends[0], ends[1], found)


def _profile_end(
    misfit: Misfit, best: Float, place: int, sign: int, least: float, rise: float
) -> tuple[float, bool] | None:
    """Return one end, and whether it is no bound; None if Newton's method does not settle."""
    others = np.arange(best.size) != place
    at, limit = best.copy(), least + rise
    for step in range(_STEPS):
        here = misfit.at(at)
        if step and abs(here.misfit - limit) <= _SETTLED * rise:
            gradient = here.jacobian.T @ here.residuals
            if _decrement(here.jacobian[:, others], gradient[others]) <= _SETTLED * rise:
                return float(at[place]), True
        at, stopped = _profile_step(here, at, place, sign, limit)
        if stopped:
            # The other parameters settle at the bound, where the misfit stays below the limit.
            here = misfit.at(at)
            if here.misfit <= limit:
                return float(at[place]), False
    return None


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
