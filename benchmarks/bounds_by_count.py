"""Bounds over residual tractions, by count: random systems that nobody has chosen.

Usage::

    python benchmarks/bounds_by_count.py --systems 20 --residuals 20

Per system how far motions under other residuals leave the bounds, how wide these are, and what they
cost beside a plain curve.
Motions that are known to be unstable do not count: nothing stays on them.
"""

from __future__ import annotations

import argparse
from time import process_time

import numpy as np

import stickslip as ss

HARMONICS, POINTS = 5, 12


def system(rng: np.random.Generator) -> ss.Model:
    """Return two or three bodies that rub on planes which their own motion presses."""
    bodies = "abc"[: rng.integers(2, 4)]
    names = [f"{body}.{axis}" for body in bodies for axis in "xz"]
    size = len(names)
    coupling = rng.normal(size=(size, size)) * rng.uniform(5.0, 25.0)
    stiffness = np.diag(rng.uniform(200.0, 400.0, size)) + 0.5 * (coupling + coupling.T)
    stiffness += max(0.0, 60.0 - np.linalg.eigvalsh(stiffness)[0]) * np.eye(size)
    mass = np.diag(rng.uniform(0.8, 2.0, size))
    structure = ss.Structure(mass, stiffness, rng.uniform(0.1, 0.6) * mass, names)
    contacts = []
    for body in bodies:
        normal = rng.normal(size=2)
        normal[-1] = abs(normal[-1]) + 1.0
        contacts.append(
            ss.Coulomb(
                [f"{body}.x", f"{body}.z"],
                normal=normal / np.linalg.norm(normal),
                friction=rng.uniform(0.2, 0.9),
                tangential_stiffness=rng.uniform(80.0, 300.0),
                normal_stiffness=rng.uniform(100.0, 400.0),
                preload=rng.uniform(1.0, 6.0),
                name=body,
            )
        )
    forces = [
        ss.Force(f"{body}.x", rng.uniform(0.3, 3.0), phase=rng.uniform(0.0, 6.0)) for body in bodies
    ]
    return ss.Model(structure, contacts, forces)


def outside(seed: int, residuals: int) -> str:
    """Return a line about one system."""
    rng = np.random.default_rng(seed)
    model = system(rng)
    natural = np.sort(ss.natural_frequencies(model))
    grid = np.linspace(0.6 * natural[0], 1.15 * natural[min(2, len(natural) - 1)], POINTS)
    start = process_time()
    plain = ss.forced_response(model, grid, HARMONICS, observe=["a.x"], stability=False)
    middle = process_time()
    bounded = ss.forced_response(
        model, grid, HARMONICS, observe=["a.x"], residual="bounds", stability=False
    )
    end = process_time()
    low, high = bounded.lower("a.x"), bounded.upper("a.x")
    worst, unstable = 0.0, 0
    for value in rng.normal(0.0, 3.0, residuals):
        other = ss.forced_response(model, grid, HARMONICS, residual=value, observe=["a.x"])
        own = other.amplitude("a.x")
        left = np.nan_to_num(np.maximum(own / high, low / own) - 1.0)
        known = np.array([stable is False for stable in other.stable])
        unstable += int((left[known] > 1e-5).sum())
        worst = max(worst, left[~known].max(initial=0.0))
    wide = high - low > 1e-9 * high
    return (
        f"{seed:4d}  outside by {worst:8.1e}  unstable ones outside {unstable:3d}"
        f"  wide at {wide.sum():2d} of {POINTS}, to {np.nanmax(high / low - 1.0):8.1e}"
        f"  evaluations {bounded.counters['evaluations'] / plain.counters['evaluations']:4.1f}"
        f"  time {(end - middle) / max(middle - start, 1e-3):5.1f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--systems", type=int, default=20)
    parser.add_argument("--residuals", type=int, default=20)
    given = parser.parse_args()
    for seed in range(given.systems):
        print(outside(seed, given.residuals), flush=True)


if __name__ == "__main__":
    main()
