"""The structure-like damper in Python: the dissertation's system, limiting cases, bad input."""

import json
import pickle

import numpy as np
import pytest

import stickslip as ss
from stickslip import plot, reference
from stickslip.model.laws import contact_from_spec
from stickslip.study import Study

D = [[2.0, -2.0], [-2.0, 2.0]]


@pytest.fixture(scope="module")
def strong():
    """All slip sets occur: 550 rad/s and 550 N."""
    return ss.forced_response(reference.damped_pair(550.0), [550.0], harmonics=25)


@pytest.fixture(scope="module")
def exact():
    return ss.exact_response(reference.damped_pair(550.0), [550.0])


def jenkins_and_damper(slip_forces, *, static=0.0):
    beam = reference.snecma_structure()
    pair = ss.join({"1": beam, "2": beam})
    forces = [ss.Force("1.tip", 40.0), ss.Force("2.tip", 30.0, phase=1.1)]
    if static:
        forces.append(ss.Force("1.tip", static, harmonic=0))
    spring = [[1e6, -1e6], [-1e6, 1e6]]
    ends = ["1.tip", "2.tip"]
    contacts = [
        ss.Jenkins(*ends, stiffness=1e6, slip_force=50.0),
        ss.StructuralDamper(ends, stiffness=spring, slip_forces=slip_forces),
    ]
    return [ss.Model(pair, [contact], forces) for contact in contacts]


def test_table_of_all_configurations_is_that_of_the_errata():
    table = ss.slip_configurations(reference.damped_pair())
    found = {tuple(point for _, point in points): omega for points, omega in table.items()}
    expected = {
        (): (541.2619, 1090.2088, 2026.5922),
        (0,): (509.2988, 715.1364, 1511.7374),
        (1,): (501.7571, 725.7708, 1639.5211),
        (2,): (191.2091, 678.9080, 1358.9952),
        (0, 1): (159.5927, 695.4112, 901.7589),
        (1, 2): (159.5927, 665.8486, 901.7589),
        (0, 2): (159.5927, 547.5404, 901.7589),
        (0, 1, 2): (159.5927, 159.5927, 901.7589),
    }
    assert found.keys() == expected.keys()
    for points, omega in expected.items():
        assert found[points][:3] == pytest.approx(omega, rel=5e-7)
    one = ss.natural_frequencies(reference.damped_pair(), slipping=[("structural", 0)])
    assert (one == table[("structural", 0),]).all()
    assert "structural[0], structural[2]" in str(table)
    every = ss.natural_frequencies(
        reference.damped_pair(), slipping=[("structural", point) for point in range(4)]
    )
    assert every == pytest.approx(found[0, 1, 2])


@pytest.mark.parametrize("result", ["strong", "exact"])
def test_forces_slip_sets_and_sum_of_the_strong_case(result, request):
    response = request.getfixturevalue(result)
    forces = response.contact_force("structural", 0, 4096)
    assert np.abs(forces).max(axis=0) == pytest.approx([24.6, 100.0, 246.05, 370.65], rel=1e-9)
    assert np.abs(response.resultant("structural", 0)).max() < 1e-9 * 370.65
    states = response.contact_states("structural", 0)
    assert set(states.sets) - {()} == {(0,), (0, 1), (0, 2), (0, 1, 2)}
    # with three slipping the fourth is constant
    fraction = response.slip_fraction("structural")[0]
    shares = [states.length[states.direction[:, point] != 0].sum() for point in range(4)]
    assert shares == pytest.approx(fraction, abs=1e-9)
    assert sum(states.share(points) for points in states.sets) == pytest.approx(1.0)
    assert fraction[3] == 0.0 == response.dissipation("structural")[0, 3]
    assert "slip sets" in repr(states)


def test_both_methods_dissipate_the_same(strong, exact):
    ours, orbit = (one.dissipation("structural")[0] for one in (strong, exact))
    assert ours == pytest.approx(orbit, rel=3e-5)
    assert exact.energy.friction[0] == pytest.approx(orbit.sum())
    assert strong.amplitude("1.tip") == pytest.approx(exact.amplitude("1.tip"), rel=1e-4)
    assert np.abs(exact.multipliers).max() < 1.0


def test_transients_of_both_schemes_settle_on_the_orbit(exact):
    model = exact.model
    run = ss.transient(model, 550.0, periods=1, start=exact.state(0))
    begin = run.contact_force("structural")[0]
    assert run.contact_force("structural")[-1] == pytest.approx(begin, abs=1e-7)
    rk4 = ss.transient(model, 550.0, periods=1, scheme="rk4", start=exact.state(0))
    assert rk4.contact_force("structural")[-1] == pytest.approx(begin, rel=1e-3, abs=0.3)


ANALYSES = {
    "balance": lambda model: ss.forced_response(model, [160.0, 300.0], harmonics=11),
    "marched": lambda model: ss.forced_response(
        model, [160.0, 300.0], harmonics=5, evaluation="marched"
    ),
    "broyden": lambda model: ss.forced_response(model, [160.0], harmonics=5, method="broyden"),
    "exact": lambda model: ss.exact_response(model, [160.0, 300.0]),
    "transient": lambda model: ss.transient(model, 170.0, periods=5),
    "rk4": lambda model: ss.transient(model, 170.0, periods=5, scheme="rk4"),
}


@pytest.mark.parametrize("analysis", ANALYSES.values(), ids=ANALYSES.keys())
@pytest.mark.parametrize("slip_forces", [(50.0, np.inf), (50.0, 65.0)])
def test_two_points_are_a_jenkins_element_in_every_analysis(analysis, slip_forces):
    jenkins, damper = (analysis(model) for model in jenkins_and_damper(slip_forces))
    if isinstance(jenkins, ss.Transient):
        pairs = [(one.displacement("1.tip"), one.contact_force(0)) for one in (jenkins, damper)]
    else:
        pairs = [(one.coefficients("1.tip"), one.contact_force(0, 0)) for one in (jenkins, damper)]
        assert damper.dissipation(0)[:, 0] == pytest.approx(jenkins.dissipation(0)[:, 0], rel=1e-9)
        assert not damper.slip_fraction(0)[:, 1].any()
    (motion, force), (ours, pair) = pairs
    assert np.abs(ours - motion).max() < 1e-9 * np.abs(motion).max()
    expected = force.reshape(len(pair), -1)[:, 0]
    assert np.abs(pair[:, 0] - expected).max() < 1e-9 * np.abs(expected).max()


def test_static_loads_are_held_as_from_rest():
    answers = [
        analysis(model, [160.0, 300.0], residual="from_rest").coefficients("1.tip")
        for analysis in (ss.forced_response, ss.exact_response)
        for model in jenkins_and_damper((50.0, np.inf), static=20.0)
    ]
    assert answers[1][:, 0] == pytest.approx(answers[0][:, 0], rel=1e-9)
    assert answers[3][:, 0] == pytest.approx(answers[2][:, 0], rel=1e-9)


def test_damper_between_blades_travels_as_the_whole_disk_does():
    stiffness = reference.damped_pair().contacts[0].stiffness
    damper = ss.StructuralDamper(
        ["damper", "next.damper", "tip", "next.tip"],
        stiffness=stiffness,
        slip_forces=[24.6, 100.0, 246.05, np.inf],
    )
    disk = ss.BladedDisk(
        reference.snecma_structure(),
        sectors=6,
        contacts=[damper],
        forces=[ss.Force("tip", 300.0)],
        engine_order=2,
    )
    wave = ss.forced_response(disk, [560.0], harmonics=7)
    ring = disk.mistuned(0)
    whole = ss.forced_response(ring, [560.0], harmonics=7)
    assembled = ss.forced_response(
        ss.Model(ring.structure, ring.contacts, ring.forces), [560.0], harmonics=7
    )
    assert wave.slip_fraction(0).any()
    for sector in range(6):
        expected = wave.sector(sector).coefficients("tip")
        for other in (whole, assembled):
            found = other.coefficients(f"{sector}.tip")
            assert np.abs(found - expected).max() < 1e-9 * np.abs(expected).max()
    assert whole.dissipation("5.structural") == pytest.approx(wave.dissipation(0), rel=1e-9)


def test_contacts_may_touch_the_ground():
    beam = reference.snecma_structure()
    damper = ss.StructuralDamper(
        ["damper", None],
        stiffness=[[2.4e7, -2.4e7], [-2.4e7, 2.4e7]],
        slip_forces=[246.048, np.inf],
    )
    model = ss.Model(beam, [damper], [ss.Force("tip", 20.313)])
    plain = ss.forced_response(reference.snecma_beam(), [170.0, 200.0], harmonics=9)
    grounded = ss.forced_response(model, [170.0, 200.0], harmonics=9)
    assert grounded.amplitude("tip") == pytest.approx(plain.amplitude("tip"), rel=1e-12)
    held = ss.StructuralDamper(["damper"], stiffness=[[2.4e7]], slip_forces=[246.048])
    assert (damper.grounding, held.grounding) == (0.0, 2.4e7)
    said = ss.forced_response(ss.Model(beam, [held], model.forces), [170.0], harmonics=3)
    assert any("do not sum to zero" in text for text in said.assumptions)
    assert said.amplitude("tip") == pytest.approx(
        ss.forced_response(reference.snecma_beam(), [170.0], harmonics=3).amplitude("tip")
    )


@pytest.mark.slow
def test_damper_survives_files_pickles_and_factors(strong, tmp_path):
    strong.save(tmp_path / "pair.nc")
    (loaded,) = ss.load(tmp_path / "pair.nc").model.contacts
    (damper,) = strong.model.contacts
    assert loaded == damper == pickle.loads(pickle.dumps(damper))
    assert contact_from_spec(json.loads(json.dumps(damper.to_spec()))) == damper
    assert hash(loaded) == hash(damper)
    assert damper.scaled(2.0).slip_forces == (49.2, 200.0, 492.1, np.inf)
    assert damper != damper.named("other")
    assert damper.linear_limit(stuck=False).stiffness == pytest.approx(np.zeros((4, 4)), abs=1e-6)


@pytest.mark.slow
def test_figures_of_forces_and_states(strong, exact):
    for result in (strong, exact):
        axes = plot.contact_forces(result, "structural", 0)
        assert len(axes) == 5
        assert "sum" in axes[-1].get_ylabel()
        dashed = axes[0].lines[0].get_ydata()
        # Without slip the force would be far above its limit
        assert np.abs(dashed).max() > 24.6
        strips = plot.events(result, 0)
        assert next(text.get_text() for text in strips.get_yticklabels()).startswith("structural")
    weak = ss.forced_response(reference.damped_pair(15.0), [250.0], harmonics=5)
    axes = plot.contact_forces(weak, 0, 0)
    for panel in axes[:4]:
        stuck, force = (line.get_ydata() for line in panel.lines[:2])
        assert force == pytest.approx(stuck, abs=1e-9 * np.abs(stuck).max())
    weak.plot("1.tip")


def test_study_file_reads_the_law(tmp_path):
    study = Study.parse(
        """
        [structure]
        mass = [[1, 0], [0, 1]]
        stiffness = [[100, 0], [0, 200]]
        damping = { modal = 0.01 }
        dofs = ["a", "b"]
        [[contact]]
        law = "structural"
        dofs = ["a", "b", "ground"]
        stiffness = [[50, -30, -20], [-30, 30, 0], [-20, 0, 20]]
        slip_forces = ["1 N", 0.5, inf]
        [[force]]
        dof = "a"
        amplitude = 1
        [analysis]
        omega = [10.0]
        """,
        folder=tmp_path,
    )
    (damper,) = study.model.contacts
    assert damper.dofs == ("a", "b", None)
    assert damper.slip_forces == (1.0, 0.5, np.inf)
    (result,) = study.run()
    assert result.converged.all()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"stiffness": [[1.0, -0.5], [-0.4, 1.0]]}, r"-0\.5 at \(0, 1\)"),
        ({"stiffness": [[1.0, -2.0], [-2.0, 1.0]]}, "eigenvalue -1"),
        ({"stiffness": [[1.0]]}, "1 x 1 for 2 dofs"),
        ({"stiffness": [[np.nan, 0.0], [0.0, 1.0]]}, r"nan at \(0, 0\)"),
        ({"slip_forces": [1.0]}, "1 slip_forces for 2 dofs"),
        ({"slip_forces": [1.0, -1.0]}, r"slip_forces\[1\] -1"),
        ({"slip_forces": [1.0, np.nan]}, r"slip_forces\[1\]"),
        ({"dofs": [None, None]}, "all the ground"),
        ({"dofs": "ab"}, "dofs"),
    ],
)
def test_bad_dampers_are_refused(arguments, message):
    given = {"dofs": ["a", "b"], "stiffness": D, "slip_forces": [1.0, 2.0]} | arguments
    with pytest.raises(ss.ModelError, match=message):
        ss.StructuralDamper(
            given["dofs"], stiffness=given["stiffness"], slip_forces=given["slip_forces"]
        )


def test_residual_forces_of_points_and_the_name_of_the_ground_are_refused():
    model = ss.reference.damped_pair(60.0)
    for analysis in (ss.forced_response, ss.exact_response):
        with pytest.raises(ss.ModelError, match=r"^residual: 3 N is for contacts of one point"):
            analysis(model, [550.0], residual=3.0)
    damper = ss.StructuralDamper(
        ["ground", "1.tip"], stiffness=[[1, -1], [-1, 1]], slip_forces=[1, 1]
    )
    with pytest.raises(ss.ModelError, match=r"unknown dof 'ground'.* \(the ground is None\)"):
        model.replaced(contacts=[damper])


def test_six_printed_digits_of_a_stiffness_are_enough():
    rng = np.random.default_rng(3)
    strains = rng.normal(size=(3, 4))
    strains -= strains.mean(axis=1, keepdims=True)
    exact = 1e6 * strains.T @ strains
    printed = np.array([[float(f"{entry:.6g}") for entry in row] for row in exact])
    assert np.linalg.eigvalsh(printed)[0] < -1e-8 * printed.max()
    pair = ss.reference.damped_pair(120.0)
    ends, limits = pair.contacts[0].dofs, (5.0, 8.0, 11.0, 20.0)
    amplitude, other = (
        ss.forced_response(
            pair.replaced(
                contacts=[ss.StructuralDamper(ends, stiffness=stiffness, slip_forces=limits)]
            ),
            [150.0, 240.0, 540.0],
            harmonics=9,
        ).amplitude("1.tip")
        for stiffness in (exact, printed)
    )
    np.testing.assert_allclose(other, amplitude, rtol=2e-4)


def test_unknown_dofs_and_impossible_states_are_refused():
    model = reference.damped_pair()
    damper = ss.StructuralDamper(["1.tip", "2.tpi"], stiffness=D, slip_forces=[1.0, 2.0])
    with pytest.raises(ss.ModelError, match=r"2\.tpi.*2\.tip"):
        model.replaced(contacts=[damper])
    with pytest.raises(ss.ModelError, match="exceeds its slip force of 24"):
        ss.State(model, contact_force={("structural", 0): 30.0})
    lone = ss.State(model, contact_force={("structural", 0): 20.0})
    with pytest.raises(ss.ModelError, match="no deformation of the contact gives"):
        ss.transient(model, 550.0, periods=1, start=lone)
    with pytest.raises(ss.ModelError, match="at most 12"):
        ss.slip_configurations(
            ss.Model(
                model.structure,
                [ss.Jenkins("1.tip", stiffness=1.0, slip_force=1.0) for _ in range(13)],
            )
        )
