"""Speed of mistuned rings of beams, as ratios measured in one run.

Usage::

    python benchmarks/rings.py            # LAPACK, single blade, number of blades, time histories
    python benchmarks/rings.py --peers    # pyHarm-os too, in an environment of its own

The ring is that of Guillen (1999), section 4.5: 36 SNECMA beams, 7e3 N/m between the tips, engine
order 3, stiffness deviations of 7 % (uniform, seed 0). Amplitudes of all dampers, their error
estimates and the contact summaries are included. Processor times on one thread, the smallest of
runs that take turns: what else the machine does enters as little as can be.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path

# One thread each: the sweeps run on one.
for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np
import scipy.linalg
from speed import HERE, install_peer

import stickslip as ss

OMEGA = (150.0, 260.0)
# Half the time of one factorisation of all unknowns is what a point may take.
HARMONICS = 9


def ring(blades: int = 36, coupling: float = 7e3) -> ss.BladedDisk:
    return ss.reference.beam_ring(blades, coupling=coupling, engine_order=3)


def mistuned(blades: int = 36, coupling: float = 7e3) -> ss.disk.MistunedDisk:
    pattern = ss.mistuning_pattern(blades, 0.07, "uniform", seed=0)
    return ring(blades, coupling).mistuned(pattern)


def dampers(blades: int) -> list[str]:
    return [f"{blade}.damper" for blade in range(blades)]


def fastest(works: Mapping[str, Callable[[], object]], rounds: int = 7) -> dict[str, float]:
    """Smallest processor time of each work in s, all works taking turns."""
    least = dict.fromkeys(works, float("inf"))
    for _ in range(rounds):
        for name, work in works.items():
            start = time.process_time()
            work()
            least[name] = min(least[name], time.process_time() - start)
    return least


def against_lapack() -> None:
    """Print the time of a point at H = 9 over that of one LU factorisation of all unknowns."""
    disk, observe = mistuned(), dampers(36)
    slots = HARMONICS + 1  # as many as the mean and even harmonics make it, see below
    size = 36 * (2 * HARMONICS + 1)
    matrix = np.random.default_rng(0).normal(size=(size, size))
    grids = {points: np.linspace(*OMEGA, points) for points in (56, 111, 221)}

    def sweep(points: int) -> Callable[[], object]:
        return lambda: ss.forced_response(disk, grids[points], HARMONICS, observe=observe)

    works = {str(points): sweep(points) for points in grids}
    taken = fastest({"lu": lambda: scipy.linalg.lu_factor(matrix), **works})
    print(f"\nOne LU factorisation of {size} unknowns: {1e3 * taken['lu']:.2f} ms")
    print(f"({36 * slots} unknowns are left of them by symmetry: odd harmonics alone)\n")
    print("| 36 mistuned beams, H = 9 | per point [ms] | of one LU | iterations per point |")
    print("|---|---|---|---|")
    for points, omega in grids.items():
        frf = ss.forced_response(disk, omega, HARMONICS, observe=observe)
        each = taken[str(points)] / points
        print(
            f"| {points} points, {OMEGA[0]:g} to {OMEGA[1]:g} rad/s | {1e3 * each:.2f} "
            f"| {each / taken['lu']:.2f} | {frf.counters['iterations'] / points:.1f} |"
        )


def against_a_blade() -> None:
    """Print what a tuned disk costs over a single blade under the same sweep."""
    omega = np.linspace(*OMEGA, 221)
    blade, disk = ss.reference.snecma_beam(20.313), ring()
    print("\n| tuned ring over single blade | ratio |\n|---|---|")
    for harmonics in (3, 9, 15):
        taken = fastest(
            {
                "blade": lambda h=harmonics: ss.forced_response(blade, omega, h),  # type: ignore[misc]
                "disk": lambda h=harmonics: ss.forced_response(disk, omega, h),  # type: ignore[misc]
            },
            rounds=15,
        )
        print(f"| H = {harmonics} | {taken['disk'] / taken['blade']:.2f} |")


def by_blades(coupling: float) -> None:
    """Print how the time of a point grows with the number of blades."""
    omega = np.linspace(*OMEGA, 56)
    counts, kept = (12, 36, 108), (3, 9)
    disks = {blades: mistuned(blades, coupling) for blades in counts}
    print(f"\n{coupling:g} N/m between the tips, per point, H = 3 | H = 9:")
    print("| blades | [ms] | iterations | contacts that slip | [ms] | iterations | that slip |")
    print("|---|---|---|---|---|---|---|")

    def sweep(blades: int, harmonics: int) -> Callable[[], ss.ForcedResponse]:
        observe = dampers(blades)
        return lambda: ss.forced_response(disks[blades], omega, harmonics, observe=observe)

    works = {f"{n} {h}": sweep(n, h) for n in counts for h in kept}
    taken = fastest(works, rounds=4)
    for blades in counts:
        row = f"| {blades} |"
        for h in kept:
            found = works[f"{blades} {h}"]()
            slip = (found.arrays.slip_fraction > 0.0).sum() / len(omega)
            each = 1e3 * taken[f"{blades} {h}"] / len(omega)
            row += f" {each:.2f} | {found.counters['iterations'] / len(omega):.1f} | {slip:.1f} |"
        print(row)
    for h in kept:
        growth = np.log(taken[f"108 {h}"] / taken[f"36 {h}"]) / np.log(3.0)
        print(f"H = {h}: from 36 to 108 blades time grows as blades^{growth:.2f}")


def automatic() -> None:
    """Print cost and result of automatic harmonics over all couplings."""
    pattern = ss.mistuning_pattern(36, 0.07, "uniform", seed=0)
    omega, observe = np.linspace(*OMEGA, 56), dampers(36)
    print("\n| coupling [N/m] | amplification, auto | [s] | per point [ms] | highest H |")
    print("|---|---|---|---|---|")
    for coupling in ss.reference.RING_COUPLINGS:
        disk = ring(coupling=coupling)
        start = time.process_time()
        frf = ss.forced_response(disk.mistuned(pattern), omega, "auto", observe=observe)
        taken = time.process_time() - start
        tuned = ss.forced_response(disk, omega, "auto")
        found = frf.amplification(tuned, "damper")
        print(
            f"| {coupling:g} | {found.factor:.4f} | {taken:.2f} | {1e3 * taken / len(omega):.0f} "
            f"| {frf.harmonics.max()} |",
            flush=True,
        )


def against_peer(folder: Path) -> None:
    """Print what pyHarm-os takes for the same ring at H = 3."""
    disk, observe, points = mistuned(), dampers(36), 12
    # From where all dampers stick: pyHarm finds no solution from scratch where they slip.
    omega = np.linspace(164.0, 175.0, points)
    force = np.zeros(108, complex)
    for one in disk.forces:
        force[disk.structure.dofs.index(one.dof)] = one.amplitude * np.exp(1j * one.phase)
    arrays = {
        "mass": disk.structure.mass,
        "damping": disk.structure.damping,
        "stiffness": disk.structure.stiffness,
        "force": force,
        "dampers": np.arange(0, 108, 3),
        "omega": omega[[0, -1]],
    }
    print("\n| pyHarm-os, H = 3 | per point [s] | times slower | largest amplitudes differ by |")
    print("|---|---|---|---|", flush=True)
    with tempfile.TemporaryDirectory() as place:
        system = Path(place) / "system.npz"
        np.savez(system, **arrays)
        for samples in (256, 64):
            command = [str(install_peer(folder)), str(HERE / "peers" / "pyharm_ring.py")]
            command += [str(system), "--samples", str(samples), "--points", str(points)]
            done = subprocess.run(command, check=True, capture_output=True, text=True)
            peer = json.loads(done.stdout.strip().splitlines()[-1])
            frf = ss.forced_response(disk, omega, 3, observe=observe)
            own = fastest({"own": lambda: ss.forced_response(disk, omega, 3, observe=observe)})
            ratio = peer["cpu_s"] / own["own"]
            solved = np.array(peer["converged"])
            close = frf.blade_amplitudes("damper").max(axis=1)
            off = np.abs(np.array(peer["largest"]) / close - 1.0)[solved].max()
            print(
                f"| {samples} samples, {solved.sum()} of {points} points solved "
                f"| {peer['cpu_s'] / points:.2f} | {ratio:.0f} | {off:.1e} |",
                flush=True,
            )


def in_time() -> None:
    """Print what a time history of the ring costs, against harmonic balance."""
    disk, observe = mistuned(), dampers(36)
    start = time.process_time()
    run = ss.transient(disk, 200.0, 200, tolerance=1e-6, observe=observe, keep=1)
    taken = time.process_time() - start
    start = time.process_time()
    ss.forced_response(disk, [200.0], 25, observe=observe)
    balance = time.process_time() - start
    print(f"\nFrom rest at 200 rad/s, exact flow: {taken:.2f} s, {run.periods} periods;", end=" ")
    print(f"{taken / balance:.0f} times one balance with H = 25 from scratch")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--peers", action="store_true", help="run pyHarm-os as well")
    default = HERE.parent / ".peers"
    parser.add_argument("--environment", type=Path, default=default, help="where pyHarm-os lives")
    options = parser.parse_args()
    against_lapack()
    against_a_blade()
    by_blades(7e3)
    by_blades(1e5)
    automatic()
    in_time()
    if options.peers:
        against_peer(options.environment)


if __name__ == "__main__":
    sys.exit(main())
