"""Limit cycles of contacts that open, and under static loads: about a state at rest."""

import numpy as np
import pytest

import stickslip as ss

NEGATIVE = -np.eye(2)


def held(contacts, load=0.0):
    """Two masses of one body in a plane, damped by 0.5 of what r = 1 takes off."""
    stiffness = [[2e4, -1e4], [-1e4, 3e4]]
    structure = ss.Structure(np.eye(2), stiffness, 0.5 * np.eye(2), ["x", "z"])
    forces = [ss.Force("z", load, harmonic=0)] if load else []
    return ss.Model(structure, contacts, forces)


def pad(**state):
    return ss.Coulomb(
        ["x", "z"],
        normal=[0.6, -0.8],
        friction=0.4,
        tangential_stiffness=1e4,
        normal_stiffness=2e4,
        **state,
    )


def apart(one, other, dofs):
    sizes = [np.array([cycles.amplitude(dof) for dof in dofs]) for cycles in (one, other)]
    return np.abs(sizes[0] / sizes[1] - 1.0).max()


@pytest.fixture(scope="module")
def preloaded():
    return held([pad(preload=20.0)])


@pytest.fixture(scope="module")
def orbits(preloaded):
    return ss.limit_cycles(preloaded, NEGATIVE, ratio=[8.0, 15.0, 22.0], method="exact")


def test_balance_meets_exact_orbits_on_both_sides(preloaded, orbits):
    balance = ss.limit_cycles(preloaded, NEGATIVE, ratio=[8.0, 15.0, 22.0], stability=False)
    assert balance.branch.tolist() == ["sticking"] * 3 + ["slipping"] * 3
    assert balance.branch.tolist() == orbits.branch.tolist()
    assert apart(balance, orbits, ["x", "z"]) < 1e-5
    assert np.allclose(balance.omega, orbits.omega, rtol=1e-6, atol=0.0)
    even = np.abs(balance.coefficients("x")[:, 2]) / balance.amplitude("x")
    assert even.min() > 1e-4  # no symmetry


def test_steps_of_the_law_go_around_the_orbit(orbits):
    for index in (0, 5):
        model, omega = orbits.model_at(index), float(orbits.omega[index])
        start = orbits.state(index)
        run = ss.transient(model, omega, periods=1, start=start, scheme="rk4", steps=8192)
        for dof in ("x", "z"):
            motion = run.displacement(dof)
            assert abs(motion[-1] - motion[0]) < 2e-4 * orbits.amplitude(dof)[index]
            assert np.ptp(motion) / 2 == pytest.approx(orbits.amplitude(dof)[index], rel=1e-3)


@pytest.mark.slow
def test_a_load_in_equilibrium_is_a_preload():
    """Normal force at rest and all scales agree: the same branch by another description."""
    load = np.array([0.6, -0.8]) @ np.linalg.solve([[2e4, -1e4], [-1e4, 3e4]], [0.0, -30.0])
    assert load > 0.0  # the load closes the contact
    limits = []
    for model in (held([pad(preload=20.0)]), held([pad(gap=0.0)], -30.0)):
        limits.append(ss.limit_cycles(model, NEGATIVE, stability=False).limit)
    assert limits[0].ratio == pytest.approx(23.7514, abs=1e-4)
    assert limits[1].ratio == pytest.approx(limits[0].ratio, rel=1e-4)


@pytest.mark.slow
def test_stable_cycles_attract_and_unstable_ones_do_not():
    structure = ss.Structure(
        np.eye(2), [[2e4, -1e4], [-1e4, 3e4]], np.diag([0.5, 40.0]), ["x", "z"]
    )
    model = ss.Model(structure, [pad(preload=20.0)])
    fed = np.diag([-1.0, 0.0])
    lco = ss.limit_cycles(model, fed)
    stable = int(np.flatnonzero(lco.stable.astype(bool))[lco.stable.astype(bool).sum() // 2])
    ratio = float(lco.ratio[stable])
    orbit = ss.limit_cycles(model, fed, ratio=[ratio], method="exact")
    assert orbit.stability.tolist() == ["stable", "unstable"]
    for index, share, goes in ((0, 1.1, True), (1, 0.9, False)):
        start = orbit.state(index)
        off = ss.State(orbit.model_at(index), share * start.displacement, share * start.velocity)
        omega = float(orbit.omega[index])
        run = ss.transient(orbit.model_at(index), omega, periods=400, keep=1, start=off)
        size = np.ptp(run.displacement("x")) / 2
        assert size == pytest.approx(orbit.amplitude("x")[0], rel=2e-3)
        assert goes or size < 0.9 * orbit.amplitude("x")[1]


def test_waves_of_a_disk_with_contacts_between_its_sectors():
    sector = ss.Structure(np.eye(2), [[2e4, -1e4], [-1e4, 3e4]], 0.5 * np.eye(2), ["x", "z"])
    between = ss.Coulomb(
        ["x", "z"],
        ["next.x", "next.z"],
        normal=[-0.6, 0.8],
        friction=0.4,
        tangential_stiffness=5e3,
        normal_stiffness=8e3,
        preload=20.0,
    )
    disk = ss.BladedDisk(sector, 4, [ss.Coupling("x", stiffness=2e3)], [between], engine_order=1)
    wave = ss.limit_cycles(disk, NEGATIVE, ratio=[6.0], harmonics=15)
    ring = disk.mistuned(0.0)
    for index in range(wave.omega.size):
        # The ring of all sectors moves on in this wave.
        arrays, omega = wave.arrays, float(wave.omega[index])
        orders = np.arange(arrays.displacement.shape[1])
        turns = np.exp(2j * np.pi * np.outer(np.arange(4), orders) / 4)
        at = turns @ arrays.displacement[index]  # (sector, dof)
        speed = (turns * 1j * orders * omega) @ arrays.displacement[index]
        traction = (turns @ arrays.contact_force[index])[:, 0]
        driven = ss.destabilised(ring, np.kron(np.eye(4), NEGATIVE), 6.0)
        start = ss.State(driven, at.real.ravel(), speed.real.ravel(), traction.real)
        run = ss.transient(driven, omega, periods=1, start=start, scheme="rk4", steps=4096)
        for name in driven.structure.dofs:
            size = np.ptp(run.displacement(name)) / 2
            assert size == pytest.approx(wave.amplitude(name[2])[index], rel=2e-3)


@pytest.mark.slow
def test_a_static_load_that_a_cubic_spring_feels_stays():
    slider = ss.Jenkins("x", stiffness=1e4, slip_force=5.0)
    spring = ss.Cubic("z", stiffness=1e8)
    loaded = held([slider, spring], 20.0)
    lco = ss.limit_cycles(loaded, NEGATIVE, ratio=[5.0], stability=False)
    mean = lco.coefficients("z")[:, 0].real
    assert (mean > 5e-4).all()
    assert lco.model_at(0).forces == loaded.forces
    slider_alone = ss.limit_cycles(held([slider], 20.0), NEGATIVE, ratio=[5.0])
    assert slider_alone.model_at(0).forces == ()


def test_what_has_no_linear_motion_at_rest_is_named():
    with pytest.raises(ss.ModelError, match="touches without a load"):
        ss.limit_cycles(held([pad(gap=0.0)]), NEGATIVE)


def test_parameters_are_not_followed_under_static_loads():
    with pytest.raises(ss.ModelError, match="follow r"):
        ss.limit_cycles(
            held([pad(gap=0.0), ss.Jenkins("x", stiffness=1e4, slip_force=5.0)], -30.0),
            NEGATIVE,
            slip_force=(1.0, 10.0),
            contacts=[1],
        )


def test_rest_is_found_where_full_steps_go_around():
    """Between the states of four contacts; the last iterate was taken for the equilibrium."""
    pads = [
        ss.Coulomb(
            ["x", "z"],
            normal=normal,
            friction=1.9986464,
            tangential_stiffness=369761.179,
            normal_stiffness=24640.8519,
            **state,
        )
        for normal, state in (
            ([0.8592458, 0.5115629], {"gap": -0.001169589385}),
            ([-0.9732499, 0.2297491], {"preload": 5.91884962}),
            ([-0.5230762, -0.8522859], {"gap": -0.000468674043}),
            ([-0.2459112, -0.9692923], {"gap": 0.001241391694}),
        )
    ]
    loads = [ss.Force("z", -146.0498, harmonic=0), ss.Force("x", -209.2074, harmonic=0)]
    model = ss.Model(held([]).structure, pads, loads)
    found = ss.limit_cycles(model, NEGATIVE, ratio=[1e5], stability=False, harmonics=1)
    assert found.limit.ratio > 0.5  # where the damping of the stuck mode vanishes
