"""How far predictions lie from measurements."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property

import numpy as np

from stickslip.analyses.arguments import highest_harmonic
from stickslip.analyses.fit_parameters import FitParameter
from stickslip.analyses.prediction import Prediction
from stickslip.model import Model
from stickslip.model.measurement import Measured
from stickslip.results.fields import Bool, Float
from stickslip.settings.fit import FitSettings

_INSIDE = 1e-9
"""Distance of starts from the bounds."""
_SETTLED = 1e-8
"""Relative change of place and misfit at which a least misfit is found."""
_BESIDE = 1e-6
"""That at which a least robust sum is found, from which the least misfit is looked for."""


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


def robust(residuals: Float, scale: float) -> float:
    """Return the sum of the squares that counts residuals far beyond a scale by their logarithm."""
    return float(scale**2 * np.log1p((residuals / scale) ** 2).sum())


class Misfit:
    """The misfit of measurements, at parameters that are scaled to 0 to 1.

    `look` is called before every evaluation; it may raise.
    """

    def __init__(
        self,
        measured: Sequence[Measured],
        model: Model,
        parameters: Sequence[FitParameter],
        settings: FitSettings,
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

    def least(
        self, start: Float, free: Bool | None = None, *, scale: float | None = None
    ) -> tuple[float, Float]:
        """Return the misfit that a start leads to and its place, with only these free.

        It is the least one; or with a `scale` that at the least `robust` sum.
        """
        from scipy.optimize import least_squares

        mask = np.ones(start.size, bool) if free is None else free

        def whole(part: Float) -> Float:
            there = start.copy()
            there[mask] = part
            return there

        def residuals(part: Float) -> Float:
            return self.at(whole(part)).residuals

        def jacobian(part: Float) -> Float:
            return self.at(whole(part)).jacobian[:, mask]

        found = least_squares(
            residuals,
            np.clip(start[mask], _INSIDE, 1.0 - _INSIDE),
            jac=jacobian,
            bounds=(0.0, 1.0),
            xtol=_SETTLED if scale is None else _BESIDE,
            ftol=_SETTLED if scale is None else _BESIDE,
            max_nfev=self.settings.max_evaluations,
            loss="linear" if scale is None else "cauchy",
            f_scale=scale or 1.0,
        )
        end = whole(found.x)
        return self.at(end).misfit, end
