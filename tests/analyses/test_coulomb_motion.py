"""Coulomb contacts in time: orbits and transients, as results show them, against balances."""

import numpy as np
import pytest

import stickslip as ss
from stickslip import _core, plot

DAMPING = np.diag([0.346410162, 2.0])
VALUES = {"friction": 0.85, "tangential_stiffness": 5.0, "normal_stiffness": 21.0}


def block(dofs=("t", "n"), normal=(0, 1), static=100.0, **changes):
    structure = ss.Structure(np.eye(2), np.diag([12.0, 21.0]), DAMPING, ["t", "n"])
    pad = ss.Coulomb(dofs, normal=normal, **VALUES | changes, name="pad")
    forces = [ss.Force("t", 40.0), ss.Force("n", 60.0)]
    still = [ss.Force("n", static, harmonic=0)] if static else []
    return ss.Model(structure, [pad], forces + still)


@pytest.fixture(scope="module")
def curves():
    return ss.exact_response(block(), [5.0]), ss.forced_response(block(), [5.0], 61)


def test_orbits_and_balances_agree(curves):
    exact, balance = curves
    assert exact.converged.all()
    assert exact.amplitude("n", "max")[0] == pytest.approx(5.665875, rel=1e-5)
    for of in ("slip_fraction", "open_fraction", "dissipation"):
        one, other = (getattr(curve, of)("pad") for curve in curves)
        assert one.shape == other.shape == (1, 1)
        np.testing.assert_allclose(one, other, rtol=1e-4)
    force = exact.contact_force("pad", 0, 64)
    np.testing.assert_allclose(force, balance.contact_force("pad", 0, 64), atol=1e-3)
    motion = exact.contact_waveform("pad", 0, 64)
    np.testing.assert_allclose(motion, balance.contact_waveform("pad", 0, 64), atol=1e-3)


def test_states_and_events_of_orbits(curves):
    exact, balance = (curve.contact_states("pad", 0) for curve in curves)
    np.testing.assert_array_equal(exact.direction, balance.direction)
    np.testing.assert_allclose(exact.start, balance.start, atol=1e-3)
    events = curves[0].events(0)
    assert [event.kind for event in events] == ["slips forward", "opens", "sticks"]
    assert {(event.contact, event.point) for event in events} == {("pad", 0)}
    assert len(plot.events(curves[0], 0).get_yticklabels()) == 1


def test_a_preload_is_part_of_the_normal_force():
    model = block([["t", "n"]], preload=50.0, static=0.0)
    exact, balance = ss.exact_response(model, [5.0]), ss.forced_response(model, [5.0], 61)
    force = exact.contact_force("pad", 0, 64)
    assert force.shape == (64, 1, 2)
    np.testing.assert_allclose(force, balance.contact_force("pad", 0, 64), atol=1e-3)
    assert exact.contact_force(("pad", 0), 0, 64).shape == (64, 2)
    run = ss.transient(model, 5.0, 60)
    pressing = run.contact_force("pad")[..., 1]
    assert pressing.shape == (run.time.size, 1)
    assert pressing.min() >= 0.0
    last = pressing[-128:, 0]
    assert last.max() == pytest.approx(force[..., 1].max(), rel=2e-2)
    again = ss.transient(model, 5.0, 2, start=run.final)
    np.testing.assert_allclose(again.contact_force("pad")[0], run.contact_force("pad")[-1])


def test_orbits_survive_storage(curves, tmp_path):
    curves[0].save(tmp_path / "pad.nc")
    again = ss.load(tmp_path / "pad.nc")
    np.testing.assert_array_equal(again.contact_force("pad", 0), curves[0].contact_force("pad", 0))
    assert list(again.events(0)) == list(curves[0].events(0))


def mass_on_a_plane():
    dofs = ["x", "y", "z"]
    stiffness, damping = np.diag([4e4, 9e4, 1.6e5]), np.diag([8.0, 10.0, 16.0])
    values = {"friction": 0.4, "tangential_stiffness": 5e4, "normal_stiffness": 8e4}
    pad = ss.Coulomb(dofs, normal=[0, 0, 1], **values, preload=40.0)
    forces = [
        ss.Force("x", 30.0),
        ss.Force("y", 25.0, phase=-0.5 * np.pi),
        ss.Force("z", 20.0, phase=-0.7),
    ]
    return ss.Model(ss.Structure(np.eye(3), stiffness, damping, dofs), [pad], forces)


def test_two_directions_are_followed_exactly():
    model = mass_on_a_plane()
    exact = ss.exact_response(model, [180.0, 260.0])
    balance = ss.forced_response(model, [260.0], 61)
    assert exact.converged.all()
    assert exact.stable.all()
    expected = [[1.79793e-3, 3.20807e-4, 9.63298e-5], [1.39417e-3, 8.77593e-4, 1.159755e-4]]
    found = np.transpose([exact.amplitude(dof, "max") for dof in "xyz"])
    np.testing.assert_allclose(found, expected, rtol=3e-5)
    for of in ("slip_fraction", "dissipation"):
        one, other = getattr(exact, of)(0)[1], getattr(balance, of)(0)[0]
        np.testing.assert_allclose(one, other, rtol=1e-3)
    kinds = {event.kind for event in exact.events(1)}
    assert kinds == {"slides", "sticks"}
    assert exact.contact_states(0, 1).slipping(0) in ((), (0,))
    assert len(plot.events(exact, 1).get_yticklabels()) == 1
    run = ss.transient(model, 260.0, 40)
    last = np.abs(run.displacement("y")[run.time > 38.0 * 2.0 * np.pi / 260.0])
    assert last.max() == pytest.approx(8.77593e-4, rel=3e-3)
    free = ss.Model(model.structure, model.contacts)
    assert ss.classify(free, {"x": 2e-3, "y": 1e-3}).reason == "held"


def test_two_directions_in_runge_kutta_steps():
    model = mass_on_a_plane()
    run = ss.transient(model, 180.0, 60, scheme="rk4", steps=400)
    assert run.contact_force(0).shape == (run.time.size, 3)
    # The printed maximum of the steady motion, to which the start decays by 1e-5 in 60 periods.
    last = np.abs(run.displacement("x")[run.time > 58.0 * 2.0 * np.pi / 180.0])
    assert last.max() == pytest.approx(1.79793e-3, rel=3e-4)
    start = run.final
    assert start.contact_force.shape == (2,)
    assert np.linalg.norm(start.contact_force) <= 0.4 * 80.0
    with pytest.raises(ss.ModelError, match="two tractions per node; give all forces"):
        ss.State(model, contact_force={"coulomb": 1.0})


def test_forces_of_a_preloaded_contact_that_sticks():
    # Its motion has odd harmonics alone, its normal force has not.
    structure = ss.Structure(np.eye(1), np.eye(1) * 2e4, np.eye(1) * 5.0, ["q"])
    pad = ss.Coulomb(
        [{"q": 0.7}, "q"],
        normal=[0, 1],
        friction=1.01,
        tangential_stiffness=28650.0,
        normal_stiffness=1274.0,
        preload=157.0,
    )
    model = ss.Model(structure, [pad], [ss.Force("q", 52.0)])
    balance, exact = ss.forced_response(model, [150.0], 9), ss.exact_response(model, [150.0])
    force = exact.contact_force(0, 0, 64)
    assert force[:, 1].min() > 150.0
    np.testing.assert_allclose(balance.contact_force(0, 0, 64), force, atol=1e-9)
    assert not balance.contact_states(0, 0).direction.any()


@pytest.mark.parametrize(
    ("preload", "coupling", "slips"), [(157.0, -3e3, False), (20.0, 0.0, True), (157.0, 0.0, False)]
)
def test_multipliers_of_a_preloaded_contact_whose_motion_alone_is_symmetric(
    preload, coupling, slips
):
    # Of displacements and normal force the latter alone has a mean: half a period is not the whole.
    stiffness = np.array([[2e4, coupling], [coupling, 2.6e4]])
    structure = ss.Structure(np.eye(2), stiffness, np.diag([5.0, 6.0]), ["x", "z"])
    values = {"friction": 0.4, "tangential_stiffness": 28650.0, "normal_stiffness": 1274.0}
    pad = ss.Coulomb(["x", "z"], normal=[0, 1], preload=preload, **values)
    model = ss.Model(structure, [pad], [ss.Force("x", 52.0)])
    exact, balance = ss.exact_response(model, [150.0]), ss.forced_response(model, [150.0], 61)
    motion = np.array([balance.coefficients(dof)[0] for dof in structure.dofs])
    assert np.abs(motion[:, ::2]).max() < 1e-15
    motion[:, ::2] = 0.0
    assert (exact.slip_fraction(0)[0, 0] > 0.0) == slips
    assert balance.stable[0]
    found, error = _core.period_multipliers(model.problem, np.zeros((2, 2)), 150.0, motion, 1e-9)
    assert error <= 1e-9
    expected = exact.multipliers[0, exact.neutral[0] :]
    for power in range(1, expected.size + 1):
        assert (found**power).sum() == pytest.approx((expected**power).sum(), abs=1e-5)


@pytest.mark.parametrize("evaluation", ["exact", "marched"])
def test_a_contact_that_sticks_holds_what_its_static_loading_has_left(evaluation):
    # The loading goes one way to the gap and another one behind it: not straight from rest.
    stiffness = np.array([[20.0, -6.0], [-6.0, 25.0]])
    structure = ss.Structure(np.eye(2), stiffness, DAMPING, ["t", "n"])
    pad = ss.Coulomb(["t", "n"], normal=[0, 1], **VALUES | {"tangential_stiffness": 15.0}, gap=1.0)
    still = [ss.Force("t", 30.0, harmonic=0), ss.Force("n", 100.0, harmonic=0)]
    model = ss.Model(structure, [pad], [ss.Force("t", 1.0), ss.Force("n", 2.0), *still])
    exact = ss.exact_response(model, [3.0])
    balance = ss.forced_response(model, [3.0], 5, evaluation=evaluation)
    assert exact.slip_fraction(0)[0, 0] == exact.open_fraction(0)[0, 0] == 0.0
    force = balance.contact_force(0, 0, 16)
    np.testing.assert_allclose(force, exact.contact_force(0, 0, 16), atol=1e-9)
    held = [balance.waveform(dof, 0, 16).mean() for dof in structure.dofs] @ stiffness
    np.testing.assert_allclose(held + force.mean(axis=0), [30.0, 100.0], atol=1e-9)
