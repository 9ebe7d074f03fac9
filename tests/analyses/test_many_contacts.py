"""Interfaces of many contacts, solved without receptances."""

import numpy as np
import pytest

import stickslip as ss
from chains import in_a_row

EA, LENGTH, STIFFNESS, LIMIT = 1e7, 0.1, 1e10, 2e4


def shear_layer(count: int, force: float) -> ss.Model:
    """Return a bar in a shear layer (Menq 1985) of elements by the trapezoid, pulled at one end."""
    step = LENGTH / (count - 1)
    share = np.full(count, step)
    share[[0, -1]] /= 2.0
    ends = np.r_[1.0, np.full(count - 2, 2.0), 1.0]
    bar = EA / step * (np.diag(ends) - np.eye(count, k=1) - np.eye(count, k=-1))
    names = [f"n{place}" for place in range(count)]
    structure = ss.Structure(np.diag(share), bar, ss.Rayleigh(mass=1.0, stiffness=0.0), names)
    contacts = [
        ss.Jenkins(name, stiffness=STIFFNESS * w, slip_force=LIMIT * w)
        for name, w in zip(names, share, strict=True)
    ]
    return ss.Model(structure, contacts, [ss.Force("n0", force)])


def dissipation(model: ss.Model) -> float:
    """Return the work per cycle far below every resonance [J]."""
    frf = ss.forced_response(model, [1.0], 81, observe=["n0"])
    assert list(frf.status) == ["converged"]
    return sum(float(frf.dissipation(c)[0].sum()) for c in range(len(model.contacts)))


def test_the_shear_layer_dissipates_what_its_elements_do_and_tends_to_the_layer() -> None:
    exact, errors = 9.601744996e-3, []
    # Six digits from the quasi-static motion of the elements; 81 harmonics have the fifth.
    for count, expected in ((51, 9.60708e-3), (101, 9.60219e-3), (401, 9.60183e-3)):
        work = dissipation(shear_layer(count, 1600.0))
        assert work == pytest.approx(expected, rel=3e-5)
        errors.append(abs(work / exact - 1.0))
    assert errors[0] > 5.0 * errors[1] > 10.0 * errors[2]


def friction_plate(count: int) -> ss.Model:
    """Return masses on a plane that slip and lift off, coupled from one to the next."""
    rng = np.random.default_rng(5)
    size = 3 * count
    stiffness = 4e4 * np.eye(size)
    for node in range(count - 1):
        own, after = slice(3 * node, 3 * node + 3), slice(3 * node + 3, 3 * node + 6)
        spring = 2e5 * np.diag(rng.uniform(0.5, 1.5, 3))
        stiffness[own, own] += spring
        stiffness[after, after] += spring
        stiffness[own, after] -= spring
        stiffness[after, own] -= spring
    names = [f"{node}.{axis}" for node in range(count) for axis in "xyz"]
    law = ss.Rayleigh(mass=30.0, stiffness=0.0)
    structure = ss.Structure(np.eye(size), stiffness, law, names)
    pads = [
        ss.Coulomb(
            [f"{node}.{axis}" for axis in "xyz"],
            normal=[0.0, 0.0, -1.0],
            friction=0.4,
            tangential_stiffness=8e4,
            normal_stiffness=1e5,
            preload=float(preload),
            name=f"pad{node}",
        )
        for node, preload in enumerate(rng.uniform(2.0, 60.0, count))
    ]
    forces = [ss.Force(f"{n}.{axis}", 12.0, phase=0.4 * n) for n in range(count) for axis in "xz"]
    return ss.Model(structure, pads, forces)


@pytest.mark.slow
def test_contacts_that_slip_and_lift_off_are_those_of_receptances() -> None:
    model = friction_plate(40)
    omega = np.linspace(300.0, 330.0, 4)
    options = {
        "evaluation": "marched",
        "samples": 64,
        "observe": ["0.x", "20.z"],
        "stability": False,
    }
    newton = ss.forced_response(model, omega, 3, **options)
    assert newton.counters["products"] > 0
    formed = ss.forced_response(model, omega, 3, method="broyden", **options)
    assert formed.counters["products"] == 0
    for dof in ("0.x", "20.z"):
        assert list(newton.status) == list(formed.status) == ["converged"] * 4
        a, b = newton.coefficients(dof), formed.coefficients(dof)
        assert np.abs(a - b).max() < 1e-7 * np.abs(b).max()
    slip = np.array([newton.slip_fraction(c) for c in range(40)])
    opens = np.array([newton.open_fraction(c) for c in range(40)])
    assert 0.1 < np.mean(slip > 0.0) < 0.95
    assert opens.max() > 0.0


@pytest.mark.parametrize("ratio", [1e-7, 1e-9, 1e-10])
def test_damping_bounds_what_many_contacts_stick_to_whatever_little_it_is(ratio: float) -> None:
    rng = np.random.default_rng(200)
    stiffness = in_a_row(1e4 * 10 ** rng.uniform(-0.2, 0.2, 201))
    squared, shapes = np.linalg.eigh(stiffness)
    damping = shapes * (2.0 * ratio * np.sqrt(squared)) @ shapes.T
    structure = ss.Structure(np.eye(200), stiffness, ss.ModalDamping(ratio))
    held = np.sort(rng.choice(200, 150, replace=False))
    contacts = [ss.Jenkins(str(i), stiffness=1e3, slip_force=1e30) for i in held]
    stiffness[held, held] += 1e3
    omega = np.sqrt(np.linalg.eigvalsh(stiffness)[0])
    model = ss.Model(structure, contacts, [ss.Force("0", 1.0)])
    dynamic = stiffness - omega**2 * np.eye(200) + 1j * omega * damping
    height = abs(np.linalg.solve(dynamic, np.eye(200)[0])[100])
    frf = ss.forced_response(model, [omega], 3)
    assert frf.amplitude("100")[0] == pytest.approx(height, rel=1e-4)


@pytest.mark.slow
def test_a_body_that_walks_says_so_early() -> None:
    """A block on friction alone, pushed by more than friction keeps while it vibrates."""
    plate = friction_plate(40)
    structure = plate.structure
    names = list(structure.dofs)
    loose = structure.stiffness - 4e4 * np.eye(len(names))
    block = ss.Structure(structure.mass, loose, ss.Rayleigh(mass=30.0, stiffness=0.0), names)
    forces = [*plate.forces, ss.Force("0.x", 400.0, harmonic=0)]
    model = ss.Model(block, plate.contacts, forces)
    options = {"evaluation": "marched", "samples": 64, "observe": ["0.x"], "stability": False}
    frf = ss.forced_response(model, [310.0], 3, **options)
    assert list(frf.status) == ["free"]
    assert frf.counters["evaluations"] < 400
