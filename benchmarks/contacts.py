"""Speed of friction contacts, as ratios measured in one run.

Usage::

    python benchmarks/contacts.py            # laws, samples, two blades and a wedge
    python benchmarks/contacts.py --peers    # and one contact in space with pyHarm-os

One mass on contacts, so that the laws take nearly all the time: laws without sliders, a planar node
and one in space, the nodes exact and sampled, against a Jenkins element; the laws without sliders
once more at 15 harmonics; the node in space by fixed samples, with their error. Then two blades and
a wedge of six degrees of freedom (Balaji and Ferhatoglu 2025): 91 frequencies with automatic
harmonics. Processor times on one thread.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np

import stickslip as ss
from stickslip.model import Contact

HERE = Path(__file__).parent
GRID = np.linspace(150.0, 420.0, 200)
HARMONICS = 7
TIMES = 5


def least(work: Callable[[], ss.ForcedResponse]) -> tuple[float, ss.ForcedResponse]:
    """Return the least time of some runs [s], and the last result."""
    times = []
    for _ in range(TIMES):
        start = time.process_time()
        result = work()
        times.append(time.process_time() - start)
    return min(times), result


STIFFNESS, DAMPING = (4e4, 9e4, 1.6e5), (8.0, 10.0, 16.0)
FORCES = ((30.0, 0.0), (25.0, -1.57), (20.0, -0.7))
CONTACT = {
    "friction": 0.4,
    "tangential_stiffness": 5e4,
    "normal_stiffness": 8e4,
    "preload": 40.0,
}


def mass(contact: Contact) -> ss.Model:
    """Return a mass on a plane."""
    structure = ss.Structure(np.eye(3), np.diag(STIFFNESS), np.diag(DAMPING), ["x", "y", "z"])
    forces = [ss.Force(dof, p, phase=phase) for dof, (p, phase) in zip("xyz", FORCES, strict=True)]
    return ss.Model(structure, [contact], forces)


def in_space() -> ss.Model:
    """Return the mass on a contact with two tangential directions."""
    return mass(ss.Coulomb(list("xyz"), normal=[0, 0, 1], **CONTACT))


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


def amplitudes(result: ss.ForcedResponse) -> np.ndarray:
    """Return the amplitudes of all directions, (3, frequencies)."""
    return np.array([result.amplitude(dof) for dof in "xyz"])


def largest_error(found: np.ndarray, exact: np.ndarray) -> float:
    """Return the largest error, relative to the largest amplitude of the direction."""
    return float((np.abs(found - exact) / exact.max(axis=1, keepdims=True)).max())


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


def laws() -> None:
    """Print the time per evaluation of every law."""
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
        "planar, exact": (mass(ss.Coulomb(["x", "z"], normal=[0, 1], **CONTACT)), "exact"),
        "planar, sampled": (mass(ss.Coulomb(["x", "z"], normal=[0, 1], **CONTACT)), "marched"),
        "in space, exact": (in_space(), "exact"),
        "in space, sampled": (in_space(), "marched"),
    }
    compared(sliders | nodes, HARMONICS)
    compared(sliders, 15)


def by_samples() -> None:
    """Print what fixed samples cost and how wrong they are, for a contact in space."""
    model = in_space()
    exact = ss.forced_response(model, GRID, HARMONICS, evaluation="exact", stability=False)
    each = exact.timings["law"] / exact.counters["evaluations"]
    reference = amplitudes(exact)
    print(f"in space by samples, against {1e6 * each:.0f} us per exact evaluation")
    for samples in (64, 128, 256, 512, 1024):

        def work(samples: int = samples) -> ss.ForcedResponse:
            return ss.forced_response(
                model, GRID, HARMONICS, evaluation="marched", samples=samples, stability=False
            )

        _, result = least(work)
        spent = result.timings["law"] / result.counters["evaluations"]
        error = largest_error(amplitudes(result), reference)
        print(f"  {samples:5} samples {1e6 * spent:8.1f} us, amplitudes wrong by {error:.1e}")


def against_peer(folder: Path) -> None:
    """Print the same contact in space in pyHarm-os, by its penalty contact."""
    python = folder / "bin" / "python"
    if not python.exists():
        print(f"pyHarm-os: not installed in {folder}; 'make peers' installs it")
        return
    model, points = in_space(), 60
    grid = np.linspace(GRID[0], GRID[-1], points)

    def work() -> ss.ForcedResponse:
        return ss.forced_response(model, grid, HARMONICS, stability=False)

    spent, result = least(work)
    exact = amplitudes(result)
    print(f"one contact in space, {points} frequencies: {1e3 * spent:.0f} ms; pyHarm-os:")
    force = [p * np.exp(1j * phase) for p, phase in FORCES]
    # Its contact takes what opens it as positive.
    force[2] = -force[2]
    study = {
        "mass": [1.0] * 3,
        "damping": DAMPING,
        "stiffness": STIFFNESS,
        "force": [[one.real, one.imag] for one in force],
        "contact": CONTACT,
        "omega": [grid[0], grid[-1]],
        "points": points,
        "harmonics": HARMONICS,
    }
    for samples in (64, 256, 1024):
        with tempfile.TemporaryDirectory() as scratch:
            path = Path(scratch) / "study.json"
            path.write_text(json.dumps({**study, "samples": samples}))
            command = [str(python), str(HERE / "peers" / "pyharm_contact.py"), str(path)]
            done = subprocess.run(command, check=False, capture_output=True, text=True)
        if done.returncode:
            print(f"  {samples:5} samples: ended with an error")
            continue
        peer = json.loads(done.stdout.strip().splitlines()[-1])
        solved = np.array(peer["converged"]) & np.isin(
            np.round(peer["omega"], 6), np.round(grid, 6)
        )
        at = np.searchsorted(grid, np.array(peer["omega"])[solved] - 1e-6)
        error = largest_error(np.array(peer["amplitude"])[:, solved], exact[:, at])
        print(
            f"  {samples:5} samples: {solved.sum()} solved in {1e3 * peer['cpu_s']:.0f} ms, "
            f"{peer['cpu_s'] / spent:.0f} times as long, amplitudes wrong by {error:.1e}"
        )


def main() -> None:
    parser = argparse.ArgumentParser(description="Speed of friction contacts.")
    parser.add_argument("--peers", action="store_true", help="run pyHarm-os as well")
    default = HERE.parent / ".peers"
    parser.add_argument("--environment", type=Path, default=default, help="where pyHarm-os lives")
    options = parser.parse_args()
    laws()
    by_samples()
    two_blades = wedge()
    around = 2.0 * np.pi * np.linspace(42.0, 51.0, 91)
    spent, result = least(lambda: ss.forced_response(two_blades, around, stability=False))
    solved = int(result.converged.sum())
    print(f"two blades and a wedge: {solved} of 91 frequencies in {1e3 * spent:.0f} ms,")
    print(f"  harmonics to {result.harmonics.max()}, {result.counters['evaluations']} evaluations")
    if options.peers:
        against_peer(options.environment)


if __name__ == "__main__":
    main()
