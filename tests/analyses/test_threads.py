"""Analyses that use all processors give the same numbers with any number of them."""

import os
import subprocess
import sys

import numpy as np
import pytest

import stickslip as ss
from stickslip.reference import snecma_beam

SWEEP = """
import sys
import numpy as np
import stickslip as ss
from stickslip.reference import snecma_beam


# Forty masses in a row, each with a Jenkins element to the ground.
def chain():
    names = [f"q{{place}}" for place in range(40)]
    stiff = 2e3 * (2.0 * np.eye(40) - np.eye(40, k=1) - np.eye(40, k=-1))
    structure = ss.Structure(np.eye(40), stiff, ss.Rayleigh(mass=0.8, stiffness=1e-4), names)
    limits = np.geomspace(0.3, 6.0, 40)
    contacts = [ss.Jenkins(q, stiffness=500.0, slip_force=f) for q, f in zip(names, limits)]
    return ss.Model(structure, contacts, [ss.Force("q20", 30.0)])


swept = {sweep}
numbers = np.concatenate([swept.amplitude(dof) for dof in swept.dofs])
numbers = np.concatenate([swept.omega, numbers])
sys.stdout.write(f"{{numbers.tobytes().hex()}} {{swept.counters}}")
"""


def swept(threads: int, sweep: str) -> str:
    environment = {**os.environ, "RAYON_NUM_THREADS": str(threads)}
    command = [sys.executable, "-c", SWEEP.format(sweep=sweep)]
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
    return done.stdout


@pytest.mark.slow
@pytest.mark.parametrize(
    ("sweep", "points", "threads"),
    [
        ("ss.exact_response(snecma_beam(), np.linspace(20, 350, 40))", 40, [3]),
        ("ss.forced_response(snecma_beam(), np.linspace(180, 240, 400), harmonics=127)", 400, [3]),
        ("ss.forced_response(chain(), (24.0, 32.0), harmonics=7)", 2 * 60, [2, 4]),
    ],
    ids=["orbits", "balances", "range"],
)
def test_pieces_of_a_sweep(sweep: str, points: int, threads: list[int]) -> None:
    alone = swept(1, sweep)
    assert len(alone) > points * 16
    assert all(swept(several, sweep) == alone for several in threads)


def test_points_of_pieces_are_those_of_their_frequencies() -> None:
    omega = np.linspace(180.0, 240.0, 400)
    whole = ss.forced_response(snecma_beam(), omega, harmonics=127)
    assert whole.converged.all()
    np.testing.assert_array_equal(whole.omega, omega)
    # The first point of a piece has no other to begin with: it is that of its frequency alone.
    begin = 16 * np.arange(25)
    alone = [ss.forced_response(snecma_beam(), omega[[i]], harmonics=127) for i in begin]
    expected = np.array([one.amplitude("tip")[0] for one in alone])
    np.testing.assert_array_equal(whole.amplitude("tip")[begin], expected)
