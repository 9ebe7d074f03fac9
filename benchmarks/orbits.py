"""Exact orbits against harmonic balance with 15 harmonics, on one thread.

Usage::

    python benchmarks/orbits.py             # all of them
    python benchmarks/orbits.py beam 16     # some

The beam of the dissertation, and a clamped bar of finite elements on 16 and on 64 Jenkins elements,
which component modes reduce to the contacts. Processor times per point, medians of runs in turn.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable

for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS", "RAYON_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np

import stickslip as ss

HARMONICS, RUNS, MODES, ELEMENTS = 15, 5, 20, 800


def beam() -> tuple[ss.Model, np.ndarray]:
    """Return the beam about its resonance."""
    return ss.reference.snecma_beam(), np.linspace(20.0, 350.0, 100)


def bar(count: int) -> tuple[ss.Model, np.ndarray]:
    """Return a clamped steel bar on contacts at its free end, about its first resonance."""
    young, density, area, length = 2.1e11, 7800.0, 1e-4, 1.0
    step = length / ELEMENTS
    stiff = 2.0 * np.eye(ELEMENTS) - np.eye(ELEMENTS, k=1) - np.eye(ELEMENTS, k=-1)
    inert = (4.0 * np.eye(ELEMENTS) + np.eye(ELEMENTS, k=1) + np.eye(ELEMENTS, k=-1)) / 6.0
    stiff[-1, -1], inert[-1, -1] = 1.0, 2.0 / 6.0
    names = [f"n{node + 1}" for node in range(ELEMENTS)]
    kept = names[-count:]
    reduced = ss.craig_bampton(
        density * area * step * inert, young * area / step * stiff, kept, modes=MODES, dofs=names
    )
    limits = np.geomspace(0.3, 1.0, count)[np.random.default_rng(1).permutation(count)]
    share = 1.0 / count
    contacts = [
        ss.Jenkins(dof, stiffness=3e7 * share, slip_force=300.0 * share * limit)
        for dof, limit in zip(kept, limits, strict=True)
    ]
    structure = reduced.structure(ss.ModalDamping(0.001))
    model = ss.Model(structure, contacts, [ss.Force(kept[-1], amplitude=200.0)])
    free = ss.natural_frequencies(model)[0]
    return model, free * np.linspace(0.8, 1.1, 8)


CASES: dict[str, Callable[[], tuple[ss.Model, np.ndarray]]] = {
    "beam": beam,
    "16": lambda: bar(16),
    "64": lambda: bar(64),
}


def spent(solve: Callable[[], object]) -> float:
    """Return the processor time of a call [s]."""
    start = time.process_time()
    solve()
    return time.process_time() - start


def main() -> None:
    """Time the cases that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", nargs="*", default=list(CASES))
    for name in parser.parse_args().cases:
        report(name)


def report(name: str) -> None:
    """Time a case by both methods in turn."""
    model, omega = CASES[name]()

    def orbits() -> ss.ExactResponse:
        return ss.exact_response(model, omega)

    def balance() -> ss.ForcedResponse:
        return ss.forced_response(model, omega, HARMONICS, stability=False)

    found, of_balance = orbits(), balance()
    times = np.array([[spent(orbits), spent(balance)] for _ in range(RUNS)])
    exact, by_balance = 1e3 * np.median(times, axis=0) / omega.size
    ratio = np.median(times[:, 0] / times[:, 1])
    print(f"{name:>5}: orbit {exact:8.3f} ms, balance {by_balance:7.3f} ms, {ratio:5.1f} times;")
    solved = [int(one.converged.sum()) for one in (found, of_balance)]
    steps, matrices = (found.counters[key] for key in ("evaluations", "factorisations"))
    print(f"       {solved[0]} and {solved[1]} of {omega.size} points;", end=" ")
    print(f"{steps / omega.size:.0f} steps and {matrices / omega.size:.1f} matrices each")


if __name__ == "__main__":
    main()
