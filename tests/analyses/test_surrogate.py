"""Surrogates, shares of the variance and percentiles against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from scipy import stats

import stickslip as ss
from stickslip.results.expansion import drawn_shares, fit_expansion

MASS, STIFFNESS, FORCE = 1.0, 1e4, 4.0
SLIP = stats.uniform(5.0, 5.0)
SPRING = stats.uniform(2e3, 2e3)


def closed_peak(slip, spring):
    """Return amplitude and frequency of the peak of a mass whose only damping is a Jenkins element.

    Of one harmonic the element has h = 4 F/pi (1 - F/(k A)) out of phase, whatever the frequency:
    the peak is where the rest is in balance, h = P.
    """
    amplitude = 4.0 * slip**2 / (spring * (4.0 * slip - np.pi * FORCE))
    turn = np.arccos(1.0 - 2.0 * slip / (spring * amplitude))
    stiffness = spring / np.pi * (turn - 0.5 * np.sin(2.0 * turn))
    return amplitude, np.sqrt((STIFFNESS + stiffness) / MASS)


@pytest.fixture(scope="module")
def rubbing():
    structure = ss.Structure([[MASS]], [[STIFFNESS]], dofs=["mass"])
    pad = ss.Jenkins("mass", stiffness=3e3, slip_force=7.0, name="pad")
    model = ss.Model(structure, [pad], [ss.Force("mass", FORCE)])
    return ss.uncertainty(
        model,
        {"pad.slip_force": SLIP, "pad.stiffness": SPRING},
        ss.HighestPeak("mass", omega=(50.0, 150.0), measure="fundamental"),
        samples=256,
        harmonics=1,
    )


def test_every_peak_is_that_of_the_closed_form(rubbing):
    assert rubbing.failed == 0
    slip, spring = (rubbing.parameter(name) for name in ("pad.slip_force", "pad.stiffness"))
    amplitude, omega = closed_peak(slip, spring)
    np.testing.assert_allclose(rubbing.values("amplitude"), amplitude, rtol=1e-6)
    np.testing.assert_allclose(rubbing.values("omega"), omega, rtol=1e-4)


@pytest.mark.slow
def test_shares_of_the_variance_are_those_of_the_closed_form(rubbing):
    nodes, weights = leggauss(40)
    shares, weights = 0.5 * (nodes + 1.0), 0.5 * weights
    values = closed_peak(SLIP.ppf(shares)[:, np.newaxis], SPRING.ppf(shares))[0]
    mean = weights @ values @ weights
    variance = weights @ values**2 @ weights - mean**2
    first = [
        (weights @ (values @ weights) ** 2 - mean**2) / variance,
        ((weights @ values) ** 2 @ weights - mean**2) / variance,
    ]
    found = rubbing.expansion("amplitude").sobol()
    assert found.error < 1e-7
    assert [one.value for one in found.first.values()] == pytest.approx(first, abs=1e-6)
    total = [1.0 - first[1], 1.0 - first[0]]
    assert [one.value for one in found.total.values()] == pytest.approx(total, abs=1e-6)
    for shares_of in (found.first, found.total):
        assert all(one.low <= one.value <= one.high for one in shares_of.values())
    expansion = rubbing.expansion("amplitude")
    assert expansion.mean == pytest.approx(mean, rel=1e-6)
    assert expansion.deviation**2 == pytest.approx(variance, rel=1e-5)


@pytest.mark.slow
def test_the_degree_is_that_of_the_least_error(rubbing):
    chosen = rubbing.expansion("amplitude")
    errors = {n: rubbing.expansion("amplitude", degree=n).cross_validation for n in range(1, 16)}
    tried = min(errors[n] for n in range(1, chosen.degree + 3))
    assert errors[chosen.degree] == chosen.cross_validation == tried < 3e-8
    # None that is not tried is much better; as many as the samples allow fit their noise.
    assert min(errors.values()) > 0.5 * chosen.cross_validation
    assert chosen.degree < 10
    assert errors[15] > 10.0 * chosen.cross_validation
    assert f"degree {chosen.degree}" in repr(chosen)
    assert rubbing.expansion("amplitude", degree=3).degree == 3


@pytest.mark.slow
def test_percentiles_are_those_of_the_closed_form(rubbing):
    shares = drawn_shares("sobol", 2, 2**16, seed=5)
    values = closed_peak(SLIP.ppf(shares[:, 0]), SPRING.ppf(shares[:, 1]))[0]
    for q in (5.0, 50.0, 95.0):
        true = np.quantile(values, q / 100.0)
        surrogate = rubbing.expansion("amplitude").percentile(q)
        assert surrogate.value == pytest.approx(true, rel=2e-3)
        own = rubbing.percentile("amplitude", q)
        assert own.low < true < own.high
        assert own.failed == 0


# -------------------------------------------------------------------------------------- estimators


@pytest.mark.slow
def test_ishigami():
    """Ishigami and Homma (1990); Saltelli et al. (2008) for the indices."""
    law = stats.uniform(-np.pi, 2.0 * np.pi)
    at = law.ppf(drawn_shares("sobol", 3, 512, seed=0))
    values = np.sin(at[:, 0]) * (1.0 + 0.1 * at[:, 2] ** 4) + 7.0 * np.sin(at[:, 1]) ** 2
    expansion = fit_expansion(("a", "b", "c"), (law,) * 3, at, values)
    found = expansion.sobol()
    variance = np.pi**4 / 50.0 + np.pi**8 / 1800.0 + 0.5 + 49.0 / 8.0
    alone = 0.5 * (1.0 + np.pi**4 / 50.0) ** 2, 49.0 / 8.0, 0.0
    joint = variance - sum(alone)
    assert [one.value for one in found.first.values()] == pytest.approx(
        [one / variance for one in alone], abs=1e-4
    )
    total = (alone[0] + joint, alone[1], joint)
    assert [one.value for one in found.total.values()] == pytest.approx(
        [one / variance for one in total], abs=1e-4
    )
    unseen = law.ppf(drawn_shares("random", 3, 2000, seed=9))
    true = np.sin(unseen[:, 0]) * (1.0 + 0.1 * unseen[:, 2] ** 4) + 7 * np.sin(unseen[:, 1]) ** 2
    said = expansion({name: unseen[:, place] for place, name in enumerate("abc")})
    error = ((said - true) ** 2).mean() / true.var()
    assert error < 1e-5
    # Four fifths of the samples know less than all of them.
    assert error < expansion.cross_validation < 1e-3


@pytest.mark.slow
def test_parameters_without_bounds_have_hermite_polynomials():
    laws = (stats.norm(2.0, 0.5), stats.lognorm(0.3, scale=4.0))
    shares = drawn_shares("sobol", 2, 128, seed=3)
    at = np.stack([law.ppf(one) for law, one in zip(laws, shares.T, strict=True)], axis=1)
    # A polynomial of degree 3 in the standard variables, which is found exactly.
    values = at[:, 0] ** 2 * np.log(at[:, 1])
    expansion = fit_expansion(("a", "b"), laws, at, values, degree=4)
    assert expansion.cross_validation < 1e-20
    assert expansion.mean == pytest.approx((2.0**2 + 0.5**2) * np.log(4.0))


def test_intervals_of_percentiles_cover_whatever_the_distribution():
    from stickslip.results.weibull import empirical_percentile

    draw, law = np.random.default_rng(2), stats.lognorm(1.0)
    held = 0
    for _ in range(400):
        found = empirical_percentile(law.rvs(60, random_state=draw), 80.0, 0.9)
        held += found.low < law.ppf(0.8) < found.high
    assert 0.89 * 400 < held < 0.97 * 400


def test_missing_samples_may_lie_anywhere():
    from stickslip.results.weibull import empirical_percentile

    data = np.arange(100.0)
    known, missing = (empirical_percentile(data, 50.0, missing=n) for n in (0, 10))
    for hidden in (-1e9, 1e9):
        whole = empirical_percentile(np.append(data, np.full(10, hidden)), 50.0)
        assert missing.low <= whole.low
        assert whole.high <= missing.high
    assert missing.low < known.low < known.high < missing.high
    assert empirical_percentile(data, 97.0, missing=10).high == np.inf


@pytest.mark.slow
def test_bars_of_the_shares(rubbing):
    ax = rubbing.plot_sobol("amplitude")
    named = [label.get_text() for label in ax.get_xticklabels()]
    assert [name.replace("\n", "") for name in named] == ["pad.slip_force", "pad.stiffness"]
    assert "surrogate misses" in ax.get_title()
