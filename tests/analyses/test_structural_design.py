"""The parameters of a structure-like damper: curves, optima, sensitivities, limit cycles."""

import numpy as np
import pytest
from typer.testing import CliRunner

import stickslip as ss
from stickslip import reference
from stickslip.cli import app
from stickslip.settings.variation import Variation

ENDS = ("1.tip", "2.tip")
SPRING = 1e6


@pytest.fixture(scope="module")
def pair():
    """The dissertation's beam pair at 60 N: limits 24.6, 100, 246.05 N and infinite."""
    return reference.damped_pair(60.0)


@pytest.fixture(scope="module")
def curve(pair):
    factors = [0.24, 0.3, 1.0, 2.0, 3.0, np.inf]
    return ss.damper_curve(pair, slip_force=factors, common="factor", dof="1.tip", harmonics=15)


def jenkins_and_damper(slip_force=50.0):
    """Two models that are the same: a spring with a slider, as one law and as the other."""
    beam = reference.snecma_structure()
    forces = [ss.Force("1.tip", 40.0), ss.Force("2.tip", 30.0, phase=1.1)]
    body = SPRING * np.array([[1, -1], [-1, 1]])
    contacts = [
        ss.Jenkins(*ENDS, stiffness=SPRING, slip_force=slip_force),
        ss.StructuralDamper(ENDS, stiffness=body, slip_forces=[slip_force, np.inf]),
    ]
    structure = ss.join({"1": beam, "2": beam})
    return [ss.Model(structure, [contact], forces) for contact in contacts]


@pytest.mark.parametrize(
    "varied",
    [
        {"slip_force": [5.0, 20.0, 80.0, 300.0, np.inf]},
        {"slip_force": [0.1, 1.0, 6.0], "common": "factor"},
        {"stiffness": [0.2, 1.0, 5.0], "common": "factor"},
        {"level": [0.3, 1.0, 5.0]},
    ],
)
def test_curves_are_those_of_a_jenkins_element(varied):
    one, other = (
        ss.damper_curve(model, dof="1.tip", harmonics=9, **varied) for model in jenkins_and_damper()
    )
    assert other.arrays.solved.all()
    np.testing.assert_allclose(other.amplitude, one.amplitude, rtol=1e-10)
    np.testing.assert_allclose(other.omega, one.omega, rtol=1e-9)
    size = np.abs(one.sensitivity).max()
    np.testing.assert_allclose(other.sensitivity, one.sensitivity, rtol=1e-9, atol=1e-9 * size)


@pytest.mark.slow
@pytest.mark.parametrize(
    "varied", [{}, {"common": "factor"}, {"parameter": "stiffness", "common": "factor"}]
)
def test_optima_are_those_of_a_jenkins_element(varied):
    one, other = (
        ss.optimal_damper(model, dof="1.tip", harmonics=5, **varied)
        for model in jenkins_and_damper()
    )
    assert other.bounds == pytest.approx(one.bounds, rel=1e-9)
    assert other.value == pytest.approx(one.value, rel=1e-8)
    assert other.amplitude == pytest.approx(one.amplitude, rel=1e-10)
    if not varied:
        assert other.slip_force == other.value


def test_sensitivities_are_those_of_a_jenkins_element():
    omega = np.linspace(150.0, 240.0, 7)
    one, other = (
        ss.forced_response(model, omega, harmonics=9).sensitivity("1.tip")
        for model in jenkins_and_damper()
    )
    np.testing.assert_allclose(
        other[("structural", 0), "slip_force"], one["jenkins", "slip_force"], rtol=1e-9
    )
    np.testing.assert_allclose(
        other["structural", "stiffness"], SPRING * one["jenkins", "stiffness"], rtol=1e-9
    )
    assert (other[("structural", 1), "slip_force"] == 0.0).all()


@pytest.mark.parametrize("measure", ["half_range", "fundamental"])
def test_sensitivities_match_differences_while_three_points_slip(measure):
    strong = reference.damped_pair(550.0)
    omega = 540.0

    def solved(model):
        return ss.forced_response(model, [omega], harmonics=11)

    frf = solved(strong)
    assert (frf.slip_fraction("structural")[0, :3] > 0.0).all()
    slopes = frf.sensitivity("1.tip", measure=measure)
    limits = strong.contacts[0].slip_forces
    points = [("structural", point) for point in range(3)]
    chosen = {("structural", "stiffness"): 1.0}
    chosen |= {(point, "slip_force"): limits[point[1]] for point in points}
    assert slopes.keys() == {*chosen, (("structural", 3), "slip_force")}
    step = 1e-5
    for (place, parameter), own in chosen.items():
        varied = Variation(parameter=parameter, contacts=(place,), common="factor")
        ahead, behind = (
            solved(varied.apply(strong, 1.0 + sign * step)).amplitude("1.tip", measure)[0]
            for sign in (1, -1)
        )
        difference = (ahead - behind) / (2.0 * step * own)
        exact = slopes[place, parameter]
        # the key is what one asks with
        assert frf.sensitivity("1.tip", place, parameter, measure) == exact
        assert exact[0] == pytest.approx(difference, rel=1e-5)
        assert abs(exact[0]) > 0.0
    together = frf.sensitivity("1.tip", "structural", "slip_force", measure)
    assert together == pytest.approx(sum(slopes[point, "slip_force"] for point in points))
    # amplitudes are homogeneous in the load and the limits together
    by_load = frf.sensitivity("1.tip", parameter="level", measure=measure)
    by_limits = sum(limits[point[1]] * slopes[point, "slip_force"] for point in points)
    assert by_load + by_limits == pytest.approx(frf.amplitude("1.tip", measure), rel=1e-10)


@pytest.mark.slow
def test_the_curve_of_the_pair_over_all_limits_is_that_of_sweeps_and_of_exact_orbits(pair, curve):
    assert curve.arrays.solved.all()
    low, high = curve.settings.span
    for index in (1, 2, 3):
        model = curve.model_at(curve.values[index])
        sweep = ss.forced_response(model, np.linspace(low, high, 200), harmonics=15)
        peak = sweep.peak("1.tip")
        assert peak.amplitude == pytest.approx(curve.amplitude[index], rel=1e-9)
        assert peak.omega == pytest.approx(curve.omega[index], abs=1e-4)
        exact = ss.exact_response(model, [peak.omega]).amplitude("1.tip")[0]
        assert abs(exact - peak.amplitude) <= curve.error_estimate[index] + 1e-9 * exact
    # F = 60 N of the errata
    assert curve.amplitude[2] == pytest.approx(6.9382e-5, rel=1e-4)
    assert curve.omega[2] == pytest.approx(531.04, abs=0.01)


@pytest.mark.slow
def test_the_curve_of_the_pair_ends_in_its_linear_limits(pair, curve):
    # beyond 60 / 21.797 of the limits nothing slips
    assert curve.amplitude[4] == pytest.approx(curve.amplitude[5], rel=1e-12)
    assert (curve.sensitivity[4:] == 0.0).all()
    assert curve.sensitivity[3] > 0.0 > curve.sensitivity[0]
    stuck = ss.forced_response(curve.model_at(np.inf), [curve.omega[5]], harmonics=1)
    assert curve.amplitude[5] == pytest.approx(stuck.amplitude("1.tip")[0], rel=1e-9)
    assert curve.model_at(2.0).contacts[0].slip_forces == (49.2, 200.0, 492.1, np.inf)
    assert any("structural[2]" in text and "times the factor" in text for text in curve.assumptions)
    curve.plot()
    frfs = [ss.forced_response(curve.model_at(factor), [531.0], harmonics=1) for factor in (1, 2)]
    told = [text.get_text() for text in ss.plot.curves(frfs, "1.tip").get_legend().get_texts()]
    assert "$F_d$ = 49.2, 200, 492.1, inf N" in told


@pytest.mark.slow
def test_the_best_factor_lies_where_two_resonances_are_equally_high(pair):
    best = ss.optimal_damper(
        pair, dof="1.tip", common="factor", bounds=(0.23, 0.27), harmonics=9, omega=(150.0, 570.0)
    )
    assert best.value == pytest.approx(0.2446, abs=5e-4)
    beside = [
        ss.forced_response(best.curve.model_at(factor), np.linspace(150, 570, 200), harmonics=9)
        for factor in (best.value * 0.98, best.value * 1.02)
    ]
    peaks = [frf.peak("1.tip") for frf in beside]
    assert min(peak.amplitude for peak in peaks) > 1.01 * best.amplitude
    assert abs(peaks[0].omega - peaks[1].omega) > 50.0
    with pytest.raises(ss.ModelError, match="have several"):
        _ = best.slip_force


@pytest.mark.slow
def test_one_point_and_all_points(pair, tmp_path):
    one = ss.damper_curve(
        pair, slip_force=[10.0, 50.0], contacts=("structural", 0), dof="1.tip", harmonics=3
    )
    assert one.model_at(10.0).contacts[0].slip_forces == (10.0, 100.0, 246.05, np.inf)
    listed = ss.damper_curve(
        pair, slip_force=[10.0], contacts=[("structural", 0)], dof="1.tip", harmonics=3
    )
    assert listed.amplitude[0] == one.amplitude[0]
    # a value for all is the same for all that can slip, as with Jenkins elements
    every = ss.damper_curve(pair, slip_force=[300.0], dof="1.tip", harmonics=3)
    assert every.model_at(50.0).contacts[0].slip_forces == (50.0, 50.0, 50.0, np.inf)
    assert any("have the same slip_force" in text for text in every.assumptions)
    last = ss.damper_curve(
        pair, slip_force=[300.0], contacts=[("structural", 3)], dof="1.tip", harmonics=3
    )
    assert last.model_at(50.0).contacts[0].slip_forces == (24.6, 100.0, 246.05, 50.0)

    one.save(tmp_path / "one.nc")
    read = ss.load(tmp_path / "one.nc")
    assert read.settings == one.settings
    assert read.settings.variation.contacts == (("structural", 0),)
    told = CliRunner().invoke(app, ["show", str(tmp_path / "one.nc")])
    assert told.exit_code == 0, told.output
    assert "slip_force of structural[0]" in told.output


def test_all_limits_infinite_are_those_that_are_varied():
    _, damper = jenkins_and_damper(np.inf)
    curve = ss.damper_curve(damper, slip_force=[20.0], dof="1.tip", harmonics=5)
    assert curve.model_at(20.0).contacts[0].slip_forces == (20.0, 20.0)


def test_both_laws_in_one_model(pair):
    spring = ss.Jenkins("1.mode", stiffness=1e5, slip_force=10.0)
    both = pair.replaced(contacts=[spring, *pair.contacts])
    names = [
        ss.damper_curve(both, dof="1.tip", harmonics=3, **varied).settings.variation.names
        for varied in (
            {"slip_force": [1.0], "common": "factor"},
            {"stiffness": [1.0], "common": "factor"},
            {"stiffness": [1e5]},  # a matrix takes no value
        )
    ]
    points = tuple(f"structural[{point}]" for point in range(3))
    assert names == [("jenkins", *points), ("jenkins", "structural"), ("jenkins",)]
    frf = ss.forced_response(both, [531.0], harmonics=3)
    with pytest.raises(ss.ModelError, match="'stiffness' is a factor on a matrix in 'structural'"):
        frf.sensitivity("1.tip", parameter="stiffness")


@pytest.mark.parametrize(
    ("varied", "message"),
    [
        ({"stiffness": [1e6]}, 'takes no value; common="factor"'),
        ({"stiffness": [1e6], "contacts": "structural"}, 'takes no value; common="factor"'),
        (
            {"stiffness": [2.0], "common": "factor", "contacts": ("structural", 0)},
            "that of the whole contact",
        ),
        ({"slip_force": [1.0], "contacts": ("structural", 4)}, "has 4, at 0 to 3"),
        ({"slip_force": [1.0], "contacts": ("structur", 0)}, "did you mean 'structural'"),
        (
            {"slip_force": [1.0], "contacts": ["structural", ("structural", 1)]},
            "more than once in 'structural[0]'",
        ),
        ({"slip_force": [1.0], "contacts": [("structural", 0, 1)]}, "write (contact, point)"),
        ({"stiffness": [np.inf], "common": "factor"}, "infinite factor"),
    ],
)
def test_what_cannot_be_varied_is_named(pair, varied, message):
    with pytest.raises(ss.ModelError) as caught:
        ss.damper_curve(pair, dof="1.tip", **varied)
    assert message in str(caught.value)


def test_sensitivities_in_what_is_not_there_are_refused(pair):
    frf = ss.forced_response(pair, [531.0], harmonics=3)
    for place, parameter, message in (
        (("structural", 0), "stiffness", "known: 'slip_force'"),
        (("structural", 9), "slip_force", "at 0 to 3"),
        ("structural", "mass", "known: 'stiffness', 'slip_force'"),
    ):
        with pytest.raises(ss.ModelError) as caught:
            frf.sensitivity("1.tip", place, parameter)
        assert message in str(caught.value)


@pytest.fixture(scope="module")
def fluttering():
    """The same two models without loads and damping, and their negative damping."""
    models = jenkins_and_damper(60.0)
    structure = models[0].structure
    bare = ss.Structure(structure.mass, structure.stiffness, None, structure.dofs)
    negative = reference.negative_damping(structure)
    return [ss.Model(bare, model.contacts, []) for model in models], negative


@pytest.mark.slow
@pytest.mark.parametrize(
    "followed",
    [
        {"slip_force": [30.0, 60.0, 90.0]},
        {"slip_force": [0.5, 1.5], "common": "factor"},
        {"stiffness": [0.9, 1.1], "common": "factor"},
    ],
)
def test_limit_cycles_along_a_parameter_are_those_of_a_jenkins_element(fluttering, followed):
    models, negative = fluttering
    one, other = (
        ss.limit_cycles(
            model, negative, mode=1, ratio=3.0, harmonics=5, stability=False, **followed
        )
        for model in models
    )
    assert one.values.size >= 2
    np.testing.assert_array_equal(other.values, one.values)
    np.testing.assert_allclose(other.omega, one.omega, rtol=1e-9)
    np.testing.assert_allclose(other.amplitude("1.tip"), one.amplitude("1.tip"), rtol=1e-9)


def test_limit_cycles_from_what_never_slips_say_so(fluttering, pair):
    (_, damper), negative = fluttering

    def cycles(model, **followed):
        return ss.limit_cycles(
            model, negative, mode=1, ratio=3.0, harmonics=5, stability=False, **followed
        )

    with pytest.raises(ss.ModelError, match="never slip"):
        cycles(damper, slip_force=[30.0], contacts=("structural", 1))
    with pytest.raises(ss.ModelError, match="follow a factor"):
        cycles(damper.replaced(contacts=pair.contacts), slip_force=[30.0])
    with pytest.raises(ss.ModelError, match="takes no value"):
        cycles(damper, stiffness=[1e6])


def test_disks_with_either_law_are_the_same():
    springs = ss.Jenkins("damper", "next.damper", stiffness=SPRING, slip_force=30.0)
    body = ss.StructuralDamper(
        ["damper", "next.damper"],
        stiffness=SPRING * np.array([[1, -1], [-1, 1]]),
        slip_forces=[30.0, np.inf],
    )
    disks = [
        ss.BladedDisk(
            reference.snecma_structure(),
            sectors=5,
            couplings=[ss.Coupling("tip", stiffness=1e5)],
            contacts=[contact],
            forces=[ss.Force("tip", 20.0)],
            engine_order=1,
        )
        for contact in (springs, body)
    ]
    one, other = (
        ss.damper_curve(disk, slip_force=[10.0, 100.0], dof="tip", harmonics=5) for disk in disks
    )
    np.testing.assert_allclose(other.amplitude, one.amplitude, rtol=1e-9)
    np.testing.assert_allclose(other.sensitivity, one.sensitivity, rtol=1e-8)
    one, other = (
        ss.mistuning_study(
            disk, deviation=0.05, patterns=2, omega=(140, 230), seed=1, harmonics=3
        ).factors("tip")
        for disk in disks
    )
    np.testing.assert_allclose(other, one, rtol=1e-7)
