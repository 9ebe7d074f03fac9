"""Weibull distributions of maxima: fits, intervals, percentiles, samples that are none."""

import numpy as np
import pytest
from scipy.stats import gumbel_r, weibull_max

import stickslip as ss
from stickslip.results.weibull import empirical_percentile, fit_weibull


def sample(shape, count, seed=0, location=2.0, scale=0.5):
    return weibull_max.rvs(shape, loc=location, scale=scale, size=count, random_state=seed)


@pytest.mark.slow
@pytest.mark.parametrize(("shape", "count"), [(1.5, 300), (3.0, 100), (6.0, 1000), (15.0, 3000)])
def test_the_fit_has_the_greatest_likelihood(shape, count):
    data = sample(shape, count)
    fit = fit_weibull(data)
    own = (fit.shape.value, fit.location.value, fit.scale.value)
    best = weibull_max.logpdf(data, own[0], own[1], own[2]).sum()
    found = weibull_max.fit(data, own[0], loc=own[1], scale=own[2])
    assert best >= weibull_max.logpdf(data, *found).sum() - 1e-6
    assert best > weibull_max.logpdf(data, shape, 2.0, 0.5).sum()
    assert fit.location.value > data.max()
    assert fit.quantile(0.3) == pytest.approx(weibull_max.ppf(0.3, own[0], own[1], own[2]))
    assert fit.cdf(fit.quantile(0.3)) == pytest.approx(0.3)
    for estimate, true in ((fit.shape, shape), (fit.scale, 0.5), (fit.location, 2.0)):
        assert estimate.low < estimate.value < estimate.high
        assert estimate.low < 1.2 * true
        assert estimate.high > 0.8 * true


@pytest.mark.slow
def test_intervals_hold_the_truth_as_often_as_they_say():
    true = weibull_max.ppf(0.999, 6.0, loc=2.0, scale=0.5)
    held = 0
    for seed in range(25):
        high = fit_weibull(sample(6.0, 200, seed), confidence=0.8).percentile(99.9)
        held += high.low <= true <= high.high
    # 20 of 25 expected, more or less 2
    assert 13 <= held <= 25
    narrow, wide = (fit_weibull(sample(6.0, 200), level).percentile(99.9) for level in (0.5, 0.99))
    assert wide.low < narrow.low < narrow.high < wide.high


def test_the_interval_is_that_of_the_likelihood():
    # Held at an end of its interval, the best fit is worse by half the quantile of chi squared.
    from scipy.optimize import minimize

    data = sample(4.0, 200)
    fit = fit_weibull(data)
    best = weibull_max.logpdf(data, fit.best[0], fit.best[2], fit.best[1]).sum()
    for end in fit.location[1:]:
        held = minimize(
            lambda at, b=end: -weibull_max.logpdf(data, np.exp(at[0]), b, np.exp(at[1])).sum(),
            np.log([fit.best[0], fit.best[1]]),
            method="Nelder-Mead",
        )
        assert best + held.fun == pytest.approx(1.9207, abs=0.01)


@pytest.mark.slow
def test_factors_without_a_limit_say_so():
    data = gumbel_r.rvs(1.3, 0.1, size=400, random_state=1)
    fit = fit_weibull(data)
    assert not fit.limited
    assert fit.location.high == fit.shape.high == np.inf
    high = fit.percentile(99.0)
    assert high.low < gumbel_r.ppf(0.99, 1.3, 0.1) < high.high
    assert fit_weibull(sample(3.0, 400)).limited


@pytest.mark.slow
def test_the_goodness_of_fit_tells_right_from_wrong():
    right = fit_weibull(sample(5.0, 150))
    assert right.test(samples=39) > 0.05
    wrong = np.concatenate([np.linspace(1.0, 1.1, 75), np.linspace(1.9, 2.0, 75)])
    fit = fit_weibull(wrong)
    assert fit.distance > 0.2
    assert fit.test(samples=39) == pytest.approx(1 / 40)


def test_empirical_percentiles():
    data = np.arange(1, 1001) / 1000.0
    found = empirical_percentile(data, 90.0)
    assert found.value == pytest.approx(0.9, abs=1e-3)
    # binomial: 900 +- 1.96 sqrt(1000 0.9 0.1)
    assert found.low == pytest.approx(0.881, abs=2e-3)
    assert found.high == pytest.approx(0.919, abs=2e-3)
    assert empirical_percentile(data[:20], 99.9).high == np.inf
    assert empirical_percentile(data[:20], 0.1).low == -np.inf


@pytest.mark.parametrize(
    ("factors", "message"),
    [
        ([1.2] * 10 + [np.nan] * 90, "10 factors for three parameters; compute at least 30"),
        ([1.2] * 50, "all 50 factors are 1.2, which is no distribution; give a deviation above 0"),
    ],
)
def test_samples_that_are_no_distribution(factors, message):
    with pytest.raises(ss.ModelError, match=message):
        fit_weibull(factors)


def test_bad_arguments():
    fit = fit_weibull(sample(5.0, 50))
    for q in (0.0, 100.0, -3):
        with pytest.raises(ss.ModelError, match="give a percentile between 0 and 100"):
            fit.percentile(q)
    with pytest.raises(ss.ModelError, match="confidence: 1; give a probability"):
        fit_weibull(sample(5.0, 50), 1.0)
    with pytest.raises(ss.ModelError, match="samples: 3 lies below 19"):
        fit.test(3)
    with pytest.raises(ss.ModelError, match="percentile: no factor"):
        empirical_percentile([np.nan], 50.0)
