"""Interfaces of many contact nodes in harmonic balance, as ratios measured in one run.

Usage::

    python benchmarks/interfaces.py                  # all of them
    python benchmarks/interfaces.py bar layer block --sizes 64 256

A clamped bar on Jenkins elements, a third of which slip, under three laws of damping; the shear
layer of Menq, whose dissipation is known in closed form; a block of finite elements, mounted at a
corner, on a face of Coulomb contacts that slip in part and lift off. Processor times of one thread;
that of a point stands beside one LAPACK factorisation of contacts times (H + 1) unknowns.
"""

from __future__ import annotations

import argparse
import os
import resource
import time

for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np
import scipy.integrate
import scipy.linalg
import scipy.optimize
import scipy.sparse

import stickslip as ss

HARMONICS = {"bar": 7, "layer": 31, "block": 5}
SIZES = {"bar": (64, 256, 1000), "layer": (100, 1000, 10000), "block": (100, 300, 1000)}
POINTS = {"bar": 40, "layer": 1, "block": 40}
BLOCK = {
    "preload": 600.0,
    "force": (50.0, 25.0, 160.0),
    "damping": 1500.0,
    "mount": 5e7,
    "omega": (12000.0, 15700.0),
}
MARCHED = {"evaluation": "marched", "samples": 128, "stability": False}
BAR = {
    "EA": 4e5,
    "length": 1.0,
    "mass": 8.0,
    "stiffness": 6e5,
    "limits": (3.0, 3e4),
    "force": 400.0,
    "omega": (300.0, 500.0),
}
LAYER = {"EA": 1e7, "length": 0.1, "stiffness": 1e10, "limit": 2e4, "force": 828.0}


def bar(count: int, damping: ss.Rayleigh | ss.ModalDamping) -> tuple[ss.Model, np.ndarray]:
    """Return a clamped bar on Jenkins elements of all slip forces, of which about a third slips."""
    step = BAR["length"] / count
    stiff = BAR["EA"] / step * (2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1))
    stiff[-1, -1] *= 0.5
    share = np.full(count, step)
    share[-1] *= 0.5
    limits = np.geomspace(*BAR["limits"], count)[np.random.default_rng(1).permutation(count)]
    names = [f"n{place}" for place in range(count)]
    structure = ss.Structure(np.diag(BAR["mass"] * share), stiff, damping, names)
    contacts = [
        ss.Jenkins(name, stiffness=BAR["stiffness"] * w, slip_force=f * w)
        for name, w, f in zip(names, share, limits, strict=True)
    ]
    forces = [ss.Force(names[-1], BAR["force"])]
    return ss.Model(structure, contacts, forces), np.linspace(*BAR["omega"], POINTS["bar"])


def layer(count: int) -> tuple[ss.Model, np.ndarray]:
    """Return a bar in a shear layer of Jenkins elements (Menq), pulled slowly at one end."""
    step = LAYER["length"] / (count - 1)
    share = np.full(count, step)
    share[[0, -1]] = 0.5 * step
    ends = np.r_[1.0, np.full(count - 2, 2.0), 1.0]
    bar = LAYER["EA"] / step * (np.diag(ends) - np.eye(count, k=1) - np.eye(count, k=-1))
    names = [f"n{place}" for place in range(count)]
    structure = ss.Structure(np.diag(share), bar, ss.Rayleigh(mass=1.0, stiffness=0.0), names)
    contacts = [
        ss.Jenkins(name, stiffness=LAYER["stiffness"] * w, slip_force=LAYER["limit"] * w)
        for name, w in zip(names, share, strict=True)
    ]
    return ss.Model(structure, contacts, [ss.Force("n0", LAYER["force"])]), np.array([1.0])


def layer_dissipation() -> float:
    """Return the exact work per cycle [J]: the loop of a Masing law from its backbone u(F)."""
    stiff, force = LAYER["EA"], LAYER["force"]
    rate = np.sqrt(LAYER["stiffness"] / stiff)
    limit, length = LAYER["limit"], LAYER["length"]

    def pulled(slip: float) -> float:
        return limit * slip + limit / rate * np.tanh(rate * (length - slip))

    def displacement(f: float) -> float:
        if f <= pulled(0.0):
            return f / (stiff * rate * np.tanh(rate * length))
        slip = scipy.optimize.brentq(lambda a: pulled(a) - f, 0.0, length, xtol=1e-16)
        return limit / LAYER["stiffness"] + (f * slip - 0.5 * limit * slip**2) / stiff

    work, _ = scipy.integrate.quad(
        displacement, 0.0, force, points=[pulled(0.0)], epsabs=0.0, epsrel=1e-12, limit=200
    )
    return 8.0 * (force * displacement(force) - work) - 4.0 * force * displacement(force)


def block(count: int) -> tuple[ss.Model, np.ndarray]:
    """Return a block of about so many nodes on its contact face, with three directions each."""
    from skfem import MeshHex

    size = np.array([0.1, 0.06, 0.03])
    # A face of w x d elements of 20 nodes has about 3 w d of them.
    wide = round(np.sqrt(count / 3.0 * size[0] / size[1]))
    deep = round(count / (3.0 * wide))
    axes = [np.linspace(0.0, s, n + 1) for s, n in zip(size, (wide, deep, 2), strict=True)]
    solid = ss.Solid(MeshHex.init_tensor(*axes), young=2.1e11, poisson=0.3, density=7800.0)
    face = np.flatnonzero(solid.nodes[:, 2] < 1e-12)
    kept = [f"{node + 1}.{way}" for node in (*face, solid.nearest(size)) for way in (1, 2, 3)]
    # Held by friction alone the block would walk where most nodes slip: no periodic motion.
    mounts = np.zeros(len(solid.dofs))
    mounts[[solid.dofs.index(dof) for dof in kept[-3:]]] = BLOCK["mount"]
    held = solid.stiffness + scipy.sparse.diags_array(mounts)
    reduced = ss.craig_bampton(solid.mass, held, kept, modes=30, dofs=solid.dofs)
    contact = ss.Coulomb(
        np.reshape(kept[:-3], (-1, 3)).tolist(),
        normal=[0.0, 0.0, -1.0],
        friction=0.4,
        tangential_stiffness=4e8 / len(face),
        normal_stiffness=6e8 / len(face),
        preload=BLOCK["preload"] / len(face),
        name="face",
    )
    forces = [
        ss.Force(dof, force, phase=phase)
        for dof, force, phase in zip(kept[-3:], BLOCK["force"], (0.0, -1.0, -0.5), strict=True)
    ]
    structure = reduced.structure(ss.Rayleigh(mass=BLOCK["damping"], stiffness=0.0))
    return ss.Model(structure, [contact], forces), np.linspace(*BLOCK["omega"], POINTS["block"])


def factorisation(unknowns: int) -> float:
    """Return the time of one LAPACK factorisation [s]."""
    matrix = np.random.default_rng(0).standard_normal((unknowns, unknowns))
    start = time.process_time()
    scipy.linalg.lu_factor(matrix, overwrite_a=True, check_finite=False)
    return time.process_time() - start


def eigenproblem(model: ss.Model) -> float:
    """Return the time of all modes of the structure by LAPACK [s]."""
    start = time.process_time()
    scipy.linalg.eigh(model.structure.stiffness, model.structure.mass)
    return time.process_time() - start


def measured(kind: str, count: int, model: ss.Model, omega: np.ndarray, **options: object) -> None:
    """Compute a curve and say what it took."""
    start = time.process_time()
    model.problem  # noqa: B018
    built = time.process_time() - start
    start = time.process_time()
    observe = [model.forces[0].dof]
    frf = ss.forced_response(model, omega, HARMONICS[kind], observe=observe, **options)
    point = (time.process_time() - start) / len(frf.omega)
    slip = [frf.slip_fraction(c) for c in range(len(model.contacts))]
    slips = np.mean([np.mean(np.asarray(s) > 0.0) for s in slip])
    shares = {name: f"{value / len(frf.omega) * 1e3:.1f}" for name, value in frf.timings.items()}
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    print(
        f"{kind:>6} {count:6d}  set-up {built:7.2f} s  point {1e3 * point:9.2f} ms"
        f"  slip {slips:.2f}"
    )
    print(f"        converged {np.mean([s == 'converged' for s in frf.status]):.2f}, {shares} ms")
    print(f"        {dict(frf.counters)}, {peak:.2f} GB at most", flush=True)
    if kind == "layer":
        works = sum(float(np.sum(frf.dissipation(c))) for c in range(len(model.contacts)))
        print(f"        dissipation {works:.9e} J, exact {layer_dissipation():.9e} J")
    if kind == "block":
        opened = np.asarray(frf.open_fraction(0))
        print(f"        lift-off {np.mean(opened > 0.0):.2f} of the nodes")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kinds", nargs="*", default=list(SIZES))
    parser.add_argument("--sizes", nargs="*", type=int)
    parser.add_argument("--points", type=int)
    parser.add_argument("--damping", choices=["mass", "rayleigh", "modal"], default="mass")
    given = parser.parse_args()
    laws = {
        "mass": ss.Rayleigh(mass=8.0, stiffness=0.0),
        "rayleigh": ss.Rayleigh(mass=4.0, stiffness=1e-5),
        "modal": ss.ModalDamping(0.01),
    }
    # What is imported and compiled at first is not part of any point.
    measured("bar", 32, *bar(32, laws["mass"]))
    for kind in given.kinds:
        for count in given.sizes or SIZES[kind]:
            if kind == "bar":
                model, omega = bar(count, laws[given.damping])
                unknowns = count * (HARMONICS[kind] + 1)
                if count <= 256:
                    print(f"        one LAPACK LU: {1e3 * factorisation(unknowns):.1f} ms")
                measured(kind, count, model, omega[: given.points])
            elif kind == "layer":
                measured(kind, count, *layer(count))
            else:
                model, omega = block(count)
                measured(kind, count, model, omega[: given.points], **MARCHED)
                print(f"        one symmetric eigenproblem: {eigenproblem(model):.2f} s")


if __name__ == "__main__":
    main()
