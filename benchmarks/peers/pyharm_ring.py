"""Forced response of a mistuned ring of beams, solved by pyHarm-os.

The peer side of a benchmark: matrices of the whole disk, a friction damper from the first degree of
freedom of every sector to ground, a harmonic force with a phase of its own on the second one, and
a sweep at equally spaced frequencies. Prints one line of JSON; everything else goes to the
standard error. Settings are those found fastest for one beam, see ``pyharm_beam.py``.

Run it with the interpreter of the peer's environment::

    python pyharm_ring.py system.npz --harmonics 3 --samples 256 --points 8

The file holds ``mass, damping, stiffness`` (N x N), the complex amplitudes ``force`` of the forces
on all degrees of freedom, ``dampers`` (their degrees of freedom) and ``omega = [first, last]``.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from pyharm_beam import DAMPER_STIFFNESS, SLIP_FORCE, WAVEFORM_POINTS, peer_surroundings


@dataclass(frozen=True)
class Ring:
    """The whole disk and how to solve it."""

    arrays: dict[str, np.ndarray]
    harmonics: int
    samples: int
    points: int

    @property
    def orders(self) -> list[int]:
        """The harmonics kept: odd ones."""
        return list(range(1, self.harmonics + 1, 2))

    @property
    def step(self) -> float:
        """Spacing of the frequencies."""
        first, last = self.arrays["omega"]
        return float(last - first) / (self.points - 1)


def connectors(ring: Ring) -> dict[str, Any]:
    """Return the dampers and forces, as pyHarm reads them."""
    parts: dict[str, Any] = {}
    for dof in ring.arrays["dampers"]:
        parts[f"damper{dof}"] = {
            "type": "Jenkins",
            "connect": {"ring": [int(dof)]},
            "dirs": [0],
            "mu": 1.0,
            "N0": SLIP_FORCE,
            "k": DAMPER_STIFFNESS,
        }
    for dof in np.flatnonzero(ring.arrays["force"]):
        force = ring.arrays["force"][dof]
        # P cos(omega t + phi) = Re P e^(i phi) cos(omega t) - Im P e^(i phi) sin(omega t)
        for kind, amplitude in (("CosinusForcing", force.real), ("SinusForcing", -force.imag)):
            parts[f"{kind}{dof}"] = {
                "type": kind,
                "connect": {"ring": [int(dof)]},
                "dirs": [0],
                "amp": float(amplitude),
            }
    return parts


def problem(ring: Ring) -> dict[str, Any]:
    """Return the input of pyHarm: system and sweep."""
    matrices = {"M": "mass", "C": "damping", "K": "stiffness"}
    matrix = {name: ring.arrays[key].copy() for name, key in matrices.items()}
    first, last = (float(omega) for omega in ring.arrays["omega"])
    sweep = {
        "study": "frf",
        "solver": "NewtonRaphson",
        "solver_options": {"max_iter": 50},
        "predictor": "secant",
        "predictor_options": {"norm": "om", "bifurcation_detect": False},
        "corrector": "nocontinuation",
        "reductors": [{"type": "noreductor"}],
        "stepsizer": "constant",
        "ds0": ring.step,
        "ds_max": ring.step,
        "stopper": "solnumber",
        "stopper_options": {"max_solutions": ring.points},
        "puls_inf": first,
        "puls_sup": last,
        "verbose": False,
    }
    return {
        "system": {"type": "Base", "nh": ring.orders, "nti": ring.samples},
        "substructures": {"ring": {"matrix": matrix, "ndofs": 1}},
        "connectors": connectors(ring),
        "analysis": {"frf": sweep},
    }


def largest(maestro: Any, states: np.ndarray, dofs: np.ndarray) -> list[float]:
    """Return the largest half range of the dampers' displacements in each state."""
    table = maestro.system.expl_dofs
    phase = np.linspace(0.0, 2.0 * np.pi, WAVEFORM_POINTS, endpoint=False)
    ranges = []
    for dof in dofs:
        unknowns = table[table["node_num"] == dof]
        basis = [
            np.cos(order * phase) if part == "c" else np.sin(order * phase)
            for order, part in zip(unknowns["harm"], unknowns["cs"], strict=True)
        ]
        ranges.append(np.ptp(states[:, unknowns.index] @ np.array(basis), axis=1) / 2.0)
    return [float(value) for value in np.max(ranges, axis=0)]


def solve(maestro_class: type[Any], ring: Ring) -> dict[str, Any]:
    """Build the model and solve it; only the solution is timed."""
    maestro = maestro_class(problem(ring))
    wall, cpu = time.perf_counter(), time.process_time()
    maestro.operate()
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    solutions = maestro.nls["frf"].SolList
    states = np.array([solution.x for solution in solutions])
    return {
        "wall_s": wall,
        "cpu_s": cpu,
        "omega": [float(omega) for omega in states[:, -1]],
        "largest": largest(maestro, states, ring.arrays["dampers"]),
        "converged": [bool(solution.flag_accepted) for solution in solutions],
    }


def main() -> None:
    """Run the benchmark and print its result; the first run warms pyHarm up."""
    parser = argparse.ArgumentParser(description="A mistuned ring, solved by pyHarm-os.")
    parser.add_argument("system", type=Path)
    parser.add_argument("--harmonics", type=int, default=3)
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("--points", type=int, default=8)
    options = parser.parse_args()
    with np.load(options.system) as file:
        arrays = {name: file[name] for name in file.files}
    ring = Ring(arrays, options.harmonics, options.samples, options.points)
    with peer_surroundings(fresh_cache=False):
        from pyHarm.Maestro import Maestro

        first = arrays["omega"][0]
        short = {**arrays, "omega": np.array([first, first + ring.step])}
        solve(Maestro, Ring(short, options.harmonics, options.samples, 2))
        result = solve(Maestro, ring)
    print(json.dumps(result), file=sys.stdout)


if __name__ == "__main__":
    main()
