"""Sweeps along a parameter: one result that knows it, in Python and in study files."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib import pyplot

import stickslip as ss
from stickslip.reference import snecma_beam
from stickslip.study import Study
from stickslip.views.kinds import view_of
from swept_study import GRID, STUDY, curve


@pytest.fixture(scope="module")
def swept():
    return ss.sweep(snecma_beam(), curve, slip_force=["50 N", "0.2 kN", 400.0])


def test_every_member_is_the_analysis_of_its_model(swept):
    np.testing.assert_array_equal(swept.values, [50.0, 200.0, 400.0])
    assert (swept.parameter, swept.unit) == ("slip_force", "N")
    for value, one in zip(swept.values, swept.results, strict=True):
        beam = snecma_beam()
        (contact,) = beam.contacts
        own = beam.replaced(contacts=[contact.adjusted("slip_force", [value])])
        np.testing.assert_array_equal(one.amplitude("tip"), curve(own).amplitude("tip"))
    assert swept.at(210.0) is swept.results[1]


def test_the_parameter_is_a_dimension(swept):
    data = swept.to_dataset()
    assert data["amplitude"].dims == ("slip_force", "omega", "dof")
    assert data["slip_force"].attrs["units"] == "N"
    found = data["amplitude"].sel(slip_force=200.0, dof="tip")
    np.testing.assert_array_equal(found, swept.results[1].amplitude("tip"))


def test_frequencies_of_their_own_stand_side_by_side():
    both = ss.sweep(snecma_beam(), lambda one: ss.forced_response(one, (180, 195)), level=[0.3, 1])
    data = both.to_dataset()
    assert data["amplitude"].dims == ("level", "position", "dof")
    for place, one in enumerate(both.results):
        known = np.isfinite(data["omega"][place])
        np.testing.assert_array_equal(data["omega"][place][known], one.omega)
        np.testing.assert_array_equal(
            data["amplitude"][place][known].sel(dof="tip"), one.amplitude("tip")
        )


@pytest.mark.parametrize(
    ("analysis", "along"),
    [
        (lambda one: ss.exact_response(one, [150.0, 170.0, 200.0]), "position"),
        (lambda one: ss.forced_response(one, (170, 195), 3), "position"),
        (lambda one: ss.nonlinear_modes(one, amplitude=(1e-4, 1e-2), harmonics=3), "mode_point"),
        (lambda one: ss.transient(one, omega=170.0, periods=3), "period"),
    ],
)
def test_shorter_results_are_filled_up(analysis, along, tmp_path):
    both = ss.sweep(snecma_beam(), analysis, slip_force=[100.0, 246.0])
    data, members = both.to_dataset(), [one.to_dataset() for one in both.results]
    assert along in data.sizes
    sizes = [{dim: one.sizes[dim] for dim in one.dims} for one in members]
    assert sizes[0] != sizes[1]
    for place, one in enumerate(members):
        assert not one.data_vars.keys() - data.data_vars.keys()
        for name, variable in one.data_vars.items():
            found = data[name][place].values
            own = tuple(slice(size) for size in variable.shape)
            np.testing.assert_array_equal(found[own], variable.values)
            if found.dtype.kind in "fc":
                found[own] = np.nan
                assert np.isnan(found).all()
    both.export(tmp_path / "both.mat")


@pytest.mark.parametrize(
    "analysis",
    [
        curve,
        lambda one: ss.exact_response(one, GRID[:3]),
        lambda one: ss.damper_curve(one, dof="tip", level=[0.5, 1.0], harmonics=3),
        lambda one: ss.nonlinear_modes(one, mode=0, amplitude=[1e-4, 1e-3], harmonics=3),
        lambda one: ss.static_response(one),
    ],
)
def test_round_trip(analysis, tmp_path):
    made = ss.sweep(snecma_beam(), analysis, slip_force=[100.0, 300.0])
    made.save(tmp_path / "it.nc")
    again = ss.load(tmp_path / "it.nc")
    assert isinstance(again, ss.Sweep)
    assert again.settings == made.settings
    assert again.diagnostics == made.diagnostics
    for one, other in zip(made.results, again.results, strict=True):
        assert type(one) is type(other)
        assert one.to_dataset().identical(other.to_dataset())
        assert one.model.contacts == other.model.contacts


def test_what_is_said_of_several_results_is_said_once():
    def analysis(model):
        # Stuck contacts need one harmonic, and no more.
        return ss.nonlinear_modes(model, amplitude=[1e-6], harmonics=3)

    made = ss.sweep(snecma_beam(), analysis, slip_force=[100.0, 200.0, 300.0])
    own = [[(one.code, dict(one.data)) for one in member.diagnostics] for member in made.results]
    assert own[0] == own[1] == own[2]
    assert len(made.diagnostics) == len(own[0])
    for one in made.diagnostics:
        assert one.data["results"] == 3
        assert one.text.endswith("(all 3 results)")
    springs = ss.sweep(snecma_beam(), analysis, stiffness=[1e7, 2e7])
    at_rest = [one for one in springs.diagnostics if one.code == "mode-at-rest"]
    assert [one.data["results"] for one in at_rest] == [1, 1]
    assert at_rest[0].text.endswith("(1 of 2 results)")
    assert at_rest[0].text.endswith("At 1e+07 N/m (1 of 2 results)")


def test_facts_that_differ_stand_with_their_value():
    def ranged(model):
        return ss.forced_response(model, (100, 300), 3)

    made = ss.sweep(snecma_beam(), ranged, level=[0.01, 1])
    facts = view_of([made]).facts(made)
    points = [said for what, said in facts if what == "points"]
    counts = [one.omega.size for one in made.results]
    assert counts[0] != counts[1]
    for said, value, count in zip(points, ("0.01", "1"), counts, strict=True):
        assert said.startswith(f"{value}: {count} from 100 to 300 rad/s")
    assert [said for what, said in facts if what == "harmonics"]


def test_sums_of_degrees_of_freedom_are_named_once():
    wedge = ss.WedgeDamper(
        angle=30.0,
        mass=0.1,
        friction=0.5,
        tangential_stiffness=3e5,
        normal_stiffness=3e5,
        load=120.0,
    )
    blade = ss.Structure(np.eye(2), 1e5 * np.eye(2), dofs=["x", "y"])
    model = wedge.between(blade, blade, left_dofs=["x", "y"], right_dofs=["x", "y"])
    static = ss.static_response(model)
    (left, _) = [said for what, said in view_of([static]).facts(static) if what == "contact"]
    assert left.startswith("left: coulomb at damper.x, damper.y, left.x, left.y, friction 0.5")


def test_it_draws_a_family(swept):
    axes = swept.plot("tip")
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    assert names[-3:] == ["slip force = 50 N", "slip force = 200 N", "slip force = 400 N"]


def test_speed_makes_the_model():
    def blade(speed):
        structure = ss.Structure([[1.0]], [[1e4 + 0.5 * speed**2]], ss.ModalDamping(0.01), ["tip"])
        return ss.Model(structure, forces=[ss.Force("tip", 1.0)])

    found = ss.sweep(
        blade, lambda one: ss.forced_response(one, (50, 400)), speed=["600 rpm", "3000 rpm"]
    )
    tops = [one.peak("tip").omega for one in found.results]
    stiffness = 1e4 + 0.5 * np.array([20 * np.pi, 100 * np.pi]) ** 2
    np.testing.assert_allclose(tops, np.sqrt(stiffness), rtol=1e-3)
    assert found.labels == ("speed = 600 rpm", "speed = 3000 rpm")
    assert found.at("3000 rpm") is found.at(300.0) is found.results[1]
    with pytest.raises(ss.ModelError, match="3000 lies outside the sweep, whose nearest is"):
        found.at(3000)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ss.sweep(snecma_beam(), curve), "none is given; give exactly one"),
        (lambda: ss.sweep(snecma_beam(), curve, slip_force=[1], level=[1]), "are given; give"),
        (lambda: ss.sweep(snecma_beam(), curve, slip_force=["1 m"]), "'1 m' is not a force"),
        (lambda: ss.sweep(snecma_beam(), curve, preload=[1]), "none of the model has a preload"),
        (lambda: ss.sweep(snecma_beam(), 3, level=[1]), "analysis: 3 cannot be called"),
        (lambda: ss.sweep(snecma_beam(), str, level=[1]), "analysis: it returned"),
        (lambda: ss.sweep(snecma_beam(), curve, speed=[1]), "give a function of the speed"),
        (lambda: ss.sweep(lambda w: 1, curve, speed=[1]), "models: it returned 1, no Model"),
        (lambda: ss.sweep(lambda w: 1, curve, level=[1]), "give a Model"),
    ],
)  # fmt: skip
def test_refusals(call, message):
    with pytest.raises(ss.ModelError, match=message):
        call()


@pytest.mark.parametrize(
    ("table", "parameter", "values"),
    [
        ('slip_force = ["1 N", 3]', "slip_force", [1.0, 3.0]),
        ("level = [0.5, 2]", "level", [0.5, 2.0]),
        ('stiffness = { from = "100 N/mm", to = "1 kN/mm", points = 2 }', "stiffness", [1e5, 1e6]),
        ('slip_force = [0.5, 2]\ncommon = "factor"', "slip_force", [0.5, 2.0]),
        ('speed = ["600 rpm", "1200 rpm"]', "speed", [20 * np.pi, 40 * np.pi]),
    ],
)
def test_a_study_computes_one_result(table, parameter, values):
    names = 'dofs = ["root", "tip"]\n'
    spinning = STUDY.replace(names, f"{names}stiffening = [[1, 0], [0, 1]]\n")
    study = Study.parse(f"{spinning}[sweep]\n{table}")
    (result,) = study.run()
    assert isinstance(result, ss.Sweep)
    assert result.parameter == parameter
    np.testing.assert_allclose(result.values, values)
    stiffness = [one.model.structure.stiffness[0, 0] for one in result.results]
    added = np.square(values) if parameter == "speed" else [0.0, 0.0]
    np.testing.assert_allclose(np.array(stiffness) - 3e6, added, atol=1e-6)
    (tabled,) = view_of([result]).tables([("", result)], "", ["tip"], "auto")
    assert tabled.row_count == 2


def test_levels_times_sweep():
    study = Study.parse(
        STUDY.replace("harmonics = 5", "harmonics = 5\nlevels = [1, 2]")
        + "[sweep]\nslip_force = [1, 3]"
    )
    low, high = study.run()
    assert high.results[1].model.forces[0].amplitude == 2.0
    assert low.results[1].model.contacts[0].slip_force == 3.0


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("slip_force = ['1 kg']", r"sweep: slip_force\[1\] = '1 kg' is not a force"),
        ("slipforce = [1]", "sweep: unknown key 'slipforce'; did you mean 'slip_force'"),
        ("", "sweep: .*none is given; give exactly one of them"),
        ("slip_force = {from = 1, to = 3}", "slip_force: a range needs 'points'"),
        ("preload = [3]", "none of the model has a preload"),
    ],
)
def test_nonsense_in_a_study_is_named(table, message):
    with pytest.raises(ss.ModelError, match=message):
        list(Study.parse(STUDY + f"[sweep]\n{table}").run())


@pytest.mark.slow
def test_run_saves_one_file(tmp_path, monkeypatch):
    from typer.testing import CliRunner

    from stickslip.cli import application

    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(f'name = "s"\n{STUDY}[sweep]\nslip_force = [1, 3]')
    done = CliRunner().invoke(application.app, ["run", "study.toml"])
    assert done.exit_code == 0, done.output
    assert sorted(one.name for one in Path("results").iterdir()) == ["s.nc", "s.png"]
    assert "1 N" in done.output


@pytest.mark.slow
def test_reports_draw_the_family(swept, tmp_path):
    from report_page import Page

    ss.report(swept, tmp_path / "a.html", dofs="tip")
    (figure, *_) = Page(tmp_path / "a.html").figures
    names = {trace.get("name") for trace in figure["data"]}
    assert {"slip force = 50 N", "slip force = 200 N", "slip force = 400 N"} <= names


def test_slip_forces_that_are_friction_times_load_follow_the_load(tmp_path):
    text = STUDY.replace('slip_force = "3 N"', 'friction = "30 %"\nnormal_load = "10 N"')
    (loads,) = Study.parse(text + '[sweep]\nnormal_load = ["5 N", "0.02 kN"]\n').run()
    assert (loads.parameter, loads.unit, loads.written) == ("normal_load", "N", ("5 N", "20 N"))
    assert [one.model.contacts[0].slip_force for one in loads.results] == [1.5, 6.0]
    (forces,) = Study.parse(STUDY + "[sweep]\nslip_force = [1.5, 6.0]\n").run()
    for one, other in zip(loads.results, forces.results, strict=True):
        np.testing.assert_array_equal(one.amplitude("tip"), other.amplitude("tip"))
    # A file keeps what the slip force was made of.
    loads.save(tmp_path / "a.nc")
    again = ss.load(tmp_path / "a.nc")
    assert again.settings.variation == loads.settings.variation
    contact = again.results[1].model.contacts[0]
    assert contact.variable() == {
        "stiffness": (5e5,),
        "slip_force": (6.0,),
        "friction": (0.3,),
        "normal_load": (20.0,),
    }
    assert contact.adjusted("stiffness", [1e5]).slip_force == 6.0
    assert contact.adjusted("friction", [0.5]).slip_force == 10.0
    assert "friction" not in contact.adjusted("slip_force", [7.0]).variable()


def test_friction_of_all_laws_is_swept_and_factors_multiply_loads():
    made = [
        ss.Jenkins(at, stiffness=1e4, friction=mu, normal_load=10.0, name=at)
        for at, mu in (("damper", 0.2), ("tip", 0.4))
    ]
    beam = snecma_beam()
    model = beam.replaced(contacts=made)

    def limits(swept):
        return [[one.slip_force for one in member.model.contacts] for member in swept.results]

    found = limits(ss.sweep(model, curve, normal_load=[0.5, 2.0], common="factor"))
    np.testing.assert_allclose(found, [[1.0, 2.0], [4.0, 8.0]])
    np.testing.assert_allclose(limits(ss.sweep(model, curve, friction=[0.5])), [[5.0, 5.0]])
    only = ss.sweep(model, curve, normal_load=[20.0], contacts="tip")
    np.testing.assert_allclose(limits(only), [[2.0, 8.0]])
    with pytest.raises(ss.ModelError, match="none of the model has a friction; they have 'stiff"):
        ss.damper_curve(model, friction=[0.5, 0.6], dof="tip")
    with pytest.raises(
        ss.ModelError, match="none of the model has a normal_load; they have 'stiff"
    ):
        ss.sweep(beam, curve, normal_load=[1.0])


def test_what_is_drawn_one_by_one_has_its_value_as_title():
    made = ss.sweep(snecma_beam(), lambda one: ss.transient(one, 170.0, 3), level=[0.5, 1.0])
    assert not made.drawn_together
    assert str(made).startswith("Sweep(2 values of level from 0.5 to 1, a Transient each)")
    output = Study.parse(STUDY).tables.output
    panels = view_of([made]).panels([made], ["tip"], output)
    titles = []
    for panel in panels:
        _, ax = pyplot.subplots()
        panel(ax=ax)
        titles.append(ax.get_title().partition(":")[0])
        pyplot.close()
    assert set(titles) == {"level = 0.5", "level = 1"}


def test_a_report_counts_the_points_of_all_results(swept):
    from stickslip.html.sections import _status

    assert _status(swept) == f"{3 * GRID.size} converged"


def test_a_sweep_of_the_speed_that_changes_nothing_is_refused():
    text = """
        [structure]
        mass = [[1.0]]
        stiffness = [[4e4]]
        dofs = ["x"]
        [[force]]
        dof = "x"
        amplitude = "20 N"
        [analysis]
        omega = [190.0]
        [sweep]
        speed = ["1000 rpm", "2000 rpm"]
    """
    with pytest.raises(ss.ModelError, match="speed: nothing in the study changes with the speed"):
        Study.parse(text)
