"""Backbones of joints with 122 contact elements, on one thread.

Usage::

    python benchmarks/joints.py             # all of them
    python benchmarks/joints.py bar lap     # some

20 amplitudes of the first mode, from stuck contacts to widespread slip, with error estimates: a
clamped bar on Jenkins elements; two beams on a lap joint of planar Coulomb contacts; the same joint
of finite elements, whose contacts have two tangential directions and a normal load that varies. The
beams are reduced to the displacements between the two bodies and component modes. Processor times.
"""

from __future__ import annotations

import argparse
import itertools
import os
import time

for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np
from scipy.linalg import block_diag
from scipy.sparse import block_diag as sparse_block_diag

import stickslip as ss

CONTACTS, POINTS = 122, 20
DAMPING = ss.ModalDamping(0.001)
STEEL = {"young": 2.1e11, "poisson": 0.3, "density": 7800.0}
LENGTH, LAP, WIDTH = 0.72, 0.12, 0.0254
"""Of the two beams together, of their lap, and of their square cross-section [m]."""
PRESSURE = 3e6
"""Mean pressure of the lap without motion [Pa], ..."""
CONTACT = {"friction": 0.4, "tangential_stiffness": 2e12, "normal_stiffness": 3e12}
"""... and its contact, stiffness per area [N/m3]."""


def bar() -> tuple[ss.Model, np.ndarray]:
    """Return a clamped bar on Jenkins elements of all slip forces."""
    step = 1.0 / CONTACTS
    stiff = 2.0 * np.eye(CONTACTS) - np.eye(CONTACTS, k=1) - np.eye(CONTACTS, k=-1)
    stiff[-1, -1] = 1.0
    share = np.full(CONTACTS, step)
    share[-1] *= 0.5
    limits = np.geomspace(3.0, 3e4, CONTACTS)[np.random.default_rng(1).permutation(CONTACTS)]
    names = [f"n{place}" for place in range(CONTACTS)]
    structure = ss.Structure(np.diag(8.0 * share), 4e5 / step * stiff, DAMPING, names)
    contacts = [
        ss.Jenkins(name, stiffness=6e5 * w, slip_force=f * w)
        for name, w, f in zip(names, share, limits, strict=True)
    ]
    return ss.Model(structure, contacts), np.geomspace(1e-5, 1.0, POINTS)


def pressures(count: int) -> np.ndarray:
    """Return pressures along the lap, highest at its three bolts."""
    place = np.linspace(0.0, 1.0, count)
    bolts = sum(np.exp(-(((place - bolt) / 0.12) ** 2)) for bolt in (1 / 6, 1 / 2, 5 / 6))
    return PRESSURE * bolts / bolts.mean()


def beams() -> tuple[ss.Model, np.ndarray]:
    """Return two beams in bending and tension, on a lap joint of planar contacts."""
    half = 0.5 * (LENGTH - LAP)
    lap = np.linspace(half, half + LAP, CONTACTS)
    ends = np.linspace(0.0, half, 21)[:-1], LENGTH - np.linspace(0.0, half, 21)[:-1][::-1]
    names: list[str] = []
    masses, stiffnesses = [], []
    for body, places in (("a", np.r_[ends[0], lap]), ("b", np.r_[lap, ends[1]])):
        size = 3 * places.size
        mass, stiffness = np.zeros((size, size)), np.zeros((size, size))
        for node, (left, right) in enumerate(itertools.pairwise(places)):
            inside = half - 1e-9 < 0.5 * (left + right) < half + LAP + 1e-9
            height = 0.5 * WIDTH if inside else WIDTH
            area, inertia, length = WIDTH * height, WIDTH * height**3 / 12.0, right - left
            own = slice(3 * node, 3 * node + 6)
            m, k = _element(area, inertia, length)
            mass[own, own] += m
            stiffness[own, own] += k
        masses.append(mass)
        stiffnesses.append(stiffness)
        names += [f"{body}{node}.{way}" for node in range(places.size) for way in "uwr"]
    mass, stiffness = block_diag(*masses), block_diag(*stiffnesses)
    # The faces: a below b, each half of the lap's height away from its axis.
    change = np.eye(len(names))
    column = {name: place for place, name in enumerate(names)}
    arm = 0.25 * WIDTH
    kept = []
    for node in range(CONTACTS):
        first, other = f"a{20 + node}", f"b{node}"
        # u_a + arm r_a' and w_a become what they are more than those of b.
        for way, sign in (("u", 1.0), ("w", 0.0)):
            row = column[f"{first}.{way}"]
            change[row, column[f"{other}.{way}"]] = 1.0
            change[row, column[f"{first}.r"]] = sign * arm
            change[row, column[f"{other}.r"]] = sign * arm
            kept.append(f"{first}.{way}")
    # Clamped at the left.
    mass, stiffness = ((change.T @ matrix @ change)[3:, 3:] for matrix in (mass, stiffness))
    reduced = ss.craig_bampton(mass, stiffness, kept, modes=20, dofs=names[3:])
    area = WIDTH * LAP / CONTACTS
    contact = ss.Coulomb(
        np.reshape(kept, (-1, 2)).tolist(),
        normal=[0.0, 1.0],
        friction=CONTACT["friction"],
        tangential_stiffness=CONTACT["tangential_stiffness"] * area,
        normal_stiffness=CONTACT["normal_stiffness"] * area,
        preload=(pressures(CONTACTS) * area).tolist(),
        name="lap",
    )
    return ss.Model(reduced.structure(DAMPING), [contact]), np.geomspace(1e-5, 3e-3, POINTS)


def _element(area: float, inertia: float, length: float) -> tuple[np.ndarray, np.ndarray]:
    """Return mass and stiffness of a straight beam, (u, w, rotation) of both ends."""
    mass, stiffness = np.zeros((6, 6)), np.zeros((6, 6))
    pull = np.ix_([0, 3], [0, 3])
    mass[pull] = np.array([[2.0, 1.0], [1.0, 2.0]]) * STEEL["density"] * area * length / 6.0
    stiffness[pull] = np.array([[1.0, -1.0], [-1.0, 1.0]]) * STEEL["young"] * area / length
    bend, a = np.ix_([1, 2, 4, 5], [1, 2, 4, 5]), length
    mass[bend] = (
        np.array(
            [
                [156.0, 22.0 * a, 54.0, -13.0 * a],
                [22.0 * a, 4.0 * a**2, 13.0 * a, -3.0 * a**2],
                [54.0, 13.0 * a, 156.0, -22.0 * a],
                [-13.0 * a, -3.0 * a**2, -22.0 * a, 4.0 * a**2],
            ]
        )
        * STEEL["density"]
        * area
        * a
        / 420.0
    )
    stiffness[bend] = (
        np.array(
            [
                [12.0, 6.0 * a, -12.0, 6.0 * a],
                [6.0 * a, 4.0 * a**2, -6.0 * a, 2.0 * a**2],
                [-12.0, -6.0 * a, 12.0, -6.0 * a],
                [6.0 * a, 2.0 * a**2, -6.0 * a, 4.0 * a**2],
            ]
        )
        * STEEL["young"]
        * inertia
        / a**3
    )
    return mass, stiffness


def lap() -> tuple[ss.Model, np.ndarray]:
    """Return the same joint of finite elements of 20 nodes; the lap's last pair has no contact."""
    from skfem import MeshHex

    half = 0.5 * (LENGTH - LAP)
    along = np.r_[
        np.linspace(0.0, half, 11)[:-1],
        np.linspace(half, half + LAP, 25),
        LENGTH - np.linspace(0.0, half, 11)[:-1][::-1],
    ]
    axes = [along, np.array([0.0, WIDTH]), np.array([0.0, 0.5, 1.0]) * WIDTH]
    whole = MeshHex.init_tensor(*axes)
    middle = whole.p[:, whole.t].mean(axis=1)
    lower = (middle[0] < half) | ((middle[0] < half + LAP) & (middle[2] < 0.5 * WIDTH))
    bodies = [ss.Solid(whole.restrict(np.flatnonzero(own)), **STEEL) for own in (lower, ~lower)]
    on = [
        (np.abs(body.nodes[:, 2] - 0.5 * WIDTH) < 1e-9)
        & (body.nodes[:, 0] > half - 1e-9)
        & (body.nodes[:, 0] < half + LAP + 1e-9)
        for body in bodies
    ]
    pad = ss.ContactInterface.from_surfaces(bodies[0], on[0], bodies[1], on[1], names=("a", "b"))
    dofs = [f"{name}.{dof}" for name, body in zip("ab", bodies, strict=True) for dof in body.dofs]
    mass, stiffness = (
        pad.relative(sparse_block_diag([getattr(body, of) for body in bodies]).tocsc(), dofs)
        for of in ("mass", "stiffness")
    )
    clamped = np.repeat(bodies[0].nodes[:, 0] < 1e-9, 3)
    free = np.flatnonzero(np.r_[~clamped, np.ones(len(dofs) - clamped.size, bool)])
    mass, stiffness = (matrix[free][:, free] for matrix in (mass, stiffness))
    dofs = [dofs[place] for place in free]
    order = np.argsort(pad.points[:, 0], kind="stable")
    kept = np.reshape([f"a.{dof}" for dof in pad.first_dofs], (-1, 3))[order]
    reduced = ss.craig_bampton(mass, stiffness, kept.ravel().tolist(), modes=20, dofs=dofs)
    areas = pad.areas[order][:CONTACTS]
    contact = ss.Coulomb(
        kept[:CONTACTS].tolist(),
        normal=pad.normals[order][:CONTACTS],
        friction=CONTACT["friction"],
        tangential_stiffness=(CONTACT["tangential_stiffness"] * areas).tolist(),
        normal_stiffness=(CONTACT["normal_stiffness"] * areas).tolist(),
        preload=(pressures(CONTACTS) * areas).tolist(),
        name="lap",
    )
    return ss.Model(reduced.structure(DAMPING), [contact]), np.geomspace(1e-5, 3e-3, POINTS)


def measured(kind: str, **options: object) -> ss.NonlinearModes:
    """Compute a backbone and say what it took."""
    model, amplitudes = {"bar": bar, "beams": beams, "lap": lap}[kind]()
    model.problem  # noqa: B018
    start = time.process_time()
    found = ss.nonlinear_modes(model, amplitude=amplitudes, **options)
    spent = time.process_time() - start
    print(f"{kind:>6} {spent:8.2f} s for {POINTS} amplitudes of mode 0, {options}")
    print(f"        {dict(found.counters)}")
    print(f"        { ({name: round(value, 2) for name, value in found.timings.items()}) } s")
    solved = sum(status.solved for status in found.status)
    print(
        f"        solved {solved}, frequency {found.omega[0] / 2 / np.pi:.2f} to "
        f"{np.nanmin(found.omega) / 2 / np.pi:.2f} Hz, damping up to "
        f"{np.nanmax(found.damping_ratio):.4f}, harmonics {np.unique(found.harmonics)}",
        flush=True,
    )
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kinds", nargs="*", default=["bar", "beams", "lap"])
    parser.add_argument("--harmonics", type=int, nargs="*", default=[3, 7])
    given = parser.parse_args()
    for kind in given.kinds:
        for harmonics in given.harmonics:
            measured(kind, harmonics=harmonics)


if __name__ == "__main__":
    main()
