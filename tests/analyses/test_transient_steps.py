"""Runge-Kutta steps: too long ones are refused or named, and what is kept is bounded."""

import numpy as np
import pytest

import stickslip as ss
from stickslip.reference import snecma_beam

# highest stuck natural frequency of the beam: 3273.79 rad/s, 16.37 times 200 rad/s


def run(steps, **options):
    return ss.transient(snecma_beam(25.0), 200.0, 5, "rk4", steps=steps, **options)


def coarse(result):
    return [text for text in result.assumptions if "too much to be followed well" in text]


@pytest.mark.parametrize("steps", [4, 20, 36])
def test_unstable_steps_are_refused_in_one_line(steps):
    message = rf"steps: {steps} Runge-Kutta steps per period are unstable: .*; give at least 37"
    with pytest.raises(ss.ModelError, match=message) as refused:
        run(steps)
    assert "\n" not in str(refused.value)


def test_the_steps_that_the_message_asks_for_are_stable():
    tip = run(37).displacement("tip")
    assert np.abs(tip).max() < 2.0 * np.abs(run(1000).displacement("tip")).max()


def test_coarse_steps_are_named_with_how_many_would_do():
    assert "; take 206 steps per period." in coarse(run(50))[0]
    assert len(coarse(run(205))) == 1
    assert coarse(run(206)) == []


def test_the_exact_flow_has_no_steps_to_refuse():
    result = ss.transient(snecma_beam(25.0), 200.0, 5, steps=4)
    assert coarse(result) == []
