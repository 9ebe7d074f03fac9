"""Bodies without mass: the limit of light ones, and the structure-like damper."""

import numpy as np
import pytest

import stickslip as ss

GRID = [99.0, 105.0, 111.0]


def wedge(mass):
    blades = (
        ss.Structure(10.0 * np.eye(2), stiffness, 100.0 * np.eye(2), ["x", "y"])
        for stiffness in ([[1e6, -9e5], [-9e5, 1e6]], [[4e5, -3e5], [-3e5, 4e5]])
    )
    damper = ss.WedgeDamper(
        angle=60.0,
        mass=mass,
        friction=0.2,
        tangential_stiffness=3e5,
        normal_stiffness=3e5,
        load=240,
    )
    forces = [ss.Force("left.x", 150.0), ss.Force("right.x", 150.0, phase=np.pi)]
    ends = {"left_dofs": ["x", "y"], "right_dofs": ["x", "y"]}
    return damper.between(*blades, **ends, forces=forces)


def test_light_bodies_converge_to_none():
    """In proportion to their mass, down to what the solution resolves."""

    def amplitude(mass):
        frf = ss.forced_response(wedge(mass), GRID, 15, tolerance=1e-8, stability=False)
        assert frf.converged.all()
        return frf.amplitude("left.x")

    limit = amplitude(0.0)
    masses = np.array([1e-3, 1e-4, 1e-5, 1e-6])
    rates = np.array([(amplitude(mass) - limit) / mass for mass in masses])
    np.testing.assert_allclose(rates[1:], rates[:1].repeat(3, axis=0), rtol=0.05)
    assert (np.abs(rates) > 0.1 * limit).all()
    np.testing.assert_allclose(amplitude(1e-8), limit, rtol=1e-6)


def test_statics_and_motions_in_time_of_no_mass():
    light, none = (ss.static_response(wedge(mass)) for mass in (1e-6, 0.0))
    np.testing.assert_allclose(none.contact_force("left"), light.contact_force("left"), rtol=1e-9)
    exact = ss.exact_response(wedge(0.0), GRID[:1])
    light = ss.exact_response(wedge(1e-5), GRID[:1])
    np.testing.assert_allclose(exact.amplitude("left.x"), light.amplitude("left.x"), rtol=2e-4)


def test_peaks_of_no_mass():
    found = {"friction": [0.1, 0.2], "dof": "left.x", "omega": (95.0, 115.0), "harmonics": 7}
    none, light = (ss.damper_curve(wedge(mass), **found) for mass in (0.0, 1e-6))
    assert all(status == "converged" for status in none.status)
    np.testing.assert_allclose(none.amplitude, light.amplitude, rtol=1e-5)


@pytest.mark.slow
def test_automatic_harmonics_of_no_mass():
    """What kinks leave out is in the estimate; a point that would cost too much says so."""
    model = wedge(0.0)
    assert model.structure.mass[model.structure.index("damper.x")].tolist() == [0.0] * 6
    exact = ss.exact_response(model, GRID, observe=["left.x"]).amplitude("left.x")
    for order in (15, 39):
        frf = ss.forced_response(model, GRID, order, observe=["left.x"], stability=False)
        error = np.abs(frf.amplitude("left.x") - exact)
        assert (error < frf.error_estimate("left.x")).all()
        assert (frf.error_estimate("left.x") < 5.0 * error).all()
    frf = ss.forced_response(model, GRID, stability=False, tolerance=3e-3)
    assert frf.converged.all()
    np.testing.assert_allclose(frf.amplitude("left.x"), exact, rtol=3e-3)
    how = {"dof": "left.x", "omega": (95.0, 115.0), "tolerance": 3e-3}
    curve = ss.damper_curve(model, friction=[0.2], **how)
    assert [str(one) for one in curve.status] == ["converged"]
    assert curve.amplitude[0] == pytest.approx(
        ss.exact_response(model, curve.omega, observe=["left.x"]).amplitude("left.x")[0], rel=3e-3
    )


def sheared(damper):
    """Two masses that move along the faces: normal forces stay what they are."""
    structure = ss.Structure(
        np.diag([1.0, 1.3, 2.0, 2.0]),
        [
            [300.0, -40.0, 0.0, 0.0],
            [-40.0, 260.0, 0.0, 0.0],
            [0.0, 0.0, 500.0, 0.0],
            [0.0, 0.0, 0.0, 500.0],
        ],
        0.4 * np.eye(4),
        ["a.x", "b.x", "a.y", "b.y"],
    )
    forces = [ss.Force("a.x", 2.0), ss.Force("b.x", 1.5, phase=1.0)]
    if isinstance(damper, ss.BodyDamper):
        ends = {"left_dofs": ["a.x", "a.y"], "right_dofs": ["b.x", "b.y"]}
        return damper.inside(structure, **ends, forces=forces)
    return ss.Model(structure, [damper], forces)


@pytest.mark.parametrize("stiffness", [(150.0, 90.0), (80.0, 200.0)])
@pytest.mark.slow
def test_no_mass_is_the_structural_damper(stiffness):
    """Where no face opens and normal forces are constant; exact orbits need a little inertia."""
    friction = (0.3, 0.5)
    sides = zip(("left", "right"), (1.0, -1.0), friction, stiffness, strict=True)
    faces = [
        ss.Face(
            points=(ss.ContactPoint([0.0, out]),),
            to=side,
            friction=own,
            tangential_stiffness=k,
            normal_stiffness=200.0,
            gap=-0.02,
        )
        for side, out, own, k in sides
    ]
    body = sheared(ss.BodyDamper(ss.RigidBody(0.0), faces))
    normal = ss.static_response(body).contact_force("left")[1]
    joint = 1.0 / (1.0 / stiffness[0] + 1.0 / stiffness[1])
    damper = ss.StructuralDamper(
        ["a.x", "b.x"],
        stiffness=[[joint, -joint], [-joint, joint]],
        slip_forces=[own * normal for own in friction],
    )
    grid = np.linspace(12.0, 24.0, 7)
    known = ss.exact_response(sheared(damper), grid)
    assert (known.slip_fraction(0) > 0.0).any()
    exact = ss.exact_response(body, grid)
    np.testing.assert_allclose(exact.amplitude("a.x"), known.amplitude("a.x"), rtol=5e-5)
    # The body itself moves with kinks, which many harmonics tell.
    errors = [
        np.abs(
            ss.forced_response(body, grid, H, stability=False).amplitude("a.x")
            / known.amplitude("a.x")
            - 1.0
        ).max()
        for H in (7, 31)
    ]
    assert errors[1] < 5e-4
    assert errors[1] < 0.15 * errors[0]


def test_sector_and_ring_of_bodies_without_mass():
    blade = ss.Structure(np.eye(2), np.diag([4e4, 2e5]), ss.Rayleigh(mass=8.0), ["x", "y"])
    damper = ss.WedgeDamper(
        angle=60.0, mass=0.0, friction=0.2, tangential_stiffness=2e4, normal_stiffness=3e4, load=40
    )
    ends = {"left_dofs": ["x", "y"], "right_dofs": ["x", "y"]}
    disk = damper.in_disk(blade, 8, **ends, engine_order=2, forces=[ss.Force("x", 15.0)])
    grid = [225.0, 235.0]
    tuned = ss.forced_response(disk, grid, 5, stability=False)
    ring = ss.forced_response(disk.mistuned(np.zeros(8)), grid, 5, stability=False)
    every = disk.mistuned(np.zeros(8))
    whole = ss.forced_response(every.with_structure(every.structure), grid, 5, stability=False)
    assert (tuned.slip_fraction("left") > 0.0).any()
    for sector in range(8):
        own = f"{sector}.x"
        np.testing.assert_allclose(ring.amplitude(own), tuned.amplitude("x"), rtol=1e-7)
        np.testing.assert_allclose(whole.amplitude(own), tuned.amplitude("x"), rtol=1e-7)
