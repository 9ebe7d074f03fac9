"""Speed of friction contacts, as ratios measured in one run.

Usage::

    python benchmarks/contacts.py

One mass on contacts, so that the laws take nearly all the time: laws without sliders, a planar
node and one in space, the nodes exact and sampled, against a Jenkins element; the laws without
sliders once more at 15 harmonics. Then two blades and a wedge of six degrees of freedom (Balaji
and Ferhatoglu 2025): 91 frequencies with automatic harmonics.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable

for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np

import stickslip as ss
from stickslip.model import Contact

GRID = np.linspace(150.0, 420.0, 200)
HARMONICS = 7
TIMES = 5


def least(work: Callable[[], ss.ForcedResponse]) -> tuple[float, ss.ForcedResponse]:
    """Return the least time of some runs [s], and the last result."""
    times = []
    for _ in range(TIMES):
        start = time.perf_counter()
        result = work()
        times.append(time.perf_counter() - start)
    return min(times), result


def mass(contact: Contact) -> ss.Model:
    """Return a mass on a plane."""
    stiffness, damping = np.diag([4e4, 9e4, 1.6e5]), np.diag([8.0, 10.0, 16.0])
    structure = ss.Structure(np.eye(3), stiffness, damping, ["x", "y", "z"])
    forces = [
        ss.Force("x", 30.0),
        ss.Force("y", 25.0, phase=-1.57),
        ss.Force("z", 20.0, phase=-0.7),
    ]
    return ss.Model(structure, [contact], forces)


def wedge() -> ss.Model:
    """Return two blades and a wedge, held by its contacts and a spring between its directions."""
    names = ["x1", "y1", "x2", "y2", "xD", "yD"]
    stiffness = np.zeros((6, 6))
    blocks = ([[1e6, -9e5], [-9e5, 1e6]], [[4e5, -3e5], [-3e5, 4e5]], [[1e6, -1e6], [-1e6, 1e6]])
    for place, block in enumerate(blocks):
        stiffness[2 * place : 2 * place + 2, 2 * place : 2 * place + 2] = block
    masses = np.diag([10.0, 10.0, 10.0, 10.0, 0.1, 0.1])
    damping = np.diag([20.0, 20.0, 20.0, 20.0, 0.0, 0.0])
    structure = ss.Structure(masses, stiffness, damping, names)
    s, c = np.sin(np.deg2rad(40.0)), np.cos(np.deg2rad(40.0))
    faces = [
        ss.Coulomb(
            ["xD", "yD"],
            [f"x{blade}", f"y{blade}"],
            normal=[side * s, c],
            friction=0.6,
            tangential_stiffness=3e5,
            normal_stiffness=3e5,
        )
        for blade, side in ((1, -1.0), (2, 1.0))
    ]
    forces = [ss.Force("yD", 240.0, harmonic=0), ss.Force("x1", 10.0), ss.Force("x2", -10.0)]
    return ss.Model(structure, faces, forces)


def compared(models: dict[str, tuple[ss.Model, str]], harmonics: int) -> None:
    """Print the time of an evaluation of each law, and its ratio to the first."""
    reference = None
    print(f"{len(GRID)} frequencies, {harmonics} harmonics: time per evaluation of the law")
    for name, (model, evaluation) in models.items():

        def work(model: ss.Model = model, evaluation: str = evaluation) -> ss.ForcedResponse:
            return ss.forced_response(
                model, GRID, harmonics, evaluation=evaluation, stability=False
            )

        spent, result = least(work)
        each = result.timings["law"] / result.counters["evaluations"]
        reference = reference or each
        ratio = f"{each / reference:6.1f} of Jenkins"
        print(f"  {name:18} {1e6 * each:8.1f} us   {ratio}, {1e3 * spent:.0f} ms in all")


def main() -> None:
    number = {
        "friction": 0.4,
        "tangential_stiffness": 5e4,
        "normal_stiffness": 8e4,
        "preload": 40.0,
    }
    joint = {"stiffness": 5e4, "slip_force": 16.0}
    sliders = {
        "Jenkins": (mass(ss.Jenkins("x", **joint)), "exact"),
        "Iwan": (mass(ss.Iwan("x", **joint, chi=-0.5)), "exact"),
        "Iwan, chi -0.8": (mass(ss.Iwan("x", **joint, chi=-0.8, beta=0.3)), "exact"),
        "exponential": (mass(ss.Masing("x", **joint, backbone="exponential")), "exact"),
        "shear layer": (
            mass(ss.Masing("x", **joint, backbone="shear-layer", shear_lag=3.0)),
            "exact",
        ),
    }
    nodes = {
        "planar, exact": (mass(ss.Coulomb(["x", "z"], normal=[0, 1], **number)), "exact"),
        "planar, sampled": (mass(ss.Coulomb(["x", "z"], normal=[0, 1], **number)), "marched"),
        "in space, exact": (mass(ss.Coulomb(list("xyz"), normal=[0, 0, 1], **number)), "exact"),
        "in space, sampled": (mass(ss.Coulomb(list("xyz"), normal=[0, 0, 1], **number)), "marched"),
    }
    compared(sliders | nodes, HARMONICS)
    compared(sliders, 15)

    two_blades = wedge()
    around = 2.0 * np.pi * np.linspace(42.0, 51.0, 91)
    spent, result = least(lambda: ss.forced_response(two_blades, around, stability=False))
    solved = int(result.converged.sum())
    print(f"two blades and a wedge: {solved} of 91 frequencies in {1e3 * spent:.0f} ms,")
    print(f"  harmonics to {result.harmonics.max()}, {result.counters['evaluations']} evaluations")


if __name__ == "__main__":
    main()
