"""Bounds over residual tractions: what is unique, what is inside, what is drawn, saved and said."""

import numpy as np
import pytest

import stickslip as ss
from stickslip.reference import snecma_beam
from stickslip.study import Study

SEARCH = 1e-5  # what the search leaves, relative to the amplitude


def pads(*, damping=0.25, force=3.0, tilt=0.3):
    """Two bodies, each on a plane that its own normal motion presses."""
    stiffness = np.diag([260.0, 310.0, 240.0, 350.0])
    for i, j, k in ((0, 1, 60.0), (1, 2, 50.0), (2, 3, 80.0), (0, 3, 40.0)):
        stiffness[[i, j], [j, i]] -= k
        stiffness[[i, j], [i, j]] += k
    mass = np.diag([1.0, 1.2, 1.4, 1.6])
    names = ["a.x", "a.z", "b.x", "b.z"]
    structure = ss.Structure(mass, stiffness, damping * mass, names)
    contacts = [
        ss.Coulomb(
            [f"{body}.x", f"{body}.z"],
            normal=[tilt, np.sqrt(1.0 - tilt**2)],
            friction=friction,
            tangential_stiffness=k,
            normal_stiffness=250.0,
            preload=preload,
            name=body,
        )
        for body, friction, k, preload in (("a", 0.5, 150.0, 2.0), ("b", 0.8, 220.0, 3.0))
    ]
    forces = [ss.Force("a.x", force), ss.Force("b.x", 0.6 * force, phase=2.0)]
    return ss.Model(structure, contacts, forces)


GRID = np.linspace(9.0, 24.0, 16)


@pytest.fixture(scope="module")
def bounded():
    return ss.forced_response(pads(), GRID, 7, residual="bounds", observe=["a.x"])


def test_monotone_contacts_have_one_vibration():
    """Even where the residual decides whether the contact slips."""
    model = snecma_beam(force=20.0)
    frf = ss.forced_response(model, np.linspace(60.0, 300.0, 9), 5, residual="bounds")
    plain = ss.forced_response(model, frf.omega, 5)
    assert set(frf.unique) == {"yes"}
    assert frf.guaranteed.all()
    np.testing.assert_array_equal(frf.amplitude("tip"), plain.amplitude("tip"))
    np.testing.assert_allclose(frf.lower("tip"), plain.amplitude("tip"), rtol=1e-12)
    np.testing.assert_array_equal(frf.lower("tip"), frf.upper("tip"))
    held = frf.residual_bounds(0).max()
    assert held > 0.0
    pushed = ss.forced_response(model, frf.omega, 5, residual=1.5 * held)
    np.testing.assert_allclose(pushed.amplitude("tip"), frf.upper("tip"), rtol=1e-9)
    assert any(one.code == "bounds" for one in frf.diagnostics)


def test_a_normal_load_that_varies_opens_an_interval(bounded):
    amplitude, lower, upper = bounded.amplitude("a.x"), bounded.lower("a.x"), bounded.upper("a.x")
    assert (lower <= amplitude).all()
    assert (amplitude <= upper).all()
    wide = upper - lower > 1e-9 * upper
    np.testing.assert_array_equal(wide, bounded.unique != "yes")
    assert (upper > 1.02 * lower).sum() > 2
    assert not bounded.guaranteed.any()
    code = {one.code: one for one in bounded.diagnostics}["bounds"]
    assert code.data["points"] == wide.sum()


@pytest.mark.slow
def test_other_assumptions_lie_inside(bounded):
    for residual in ("from_rest", -1.5, -0.4, 0.3, 0.9, 2.0):
        other = ss.forced_response(pads(), GRID, 7, residual=residual, observe=["a.x"])
        assert (other.amplitude("a.x") <= bounded.upper("a.x") * (1.0 + SEARCH)).all()
        assert (other.amplitude("a.x") >= bounded.lower("a.x") * (1.0 - SEARCH)).all()


@pytest.mark.slow
def test_transients_from_random_starts_lie_inside():
    """What time integration comes to has its own residual tractions, whatever they are."""
    model, rng = pads(), np.random.default_rng(5)
    frf = ss.forced_response(model, GRID[::3], 31, residual="bounds", observe=["a.x"])
    outside, moved = [], []
    for position, omega in enumerate(frf.omega):
        for _ in range(9):
            start = ss.State(model, rng.normal(0.0, 2e-2, 4), rng.normal(0.0, 0.3, 4))
            run = ss.transient(
                model, omega=omega, periods=2000, start=start, tolerance=1e-8, keep=1
            )
            assert run.status == "settled"
            own = run.amplitude("a.x")
            low, high = frf.lower("a.x")[position], frf.upper("a.x")[position]
            outside.append(max(own / high, low / own) - 1.0)
            moved.append(abs(own / frf.amplitude("a.x")[position] - 1.0))
    assert max(outside) < SEARCH
    assert max(moved) > 1e-2


@pytest.mark.slow
def test_a_search_over_both_tractions_finds_no_more():
    """9 x 9 tractions at the start of a motion, as far as they last."""
    model = pads()
    frf = ss.forced_response(model, [12.0, 15.0], 31, residual="bounds", observe=["a.x"])
    assert set(frf.unique) == {"no"}
    for place, omega in enumerate(frf.omega):
        found = []
        for a, b in np.ndindex(9, 9):
            forces = [0.99 * (a / 4.0 - 1.0), 2.376 * (b / 4.0 - 1.0)]
            start = ss.State(model, contact_force=forces)
            run = ss.transient(
                model, omega=omega, periods=2000, start=start, tolerance=1e-8, keep=1
            )
            assert run.status == "settled"
            found.append(run.amplitude("a.x"))
        lower, upper = frf.lower("a.x")[place], frf.upper("a.x")[place]
        assert max(found) > 1.005 * min(found)
        assert lower * (1.0 - SEARCH) <= min(found)
        assert max(found) <= upper * (1.0 + SEARCH)


def test_cost_in_evaluations(bounded):
    plain = ss.forced_response(pads(), GRID, 7, observe=["a.x"])
    assert bounded.counters["evaluations"] <= 6 * plain.counters["evaluations"]


def test_a_range():
    frf = ss.forced_response(pads(), (10.0, 14.0), 3, residual="bounds", observe=["a.x"])
    assert np.isfinite(frf.lower("a.x")).all()
    assert (frf.upper("a.x") >= frf.lower("a.x")).all()
    assert (frf.upper("a.x") > 1.005 * frf.lower("a.x")).any()


def test_bounds_are_saved_and_drawn(bounded, tmp_path):
    bounded.save(tmp_path / "bounds.nc")
    loaded = ss.load(tmp_path / "bounds.nc")
    np.testing.assert_array_equal(loaded.lower("a.x"), bounded.lower("a.x"))
    np.testing.assert_array_equal(loaded.upper("a.x"), bounded.upper("a.x"))
    np.testing.assert_array_equal(loaded.unique, bounded.unique)
    assert loaded.settings.bounds
    ax = loaded.plot("a.x")
    assert "all residual tractions" in [text.get_text() for text in ax.get_legend().get_texts()]


def test_plain_curves_have_none():
    frf = ss.forced_response(pads(), GRID[:2], 3)
    assert set(frf.unique) == {"not asked"}
    with pytest.raises(ss.ModelError, match=r"^residual: its bounds were not computed; give resid"):
        frf.lower("a.x")
    with pytest.raises(ss.ModelError, match=r"^residual: unknown choice 'bounds'"):
        ss.optimal_damper(pads(), parameter="friction", dof="a.x", residual="bounds")


@pytest.mark.slow
def test_a_contact_in_space():
    """Two tangential directions: sliders move in a plane."""
    structure = ss.Structure(
        np.diag([1.0, 1.0, 1.0, 1.3, 1.3, 1.3]),
        np.diag([300.0, 340.0, 320.0, 280.0, 360.0, 330.0]) + 40.0 * np.ones((6, 6)),
        0.3 * np.eye(6),
        [f"{body}.{axis}" for body in "ab" for axis in "xyz"],
    )
    contacts = [
        ss.Coulomb(
            [f"{body}.{axis}" for axis in "xyz"],
            normal=[0.3, 0.1, np.sqrt(0.9)],
            friction=0.5,
            tangential_stiffness=150.0,
            normal_stiffness=250.0,
            preload=preload,
        )
        for body, preload in (("a", 1.5), ("b", 3.0))
    ]
    forces = [ss.Force("a.x", 1.2), ss.Force("a.y", 0.8, phase=1.0), ss.Force("b.y", 0.5)]
    space = ss.Model(structure, contacts, forces)
    grid = np.array([15.0, 17.0, 19.0])
    frf = ss.forced_response(space, grid, 3, residual="bounds", observe=["a.x"])
    assert (frf.upper("a.x") >= frf.amplitude("a.x")).all()
    for residual in (-0.8, 0.5):
        other = ss.forced_response(space, grid, 3, residual=residual, observe=["a.x"])
        assert (other.amplitude("a.x") <= frf.upper("a.x") * (1.0 + 1e-4)).all()
        assert (other.amplitude("a.x") >= frf.lower("a.x") * (1.0 - 1e-4)).all()


def test_peaks_between_bounds(bounded):
    least, highest = bounded.peak_bounds("a.x")
    assert least.amplitude <= bounded.peak("a.x").amplitude * (1.0 + 1e-12)
    assert bounded.peak("a.x").amplitude <= highest.amplitude * (1.0 + 1e-12)
    unique = ss.forced_response(snecma_beam(force=20.0), (180.0, 260.0), 5, residual="bounds")
    least, highest = unique.peak_bounds("tip")
    assert highest.amplitude - least.amplitude < 1e-9 * highest.amplitude
    assert highest == unique.peak("tip")


def test_a_study_file():
    study = Study.parse(
        """
        [structure]
        mass = [[1.0, 0.0], [0.0, 1.2]]
        damping = [[0.2, 0.0], [0.0, 0.3]]
        stiffness = [[260.0, -60.0], [-60.0, 310.0]]
        dofs = ["x", "z"]
        [[contact]]
        law = "coulomb"
        dofs = ["x", "z"]
        normal = [0, 1]
        friction = 0.5
        tangential_stiffness = "150 N/m"
        normal_stiffness = "250 N/m"
        preload = "2 N"
        [[force]]
        dof = "x"
        amplitude = "3 N"
        [analysis]
        omega = ["11 rad/s", "12 rad/s"]
        harmonics = 3
        residual = "bounds"
        observe = ["x"]
        """
    )
    (found,) = study.run()
    assert found.bounded
    assert found.settings.bounds
    assert found.settings.residual == "centred"


@pytest.mark.slow
def test_orbits_go_as_far_as_a_balance_of_many_harmonics(bounded):
    """What is extreme is found by few harmonics; what an orbit with it does is exact."""
    grid = GRID[:8:2]
    exact = ss.exact_response(pads(), grid, residual="bounds", observe=["a.x"])
    fine = ss.forced_response(pads(), grid, 63, residual="bounds", observe=["a.x"])
    np.testing.assert_array_equal(exact.unique, fine.unique)
    np.testing.assert_allclose(exact.lower("a.x"), fine.lower("a.x"), rtol=2.0 * SEARCH)
    np.testing.assert_allclose(exact.upper("a.x"), fine.upper("a.x"), rtol=2.0 * SEARCH)
    assert (exact.upper("a.x") > 1.02 * exact.lower("a.x")).sum() > 1
    plain = ss.exact_response(pads(), grid, observe=["a.x"])
    np.testing.assert_array_equal(exact.amplitude("a.x"), plain.amplitude("a.x"))
    assert exact.settings.bounds
    assert any(one.code == "bounds" for one in exact.diagnostics)


def test_orbits_of_monotone_contacts_are_the_only_ones():
    exact = ss.exact_response(snecma_beam(force=20.0), [180.0, 260.0], residual="bounds")
    assert exact.guaranteed.all()
    np.testing.assert_array_equal(exact.lower("tip"), exact.amplitude("tip"))
    np.testing.assert_array_equal(exact.upper("tip"), exact.amplitude("tip"))


@pytest.mark.slow
def test_orbits_of_a_wedge():
    """A static load presses: the past may have left more than one vibration from rest."""
    blades = (
        ss.Structure(10.0 * np.eye(2), stiffness, 100.0 * np.eye(2), ["x", "y"])
        for stiffness in ([[1e6, -9e5], [-9e5, 1e6]], [[4e5, -3e5], [-3e5, 4e5]])
    )
    wedge = ss.WedgeDamper(
        angle=40.0, mass=0.1, friction=0.6, tangential_stiffness=3e5, normal_stiffness=3e5, load=240
    )
    ends = {"left_dofs": ["x", "y"], "right_dofs": ["x", "y"]}
    forces = [ss.Force("left.x", 200.0), ss.Force("right.x", 200.0, phase=np.pi)]
    model = wedge.between(*blades, **ends, forces=forces)
    grid = [298.5, 305.25, 312.0]
    exact = ss.exact_response(model, grid, residual="bounds", observe=["left.x"])
    fine = ss.forced_response(model, grid, 63, residual="bounds", observe=["left.x"])
    assert (exact.upper("left.x") > 1.02 * exact.lower("left.x")).tolist() == [True, True, False]
    np.testing.assert_allclose(exact.lower("left.x"), fine.lower("left.x"), rtol=2.0 * SEARCH)
    np.testing.assert_allclose(exact.upper("left.x"), fine.upper("left.x"), rtol=2.0 * SEARCH)


@pytest.mark.slow
def test_a_structural_damper_beside_a_normal_load_that_varies():
    """Its sliders are varied with the others: what a preloaded damper holds presses the pads."""
    base = pads(force=2.0)
    damper = ss.StructuralDamper(
        ["a.z", "b.z"],
        stiffness=[[90.0, 20.0], [20.0, 70.0]],
        slip_forces=[1.0, 1.2],
        name="damper",
    )
    model = base.replaced(contacts=[*base.contacts, damper])
    frf = ss.forced_response(model, GRID[::3], 5, residual="bounds", observe=["a.x"])
    lower, upper = frf.lower("a.x"), frf.upper("a.x")
    assert not frf.guaranteed.any()
    assert (upper > 1.01 * lower).any()
    for residual in ("from_rest", -0.8, -0.3, 0.4, 1.0):
        other = ss.forced_response(model, GRID[::3], 5, residual=residual, observe=["a.x"])
        assert (other.amplitude("a.x") <= upper * (1.0 + SEARCH)).all()
        assert (other.amplitude("a.x") >= lower * (1.0 - SEARCH)).all()


def weakly_coupled(force):
    """The pads where their own motion presses them little: one motion per residual traction."""
    return pads(damping=0.6, force=force, tilt=0.1)


FRICTION = {"friction": [0.3, 0.5, 0.7], "dof": "a.x", "harmonics": 7, "omega": (9.0, 24.0)}


@pytest.fixture(scope="module")
def bounded_peaks():
    return ss.damper_curve(weakly_coupled(0.4), residual="bounds", **FRICTION)


@pytest.mark.slow
def test_peaks_along_a_parameter(bounded_peaks):
    """What any residual traction makes of a peak lies between its bounds."""
    curve = bounded_peaks
    plain = ss.damper_curve(weakly_coupled(0.4), **FRICTION)
    np.testing.assert_allclose(curve.amplitude, plain.amplitude, rtol=1e-9)
    assert curve.counters["evaluations"] <= 6 * plain.counters["evaluations"]
    assert (curve.upper[1:] > 1.005 * curve.lower[1:]).all()
    assert not curve.guaranteed.any()
    for residual in (-2.0, -0.7, -0.2, 0.2, 0.7, 2.0, "from_rest"):
        other = ss.damper_curve(weakly_coupled(0.4), residual=residual, **FRICTION)
        assert (other.amplitude <= curve.upper * (1.0 + SEARCH)).all()
        assert (other.amplitude >= curve.lower * (1.0 - SEARCH)).all()
    fine = ss.forced_response(
        curve.model_at(0.7), np.linspace(21.0, 22.0, 41), 7, residual="bounds", observe=["a.x"]
    )
    least, highest = fine.peak_bounds("a.x")
    assert curve.lower[2] == pytest.approx(least.amplitude, rel=1e-4)
    assert curve.upper[2] == pytest.approx(highest.amplitude, rel=1e-4)


@pytest.mark.slow
def test_unique_peaks_have_no_width():
    """Where all contacts slip at the peak, and where laws are monotone."""
    curve = ss.damper_curve(weakly_coupled(2.0), residual="bounds", **FRICTION)
    assert (curve.unique == "yes").all()
    np.testing.assert_array_equal(curve.upper, curve.amplitude)
    np.testing.assert_array_equal(curve.lower, curve.amplitude)
    beam = {"slip_force": [20.0, 100.0], "dof": "tip", "harmonics": 5, "residual": "bounds"}
    monotone = ss.damper_curve(snecma_beam(force=20.0), **beam)
    assert monotone.guaranteed.all()
    np.testing.assert_array_equal(monotone.upper, monotone.amplitude)


def test_levels_scale_bounds():
    """The level counts, however it is shared between the forces and the factor on them."""
    at = FRICTION | {"residual": "bounds"}
    del at["friction"]
    one = ss.damper_curve(weakly_coupled(0.8), level=[0.25], **at)
    other = ss.damper_curve(weakly_coupled(0.2), level=[1.0], **at)
    np.testing.assert_allclose(one.upper, other.upper, rtol=1e-9)
    np.testing.assert_allclose(one.lower, other.lower, rtol=1e-9)
    assert one.upper > 1.005 * one.lower


def test_bounded_peaks_are_saved_drawn_and_told(bounded_peaks, tmp_path):
    bounded_peaks.save(tmp_path / "peaks.nc")
    loaded = ss.load(tmp_path / "peaks.nc")
    np.testing.assert_array_equal(loaded.lower, bounded_peaks.lower)
    np.testing.assert_array_equal(loaded.unique, bounded_peaks.unique)
    texts = [text.get_text() for text in loaded.plot().get_legend().get_texts()]
    assert "all residual tractions" in texts
    (told,) = [one for one in loaded.diagnostics if one.code == "bounds"]
    assert told.data["points"] == (loaded.unique != "yes").sum()


def test_peaks_without_bounds():
    curve = ss.damper_curve(pads(), friction=[0.3], dof="a.x", harmonics=1, omega=(9.0, 24.0))
    assert set(curve.unique) == {"not asked"}
    with pytest.raises(ss.ModelError, match=r"^residual: its bounds were not computed"):
        _ = curve.upper
    with pytest.raises(ss.ModelError, match=r"^measure: 'max' has no bounds"):
        ss.damper_curve(pads(), residual="bounds", measure="max", **FRICTION)
