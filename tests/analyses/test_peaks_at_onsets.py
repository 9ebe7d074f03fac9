"""Peaks at the onset of slip: found, with their slopes, and no optimum beside them."""

import numpy as np
import pytest

import stickslip as ss


def dense_structure(slip_force):
    """A contact that sticks from 190.3 to 194 rad/s about an antiresonance of its motion alone."""
    mass = np.diag([1.16, 1.02, 0.953, 1.16, 0.714, 2.23])
    stiffness = [
        [50500.0, -32400.0, -24200.0, 47400.0, 56500.0, 3280.0],
        [-32400.0, 120000.0, 7260.0, -6830.0, -48900.0, 25.4],
        [-24200.0, 7260.0, 64400.0, -11800.0, -29400.0, -16400.0],
        [47400.0, -6830.0, -11800.0, 101000.0, 69300.0, 44000.0],
        [56500.0, -48900.0, -29400.0, 69300.0, 187000.0, 53500.0],
        [3280.0, 25.4, -16400.0, 44000.0, 53500.0, 99200.0],
    ]
    damping = ss.Rayleigh(mass=0.246, stiffness=4.473e-5)
    structure = ss.Structure(mass, stiffness, damping, [f"q{i}" for i in range(6)])
    contact = ss.Jenkins("q0", "q3", stiffness=245000.0, slip_force=slip_force)
    return ss.Model(structure, [contact], [ss.Force("q2", 4.93)])


@pytest.mark.parametrize("harmonics", [1, 3, 5])
def test_a_peak_beside_an_antiresonance_of_the_contact_is_found(harmonics):
    model = dense_structure(0.75)
    fine = ss.forced_response(model, np.linspace(188.0, 200.0, 2401), harmonics)
    # At its highest the contact is about to slip, and it slips at all points of a coarse look.
    slips = fine.slip_fraction(0)[:, 0] > 0.0
    assert slips[[0, -1]].all()
    assert not slips.all()
    curve = ss.damper_curve(
        model, slip_force=[0.75], dof="q5", omega=(100.0, 675.0), harmonics=harmonics
    )
    assert curve.amplitude[0] >= (1 - 1e-6) * fine.amplitude("q5").max()


def four_masses(slip_force):
    stiffness = np.diag([16391.0, 18112.0, 17987.0, 17159.0])
    stiffness -= 920.0 * (np.eye(4, k=1) + np.eye(4, k=-1))
    damping = ss.Rayleigh(mass=0.02, stiffness=1.25e-6)
    structure = ss.Structure(np.eye(4), stiffness, damping, ["a", "b", "c", "d"])
    forces = [ss.Force("c", 0.79, phase=2.27), ss.Force("a", 0.58, phase=3.86)]
    contact = ss.Jenkins("c", stiffness=7.8e4, slip_force=slip_force)
    return ss.Model(structure, [contact], forces)


@pytest.mark.parametrize("value", [1.6451, 1.8552])
def test_the_slope_of_a_peak_at_the_onset_of_slip_follows_it(value):
    values = value * (1.0 + np.array([-1e-4, 0.0, 1e-4]))
    curve = ss.damper_curve(four_masses(1.0), slip_force=values, dof="d", harmonics=1)
    difference = (curve.amplitude[2] - curve.amplitude[0]) / (values[2] - values[0])
    assert difference > 0.0
    assert curve.sensitivity[1] == pytest.approx(difference, rel=5e-3)
    span = curve.settings.span
    frf = ss.forced_response(four_masses(value), np.linspace(*span, 60), 1)
    assert frf.peak("d").amplitude == pytest.approx(curve.amplitude[1], rel=1e-7)
    slopes = frf.peak_sensitivity("d")
    assert slopes["jenkins", "slip_force"] == pytest.approx(difference, rel=5e-3)
    assert frf.peak_sensitivity("d", parameter="slip_force") == slopes["jenkins", "slip_force"]
    # Forces and limits grow together with the motion.
    level = frf.peak_sensitivity("d", parameter="level")
    assert level == pytest.approx(frf.peak("d").amplitude - value * difference, rel=5e-3)


def test_an_optimum_lies_at_no_value_where_a_search_errs():
    stiffness = [
        [662500.0, -337800.0, 0.0, 0.0, 0.0, -305800.0],
        [-337800.0, 515500.0, -154100.0, 0.0, 0.0, 0.0],
        [0.0, -154100.0, 456900.0, -295300.0, 0.0, 0.0],
        [0.0, 0.0, -295300.0, 500400.0, -152100.0, 0.0],
        [0.0, 0.0, 0.0, -152100.0, 560900.0, -392300.0],
        [-305800.0, 0.0, 0.0, 0.0, -392300.0, 750000.0],
    ]
    mass = np.diag([1.847, 1.766, 1.089, 1.24, 1.515, 0.5912])
    names = [f"q{i}" for i in range(6)]
    structure = ss.Structure(mass, stiffness, ss.ModalDamping(0.0018986430789786884), names)
    contacts = [
        ss.Jenkins("q5", "q2", stiffness=32310.0, slip_force=0.9628, name="c0"),
        ss.Jenkins("q4", stiffness=1241000.0, slip_force=0.01567, name="c1"),
    ]
    forces = [ss.Force("q0", 0.0856, phase=1.22), ss.Force("q3", 0.07167, phase=4.84)]
    best = ss.optimal_damper(ss.Model(structure, contacts, forces), dof="q0", harmonics=1)
    fine = ss.forced_response(best.model, np.linspace(*best.curve.settings.span, 4001), 1)
    assert best.amplitude >= (1 - 1e-4) * fine.amplitude("q0").max()
