"""Responses along the speed of rotation where several motions exist."""

import numpy as np
import pytest

import stickslip as ss

ORDER = 2.0
SPEEDS = np.linspace(0.52, 0.86, 35)


def hardening(speed, stiffening=0.0):
    """A Duffing oscillator, which may stiffen with the speed."""
    body = ss.Structure([[1.0]], [[1.0 + stiffening * speed**2]], [[0.06]], ["x"])
    return ss.Model(body, [ss.Cubic("x", stiffness=1.0)], [ss.Force("x", 0.1)])


def along(speeds, **changed):
    return ss.speed_response(
        lambda speed: hardening(speed, **changed), speeds, engine_order=ORDER, dof="x"
    )


def swept(speeds):
    return ss.forced_response(hardening(0.0), ORDER * speeds, 7).amplitude("x")


def test_branch_in_the_direction_of_the_speeds():
    """A model that is the same at all speeds is swept over the frequency."""
    up, down = along(SPEEDS).amplitude, along(SPEEDS[::-1]).amplitude[::-1]
    np.testing.assert_allclose(up, swept(SPEEDS), rtol=1e-6)
    np.testing.assert_allclose(down, swept(SPEEDS[::-1])[::-1], rtol=1e-6)
    several = up > 1.5 * down
    assert several.sum() > 5
    # The upper branch ends once, and the lower one begins once.
    assert np.count_nonzero(np.diff(several)) == 2


def test_branch_of_a_model_that_changes():
    """Every speed lies on the branch that arclength follows through the model of that speed."""
    up, down = (along(speeds, stiffening=0.3) for speeds in (SPEEDS, SPEEDS[::-1]))
    lower = down.amplitude[::-1]
    several = np.flatnonzero(up.amplitude > 1.5 * lower)
    assert several.size > 5
    for index in several:
        model, omega = hardening(SPEEDS[index], 0.3), ORDER * SPEEDS[index]
        curve = ss.forced_response(model, (0.8, 2.2), 7, stability=False)
        x, y = curve.omega - omega, curve.amplitude("x")
        (met,) = np.nonzero(x[:-1] * x[1:] <= 0.0)
        heights = y[met] - x[met] * np.diff(y)[met] / np.diff(x)[met]
        assert heights.max() == pytest.approx(up.amplitude[index], rel=1e-2)
        assert heights.min() == pytest.approx(lower[index], rel=1e-2)


def test_other_contacts_begin_without_a_start():
    def model(speed):
        one = hardening(speed)
        stops = [ss.Stop("x", stiffness=1.0, gap=9.0)] if speed > 1.0 else []
        return ss.Model(one.structure, [*one.contacts, *stops], one.forces)

    found = ss.speed_response(model, [0.9, 1.1], engine_order=ORDER, dof="x")
    alone = ss.speed_response(model, [1.1], engine_order=ORDER, dof="x")
    np.testing.assert_allclose(found.amplitude[1:], alone.amplitude, rtol=1e-9)
