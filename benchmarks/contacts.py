"""Speed of friction contacts, as ratios measured in one run.

Usage::

    python benchmarks/contacts.py            # laws, samples, two blades and a wedge
    python benchmarks/contacts.py --peers    # and a contact in space and a wedge with pyHarm-os

One mass on contacts, so that the laws take nearly all the time: laws without sliders, a planar node
and one in space, the nodes exact and sampled, against a Jenkins element; the laws without sliders
once more at 15 harmonics; the node in space by fixed samples, with their error. Then two blades and
a wedge of six degrees of freedom (Balaji and Ferhatoglu 2025): 91 frequencies with automatic
harmonics. Processor times on one thread.

tmdsimpy is not on PyPI: it cannot be installed for these runs, and is not in them.
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
from typing import Any

for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np

import stickslip as ss
from stickslip.model import Contact

HERE = Path(__file__).parent
GRID = np.linspace(150.0, 420.0, 200)
AROUND = 2.0 * np.pi * np.linspace(42.0, 51.0, 91)
HARMONICS = 7
PEER_HARMONICS = (9, 27)
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


SINE, COSINE = np.sin(np.deg2rad(40.0)), np.cos(np.deg2rad(40.0))
FACES = {1: [-SINE, COSINE], 2: [SINE, COSINE]}
FACE = {"friction": 0.6, "tangential_stiffness": 3e5, "normal_stiffness": 3e5}
PRESS, PUSH = 240.0, 10.0
BLOCKS = ([[1e6, -9e5], [-9e5, 1e6]], [[4e5, -3e5], [-3e5, 4e5]], [[1e6, -1e6], [-1e6, 1e6]])
MASSES, DAMPINGS = (10.0, 10.0, 0.1), (20.0, 20.0, 0.0)


def wedge(preloads: tuple[float, float] | None = None) -> ss.Model:
    """Return two blades and a wedge, held by its contacts and a spring between its directions.

    A static load presses the wedge, or the faces have preloads [N].
    """
    names = ["x1", "y1", "x2", "y2", "xD", "yD"]
    structure = ss.Structure(
        np.diag(np.repeat(MASSES, 2)),
        np.block([[np.array(BLOCKS[i]) * (i == j) for j in range(3)] for i in range(3)]),
        np.diag(np.repeat(DAMPINGS, 2)),
        names,
    )
    faces = [
        ss.Coulomb(
            ["xD", "yD"],
            [f"x{blade}", f"y{blade}"],
            normal=normal,
            preload=None if preloads is None else preloads[blade - 1],
            **FACE,
        )
        for blade, normal in FACES.items()
    ]
    forces = [ss.Force("x1", PUSH), ss.Force("x2", -PUSH)]
    if preloads is None:
        forces.append(ss.Force("yD", PRESS, harmonic=0))
    return ss.Model(structure, faces, forces)


def normal_loads() -> tuple[float, float]:
    """Return the normal forces of the static load where no face takes up friction [N]."""
    model, rows = wedge(), np.zeros((2, 6))
    for row, (blade, normal) in zip(rows, FACES.items(), strict=True):
        row[4:] = normal
        row[2 * blade - 2 : 2 * blade] = [-n for n in normal]
    stiff = FACE["normal_stiffness"]
    load = np.zeros(6)
    load[5] = PRESS
    first, second = (
        stiff * rows @ np.linalg.solve(model.structure.stiffness + stiff * rows.T @ rows, load)
    )
    return float(first), float(second)


def amplitudes(result: ss.ForcedResponse) -> np.ndarray:
    """Return the amplitudes of all directions, (directions, frequencies)."""
    return np.array([result.amplitude(dof) for dof in result.dofs])


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


def by_peer(python: Path, study: dict[str, Any], exact: np.ndarray, spent: float) -> None:
    """Print the study in pyHarm-os by some samples, against amplitudes and the time they took."""
    grid = np.linspace(*study["omega"], study["points"])
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


def peer_contact(python: Path) -> None:
    """Print one contact in space, here and in pyHarm-os, by its penalty contact."""
    model, points = in_space(), 60
    grid = np.linspace(GRID[0], GRID[-1], points)
    spent, result = least(lambda: ss.forced_response(model, grid, HARMONICS, stability=False))
    print(f"one contact in space, {points} frequencies: {1e3 * spent:.0f} ms; pyHarm-os:")
    force = [p * np.exp(1j * phase) for p, phase in FORCES]
    structure = model.structure
    # Its contacts take what opens them as positive.
    contact = {"between": ["mass"], "normal": [0, 0, -1], "tangents": [[1, 0, 0], [0, 1, 0]]}
    study = {
        "bodies": {"mass": matrices(structure.mass, structure.damping, structure.stiffness)},
        "contacts": [contact | CONTACT],
        "forces": [["mass", i, one.real, one.imag] for i, one in enumerate(force)],
        "omega": [grid[0], grid[-1]],
        "points": points,
        "harmonics": HARMONICS,
        "momentum": 0.0,
    }
    by_peer(python, study, amplitudes(result), spent)


def peer_wedge(python: Path) -> None:
    """Print two blades and a wedge with the normal forces of its load as preloads, here and there.

    Sliders start at rest in both programs. Errors are those against 63 harmonics.
    """
    loads = normal_loads()
    model = wedge(loads)

    def curve(harmonics: int | str) -> ss.ForcedResponse:
        return ss.forced_response(
            model, AROUND, harmonics, residual="from_rest", stability=False, tolerance=1e-3
        )

    exact = amplitudes(curve(63))
    spent, result = least(lambda: curve("auto"))
    error = largest_error(amplitudes(result), exact)
    highest = int(result.harmonics.max())
    print(f"two blades and a prestressed wedge, {len(AROUND)} frequencies: {1e3 * spent:.0f} ms,")
    print(f"  harmonics to {highest}, amplitudes wrong by {error:.1e}; pyHarm-os:")
    names = ["blade 1", "blade 2", "damper"]
    study = {
        "bodies": {
            name: matrices(m * np.eye(2), c * np.eye(2), np.array(block))
            for name, m, c, block in zip(names, MASSES, DAMPINGS, BLOCKS, strict=True)
        },
        "contacts": [
            {
                "between": ["damper", f"blade {blade}"],
                "normal": [-n for n in normal],
                "tangents": [[normal[1], -normal[0]]],
                "preload": loads[blade - 1],
            }
            | FACE
            for blade, normal in FACES.items()
        ],
        "forces": [["blade 1", 0, PUSH, 0.0], ["blade 2", 0, -PUSH, 0.0]],
        "omega": [AROUND[0], AROUND[-1]],
        "points": len(AROUND),
        # Without it Newton's method ends where a face begins to slip.
        "momentum": 0.5,
    }
    for harmonics in PEER_HARMONICS:
        print(f"  {harmonics} harmonics:")
        by_peer(python, study | {"harmonics": harmonics}, exact, spent)


def matrices(mass: np.ndarray, damping: np.ndarray, stiffness: np.ndarray) -> dict[str, Any]:
    """Return the matrices of a body as the peer's script reads them."""
    return {"mass": mass.tolist(), "damping": damping.tolist(), "stiffness": stiffness.tolist()}


def main() -> None:
    parser = argparse.ArgumentParser(description="Speed of friction contacts.")
    parser.add_argument("--peers", action="store_true", help="run pyHarm-os as well")
    default = HERE.parent / ".peers"
    parser.add_argument("--environment", type=Path, default=default, help="where pyHarm-os lives")
    options = parser.parse_args()
    laws()
    by_samples()
    two_blades = wedge()
    spent, result = least(lambda: ss.forced_response(two_blades, AROUND, stability=False))
    solved = int(result.converged.sum())
    print(f"two blades and a wedge: {solved} of 91 frequencies in {1e3 * spent:.0f} ms,")
    print(f"  harmonics to {result.harmonics.max()}, {result.counters['evaluations']} evaluations")
    python = options.environment / "bin" / "python"
    if options.peers and not python.exists():
        print(f"pyHarm-os: not installed in {options.environment}; 'make peers' installs it")
    elif options.peers:
        peer_contact(python)
        peer_wedge(python)


if __name__ == "__main__":
    main()
