"""Limit cycles of structures with friction and a nonlinear spring."""

import numpy as np
import pytest

import stickslip as ss

MASS, STIFFNESS = np.eye(2), [[2e4, -1e4], [-1e4, 2e4]]
DAMPING, NEGATIVE = np.diag([2.0, 2.0]), np.diag([-4.0, -4.0])
SLIP_FORCE = 5.0


def model(cubic: float, ratio: float) -> ss.Model:
    damping = DAMPING + ratio * NEGATIVE
    contacts = [
        ss.Jenkins("a", stiffness=1e4, slip_force=SLIP_FORCE),
        ss.Cubic("b", stiffness=cubic),
    ]
    return ss.Model(ss.Structure(MASS, STIFFNESS, damping, ["a", "b"]), contacts, [])


def start(cycles: ss.LimitCycles, index: int) -> ss.State:
    """The state at the start of the period; friction is marched until its force repeats."""
    series = np.array([cycles.coefficients(dof)[index] for dof in "ab"])
    orders = np.arange(series.shape[1])
    angles = np.linspace(0.0, 4.0 * np.pi, 20001)
    force = 0.0
    for du in np.diff((series[0] @ np.exp(1j * np.outer(orders, angles))).real):
        force = float(np.clip(force + 1e4 * du, -SLIP_FORCE, SLIP_FORCE))
    velocity = (1j * orders * cycles.omega[index] * series).real.sum(1)
    ratio = float(cycles.ratio[index])
    return ss.State(model(1e9, ratio), series.real.sum(1), velocity, {0: force})


@pytest.mark.parametrize("cubic", [1e7, 1e9, 1e12])
def test_the_branch_begins_at_the_amplitude_at_which_friction_slips(cubic: float) -> None:
    # The stuck mode has another frequency there than at rest, by more than its damping bears.
    cycles = ss.limit_cycles(
        model(cubic, 0.0), negative_damping=NEGATIVE, mode=0, harmonics=9, ratio=[0.6]
    )
    assert cycles.branch[0] == "sticking"
    assert cycles.amplitude("a")[0] * 1e4 == pytest.approx(SLIP_FORCE, rel=0.05)


@pytest.mark.slow
def test_cycles_with_a_stiffening_spring_go_on_in_time() -> None:
    cycles = ss.limit_cycles(
        model(1e9, 0.0), negative_damping=NEGATIVE, mode=0, harmonics=21, ratio=[1.0, 3.0]
    )
    assert {"sticking", "slipping"} <= set(cycles.branch)
    for index, ratio in enumerate(cycles.ratio):
        own, state = model(1e9, float(ratio)), start(cycles, index)
        run = ss.transient(own, cycles.omega[index], 1, "rk4", steps=2000, start=state, samples=64)
        for dof in "ab":
            assert run.amplitude(dof) == pytest.approx(cycles.amplitude(dof)[index], rel=5e-5)
