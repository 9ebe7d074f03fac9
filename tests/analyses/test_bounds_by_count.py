"""Bounds of systems that nobody has chosen hold; benchmarks/bounds_by_count.py has more."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss

SEARCH = 1e-5
FILE = Path(__file__).parents[2] / "benchmarks" / "bounds_by_count.py"


@pytest.fixture(scope="module")
def benchmark():
    spec = importlib.util.spec_from_file_location("bounds_by_count", FILE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.slow
@pytest.mark.parametrize("seed", [2, 3, 4, 12])
def test_random_residuals_lie_inside(benchmark, seed):
    model = benchmark.system(np.random.default_rng(seed))
    natural = np.sort(ss.natural_frequencies(model))
    grid = np.linspace(0.6 * natural[0], 1.15 * natural[2], 6)
    how = {"harmonics": 5, "observe": ["a.x"]}
    plain = ss.forced_response(model, grid, stability=False, **how)
    bounded = ss.forced_response(model, grid, residual="bounds", stability=False, **how)
    assert bounded.counters["evaluations"] <= 6 * plain.counters["evaluations"]
    lower, upper = bounded.lower("a.x"), bounded.upper("a.x")
    assert (upper > 1.001 * lower).any()
    wide = upper - lower > 1e-9 * upper
    np.testing.assert_array_equal(wide, bounded.unique != "yes")
    for residual in np.random.default_rng(1).normal(0.0, 3.0, 8):
        other = ss.forced_response(model, grid, residual=residual, **how)
        held = np.array([stable is not False for stable in other.stable]) & other.converged
        amplitude = other.amplitude("a.x")[held]
        assert (amplitude <= upper[held] * (1.0 + SEARCH)).all()
        assert (amplitude >= lower[held] * (1.0 - SEARCH)).all()


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "at"), [(1, 8), (5, 10), (19, 5)])
def test_vibrations_beside_that_of_the_curve_lie_inside(benchmark, seed, at):
    """Motions in time from random starts settle elsewhere too where the normal load varies."""
    rng = np.random.default_rng(seed)
    model = benchmark.system(rng)
    natural = np.sort(ss.natural_frequencies(model))
    grid = np.linspace(0.6 * natural[0], 1.15 * natural[2], 12)
    frf = ss.forced_response(model, grid, 15, observe=["a.x"], residual="bounds", stability=False)
    lower, upper = frf.lower("a.x")[at], frf.upper("a.x")[at]
    assert upper > 1.05 * lower
    assert frf.unique[at] != "yes"
    size, settled = len(model.structure), []
    for _ in range(6):
        start = ss.State(model, rng.normal(0.0, 2e-2, size), rng.normal(0.0, 0.3, size))
        motion = ss.transient(
            model, omega=grid[at], periods=600, start=start, tolerance=1e-6, keep=1
        )
        if motion.status == "settled":
            settled.append(motion.amplitude("a.x"))
    assert len(settled) >= 2
    assert max(settled) <= upper * 1.002
    assert min(settled) >= lower / 1.002


@pytest.mark.parametrize("seed", [2, 3, 4, 12])
def test_a_frequency_by_itself_is_searched_as_well_as_in_a_curve(benchmark, seed):
    model = benchmark.system(np.random.default_rng(seed))
    natural = np.sort(ss.natural_frequencies(model))
    grid = np.linspace(0.6 * natural[0], 1.15 * natural[2], 12)
    how = {"harmonics": 9, "observe": ["a.x"], "residual": "bounds", "stability": False}
    curve = ss.forced_response(model, grid, **how)
    assert (curve.unique != "yes").any()
    for at in np.flatnonzero(curve.unique != "yes"):
        alone = ss.forced_response(model, [grid[at]], **how)
        assert alone.unique[0] != "yes"
