"""Chapter VII on the beam: what is reproduced, against closed forms and independent computation."""

import numpy as np
import pytest
from scipy.optimize import brentq

import stickslip as ss
from stickslip_reproduce import chapter_7_body as bodies
from stickslip_reproduce import chapter_7_contact as contacts

BEAM = ss.reference.snecma_structure()
STIFFNESS = ss.reference.DAMPER_STIFFNESS
SLIP_FORCE = ss.reference.DAMPER_SLIP_FORCE


def chain(displacements, forces):
    """Return Jenkins elements in parallel whose first loading joins points by straight lines."""
    slopes = np.append(np.diff(forces) / np.diff(displacements), 0.0)
    stiffness = -np.diff(slopes)
    return ss.ParallelJenkins(
        "damper", stiffness=stiffness, slip_forces=stiffness * displacements[1:]
    )


@pytest.mark.parametrize("law", ["exponential", "iwan"])
def test_microslip_is_that_of_elements_in_parallel(law):
    u = np.concatenate([[0.0], np.geomspace(2e-7, 2e-4, 60)])
    if law == "exponential":
        backbone = SLIP_FORCE * (1.0 - np.exp(-STIFFNESS * u / SLIP_FORCE))
        model, omega = contacts._exponential(16.563), [185.0, 190.77, 200.0]
    else:
        # Segalman's closed form with chi = -1/2 and beta = 0, gross slip at phi.
        phi = 3.0 * SLIP_FORCE / STIFFNESS
        share = np.minimum(u / phi, 1.0)
        backbone = STIFFNESS * phi * (share - share**1.5 * 2.0 / 3.0)
        model, omega = contacts._iwan(16.563), [185.0, 191.06, 200.0]
    elements = model.replaced(contacts=[chain(u, backbone)])
    found = ss.forced_response(model, omega, 15).amplitude("tip")
    np.testing.assert_allclose(
        found, ss.exact_response(elements, omega).amplitude("tip"), rtol=5e-3
    )


def test_a_level_plane_is_the_elementary_damper():
    omega = [180.0, 194.0, 230.0]
    elementary = ss.exact_response(ss.reference.snecma_beam(16.563), omega)
    level = ss.exact_response(contacts._inclined(0.0, 16.563), omega)
    np.testing.assert_allclose(level.amplitude("tip"), elementary.amplitude("tip"), rtol=1e-8)


@pytest.mark.parametrize(("slope", "load", "omega"), [(5.0, 16.563, 200.0), (15.0, 38.438, 178.0)])
def test_a_slope_by_runge_kutta(slope, load, omega):
    model = contacts._inclined(slope, load)
    exact = ss.exact_response(model, [omega])
    run = ss.transient(
        model, omega, periods=600, scheme="rk4", tolerance=1e-7, keep=1, observe="tip"
    )
    assert run.amplitude("tip") == pytest.approx(exact.amplitude("tip")[0], rel=2e-4)
    assert (exact.open_fraction(0)[0] > 0.3) == (slope == 15.0)


def circle(load, omega):
    """Return the tip on a circle: a traction of constant size, behind the motion by a fixed angle.

    On a circle of radius R the friction force of the size F_d has the component F_d d / R along
    the displacement, d = F_d / k_d, and dissipates the rest.
    """
    stiffness = BEAM.stiffness - omega**2 * BEAM.mass + 1j * omega * BEAM.damping
    least = SLIP_FORCE / STIFFNESS

    def motion(radius):
        share = min(least / radius, 1.0)
        with_damper = stiffness.copy()
        with_damper[0, 0] += SLIP_FORCE / max(radius, least) * (share + 1j * np.sqrt(1 - share**2))
        return np.linalg.solve(with_damper, [0.0, load, 0.0])

    if abs(motion(least)[0]) <= least:
        return abs(motion(least)[1])
    radius = brentq(lambda radius: abs(motion(radius)[0]) - radius, least, 1e-2, xtol=1e-16)
    return abs(motion(radius)[1])


@pytest.mark.parametrize("load", [6.563, 16.563, 38.438])
def test_a_circle_is_its_closed_form(load):
    omega = np.array([140.0, 160.0, 198.61, 217.0, 250.0])
    found = ss.forced_response(contacts._in_two_planes(1.0, load), omega, 15)
    expected = [circle(load, one) for one in omega]
    for plane in "12":
        np.testing.assert_allclose(found.amplitude(f"{plane}.tip"), expected, rtol=1e-8)


def test_an_ellipse_by_runge_kutta():
    model = contacts._in_two_planes(0.5, 16.563)
    exact = ss.exact_response(model, [191.0])
    run = ss.transient(model, 191.0, periods=600, scheme="rk4", tolerance=1e-7, keep=1)
    for dof in ("1.tip", "2.tip"):
        assert run.amplitude(dof) == pytest.approx(exact.amplitude(dof)[0], rel=2e-4)


def test_half_the_slow_loop_of_the_wedge_is_the_slip_force():
    load = bodies._wedge_load()
    angle, friction = np.radians(bodies.ANGLE), bodies.FRICTION
    out, back = (
        0.5
        * load
        * (np.sin(angle) + sign * friction * np.cos(angle))
        / (np.cos(angle) - sign * friction * np.sin(angle))
        for sign in (1.0, -1.0)
    )
    assert 0.5 * (out - back) == pytest.approx(SLIP_FORCE, rel=1e-12)
    # The force across the load stays between the same two while the beams slip fast, too.
    model = bodies._wedge(np.pi, 38.438)
    exact = ss.exact_response(model, [165.0])
    force = exact.contact_force("left", 0).reshape(-1, 1, 2)
    across = np.abs(model.contacts[0].on_first(force)[:, 0])
    assert across.max() == pytest.approx(out, rel=0.01)
    assert across.min() == pytest.approx(back, rel=0.05)


def test_a_wedge_in_phase_is_a_mass_on_a_spring():
    load, omega = 16.563, np.array([150.0, 159.5, 170.0])
    found = ss.exact_response(bodies._wedge(0.0, load), omega).amplitude("left.tip")
    # Half the wedge on the spring of one face moves with each beam.
    mass, stiffness = np.zeros((2, 4, 4))
    mass[:3, :3], stiffness[:3, :3] = BEAM.mass, BEAM.stiffness
    mass[3, 3] = 0.5 * bodies.WEIGHT
    stiffness[np.ix_([0, 3], [0, 3])] += STIFFNESS * np.array([[1.0, -1.0], [-1.0, 1.0]])
    damping = np.zeros((4, 4))
    damping[:3, :3] = BEAM.damping
    expected = [
        abs(np.linalg.solve(stiffness - w**2 * mass + 1j * w * damping, [0, load, 0, 0])[1])
        for w in omega
    ]
    np.testing.assert_allclose(found, expected, rtol=1e-6)


def test_a_wedge_in_opposition_in_time():
    model = bodies._wedge(np.pi, 16.563)
    exact = ss.exact_response(model, [195.0])
    run = ss.transient(model, 195.0, periods=300, scheme="exact", tolerance=1e-6, keep=1)
    assert run.amplitude("left.tip") == pytest.approx(exact.amplitude("left.tip")[0], rel=1e-3)


def test_a_damper_without_mass_is_the_elementary_one():
    omega = [180.0, 194.0, 230.0]
    light = ss.exact_response(bodies._heavy(1e-4, 16.563), omega).amplitude("beam.tip")
    elementary = ss.exact_response(ss.reference.snecma_beam(16.563), omega).amplitude("tip")
    np.testing.assert_allclose(light, elementary, rtol=5e-4)


def test_a_damper_with_mass_by_runge_kutta():
    model = bodies._heavy(0.1, 16.563)
    exact = ss.exact_response(model, [194.0])
    run = ss.transient(model, 194.0, periods=600, scheme="rk4", tolerance=1e-7, keep=1)
    assert run.amplitude("beam.tip") == pytest.approx(exact.amplitude("beam.tip")[0], rel=2e-4)


def test_frequencies_with_the_mass_of_the_damper():
    share = 0.1
    added = share * BEAM.mass[0, 0]
    spring = 2.0 * STIFFNESS
    for slipping in ([], [0]):
        mass, stiffness = np.zeros((2, 4, 4))
        mass[:3, :3], stiffness[:3, :3] = BEAM.mass, BEAM.stiffness
        mass[3, 3] = added
        stiffness[np.ix_([0, 3], [0, 3])] += spring * np.array([[1.0, -1.0], [-1.0, 1.0]])
        stiffness[3, 3] += 0.0 if slipping else spring
        expected = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real))
        found = ss.natural_frequencies(bodies._heavy(share, 1.0), slipping=slipping)
        np.testing.assert_allclose(found, expected, rtol=1e-9)
