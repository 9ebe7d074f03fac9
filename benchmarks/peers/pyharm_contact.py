"""Forced response of bodies on contacts with friction, solved by pyHarm-os.

The peer side of a benchmark: bodies of two or three directions each, contacts with friction
between them or to the ground under normal forces that vary and vanish (pyHarm's penalty contact,
``Penalty3D``), and a sweep at equally spaced frequencies. Prints one line of JSON; everything else
goes to the standard error.

Run it with the interpreter of the peer's environment::

    python pyharm_contact.py study.json

The file holds ``bodies`` (by name: ``mass, damping, stiffness``, matrices), ``contacts`` (each of
``between``, one or two bodies, ``normal``, ``tangents``, friction, stiffnesses and preload),
``forces`` (each of body, direction, real and imaginary part), ``omega = [first, last]``,
``points``, ``harmonics``, ``samples`` and ``momentum``, the share of the last Jacobian that
pyHarm's Newton method keeps. Amplitudes are given in the order of the bodies.

pyHarm-os 1.2.2 leaves jax, by which this contact is evaluated, in single precision: then Newton's
method does not reach its tolerance at any frequency. Double precision is set below.

pyHarm's contact takes the displacement that opens it as positive. With a preload its march is the
radial return of a circular cone, three periods long: first order in the distance of the samples.
With a gap and no preload, pyHarm-os 1.2.2 keeps its friction only where the contact is open (the
mask of ``JenkinsResidual_jax``), so that a wedge is compared in its prestressed form: the normal
forces of its static load as preloads.
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


def contact(study: dict[str, Any], system: str) -> dict[str, Any]:
    """Return one contact, its directions those of a system of coordinates.

    pyHarm's contact has two tangential directions. In a plane the one there is serves twice, each
    time with half of the stiffness: then its cone is wider by the square root of two.
    """
    planar = len(study["normal"]) == 2
    return {
        "type": "Penalty3D",
        "connect": {body: [0] for body in study["between"]},
        "coordinatesystem": system,
        "dirs": [0, 1, 1] if planar else [0, 1, 2],
        "mu": study["friction"] / (np.sqrt(2.0) if planar else 1.0),
        "k_t": study["tangential_stiffness"] / (2.0 if planar else 1.0),
        "k_n": study["normal_stiffness"],
        "N0": study["preload"],
        "g": 0.0,
    }


def problem(study: dict[str, Any]) -> dict[str, Any]:
    """Return the input of pyHarm: system and sweep."""
    bodies = {
        name: {
            "matrix": {
                letter: np.array(body[key], dtype=float)
                for letter, key in (("M", "mass"), ("C", "damping"), ("K", "stiffness"))
            },
            "ndofs": len(body["mass"]),
        }
        for name, body in study["bodies"].items()
    }
    contacts = {f"contact{i}": one for i, one in enumerate(study["contacts"])}
    connectors = {name: contact(one, name) for name, one in contacts.items()}
    coordinates = {name: [one["normal"], *one["tangents"]] for name, one in contacts.items()}
    for number, (body, direction, real, imaginary) in enumerate(study["forces"]):
        for kind, amplitude in (("CosinusForcing", real), ("SinusForcing", -imaginary)):
            connectors[f"{kind}{number}"] = {
                "type": kind,
                "connect": {body: [0]},
                "dirs": [direction],
                "amp": amplitude,
            }
    first, last = study["omega"]
    step = (last - first) / (study["points"] - 1)
    sweep = {
        "study": "frf",
        "solver": "NewtonRaphson",
        "solver_options": {"max_iter": 100, "momentum": study["momentum"]},
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
        "substructures": bodies,
        "coordinates": coordinates,
        "connectors": connectors,
        "analysis": {"frf": sweep},
    }


def half_ranges(maestro: Any, states: np.ndarray) -> list[list[float]]:
    """Return half the peak-to-peak displacement of every direction in each state."""
    table = maestro.system.expl_dofs
    phase = np.linspace(0.0, 2.0 * np.pi, WAVEFORM_POINTS, endpoint=False)
    ranges = []
    for _, unknowns in table.groupby(["sub", "dof_num"], sort=False):
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
