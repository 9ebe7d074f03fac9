"""Resonances that neither damping nor friction bounds, with every law whose force is bounded."""

import warnings

import numpy as np
import pytest

import stickslip as ss

SPAN = (60.0, 140.0)
STUCK = 3e3

BOUNDED = {
    "jenkins": lambda limit: ss.Jenkins("a", stiffness=STUCK, slip_force=limit),
    "parallel": lambda limit: ss.ParallelJenkins(
        "a", stiffness=[1e3, 2e3], slip_forces=[limit / 4.0, 3.0 * limit / 4.0]
    ),
    "structural": lambda limit: ss.StructuralDamper(
        ["a"], stiffness=[[STUCK]], slip_forces=[limit]
    ),
    "iwan": lambda limit: ss.Iwan("a", stiffness=STUCK, slip_force=limit, chi=-0.5, beta=0.0),
    "exponential": lambda limit: ss.Masing(
        "a", stiffness=STUCK, slip_force=limit, backbone="exponential"
    ),
    "table": lambda limit: ss.Masing(
        "a", backbone=([limit / STUCK, 3.0 * limit / STUCK], [0.7 * limit, limit])
    ),
    "bouc-wen": lambda limit: ss.BoucWen("a", stiffness=STUCK, slip_force=limit),
    "coulomb": lambda limit: ss.Coulomb(
        ["a"], normal=None, friction=0.5, tangential_stiffness=STUCK, preload=2.0 * limit
    ),
    "coulomb in a plane": lambda limit: ss.Coulomb(
        ["a", "b"], normal=None, friction=0.5, tangential_stiffness=STUCK, preload=2.0 * limit
    ),
}


def undamped(contacts, coupling=0.0, force=20.0):
    stiffness = [[1e4 + coupling, -coupling], [-coupling, 3e4]]
    structure = ss.Structure(np.eye(2), stiffness, dofs=["a", "b"])
    return ss.Model(structure, contacts, [ss.Force("a", force)])


@pytest.mark.parametrize("law", BOUNDED)
@pytest.mark.parametrize("coupling", [0.0, 1e3])
def test_a_load_beyond_a_limit_has_no_peak(law, coupling):
    grid = np.linspace(*SPAN, 40)
    model = undamped([BOUNDED[law](2.0)], coupling)
    natural = ss.natural_frequencies(undamped([], coupling))[0]
    with pytest.warns(UserWarning, match="neither damping nor friction bounds"):
        peak = ss.forced_response(model, grid, 3).peak("a")
    assert peak.amplitude == np.inf
    assert peak.omega == pytest.approx(natural, rel=1e-9)
    below = ss.forced_response(model, np.linspace(60.0, 80.0, 9), 3)
    strong = ss.forced_response(undamped([BOUNDED[law](40.0)], coupling), grid, 3)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert below.peak("a").amplitude < 0.01
        assert strong.peak("a").amplitude < 0.1


@pytest.mark.parametrize("law", ["jenkins", "bouc-wen", "coulomb in a plane"])
def test_a_damper_curve_and_a_map_say_so(law):
    def build(limit, coupling):
        return undamped([BOUNDED[law](limit)], coupling)

    found = ss.design_map(
        build, {"limit": [2.0, 40.0], "coupling": [0.0, 1e3]}, dof="a", omega=SPAN, threads=1
    )
    assert found.status[0] == ("singular",) * 2
    assert np.isnan(found.amplitude[0]).all()
    assert np.isnan(found.omega[0]).all()
    assert (found.amplitude[1] < 0.1).all()
    assert found.optimum["limit"] == 40.0
    if law == "jenkins":
        assert found.status[1] == ("converged",) * 2
        curve = ss.damper_curve(build(2.0, 0.0), slip_force=[2.0, 40.0], dof="a", omega=SPAN)
        assert curve.status == ("singular", "converged")
        assert found.amplitude[1, 0] == pytest.approx(curve.amplitude[1], rel=1e-2)


GROWING = {
    "normal load": ss.Coulomb(
        ["a", "b"],
        normal=[0.0, 1.0],
        friction=0.5,
        tangential_stiffness=STUCK,
        normal_stiffness=STUCK,
        preload=4.0,
    ),
    "cubic": ss.Cubic("a", stiffness=1e6),
    "stop": ss.Stop("a", stiffness=1e4, gap=0.01),
}


@pytest.mark.parametrize("law", GROWING)
def test_forces_that_grow_may_bound(law):
    """The normal load moves with the mode, the springs stiffen."""
    contacts = [BOUNDED["jenkins"](2.0), GROWING[law]]
    response = ss.forced_response(undamped(contacts, 1e3), np.linspace(*SPAN, 40), 3)
    with warnings.catch_warnings():
        warnings.filterwarnings("error", "peak of 'a': neither damping")
        assert np.isfinite(response.peak("a").amplitude)


def test_what_grows_elsewhere_bounds_nothing():
    cubic = ss.Cubic("b", stiffness=1e6)
    response = ss.forced_response(
        undamped([BOUNDED["jenkins"](2.0), cubic]), np.linspace(*SPAN, 40), 3
    )
    with pytest.warns(UserWarning, match="neither damping nor friction bounds"):
        assert response.peak("a").amplitude == np.inf


@pytest.mark.parametrize(("limit", "bounded"), [(11.0, False), (11.2, True)])
def test_friction_in_a_plane_is_one_traction(limit, bounded):
    """At 45 degrees it does as much as along a direction: 4/pi of its limit."""
    structure = ss.Structure(np.eye(2), [[2e4, -1e4], [-1e4, 2e4]], dofs=["a", "b"])
    model = ss.Model(structure, [BOUNDED["coulomb in a plane"](limit)], [ss.Force("a", 20.0)])
    response = ss.forced_response(model, np.linspace(*SPAN, 40), 3)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert np.isfinite(response.peak("a").amplitude) == bounded


def test_a_plane_moved_far_beyond_its_slip_ends():
    """Exactly at the resonance: panels of the slip equation had filled the memory."""
    response = ss.forced_response(undamped([BOUNDED["coulomb in a plane"](2.0)]), [100.0], 3)
    assert not response.converged[0]


@pytest.mark.parametrize(("force", "bounded"), [(0.8, True), (1.2, True), (1.3, False)])
def test_friction_opposes_a_motion_by_square_waves_of_its_own_harmonic(force, bounded) -> None:
    """The limit of 1 N at any harmonic by 4/pi, however small the load is at the first."""
    body = ss.Structure([[1.0]], [[1.0]], dofs=["a"])
    loads = [ss.Force("a", 1e-3), ss.Force("a", force, harmonic=3)]
    model = ss.Model(body, [ss.Jenkins("a", stiffness=1.0, slip_force=1.0)], loads)
    curve = ss.forced_response(model, np.linspace(0.3, 0.36, 61), 9)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        height = curve.peak("a").amplitude
    assert np.isfinite(height) == bounded
    if bounded:
        assert height >= curve.amplitude("a").max()
