"""The three-parameter Weibull distribution of amplification factors, with its confidence.

The largest of many responses that cannot exceed some limit follows, whatever they are, the Weibull
distribution of maxima, F(x) = exp(-((b - x)/s)^c) up to the limit b (Fisher and Tippett 1928; for
mistuned disks Castanier and Pierre 2006, and the references there). Whitehead (1966) shows that
amplification has a limit where the disk is linear.

It is fitted by maximum likelihood, and confidence intervals are those of the profile likelihood:
all values of a parameter, or a percentile, whose best fit is not significantly worse (Coles 2001,
section 2.6.6). They are not symmetric, as they should be for what lies beyond the data.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from stickslip.checks import constant, real_number, whole_number
from stickslip.errors import ModelError
from stickslip.results.documented import Frozen
from stickslip.results.fields import Float
from stickslip.results.weibull_likelihood import best_fit, excess_at_no_limit, interval

FEWEST = 30
"""Factors below which three parameters mean nothing."""

_NEGLIGIBLE = 1e-9
"""Relative spread below which factors count as equal."""


class Estimate(NamedTuple):
    """A number with its confidence interval."""

    value: float
    """The most likely value."""
    low: float
    """Lower end of the interval; it may be open, minus infinity."""
    high: float
    """Upper end; it may be open, infinity."""


class Percentile(Estimate):
    """A percentile with its confidence interval, an end of which is open for too few factors."""


class WeibullFit(Frozen):
    """A Weibull distribution of maxima, F(x) = exp(-((location - x)/scale)^shape).

    Attributes
    ----------
    confidence : float
        Probability with which an interval is to hold the true value.
    factors : ndarray of float64, shape (n,)
        What was fitted, ascending.
    best : (float, float, float)
        Shape, scale and location of the greatest likelihood.
    """

    confidence: float
    factors: Float
    best: tuple[float, float, float]

    def __repr__(self) -> str:
        shape, scale, location = self.best
        return (
            f"WeibullFit(shape={shape:.4g}, scale={scale:.4g}, location={location:.4g}, of "
            f"{self.factors.size} factors)"
        )

    @cached_property
    def shape(self) -> Estimate:
        """Exponent c; below 2 intervals are approximate: the theory of the likelihood ends there.

        An upper end of infinity says that the factors show no upper limit.
        """
        return self._estimate(self.best[0], "shape")

    @cached_property
    def scale(self) -> Estimate:
        """Scale s."""
        return self._estimate(self.best[1], "scale")

    @cached_property
    def location(self) -> Estimate:
        """Upper limit b, which no factor exceeds."""
        return self._estimate(self.best[2], 1.0)

    @property
    def limited(self) -> bool:
        """Whether the factors show that there is an upper limit, to the confidence.

        If not, scale and location are nominal; percentiles inside and a little beyond the data are
        still good.
        """
        return self.shape.high < np.inf

    @cached_property
    def distance(self) -> float:
        """Largest distance of the empirical distribution from the fit (Kolmogorov-Smirnov)."""
        return _distance(self.factors, self.best)

    def _estimate(self, value: float, of: str | float) -> Estimate:
        low, high = interval(self.factors, self.best, self.confidence, of)
        return Estimate(value, low, np.inf if self._is_open else high)

    @cached_property
    def _is_open(self) -> bool:
        """Whether the largest shape that is tried is not significantly worse."""
        return excess_at_no_limit(self.factors, self.best, self.confidence) <= 0.0

    def cdf(self, x: ArrayLike) -> Float:
        """Return the probability that a factor is not above x."""
        return np.asarray(_frozen(self.best).cdf(x), dtype=np.float64)

    def quantile(self, probability: ArrayLike) -> Float:
        """Return the factor that is not exceeded with a probability from 0 to 1."""
        return np.asarray(_frozen(self.best).ppf(probability), dtype=np.float64)

    def percentile(self, q: float) -> Percentile:
        """Return a percentile of the fit, with the interval of its profile likelihood.

        Raises ModelError if q lies outside.

        Parameters
        ----------
        q : float
            From 0 to 100, exclusive: 99.9.
        """
        share = share_of(q)
        value = float(self.quantile(share))
        return Percentile(value, *interval(self.factors, self.best, self.confidence, share))

    def test(self, samples: int = 99, seed: int = 0) -> float:
        """Return how likely so large a distance is, if the distribution is right.

        The share of draws with a larger one, from 1/(samples + 1) to 1; below 0.05 the distribution
        is doubtful.

        Raises ModelError if samples or seed are no whole numbers in their range.

        Parameters
        ----------
        samples : int, optional
            Samples of the fit that are drawn, each fitted anew (parametric bootstrap).
        seed : int, optional
            Of the draws.
        """
        count = whole_number(samples, "samples", smallest=19)
        generator = np.random.default_rng(whole_number(seed, "seed"))
        frozen, larger = _frozen(self.best), 0
        for _ in range(count):
            drawn = np.sort(frozen.rvs(self.factors.size, random_state=generator))
            larger += _distance(drawn, best_fit(drawn)) >= self.distance
        return (1 + larger) / (1 + count)


def fit_weibull(factors: ArrayLike, confidence: float = 0.95) -> WeibullFit:
    """Fit a Weibull distribution of maxima to factors, of which not-a-number is left out."""
    level = confidence_of(confidence)
    data = _sorted(factors)
    if data.size < FEWEST:
        raise ModelError(
            f"weibull: {data.size} factors for three parameters; compute at least {FEWEST} patterns"
        )
    if data[-1] - data[0] <= _NEGLIGIBLE * abs(data[-1]):
        raise ModelError(
            f"weibull: all {data.size} factors are {data[0]:.6g}, which is no distribution; give a "
            "deviation above 0"
        )
    return WeibullFit(confidence=level, factors=constant(data), best=best_fit(data))


def empirical_percentile(
    factors: ArrayLike, q: float, confidence: float = 0.95, missing: int = 0
) -> Percentile:
    """Return a percentile of the factors themselves, whatever their distribution.

    Its interval is that of order statistics (binomial); ends for which there are too few factors
    are infinite. Factors that are `missing` may be any number, which makes the interval wider.
    """
    from scipy.stats import binom

    share, level = share_of(q), confidence_of(confidence)
    data = _sorted(factors)
    if not data.size:
        raise ModelError("percentile: no factor; compute at least one pattern")
    tail = 0.5 * (1.0 - level)
    # P(X_(k) <= x_q) is that of at least k factors below.
    below = binom.cdf(np.arange(data.size + missing), data.size + missing, share)
    low = np.flatnonzero(below <= tail)[-1:] - missing
    high = np.flatnonzero(below >= 1.0 - tail)[:1]
    return Percentile(
        float(np.quantile(data, share)),
        float(data[low[0]]) if low.size and low[0] >= 0 else -np.inf,
        float(data[high[0]]) if high.size and high[0] < data.size else np.inf,
    )


def _sorted(factors: ArrayLike) -> Float:
    data = np.sort(np.asarray(factors, dtype=np.float64).ravel())
    return data[np.isfinite(data)]


def share_of(q: float) -> float:
    """Return a percentage as a share, or refuse what is none."""
    return _inside(q, "q", 100.0, "a percentile between 0 and 100, 99.9") / 100.0


def confidence_of(value: float) -> float:
    """Return a confidence, or refuse what is none."""
    return _inside(value, "confidence", 1.0, "a probability between 0 and 1, 0.95")


def _inside(value: float, entry: str, most: float, remedy: str) -> float:
    number = real_number(value, entry)
    if not 0.0 < number < most:
        raise ModelError(f"{entry}: {number:g}; give {remedy}")
    return number


def _frozen(best: tuple[float, float, float]) -> Any:
    from scipy.stats import weibull_max

    shape, scale, location = best
    return weibull_max(shape, loc=location, scale=scale)


def _distance(data: Float, best: tuple[float, float, float]) -> float:
    probability = _frozen(best).cdf(data)
    steps = np.arange(data.size + 1) / data.size
    return float(max((steps[1:] - probability).max(), (probability - steps[:-1]).max()))
