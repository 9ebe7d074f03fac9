"""How fast truncation and sampling errors fall: rates, by which a lost order would be seen."""

import numpy as np
import pytest

import stickslip as ss

OMEGA = np.linspace(90.0, 130.0, 12)


@pytest.fixture(scope="module")
def model():
    structure = ss.Structure([[1.0]], [[1e4]], ss.Rayleigh(mass=0.2), ["q"])
    damper = ss.Jenkins("q", stiffness=5e3, slip_force=1.0)
    return ss.Model(structure, [damper], [ss.Force("q", 3.0)])


def rate(counts, errors):
    """Slope of the logarithms, after the mean over all frequencies has smoothed what oscillates."""
    return np.polyfit(np.log(counts), np.log(errors).mean(axis=1), 1)[0]


def test_the_error_falls_with_the_fourth_power_of_the_harmonics(model):
    # A force with kinks has harmonics like 1/k^2, the mass answers them with 1/k^2 once more.
    exact = ss.exact_response(model, OMEGA).amplitude("q")
    counts = [3, 7, 15, 31, 63]
    found = [ss.forced_response(model, OMEGA, harmonics).amplitude("q") for harmonics in counts]
    assert rate(counts, np.abs(np.array(found) / exact - 1.0)) == pytest.approx(-4.0, abs=0.4)


def test_the_error_of_a_march_falls_with_the_square_of_the_samples(model):
    closed = ss.forced_response(model, OMEGA, 15).amplitude("q")
    counts = [64, 128, 256, 512, 1024, 2048]
    found = [
        ss.forced_response(model, OMEGA, 15, evaluation="marched", samples=samples).amplitude("q")
        for samples in counts
    ]
    assert rate(counts, np.abs(np.array(found) / closed - 1.0)) == pytest.approx(-2.0, abs=0.4)
