"""Limit cycles of laws without sliders: power, exact orbits, whole branches."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from microslip import exponential, iwan, structure


def test_limit_cycles_balance_power():
    negative = -2.0 * np.eye(1)
    one = ss.Structure([[1.0]], [[1e4]], [[0.2]], ["a"])
    own = ss.Model(one, [iwan(stiffness=4e3, slip_force=1.0, chi=-0.5)], [])
    cycles = ss.limit_cycles(
        own, negative_damping=negative, mode=0, ratio=[0.3, 1.0, 2.0], harmonics=9
    )
    # Both sides of the branch, and the whole of it though slip begins at next to nothing.
    assert sorted(cycles.ratio) == [0.3, 0.3, 1.0, 1.0, 2.0, 2.0]
    assert cycles.limit is not None
    for ratio, omega, amplitude in zip(
        cycles.ratio, cycles.omega, cycles.amplitude("a"), strict=True
    ):
        fed = np.pi * omega * (2.0 * ratio - 0.2) * amplitude**2
        joint = own.contacts[0]
        k, s, end = joint.stiffness, joint.slip_force, joint.gross_slip_displacement
        x = amplitude / end
        if x < 1.0:
            lost = 4 * k * amplitude**2 * x**0.5 * 0.5 / (1.5 * 2.5)
        else:
            lost = (
                8 * (k * end**2 * (0.5 - 1 / (1.5 * 2.5)) + s * (amplitude - end))
                - 4 * s * amplitude
            )
        assert lost == pytest.approx(fed, rel=0.02)


def cycles(method, contacts, **options):
    own = ss.Model(structure(), contacts, [])
    negative = -np.diag([2.0, 1.0])
    return ss.limit_cycles(own, negative_damping=negative, mode=0, method=method, **options)


@pytest.mark.slow
def test_exact_limit_cycles_are_those_of_the_balance():
    joints = [iwan("a", slip_force=1.0), exponential("a", "b", slip_force=0.5)]
    exact = cycles("exact", joints, ratio=[1.0])
    balance = cycles("newton", joints, ratio=[1.0], harmonics=63)
    np.testing.assert_allclose(balance.omega, exact.omega, rtol=1e-7)
    np.testing.assert_allclose(balance.amplitude("b"), exact.amplitude("b"), rtol=1e-6)
    np.testing.assert_array_equal(exact.stable, [True, False])
    np.testing.assert_allclose(
        np.abs(balance.multipliers[:, 0]), np.abs(exact.multipliers[:, 0]), rtol=1e-5
    )


@pytest.mark.slow
@pytest.mark.parametrize("change", [0.0, 1e-13, 4e-13])
def test_cycles_that_grow_fast_are_closed_over_several_segments(change):
    # Mode 1 grows by 1e10 in half a period: one stretch of the flow cannot be steered. Rounding
    # tells whether it closes a loop at its own end: the branch does not hang on it.
    stiffness, damping = [[1.2e4 * (1.0 + change), -10.0], [-10.0, 4e4]], 0.2 * np.eye(2)
    own = ss.Model(ss.Structure(np.eye(2), stiffness, damping, ["a", "b"]), [iwan()], [])
    options = {"negative_damping": -np.diag([2.0, 600.0]), "mode": 0, "ratio": [1.6]}
    exact = ss.limit_cycles(own, method="exact", **options)
    balance = ss.limit_cycles(own, harmonics=63, stability=False, **options)
    np.testing.assert_allclose(balance.omega, exact.omega, rtol=1e-7)
    np.testing.assert_allclose(balance.amplitude("a"), exact.amplitude("a"), rtol=1e-6)
    assert (np.abs(exact.multipliers[:, 0]) > 1e20).all()


@pytest.mark.parametrize("law", [iwan(slip_force=1.0), exponential(slip_force=1.0)])
@pytest.mark.slow
def test_branches_pass_where_a_reversal_meets_the_begin_of_the_orbit(law):
    coupled = ss.Structure(
        np.eye(2), [[1.02e4, -200.0], [-200.0, 1.02e4]], 0.2 * np.eye(2), ["a", "b"]
    )
    options = {"negative_damping": -np.diag([2.0, 4.0]), "mode": 0, "stability": False}
    own = ss.Model(coupled, [law], [])
    exact = ss.limit_cycles(own, method="exact", **options)
    balance = ss.limit_cycles(own, harmonics=31, **options)
    assert exact.limit.ratio == pytest.approx(balance.limit.ratio, rel=1e-5)
    assert exact.limit.omega == pytest.approx(balance.limit.omega, rel=1e-6)
    assert exact.branch[-1] == "slipping"
    assert exact.amplitude("a")[-1] > 1e3 * exact.amplitude("a")[0]
    # What is asked for between points that begin at different times is found, too.
    wanted = np.linspace(1.2 * exact.ratio[-1], 0.99 * exact.limit.ratio, 15)
    at = ss.limit_cycles(own, method="exact", ratio=list(wanted), **options)
    assert at.ratio.size == 2 * wanted.size


@pytest.mark.parametrize(
    ("contacts", "negative"),
    [
        ([ss.Masing("a", stiffness=900.0, slip_force=0.2, backbone="exponential"), iwan("b")], 1.5),
        (
            [exponential("a", "b", slip_force=0.4), ss.Jenkins("b", stiffness=7e3, slip_force=0.4)],
            2,
        ),
        ([iwan("a", chi=-0.97, beta=0.4), exponential("a", "b")], 2.5),
    ],
)
@pytest.mark.slow
def test_branches_begin_where_several_contacts_slip_little_by_little(contacts, negative):
    options = {"negative_damping": -np.diag([negative, 1.0]), "mode": 0, "stability": False}
    own = ss.Model(structure(damping=0.01), contacts, [])
    branch = ss.limit_cycles(own, harmonics=7, **options)
    assert branch.limit is not None
    assert branch.ratio[-1] < branch.limit.ratio


@pytest.mark.parametrize("method", ["newton", "exact"])
@pytest.mark.slow
def test_ratios_beyond_the_limit_are_said_to_have_no_cycle(method):
    found = cycles(method, [iwan()], ratio=[1.0, 1e3])
    assert found.ratio.tolist() == [1.0, 1.0]
    assert "values-missed" in {d.code for d in found.diagnostics}
    none = cycles(method, [iwan()], ratio=[1e3])
    assert none.ratio.size == 0
    assert "ratio = 1000" in next(d.text for d in none.diagnostics if d.code == "values-missed")
