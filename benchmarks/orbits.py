"""Exact orbits against harmonic balance with 15 harmonics, on one thread.

Usage::

    python benchmarks/orbits.py             # all of them
    python benchmarks/orbits.py beam 16     # some

The beam of the dissertation, and a clamped bar of finite elements on 16 and on 64 Jenkins elements,
which component modes reduce to the contacts; once more with its fast modes slowed. Processor times
per point, medians of runs in turn.
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

HARMONICS, RUNS, MODES, ELEMENTS, SCALING = 15, 5, 20, 800, 1e-5


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

    def slowed() -> ss.ExactResponse:
        return ss.exact_response(model, omega, mass_scaling=SCALING)

    found, of_balance, of_slowed = orbits(), balance(), slowed()
    runs = [[spent(one) for one in (balance, orbits, slowed)] for _ in range(RUNS)]
    times = 1e3 * np.array(runs) / omega.size
    print(f"{name:>5}: balance {np.median(times[:, 0]):.3f} ms, ", end="")
    print(f"{int(of_balance.converged.sum())} of {omega.size} points")
    dof = model.forces[0].dof
    change = np.abs(of_slowed.amplitude(dof) / found.amplitude(dof) - 1.0).max()
    for one, taken, what in ((found, times[:, 1], "orbit"), (of_slowed, times[:, 2], "slowed")):
        steps, matrices = (one.counters[key] for key in ("evaluations", "factorisations"))
        ratio = np.median(taken / times[:, 0])
        print(f"       {what} {np.median(taken):8.3f} ms, {ratio:5.1f} times;", end=" ")
        print(f"{int(one.converged.sum())} of {omega.size} points;", end=" ")
        print(f"{steps / omega.size:.0f} steps and {matrices / omega.size:.1f} matrices each")
    print(f"       changed by {change:.1e} at most")


if __name__ == "__main__":
    main()
