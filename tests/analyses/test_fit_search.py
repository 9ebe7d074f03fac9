"""Whether the search of a fit finds the least misfit among many minima."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss

MASS = np.diag([1.0, 0.5, 0.4])
STIFFNESS = 1e4 * np.array([[2.2, -1.0, 0.0], [-1.0, 2.1, -1.0], [0.0, -1.0, 1.2]])
RIG = ss.Structure(MASS, STIFFNESS, ss.ModalDamping(0.004), ["a", "b", "c"])
TRUE = {"stiffness": 8e3, "gap": 2e-4}
BOUNDS = {"stop.stiffness": (1e3, 1e5), "gap": (1e-5, 1e-2)}


def curves(seed: int, noise: float | None) -> list[ss.Measurement]:
    """Frequencies lie farther apart than the resonance is wide."""
    rng = np.random.default_rng(seed)
    omega = np.linspace(55.0, 110.0, 24)
    tests = []
    for level in (0.3, 1.5, 6.0):
        model = ss.Model(RIG, [ss.Stop("b", **TRUE)], [ss.Force("a", level)])
        seen = ss.forced_response(model, omega, 3, stability=False).amplitude("c")
        seen = seen * (1.0 + 0.02 * rng.standard_normal(omega.size))
        tests.append(ss.Measurement(omega, "c", seen, relative_noise=noise, model=model))
    return tests


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "noise"), [(0, 0.02), (1, 0.02), (2, 0.02), (0, None)])
def test_a_stop_is_found_though_a_resonance_passes_from_frequency_to_frequency(seed, noise):
    tests = curves(seed, noise)
    found = ss.fit(tests[0].model, tests, parameters=BOUNDS, harmonics=3, intervals="covariance")
    assert found.scatter < (0.03 if noise is None else 1.3)
    assert found.values["stop.stiffness"] == pytest.approx(8e3, rel=0.01)
    assert found.values["gap"] == pytest.approx(2e-4, rel=0.02)


def test_starts_with_few_harmonics_count_as_evaluations():
    linear = ss.Model(RIG, [ss.Cubic("b", stiffness=1e6)], [ss.Force("a", 1e-3)])
    seen = ss.forced_response(linear, [60.0, 70.0], 1).amplitude("c")
    test = ss.Measurement([60.0, 70.0], "c", seen, relative_noise=0.02)
    parameters = {"level": (0.5, 2.0)}
    few, many = (
        ss.fit(linear, test, parameters=parameters, harmonics=1, starts=starts)
        for starts in (4, 12)
    )
    assert many.counters["evaluations"] >= 12
    assert few.values["level"] == pytest.approx(1.0, rel=1e-3)
