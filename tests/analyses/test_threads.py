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
from stickslip.reference import beam_ring, snecma_beam

swept = {sweep}
numbers = np.concatenate([swept.amplitude(dof) for dof in swept.dofs])
sys.stdout.write(f"{{numbers.tobytes().hex()}} {{swept.counters}}")
"""


def swept(threads: int, sweep: str) -> str:
    environment = {**os.environ, "RAYON_NUM_THREADS": str(threads)}
    command = [sys.executable, "-c", SWEEP.format(sweep=sweep)]
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
    return done.stdout


@pytest.mark.slow
def test_exact_orbits_of_a_sweep_in_pieces() -> None:
    sweep = "ss.exact_response(snecma_beam(), np.linspace(20, 350, 40))"
    alone = swept(1, sweep)
    assert len(alone) > 40 * 16
    assert swept(3, sweep) == alone


@pytest.mark.slow
def test_balances_of_a_long_sweep_in_pieces() -> None:
    sweep = "ss.forced_response(snecma_beam(), np.linspace(180, 240, 400), harmonics=127)"
    alone = swept(1, sweep)
    assert len(alone) > 400 * 16
    assert swept(3, sweep) == alone


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
