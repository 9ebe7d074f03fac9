"""Limit cycles with a law that has no describing function in closed form."""

import numpy as np
import pytest

import stickslip as ss

STIFFNESS, SLIP_FORCE = 3e3, 2.0
DAMPING, NEGATIVE = np.diag([0.4, 0.6]), -np.diag([1.0, 0.8])


def model(law: ss.BoucWen | ss.Jenkins, ratio: float = 0.0) -> ss.Model:
    stiffness = [[1.2e4, -2e3], [-2e3, 1.9e4]]
    structure = ss.Structure(np.eye(2), stiffness, DAMPING + ratio * NEGATIVE, ["a", "b"])
    return ss.Model(structure, [law], [])


def joint(exponent: float, beta: float = 0.5) -> ss.BoucWen:
    numbers = {"stiffness": STIFFNESS, "slip_force": SLIP_FORCE}
    return ss.BoucWen("a", **numbers, exponent=exponent, beta=beta)


def start(law: ss.BoucWen, cycles: ss.LimitCycles, index: int) -> ss.State:
    """The state at the start of the period, with the force that half a period turns round."""
    series = np.array([cycles.coefficients(dof)[index] for dof in "ab"])
    orders = np.arange(series.shape[1])
    half = np.exp(1j * np.outer(np.linspace(0.0, np.pi, 4001), orders))
    change = np.diff((half @ series[0]).real) * STIFFNESS / SLIP_FORCE

    def rate(y: float, dv: float) -> float:
        falls = 1.0 - 2.0 * law.beta
        return 1.0 - abs(y) ** law.exponent * (1.0 if y * dv > 0 else falls)

    begin = end = 0.0
    for _ in range(30):
        begin = 0.5 * (begin - end)
        end = begin
        for dv in change:
            end += dv * rate(end + 0.5 * dv * rate(end, dv), dv)
    velocity = (1j * orders * cycles.omega[index] * series).real.sum(1)
    own = model(law, float(cycles.ratio[index]))
    return ss.State(own, series.real.sum(1), velocity, {0: SLIP_FORCE * begin})


@pytest.mark.parametrize(("exponent", "beta"), [(1.0, 0.5), (2.0, 0.9), (8.0, 0.6)])
@pytest.mark.slow
def test_cycles_close_in_time(exponent: float, beta: float) -> None:
    law = joint(exponent, beta)
    cycles = ss.limit_cycles(
        model(law), negative_damping=NEGATIVE, mode=0, harmonics=21, ratio=[2.0, 4.0]
    )
    assert set(cycles.branch) == {"sticking", "slipping"}
    for index in range(cycles.ratio.size):
        begin = start(law, cycles, index)
        own = model(law, float(cycles.ratio[index]))
        run = ss.transient(own, cycles.omega[index], 1, "rk4", steps=4096, start=begin)
        for dof in "ab":
            motion = run.displacement(dof)
            assert abs(motion[-1] - motion[0]) < 1e-4 * cycles.amplitude(dof)[index]


@pytest.mark.slow
def test_a_large_exponent_comes_near_a_jenkins_element() -> None:
    jenkins = ss.Jenkins("a", stiffness=STIFFNESS, slip_force=SLIP_FORCE)
    options = {"negative_damping": NEGATIVE, "mode": 0, "harmonics": 9, "stability": False}
    limit = ss.limit_cycles(model(jenkins), **options).limit.ratio
    branches = [ss.limit_cycles(model(joint(n)), **options) for n in (2.0, 8.0, 32.0, 100.0)]
    # The first motions balance at once: no exponent takes part of the branch away.
    assert all(branch.ratio[0] < 0.5 for branch in branches)
    apart = [abs(branch.limit.ratio / limit - 1.0) for branch in branches]
    assert apart == sorted(apart, reverse=True)
    assert apart[-1] < 1e-3
