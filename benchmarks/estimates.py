"""Cost of error estimates over that of the solutions they judge, as ratios measured in one run.

Usage::

    python benchmarks/estimates.py

Beams, chains with few and many contacts, also of stiffnesses over two decades, damping that is not
proportional, microslip, a stop, a cubic spring, a sampled law, nodes in a plane and in space,
wedges and mistuned rings of which 1, 2 or 4 contacts slip, with 1, 3, 9 and 15 harmonics: one
frequency from nothing, a curve in steps of 0.5 % whose solutions start from their neighbours, and
one in steps of 0.1 %. The smallest times of runs on one thread. An estimate should never take
longer than its solution.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from functools import partial

for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS", "RAYON_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np
from contacts import CONTACT, in_space, mass, normal_loads, wedge

import stickslip as ss

TIMES = 9
HARMONICS = (1, 3, 9, 15)
POINTS = {0.1 / 19: 20, 1e-3: 40}
"""Numbers of points of the curves, by their relative step."""


def chain(dofs: int, contacts: int, proportional: bool, decades: float = 0.5) -> ss.Model:
    """Return a chain of unit masses with dampers to ground, of stiffnesses over some decades."""
    rng = np.random.default_rng(dofs)
    k = 10 ** rng.uniform(4.0, 4.5, dofs + 1)
    stiffness = np.diag(k[:-1] + k[1:]) - np.diag(k[1:-1], 1) - np.diag(k[1:-1], -1)
    names = [f"x{i}" for i in range(dofs)]
    damping = ss.ModalDamping(5e-3) if proportional else np.diag(rng.uniform(0.1, 2.0, dofs))
    dampers = [
        ss.Jenkins(
            names[int(i)],
            stiffness=2e4 * 10 ** rng.uniform(-decades, decades),
            slip_force=3.0 * 10 ** rng.uniform(-2.0 * decades, 0.0),
        )
        for i in np.linspace(0, dofs - 1, contacts)
    ]
    structure = ss.Structure(np.eye(dofs), stiffness, damping, names)
    return ss.Model(structure, dampers, [ss.Force(names[dofs // 2], 20.0)])


def slipping(disk: ss.disk.MistunedDisk, omega: float) -> int:
    """Return how many contacts slip at a frequency."""
    frf = ss.forced_response(disk, [omega], 1)
    return sum(bool(frf.slip_fraction(i).max() > 0.0) for i in range(disk.sectors))


def ring(blades: int, wanted: int, omega: float) -> ss.disk.MistunedDisk:
    """Return a mistuned ring of beams under a load that makes so many of its contacts slip."""
    tuned = ss.reference.beam_ring(blades, coupling=7e3, engine_order=3)
    pattern = ss.mistuning_pattern(blades, 0.03, "uniform", seed=blades + wanted)
    low, high = 1e-3, 1e3
    for _ in range(40):
        level = np.sqrt(low * high)
        disk = ss.BladedDisk(
            tuned.structure,
            sectors=blades,
            couplings=tuned.couplings,
            contacts=tuned.contacts,
            forces=[ss.Force("tip", level * 20.313)],
            engine_order=3,
        ).mistuned(pattern)
        count = slipping(disk, omega)
        if count == wanted:
            break
        low, high = (level, high) if count < wanted else (low, level)
    return disk


def models() -> Iterator[tuple[str, ss.Model | ss.disk.MistunedDisk, float]]:
    """Yield names, models and frequencies at which they slip."""
    beam = ss.reference.snecma_beam()
    yield "beam", beam, 200.0
    for name, contact in {
        "Iwan": ss.Iwan("damper", stiffness=2.4e7, slip_force=246.0, chi=-0.5, beta=0.0),
        "exponential": ss.Masing(
            "damper", stiffness=2.4e7, slip_force=246.0, backbone="exponential"
        ),
        "stop": ss.Stop("tip", stiffness=1e4, gap=1e-4),
        "cubic": ss.Cubic("tip", stiffness=1e9),
        "Bouc-Wen": ss.BoucWen("damper", stiffness=2.4e7, slip_force=246.0),
    }.items():
        yield name, ss.Model(beam.structure, [contact], beam.forces), 200.0
    yield "node in a plane", mass(ss.Coulomb(["x", "z"], normal=[0, 1], **CONTACT)), 250.0
    yield "node in space", in_space(), 300.0
    yield "wedge", wedge(), 200.0
    yield "wedge, preloaded", wedge(normal_loads()), 200.0
    for dofs, contacts in ((40, 5), (100, 20), (200, 60), (300, 100)):
        yield f"chain {dofs}, {contacts} contacts", chain(dofs, contacts, True), 120.0
    for dofs, contacts in ((40, 20), (60, 30)):
        yield f"chain {dofs}, {contacts} over decades", chain(dofs, contacts, True, 1.0), 120.0
    for dofs, contacts in ((20, 3), (60, 5), (150, 5)):
        yield f"not proportional {dofs}, {contacts}", chain(dofs, contacts, False), 120.0
    for blades in (12, 24, 48):
        for wanted in (1, 2, 4):
            yield f"ring {blades}, {wanted} slip", ring(blades, wanted, 185.0), 185.0


def ratio(model: ss.Model | ss.disk.MistunedDisk, omega: np.ndarray, harmonics: int) -> float:
    """Return the time of the estimates over that of all else."""
    solve = partial(ss.forced_response, model, omega, harmonics, stability=False)
    runs = [solve().timings for _ in range(TIMES)]
    estimate = min(run["estimate"] for run in runs)
    return estimate / min(run["total"] - run["estimate"] for run in runs)


def main() -> None:
    """Print a row for each model."""
    orders = " | ".join(f"H = {harmonics}" for harmonics in HARMONICS)
    print(f"| estimate over solution: one point, curve, fine curve | {orders} |")
    print("|---" * (1 + len(HARMONICS)) + "|")
    worst = np.zeros(1 + len(POINTS))
    for name, model, omega in models():
        cells = []
        for harmonics in HARMONICS:
            curves = (omega * (1.0 + step * np.arange(n)) for step, n in POINTS.items())
            grids = np.array([omega]), *curves
            ratios = np.array([ratio(model, grid, harmonics) for grid in grids])
            worst = np.maximum(worst, ratios)
            cells.append(", ".join(f"{one:.2f}" for one in ratios))
        print(f"| {name} | {' | '.join(cells)} |", flush=True)
    point, curve, fine = worst
    print(f"\nLargest: {point:.2f} of one point, {curve:.2f} of a curve, {fine:.2f} of a fine one")


if __name__ == "__main__":
    main()
