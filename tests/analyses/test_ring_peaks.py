"""Highest points of mistuned rings against dense grids: modes are close and hardly damped."""

import numpy as np
import pytest

import stickslip as ss


def ring_of_masses(count, order):
    """Single masses on sliders to the ground that are almost never still."""
    disk = ss.BladedDisk(
        ss.Structure([[0.65]], [[1.7e4]], [[0.17]], dofs=["x"]),
        count,
        [ss.Coupling("x", stiffness=400.0)],
        [ss.Jenkins("x", stiffness=1000.0, slip_force=0.15)],
        [ss.Force("x", 4.0)],
        engine_order=order,
    )
    return disk, (130.0, 200.0)


def ring_that_lets_go(count, order):
    """Friction holds a mass on the one that is damped; once it slips, hardly anything damps it."""
    disk = ss.BladedDisk(
        ss.Structure(
            np.eye(2), [[2.8e4, 0.0], [0.0, 1.93e4]], np.diag([1.26, 0.06]), dofs=["x", "y"]
        ),
        count,
        [ss.Coupling("y", stiffness=100.0)],
        [ss.Jenkins("y", "x", stiffness=1.3e4, slip_force=0.4)],
        [ss.Force("y", 1.2)],
        engine_order=order,
    )
    return disk, (118.0, 200.0)


@pytest.mark.slow
@pytest.mark.parametrize("build", [ring_of_masses, ring_that_lets_go])
@pytest.mark.parametrize(("count", "order"), [(4, 0), (5, 4), (7, 2), (11, 8)])
def test_the_highest_of_close_modes_is_found(build, count, order):
    disk, span = build(count, order)
    for seed in range(4):
        pattern = np.random.default_rng(seed).normal(0.0, 10.0 ** (-2.0 - 0.5 * seed), count)
        ring, first = disk.mistuned(pattern), disk.contacts[0].dofs[0]
        peak = ss.forced_response(ring, np.linspace(*span, 15), 3).peak(f"0.{first}")
        dense = ss.forced_response(ring, np.linspace(*span, 8001), 3, stability=False)
        assert dense.converged.all()
        assert peak.amplitude >= 0.9995 * dense.amplitude(f"0.{first}").max()
