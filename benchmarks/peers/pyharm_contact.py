"""Forced response of a mass on a plane with friction, solved by pyHarm-os.

The peer side of a benchmark: three degrees of freedom, one contact with friction in two directions
under a normal load that varies and vanishes (pyHarm's penalty contact, ``Penalty3D``), and a sweep
at equally spaced frequencies. Prints one line of JSON; everything else goes to the standard error.

Run it with the interpreter of the peer's environment::

    python pyharm_contact.py study.json

The file holds ``mass, damping, stiffness`` (diagonals), ``force`` (pairs of real and imaginary
part), ``contact`` (friction, tangential_stiffness, normal_stiffness, preload), ``omega = [first,
last]``, ``points``, ``harmonics`` and ``samples``.

pyHarm-os 1.2.2 leaves jax, by which this contact is evaluated, in single precision: then Newton's
method does not reach its tolerance at any frequency. Double precision is set below.

pyHarm's contact takes the displacement that opens it as positive. With a preload its march is the
radial return of a circular cone, three periods long: first order in the distance of the samples.
With a gap and no preload, pyHarm-os 1.2.2 keeps its friction only where the contact is open (the
mask of ``JenkinsResidual_jax``), so that a wedge pressed by a static load cannot be compared.
"""

from __future__ import annotations

import json
import os
import sys
import time
from pathlib import Path
from typing import Any

os.environ["JAX_ENABLE_X64"] = "1"  # read when jax loads

import numpy as np
from pyharm_beam import WAVEFORM_POINTS, peer_surroundings


def problem(study: dict[str, Any]) -> dict[str, Any]:
    """Return the input of pyHarm: system and sweep."""
    matrices = {
        name: np.diag(study[key]).astype(float)
        for name, key in (("M", "mass"), ("C", "damping"), ("K", "stiffness"))
    }
    contact = study["contact"]
    connectors: dict[str, Any] = {
        "contact": {
            "type": "Penalty3D",
            "connect": {"mass": [0]},
            "dirs": [2, 0, 1],
            "mu": contact["friction"],
            "k_t": contact["tangential_stiffness"],
            "k_n": contact["normal_stiffness"],
            "N0": contact["preload"],
            "g": 0.0,
        }
    }
    for direction, (real, imaginary) in enumerate(study["force"]):
        for kind, amplitude in (("CosinusForcing", real), ("SinusForcing", -imaginary)):
            connectors[f"{kind}{direction}"] = {
                "type": kind,
                "connect": {"mass": [0]},
                "dirs": [direction],
                "amp": amplitude,
            }
    first, last = study["omega"]
    step = (last - first) / (study["points"] - 1)
    sweep = {
        "study": "frf",
        "solver": "NewtonRaphson",
        "solver_options": {"max_iter": 50},
        "predictor": "secant",
        "predictor_options": {"norm": "om", "bifurcation_detect": False},
        "corrector": "nocontinuation",
        "reductors": [{"type": "noreductor"}],
        "stepsizer": "constant",
        "ds0": step,
        "ds_max": step,
        "stopper": "solnumber",
        "stopper_options": {"max_solutions": study["points"]},
        "puls_inf": first,
        "puls_sup": last,
        "verbose": False,
    }
    orders = list(range(study["harmonics"] + 1))
    return {
        "system": {"type": "Base", "nh": orders, "nti": study["samples"]},
        "substructures": {"mass": {"matrix": matrices, "ndofs": 3}},
        "connectors": connectors,
        "analysis": {"frf": sweep},
    }


def half_ranges(maestro: Any, states: np.ndarray) -> list[list[float]]:
    """Return half the peak-to-peak displacement of every direction in each state."""
    table = maestro.system.expl_dofs
    phase = np.linspace(0.0, 2.0 * np.pi, WAVEFORM_POINTS, endpoint=False)
    ranges = []
    for direction in range(3):
        unknowns = table[table["dof_num"] == direction]
        basis = [
            np.cos(order * phase) if part == "c" else np.sin(order * phase)
            for order, part in zip(unknowns["harm"], unknowns["cs"], strict=True)
        ]
        ranges.append(np.ptp(states[:, unknowns.index] @ np.array(basis), axis=1) / 2.0)
    return [[float(value) for value in one] for one in ranges]


def solve(maestro_class: type[Any], study: dict[str, Any]) -> dict[str, Any]:
    """Build the model and solve it; only the solution is timed."""
    maestro = maestro_class(problem(study))
    cpu = time.process_time()
    maestro.operate()
    cpu = time.process_time() - cpu
    solutions = maestro.nls["frf"].SolList
    states = np.array([solution.x for solution in solutions])
    return {
        "cpu_s": cpu,
        "omega": [float(omega) for omega in states[:, -1]],
        "amplitude": half_ranges(maestro, states),
        "converged": [bool(solution.flag_accepted) for solution in solutions],
    }


def main() -> None:
    """Run the study twice and print the second result; the first run warms pyHarm up."""
    study = json.loads(Path(sys.argv[1]).read_text())
    with peer_surroundings(fresh_cache=False):
        from pyHarm.Maestro import Maestro

        solve(Maestro, study)
        result = solve(Maestro, study)
    print(json.dumps(result))


if __name__ == "__main__":
    main()
