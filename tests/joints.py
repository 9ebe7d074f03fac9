"""Structures with joints whose nonlinear modes are computed."""

from __future__ import annotations

import numpy as np

import stickslip as ss
from chains import in_a_row

JENKINS = ss.Jenkins("x", stiffness=4e3, slip_force=1.0)


def one_mass(*contacts, force=None, damping=2.0):
    """Return a mass of 1 kg on a spring of 1e4 N/m."""
    structure = ss.Structure(mass=[[1.0]], stiffness=[[1e4]], damping=[[damping]], dofs=["x"])
    return ss.Model(structure, contacts=contacts, forces=[] if force is None else [force])


def chain(force=None):
    """Return three masses with two elements of one joint."""
    structure = ss.Structure(
        mass=np.diag([1.0, 0.5, 0.3]),
        stiffness=[[3e4, -1e4, 0.0], [-1e4, 2.5e4, -5e3], [0.0, -5e3, 2e4]],
        damping=ss.ModalDamping(0.003),
        dofs=["x", "y", "z"],
    )
    contacts = [
        ss.Jenkins("x", stiffness=4e3, slip_force=1.0),
        ss.Jenkins("y", "z", stiffness=2e3, slip_force=0.7),
    ]
    return ss.Model(structure, contacts=contacts, forces=[] if force is None else [force])


def wedge():
    """Return two blades and a wedge with the parameters of Balaji and Ferhatoglu (2025)."""
    stiffness = np.zeros((6, 6))
    blocks = [(1e6, -9e5), (4e5, -3e5), (1e6, -1e6)]
    for place, (own, other) in enumerate(blocks):
        stiffness[2 * place : 2 * place + 2, 2 * place : 2 * place + 2] = [
            [own, other],
            [other, own],
        ]
    structure = ss.Structure(
        mass=np.diag([10.0, 10.0, 10.0, 10.0, 0.1, 0.1]),
        stiffness=stiffness,
        damping=np.diag([20.0, 20.0, 20.0, 20.0, 0.0, 0.0]),
        dofs=["x1", "y1", "x2", "y2", "xD", "yD"],
    )
    cos, sin = np.cos(np.deg2rad(40.0)), np.sin(np.deg2rad(40.0))
    keys = {"friction": 0.6, "tangential_stiffness": 3e5, "normal_stiffness": 3e5}
    contacts = [
        ss.Coulomb(["xD", "yD"], other=["x1", "y1"], normal=[-sin, cos], **keys),
        ss.Coulomb(["xD", "yD"], other=["x2", "y2"], normal=[sin, cos], **keys),
    ]
    return ss.Model(structure, contacts=contacts, forces=[ss.Force("yD", 240.0, harmonic=0)])


def jointed(rng):
    """Return a random chain with contacts of all kinds, and a mode of it."""
    size = int(rng.integers(2, 7))
    springs = 10.0 ** rng.uniform(3.5, 4.5, size + 1)
    dofs = [f"d{i}" for i in range(size)]
    structure = ss.Structure(
        mass=np.diag(rng.uniform(0.2, 2.0, size)),
        stiffness=in_a_row(springs),
        damping=ss.ModalDamping(rng.choice([0.0005, 0.003, 0.01])),
        dofs=dofs,
    )
    contacts = []
    for place in range(int(rng.integers(1, 5))):
        first = int(rng.integers(size))
        ends = [dofs[first], dofs[(first + 1 + int(rng.integers(size - 1))) % size]]
        spring, force = 10.0 ** rng.uniform(3.0, 4.5), 10.0 ** rng.uniform(-1.0, 1.0)
        at = ends[: int(rng.integers(1, 3))]
        angle = rng.uniform(0.0, np.pi)
        pad = {
            "normal": [-np.sin(angle), np.cos(angle)],
            "friction": rng.uniform(0.1, 0.8),
            "tangential_stiffness": spring,
            "normal_stiffness": 10.0 ** rng.uniform(3.0, 4.5),
            "name": f"c{place}",
        }
        kinds = [
            ss.Jenkins(*at, stiffness=spring, slip_force=force, name=f"c{place}"),
            ss.Stop(*at, stiffness=spring, gap=force / spring, name=f"c{place}"),
            ss.Coulomb(ends, preload=force, **pad),
            ss.Coulomb(ends, gap=force / spring * rng.uniform(-1.0, 1.0), **pad),
        ]
        contacts.append(kinds[rng.integers(4)])
    loaded = [ss.Force(dofs[0], float(10.0 ** rng.uniform(-1.0, 1.0)), harmonic=0)]
    model = ss.Model(structure, contacts=contacts, forces=loaded if rng.random() < 0.4 else [])
    return model, int(rng.integers(size))


def bar(count):
    """Return a clamped bar on Jenkins elements of all slip forces."""
    step = 1.0 / count
    stiff = 2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1)
    stiff[-1, -1] = 1.0
    limits = np.geomspace(3.0, 3e4, count)[np.random.default_rng(1).permutation(count)]
    names = [f"n{place}" for place in range(count)]
    structure = ss.Structure(
        8.0 * step * np.eye(count), 4e5 / step * stiff, ss.ModalDamping(0.001), names
    )
    contacts = [
        ss.Jenkins(name, stiffness=6e5 * step, slip_force=limit * step)
        for name, limit in zip(names, limits, strict=True)
    ]
    return ss.Model(structure, contacts)


def describing(amplitude, stiffness=4e3, limit=1.0):
    """Return the complex stiffness of a Jenkins element (Griffin 1980)."""
    onset = limit / stiffness
    if amplitude <= onset:
        return stiffness + 0j
    angle = np.arccos(1.0 - 2.0 * onset / amplitude)
    real = stiffness / np.pi * (angle - 0.5 * np.sin(2.0 * angle))
    work = 4.0 * limit * (amplitude - onset)
    return real + 1j * work / (np.pi * amplitude**2)
