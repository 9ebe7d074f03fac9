"""Sparse polynomial expansions of a number in uncertain parameters, and Sobol indices.

A number of finite variance that depends on independent parameters is a series of products of
polynomials, orthonormal under their distributions (Wiener 1938; Xiu and Karniadakis 2002). Which
products matter is found by least-angle regression, as many as make the corrected leave-one-out
error least (Blatman and Sudret 2011), by OpenTURNS. The squares of the coefficients are shares of
the variance, hence Sobol indices (Sudret 2008).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from stickslip.checks import constant, optional_package, whole_number
from stickslip.errors import ModelError
from stickslip.results.documented import Frozen
from stickslip.results.fields import Float, Int
from stickslip.results.weibull import Estimate, confidence_of, share_of

if TYPE_CHECKING:
    from scipy.stats.distributions import rv_frozen

FEWEST = 16
"""Samples below which an expansion means nothing."""
_FOLDS = 5
_TERMS = 400
"""Most products of polynomials that are tried: the time of a fit grows with their cube."""
_HIGHEST = 20
"""Highest degree of a product."""
_SPARSE = 0.75
"""Exponent of the hyperbolic truncation: products of many parameters have low degrees."""
_RISES = 2
"""Degrees in turn that do not lower the error, after which no higher one is tried."""
_EXACT = 1e-12
"""Error that no higher degree has to lower: samples are known to six digits at best."""
_RESAMPLED = 200
"""Resampled sets of samples from which intervals are taken."""
_POINTS = 2**14
"""Points at which percentiles of an expansion are taken."""


class SobolIndices(NamedTuple):
    """Shares that parameters have in the variance of a number."""

    first: Mapping[str, Estimate]
    """Share of a parameter alone, by its name."""
    total: Mapping[str, Estimate]
    """Share of a parameter with all that it does together with others."""
    error: float
    """Share of the variance that the expansion does not explain, by cross-validation."""


class Germ(NamedTuple):
    """A standard variable in which a parameter is smooth: uniform on (-1, 1), or normal.

    Parameters between two bounds follow from a uniform one, others from a normal one: a uniform or
    normal parameter is linear in it, a lognormal one its exponential.
    """

    law: rv_frozen[Any, Any]
    bounded: bool

    @classmethod
    def of(cls, law: rv_frozen[Any, Any]) -> Germ:
        """Return the germ of a distribution."""
        return cls(law, bool(np.isfinite(law.support()).all()))

    def at(self, values: Float) -> Float:
        """Return the variable for values of the parameter."""
        from scipy.special import ndtri

        shares = self.law.cdf(values)
        found: Float = 2.0 * shares - 1.0 if self.bounded else ndtri(shares)
        return found

    def polynomials(self, at: Float, degree: int) -> Float:
        """Return the orthonormal polynomials, Legendre's or Hermite's, shape (degree + 1, n)."""
        from scipy.special import eval_hermitenorm, eval_legendre, gammaln

        n = np.arange(degree + 1)[:, np.newaxis]
        found: Float = (
            np.sqrt(2.0 * n + 1.0) * eval_legendre(n, at)
            if self.bounded
            else np.exp(-0.5 * gammaln(n + 1.0)) * eval_hermitenorm(n, at)
        )
        return found


class Expansion(Frozen):
    """A sparse polynomial surrogate of a number in uncertain parameters.

    Attributes
    ----------
    names : tuple of str
        The parameters.
    germs : tuple of Germ
        The standard variables of the parameters.
    points : ndarray of float64, shape (n, d)
        The standard variables at the samples.
    values : ndarray of float64, shape (n,)
        The number at the samples.
    degrees : ndarray of int64, shape (t, d)
        Degrees in the parameters of every product that is kept.
    coefficients : ndarray of float64, shape (t,)
        Their coefficients.
    degree : int
        Highest degree that was tried: given, or that of the least error by cross-validation.
    cross_validation : float
        Error by cross-validation: the mean square of what is left in samples that the fit has not
        seen, over the variance. The products are chosen anew in each of five parts, all of the same
        degree.
    """

    names: tuple[str, ...]
    germs: tuple[Germ, ...]
    points: Float
    values: Float
    degrees: Int
    coefficients: Float
    degree: int
    cross_validation: float

    def __repr__(self) -> str:
        return (
            f"Expansion({self.coefficients.size} terms in {len(self.names)} parameter(s), up to "
            f"degree {self.degree}, error {self.cross_validation:.2g} of the variance)"
        )

    def __call__(self, parameters: Mapping[str, ArrayLike]) -> Float:
        """Return the number at values of all parameters, by their names, shape (n,).

        Raises ModelError if a parameter is missing.
        """
        missing = [name for name in self.names if name not in parameters]
        if missing:
            raise ModelError(f"parameters: {missing[0]!r} is missing; give {', '.join(self.names)}")
        columns = [np.atleast_1d(np.asarray(parameters[name], np.float64)) for name in self.names]
        points = [germ.at(one) for germ, one in zip(self.germs, columns, strict=True)]
        return constant(
            self._design(np.stack(np.broadcast_arrays(*points), axis=1)) @ self.coefficients
        )

    @property
    def mean(self) -> float:
        """Mean of the number."""
        return float(self.coefficients[~self.degrees.any(axis=1)].sum())

    @property
    def deviation(self) -> float:
        """Standard deviation of the number."""
        return float(np.sqrt((self.coefficients[self.degrees.any(axis=1)] ** 2).sum()))

    @property
    def error(self) -> float:
        """Standard deviation of what the expansion misses, by cross-validation."""
        return float(np.sqrt(self.cross_validation * self.values.var()))

    def percentile(self, q: float, confidence: float = 0.95) -> Estimate:
        """Return what q percent do not exceed, with its interval.

        The interval is that of resampled fits. It says nothing of an `error` that is systematic.

        Raises ModelError if q is not between 0 and 100.
        """
        share, level = share_of(q), confidence_of(confidence)
        design = self._design(self._drawn)
        heights = np.quantile(design @ self._resampled.T, share, axis=0)
        value = float(np.quantile(design @ self.coefficients, share))
        return _estimate(value, heights, level)

    def sobol(self, confidence: float = 0.95) -> SobolIndices:
        """Return the Sobol indices of the parameters, with intervals by resampled fits.

        Raises ModelError if the number does not vary.
        """
        level = confidence_of(confidence)
        if not self.deviation > 0.0:
            raise ModelError("sobol: the number does not vary, and has no shares of a variance")
        squares = np.vstack([self.coefficients, self._resampled]) ** 2
        involved = self.degrees > 0
        alone = involved & (involved.sum(axis=1) == 1)[:, np.newaxis]
        whole = squares[:, involved.any(axis=1)].sum(axis=1, keepdims=True)

        def shares(chosen: Any) -> dict[str, Estimate]:
            found = squares @ chosen / whole
            return {
                name: _estimate(float(found[0, at]), found[1:, at], level)
                for at, name in enumerate(self.names)
            }

        return SobolIndices(shares(alone), shares(involved), self.cross_validation)

    @cached_property
    def _resampled(self) -> Float:
        """Coefficients of the kept products for resampled samples, shape (r, t)."""
        # The products are kept: "fast bootstrap" of Marelli and Sudret (2018).
        draw = np.random.default_rng(0)
        design = self._design(self.points)
        left = self.values - design @ self.coefficients
        # What is left is what an unseen sample would leave.
        left = left * (self.error / max(float(left.std()), 1e-300))
        solve = np.linalg.pinv(design)
        fits = [self.coefficients + solve @ draw.choice(left, left.size) for _ in range(_RESAMPLED)]
        return np.stack(fits)

    @cached_property
    def _drawn(self) -> Float:
        """Standard variables that fill their space, shape (points, d)."""
        from scipy.special import ndtri

        shares = drawn_shares("sobol", len(self.names), _POINTS, seed=1)
        bounded = np.array([germ.bounded for germ in self.germs])
        return np.where(bounded, 2.0 * shares - 1.0, ndtri(shares))

    def _design(self, points: Float) -> Float:
        return _products(self.germs, points, self.degrees)


def fit_expansion(
    names: Sequence[str],
    laws: Sequence[rv_frozen[Any, Any]],
    parameters: Float,
    values: Float,
    degree: int | None = None,
) -> Expansion:
    """Return the expansion of a number in independent parameters, from (n, d) samples of them.

    Without a highest degree it has the one of the least error by cross-validation: degrees rise
    from 1 until the error has risen twice running or is below 1e-12, as far as the samples
    allow. Fewer than 16 samples are refused.
    """
    if values.size < FEWEST:
        raise ModelError(
            f"expansion: {values.size} samples; compute at least {FEWEST}, better 10 per parameter"
        )
    germs = tuple(Germ.of(law) for law in laws)
    points = np.stack([germ.at(one) for germ, one in zip(germs, parameters.T, strict=True)], axis=1)
    made = partial(_of_degree, tuple(names), germs, points, values)
    if degree is not None:
        return made(whole_number(degree, "degree", smallest=1))
    best, rises = made(1), 0
    while (
        rises < _RISES
        and best.cross_validation > _EXACT
        and best.degree + rises < _highest(len(germs), values.size)
    ):
        other = made(best.degree + rises + 1)
        # Of noise alone every degree explains nothing: the least one stays.
        better = other.cross_validation < best.cross_validation
        best, rises = (other, 0) if better else (best, rises + 1)
    return best


def _highest(parameters: int, samples: int) -> int:
    """Return the highest degree with two samples for each product."""
    degree, most = 1, min(_TERMS, samples // 2)
    rule = _rule(parameters)
    while degree < _HIGHEST and rule.getBasisSizeFromTotalDegree(degree + 1) <= most:
        degree += 1
    return degree


def _rule(parameters: int) -> Any:
    """Return the order in which products are tried."""
    ot = optional_package("openturns", "polynomial expansions", "openturns", "uncertainty")
    return ot.HyperbolicAnisotropicEnumerateFunction(parameters, _SPARSE)


def _of_degree(
    names: tuple[str, ...], germs: tuple[Germ, ...], points: Float, values: Float, degree: int
) -> Expansion:
    """Return the expansion in products up to a degree, with its error by cross-validation."""
    degrees, coefficients = _selected(germs, points, values, degree)
    variance = float(values.var())
    missed = 0.0
    for fold in range(_FOLDS):
        unseen = np.arange(values.size) % _FOLDS == fold
        kept, found = _selected(germs, points[~unseen], values[~unseen], degree)
        said = _products(germs, points[unseen], kept) @ found
        missed += float(((values[unseen] - said) ** 2).sum())
    return Expansion(
        names=names,
        germs=germs,
        points=constant(points),
        values=constant(values),
        degrees=constant(degrees),
        coefficients=constant(coefficients),
        degree=degree,
        cross_validation=missed / values.size / variance if variance > 0.0 else 0.0,
    )


def _selected(
    germs: Sequence[Germ], points: Float, values: Float, degree: int
) -> tuple[Int, Float]:
    """Return the products that matter, with their coefficients."""
    scale = float(np.abs(values - values.mean()).max())
    if scale <= 1e-14 * abs(float(values.mean())):
        return np.zeros((1, len(germs)), np.int64), np.array([values.mean()])
    ot = optional_package("openturns", "polynomial expansions", "openturns", "uncertainty")
    rule = _rule(len(germs))
    size = rule.getBasisSizeFromTotalDegree(degree)
    families = [ot.LegendreFactory() if one.bounded else ot.HermiteFactory() for one in germs]
    margins = [ot.Uniform(-1.0, 1.0) if one.bounded else ot.Normal() for one in germs]
    algorithm = ot.FunctionalChaosAlgorithm(
        ot.Sample(points),
        # Values from 1 to 3: where their mean is nearly 0, rounding ends the selection too soon.
        ot.Sample(((values - values.mean()) / scale + 2.0)[:, np.newaxis]),
        ot.JointDistribution(margins),
        ot.FixedStrategy(ot.OrthogonalProductPolynomialFactory(families, rule), size),
        ot.LeastSquaresStrategy(
            ot.LeastSquaresMetaModelSelectionFactory(ot.LARS(), ot.CorrectedLeaveOneOut())
        ),
    )
    algorithm.run()
    chosen = [list(rule(place)) for place in algorithm.getResult().getIndices()]
    degrees = np.unique(np.array([[0] * len(germs), *chosen], dtype=np.int64), axis=0)
    design = _products(germs, points, degrees)
    found = np.linalg.lstsq(design, values, rcond=None)[0]
    return degrees, np.asarray(found, np.float64)


def _products(germs: Sequence[Germ], points: Float, degrees: Int) -> Float:
    """Return the products of polynomials at points, shape (n, t)."""
    found = np.ones((len(points), len(degrees)))
    for germ, at, own in zip(germs, points.T, degrees.T, strict=True):
        found *= germ.polynomials(at, int(own.max(initial=0)))[own].T
    return found


def _estimate(value: float, resampled: Float, level: float) -> Estimate:
    low, high = np.quantile(resampled, [0.5 * (1.0 - level), 0.5 * (1.0 + level)])
    return Estimate(value, float(low), float(high))


def drawn_shares(sampling: str, parameters: int, samples: int, seed: int) -> Float:
    """Return points of the unit cube, shape (samples, parameters); see `SampledSettings`."""
    from scipy.stats import qmc

    if sampling == "random":
        return np.random.default_rng(seed).random((samples, parameters))
    sequence = qmc.Sobol(parameters, seed=seed)
    # Powers of 2 only are drawn without a warning.
    drawn: Float = sequence.random_base2(max(samples - 1, 1).bit_length())[:samples]
    # Quantiles at 0 may be infinite.
    return np.clip(drawn, 2.0**-53, 1.0 - 2.0**-53)
