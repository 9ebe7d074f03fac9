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


@pytest.mark.parametrize("law", BOUNDED)
@pytest.mark.parametrize("coupling", [0.0, 1e3])
def test_exactly_there_a_solution_is_not_looked_for_long(law, coupling):
    """No homotopy leads to what does not exist; a millionth beside it the motion is known."""
    model = undamped([BOUNDED[law](2.0)], coupling)
    natural = ss.natural_frequencies(undamped([], coupling))[0]
    response = ss.forced_response(model, [natural, natural * (1.0 + 1e-6)], 3, stability=False)
    assert response.status == ("singular", "converged")
    assert response.counters["homotopies"] == 0
    assert response.counters["evaluations"] < 1000
    # As good as without friction and without damping.
    assert 500.0 < response.amplitude("a")[1] < 1500.0


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


def blades(count, contacts, forces, damping=None):
    """Equal oscillators of 100 rad/s with nothing but contacts between them."""
    structure = ss.Structure(
        np.eye(count),
        1e4 * np.eye(count),
        damping=damping,
        dofs=[f"q{blade}" for blade in range(count)],
    )
    return ss.Model(structure, contacts, forces)


def between(count, limit, law=ss.Jenkins):
    pairs = [(blade, (blade + 1) % count) for blade in range(count if count > 2 else 1)]
    return [law(f"q{a}", f"q{b}", stiffness=STUCK, slip_force=limit) for a, b in pairs]


def unbounded(model):
    """Which degrees of freedom nothing bounds at the common frequency."""
    grid = np.linspace(*SPAN, 40)
    response = ss.forced_response(model, grid, 3, stability=False)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        peaks = [response.peak(dof) for dof in model.structure.dofs]
    assert all(peak.omega == pytest.approx(100.0) for peak in peaks if np.isinf(peak.amplitude))
    return [bool(np.isinf(peak.amplitude)) for peak in peaks]


@pytest.mark.parametrize("law", [ss.Jenkins, ss.BoucWen])
def test_a_common_motion_of_equal_blades_is_seen_by_no_contact_between_them(law):
    """Friction above the load bounds each blade against the other, not both together."""
    model = blades(2, between(2, 50.0, law), [ss.Force("q0", 1.0)])
    assert unbounded(model) == [True, True]
    against = [ss.Force("q0", 1.0), ss.Force("q1", 1.0, phase=np.pi)]
    assert unbounded(blades(2, between(2, 50.0, law), against)) == [False, False]


@pytest.mark.parametrize("count", [3, 6, 13])
def test_a_wave_over_equal_blades_is_bounded_by_what_contacts_see_of_it(count):
    """Between neighbours it moves by 2 sin(pi/n) of its amplitude, against 4/pi of the limit."""
    enough = np.pi / 4.0 / (2.0 * np.sin(np.pi / count))
    wave = [ss.Force(f"q{i}", 1.0, phase=2.0 * np.pi * i / count) for i in range(count)]
    for share, expected in ((0.999, True), (1.001, False)):
        model = blades(count, between(count, share * enough), wave)
        found = model.problem.unbounded(SPAN)
        assert [one is not None for one in found] == [expected] * count
    # The problem of a grid search and that of a branch judge alike.
    assert unbounded(blades(count, between(count, 0.9 * enough), wave)) == [True] * count


def test_of_equal_blades_only_those_grow_that_friction_lets_go():
    """The first pair is held to the ground, the second is not."""
    contacts = [
        ss.Jenkins("q0", stiffness=STUCK, slip_force=2.0),
        ss.Jenkins("q0", "q1", stiffness=STUCK, slip_force=5.0),
        ss.Jenkins("q2", "q3", stiffness=STUCK, slip_force=5.0),
    ]
    forces = [ss.Force("q1", 1.0), ss.Force("q2", 1.0)]
    assert unbounded(blades(4, contacts, forces)) == [False, False, True, True]


def test_a_traction_in_a_plane_between_equal_oscillators():
    """In phase with a load that turns a traction does pi/2 of what a force along a line does."""
    plane = BOUNDED["coulomb in a plane"]
    for limit, expected in ((0.99, True), (1.01, False)):
        structure = ss.Structure(np.eye(2), 1e4 * np.eye(2), dofs=["a", "b"])
        forces = [ss.Force("a", 1.0), ss.Force("b", 1.0, phase=0.5 * np.pi)]
        model = ss.Model(structure, [plane(limit)], forces)
        found = model.problem.unbounded(SPAN)
        assert [one is not None for one in found] == [expected] * 2


def test_what_a_growing_force_does_not_see_of_equal_blades_is_unbounded():
    """A cubic spring holds the first blade to the ground, and leaves the last one alone."""
    contacts = [*between(2, 5.0), ss.Cubic("q0", stiffness=1e6)]
    model = blades(3, contacts, [ss.Force("q1", 1.0), ss.Force("q2", 1.0)])
    found = model.problem.unbounded(SPAN)
    assert [one is not None for one in found] == [False, False, True]


def test_equal_frequencies_far_apart_in_a_structure():
    """Two sub-structures of one frequency beside a stiff one: rounding parts them."""
    stiffness = np.diag([1e4, 1e4, 1e10])
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    structure = ss.Structure(np.eye(3), turn @ stiffness @ turn.T, dofs=["a", "b", "c"])
    first, second = turn[:, 0], turn[:, 1]
    forces = [ss.Force(dof, float(p)) for dof, p in zip("abc", first, strict=True)]
    contact = [ss.Jenkins("a", "b", stiffness=STUCK, slip_force=50.0)]
    # Some motion of the pair leaves the distance of a and b as it is, and is driven.
    seen = np.array([first[0] - first[1], second[0] - second[1]])
    assert abs(seen[1]) > 0.1 * np.linalg.norm(seen)
    found = ss.Model(structure, contact, forces).problem.unbounded(SPAN)
    assert all(one is not None for one in found)


@pytest.mark.parametrize("seed", range(12))
def test_what_is_unbounded_grows_as_damping_vanishes(seed):
    """Beside the verdict the balance itself, with a millionth of damping and a tenth of it."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 6))
    contacts = []
    for _ in range(int(rng.integers(1, count + 1))):
        a, b = (f"q{i}" for i in rng.choice(count, 2, replace=False))
        ends = (a, b) if rng.random() < 0.7 else (a,)
        limit = float(10.0 ** rng.uniform(-1.0, 1.0))
        contacts.append(ss.Jenkins(*ends, stiffness=STUCK, slip_force=limit))
    forces = [
        ss.Force(f"q{i}", float(10.0 ** rng.uniform(-1.0, 1.0)), phase=float(rng.uniform(0.0, 6.0)))
        for i in rng.choice(count, int(rng.integers(1, 3)), replace=False)
    ]
    found = blades(count, contacts, forces).problem.unbounded(SPAN)
    heights = []
    for ratio in (1e-6, 1e-7):
        damped = blades(count, contacts, forces, ss.ModalDamping(ratio))
        solution = ss.forced_response(damped, [100.0], 3)
        assert solution.converged[0]
        heights.append([solution.amplitude(f"q{i}", "fundamental")[0] for i in range(count)])
    grows = np.array(heights[1]) / np.maximum(heights[0], 1e-6 * np.max(heights))
    for one, growth in zip(found, grows, strict=True):
        assert growth < 1.1 if one is None else growth > 9.0


def test_a_summary_asks_once_for_all(monkeypatch):
    """The poles of a model are those of all its degrees of freedom."""
    contacts = between(6, 0.5, ss.BoucWen)
    response = ss.forced_response(blades(6, contacts, [ss.Force("q0", 1.0)]), [90.0, 95.0], 3)
    asked = []

    class Problem:
        def __init__(self, problem):
            self.problem = problem

        def __getattr__(self, name):
            asked.append(name)
            return getattr(self.problem, name)

    monkeypatch.setitem(response.model.__dict__, "problem", Problem(response.model.problem))
    assert len(response.summary()) == 6
    response.peak("q1", "max")
    assert asked.count("unbounded") == 1


def mistuned_blades(force):
    """A ring of twelve blades that differ, without any damping, and the same as one structure."""
    count, blade = 12, np.array([[5e4, -2e4], [-2e4, 2.2e4]])
    pattern = np.random.default_rng(0).normal(0.0, 0.01, count)
    disk = ss.BladedDisk(
        ss.Structure(np.diag([1.0, 0.5]), blade, dofs=["a", "b"]),
        count,
        [ss.Coupling("a", stiffness=1e3)],
        [ss.Jenkins("b", stiffness=5e3, slip_force=1.0)],
        [ss.Force("b", force)],
        engine_order=2,
    )
    stiffness = np.kron(np.diag(1.0 + pattern), blade)
    for i in range(count):
        tie = np.eye(2 * count)[2 * i] - np.eye(2 * count)[2 * ((i + 1) % count)]
        stiffness += 1e3 * np.outer(tie, tie)
    dofs = [f"{i}.{dof}" for i in range(count) for dof in "ab"]
    whole = ss.Model(
        ss.Structure(np.kron(np.eye(count), np.diag([1.0, 0.5])), stiffness, dofs=dofs),
        [ss.Jenkins(f"{i}.b", stiffness=5e3, slip_force=1.0) for i in range(count)],
        [ss.Force(f"{i}.b", force, phase=4.0 * np.pi * i / count) for i in range(count)],
    )
    return disk.mistuned(pattern), whole


@pytest.mark.parametrize("grid", [np.linspace(100.0, 170.0, 15), (100.0, 170.0)])
def test_friction_bounds_undamped_blades_in_all_their_modes_or_in_none(grid):
    """A blade by itself resonates among the modes of the ring, where nothing bounds it."""
    (ring, whole), (driven, _) = mistuned_blades(0.5), mistuned_blades(3.0)
    response = ss.forced_response(ring, grid, 3)
    assert response.converged.all()
    found, expected = response.peak("1.b"), ss.forced_response(whole, grid, 3).peak("1.b")
    assert not found.beside_gap
    assert (found.omega, found.amplitude) == pytest.approx((expected.omega, expected.amplitude))
    with pytest.warns(UserWarning, match="neither damping nor friction bounds"):
        assert ss.forced_response(driven, grid, 3).peak("1.b").amplitude == np.inf


def test_undamped_blades_have_amplification_factors():
    """None of these disks had been found."""
    disk = mistuned_blades(0.5)[0].disk
    found = ss.mistuning_study(disk, 0.02, patterns=3, dofs="b", omega=(100.0, 200.0), harmonics=3)
    assert (found.status == "converged").all()
    assert (found.factors("b") > 1.0).all()


@pytest.mark.parametrize("dofs", [450, 1001])
def test_a_large_undamped_chain_is_judged_while_its_modes_are_affordable(dofs):
    """Up to a thousand of its degrees of freedom."""
    stiffness = 1e4 * (2.0 * np.eye(dofs) - np.eye(dofs, k=1) - np.eye(dofs, k=-1))
    structure = ss.Structure(np.eye(dofs), stiffness)
    contact = ss.Jenkins("1", stiffness=STUCK, slip_force=1e-3)
    model = ss.Model(structure, [contact], [ss.Force("2", 1.0)])
    frequency = ss.natural_frequencies(ss.Model(structure, [], []))[9]
    span = (frequency * 0.99, frequency * 1.01)
    found = model.problem.unbounded(span)
    assert (found[5] is not None) == (dofs < 1000)


def test_exact_orbits_beside_a_resonance_without_bound():
    stiffness = 1e4 * (2.0 * np.eye(3) - np.eye(3, k=1) - np.eye(3, k=-1))
    structure = ss.Structure(np.eye(3), stiffness, None, ["a", "b", "c"])
    damper = ss.Jenkins("a", stiffness=5e3, slip_force=5.0)
    orbits = ss.exact_response(
        ss.Model(structure, [damper], [ss.Force("b", 30.0)]), np.linspace(70.0, 80.0, 21)
    )
    assert orbits.converged.all()
    with pytest.warns(UserWarning, match="neither damping nor friction bounds"):
        peak = orbits.peak("b")
    assert peak.amplitude == np.inf
    assert peak.omega == pytest.approx(100.0 * np.sqrt(2.0 - np.sqrt(2.0)), rel=1e-9)
    damped = ss.Structure(np.eye(3), stiffness, ss.ModalDamping(1e-3), ["a", "b", "c"])
    model = ss.Model(damped, [damper], [ss.Force("b", 30.0)])
    assert np.isfinite(ss.exact_response(model, np.linspace(70.0, 80.0, 21)).peak("b").amplitude)


@pytest.mark.parametrize("omega", [SPAN, np.linspace(*SPAN, 9)], ids=["range", "grid"])
@pytest.mark.parametrize("analysis", [ss.forced_response, ss.exact_response])
def test_a_curve_names_the_resonance(analysis, omega, tmp_path):
    model = undamped([BOUNDED["jenkins"](2.0)], 1e3)
    natural = ss.natural_frequencies(undamped([], 1e3))[0]
    curve = analysis(model, omega)
    curve.save(tmp_path / "curve.nc")
    for one in (curve, ss.load(tmp_path / "curve.nc")):
        (said,) = [told for told in one.diagnostics if told.code == "unbounded-resonance"]
        assert said.severity == "caution"
        assert said.data["omega"] == pytest.approx(natural, rel=1e-9)
        assert f"{natural:.6g} rad/s" in said.text
        assert "'a', 'b'" in said.text
    bounded = analysis(undamped([BOUNDED["jenkins"](40.0)], 1e3), omega)
    assert not any(told.code == "unbounded-resonance" for told in bounded.diagnostics)


@pytest.mark.parametrize("analysis", [ss.forced_response, ss.exact_response])
def test_a_resonance_that_is_given_is_named(analysis):
    model = undamped([BOUNDED["jenkins"](2.0)], 1e3)
    natural = ss.natural_frequencies(undamped([], 1e3))[0]
    for at in (natural, np.nextafter(natural, 0.0), np.nextafter(natural, np.inf)):
        assert "unbounded-resonance" in [told.code for told in analysis(model, [at]).diagnostics]
