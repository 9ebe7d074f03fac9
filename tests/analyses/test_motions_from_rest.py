"""Motions that begin, end or break off where quantities vanish: against independent integration."""

import numpy as np
import pytest

import stickslip as ss

CUBE = ss.Structure(np.eye(3), 1e3 * np.eye(3), np.eye(3), ["x", "y", "z"])
PAIR = ss.Structure(np.eye(2), [[2e4, -1e4], [-1e4, 1e4]], 0.5 * np.eye(2), ["a", "b"])


@pytest.mark.parametrize("seed", [3, 8, 13])
def test_a_law_at_its_limit_beside_a_contact_in_a_plane_is_no_growth(seed):
    flat = ss.Coulomb(
        ["x", "y"], normal=None, friction=0.4, tangential_stiffness=900.0, preload=5.0
    )
    law = ss.Iwan("x", stiffness=1000.0, slip_force=2.0, chi=-0.3, beta=0.5)
    model = ss.Model(CUBE, [flat, law])
    rng = np.random.default_rng(seed)
    start = {dof: rng.normal() * 0.02 for dof in "xy"} | {"z": rng.normal() * 0.01}
    exact, steps = (
        ss.transient(model, 40.0, 10, start=start, samples=8, **options)
        for options in ({}, {"scheme": "rk4", "steps": 4000})
    )
    x, expected = (one.displacement("x") for one in (exact, steps))
    np.testing.assert_allclose(x, expected, atol=1e-5 * np.abs(expected).max())


@pytest.mark.parametrize(
    ("load", "phase"),
    [((10, 40, 25), 0), ((-40, 5, 25), 0), ((0, 40, 25), 0), ((10, 40, 25), -0.5 * np.pi)],
)
def test_a_contact_that_closes_from_rest_slides_where_it_is_pushed(load, phase):
    pad = ss.Coulomb(
        ["x", "y", "z"],
        normal=[0, 0, 1],
        friction=0.1,
        tangential_stiffness=900.0,
        normal_stiffness=900.0,
    )
    forces = [ss.Force(dof, p, phase=phase) for dof, p in zip("xyz", load, strict=True)]
    model = ss.Model(CUBE, [pad], forces)
    exact, steps = (
        ss.transient(model, 20.0, 1, samples=64, **options)
        for options in ({}, {"scheme": "rk4", "steps": 16000})
    )
    most = np.abs(steps.contact_force(0)).max()
    np.testing.assert_allclose(exact.contact_force(0), steps.contact_force(0), atol=1e-4 * most)


def test_a_motion_below_an_open_contact_decays():
    pad = ss.Coulomb(
        ["a", "b"],
        normal=[0, 1],
        friction=0.3,
        tangential_stiffness=1e4,
        normal_stiffness=1e4,
        gap=1e-3,
    )
    found = ss.classify(ss.Model(PAIR, [pad]), {"a": 1e-4, "b": 2e-5}, periods=20)
    assert found.motion == "decaying"


def test_a_motion_that_fades_about_a_shifted_equilibrium_decays():
    structure = ss.Structure(np.eye(2), [[3e3, -1e3], [-1e3, 3e3]], np.eye(2), ["x", "y"])
    law = ss.Masing("x", stiffness=1000.0, slip_force=2.0, backbone="exponential")
    pad = ss.Coulomb(
        ["x", "y"],
        normal=[0, 1],
        friction=0.4,
        tangential_stiffness=900.0,
        normal_stiffness=900.0,
        preload=2.0,
    )
    found = ss.classify(ss.Model(structure, [law, pad]), {"x": 0.03, "y": 0.01})
    assert found.motion == "decaying"


@pytest.mark.parametrize("ratio", [5.143, 5.0965, 4.89])
def test_the_exact_state_of_an_unstable_cycle_is_no_settled_motion(ratio):
    model, negative = ss.reference.flutter_mass()
    cycles = ss.limit_cycles(model, negative_damping=negative, ratio=[ratio], method="exact")
    found = ss.classify(cycles.model_at(1), cycles.state(1))
    # It grows for ever, or settles on the stable cycle of the same ratio.
    assert not np.isclose(found.omega, cycles.omega[1], rtol=1e-3)


def test_a_mode_that_nothing_damps_changes_no_stability():
    structure = ss.Structure(np.eye(2), [[2e4, -5e3], [-5e3, 2e4]], None, ["a", "b"])
    model = ss.Model(structure, [ss.Jenkins("a", "b", stiffness=1e4, slip_force=5.0)])
    negative = -np.array([[1.0, -1.0], [-1.0, 1.0]])
    cycles = ss.limit_cycles(model, negative, mode=1, method="exact")
    assert len(cycles.changes) <= 1


@pytest.mark.parametrize(
    ("mode", "negative", "message"),
    [(7, -np.eye(2), "mode = 7"), (1, np.eye(2), "mind the sign of negative_damping")],
)
def test_stability_maps_refuse_what_no_value_allows(mode, negative, message):
    model = ss.Model(PAIR, [ss.Jenkins("a", "b", stiffness=1e4, slip_force=5.0)])
    with pytest.raises(ss.ModelError, match=message):
        ss.stability_map(model, negative, mode=mode, stiffness=[1e4, 2e4])
