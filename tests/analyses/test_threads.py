"""Analyses that use all processors give the same numbers with any number of them."""

import os
import subprocess
import sys

SWEEP = """
import sys
import numpy as np
import stickslip as ss
from stickslip.reference import snecma_beam

orbits = ss.exact_response(snecma_beam(), np.linspace(20, 350, 40))
numbers = np.concatenate([orbits.amplitude(dof) for dof in orbits.dofs])
sys.stdout.write(f"{numbers.tobytes().hex()} {orbits.counters}")
"""


def swept(threads: int) -> str:
    environment = {**os.environ, "RAYON_NUM_THREADS": str(threads)}
    command = [sys.executable, "-c", SWEEP]
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
    return done.stdout


def test_exact_orbits_of_a_sweep_in_pieces() -> None:
    alone = swept(1)
    assert len(alone) > 40 * 16
    assert swept(3) == alone
