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
