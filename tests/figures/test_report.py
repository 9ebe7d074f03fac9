"""Reports: what stands on the page, and how a new kind of result joins."""

import json
import re
import sys
from itertools import pairwise
from types import ModuleType
from typing import ClassVar

import numpy as np
import pytest
from scipy import stats

import stickslip as ss
from packed import numbers
from report_page import Page
from stickslip.results.diagnostic import diagnostic
from stickslip.results.result import Result
from stickslip.views import kinds
from stickslip.views.kinds import View
from stickslip.views.tables import tabulated

BEAM = ss.reference.snecma_beam(20.313)
FLUTTER = ss.destabilised(ss.reference.single_dof(), ss.Rayleigh(mass=-20.0))
LOAD = ss.Force("tip", 20.0, harmonic=0)


def names_of(figure):
    return [trace["name"] for trace in figure["data"] if trace["showlegend"]]


@pytest.fixture(scope="module")
def results():
    grid = np.linspace(150.0, 250.0, 24)
    disk = ss.reference.beam_ring()
    mistuned = disk.mistuned(0.05 * ss.mistuning_pattern(disk.sectors, 1.0, seed=1))
    forces = np.geomspace(10.0, 1e3, 8)
    measured = ss.forced_response(BEAM, grid, 1).amplitude("tip")
    return {
        "low": ss.forced_response(ss.reference.snecma_beam(6.563), grid, 5),
        "high": ss.certify(ss.forced_response(BEAM, grid, 5), 3),
        "griffin": ss.single_harmonic(BEAM, grid),
        "exact": ss.exact_response(BEAM, grid),
        "transient": ss.transient(BEAM, 170.0, 12, keep=3, samples=32),
        "curve": ss.damper_curve(BEAM, slip_force=forces, dof="tip"),
        "optimum": ss.optimal_damper(BEAM, dof="tip", bounds=(50.0, 1e3)),
        "tuned": ss.forced_response(disk, grid, 3),
        "mistuned": ss.forced_response(mistuned, grid[::4], 3),
        "patterns": ss.mistuning_study(
            disk, 0.05, patterns=12, omega=(180.0, 230.0), dofs=["damper"], harmonics=1
        ),
        "branch": ss.limit_cycles(*ss.reference.flutter_mass(), harmonics=5),
        "boundary": ss.stability_map(*ss.reference.flutter_mass(), stiffness=[1.2e7, 2.4e7]),
        "settled": ss.classify(FLUTTER, {"mass": 5e-5}),
        "starts": ss.basin_map(FLUTTER, {"mass": [1e-5, 1e-4], 0: [2e-5, 2e-4]}),
        "fitted": ss.fit(
            BEAM,
            ss.Measurement(grid, "tip", measured, relative_noise=0.02),
            parameters={"slip_force": (10.0, 1e3)},
            harmonics=1,
        ),
        "backbone": ss.nonlinear_modes(BEAM, amplitude=np.geomspace(1e-4, 1e-2, 5), harmonics=3),
        "uncertain": ss.uncertainty(
            BEAM,
            {"slip_force": stats.uniform(200.0, 100.0)},
            ss.HighestPeak("tip", omega=(100.0, 300.0)),
            samples=20,
            harmonics=1,
        ),
        "waves": ss.flutter_map(
            ss.reference.beam_ring(sectors=4), ss.AerodynamicDamping(ratio=[-0.01] * 4), harmonics=1
        ),
        "levels": ss.sweep(
            BEAM, lambda model: ss.forced_response(model, grid[::4], 3), slip_force=[100.0, 300.0]
        ),
        "turning": ss.campbell(ss.reference.laxalde_blisk(), speed=[100.0, 400.0], orders=[2, 4]),
        "revolving": ss.speed_response(
            ss.reference.laxalde_blisk(), [250.0, 300.0, 350.0], dof="tip", harmonics=1
        ),
        "rest": ss.static_response(ss.Model(BEAM.structure, BEAM.contacts, [LOAD])),
    }


@pytest.fixture(scope="module")
def page(results, tmp_path_factory):
    file = tmp_path_factory.mktemp("report") / "all.html"
    ss.report(results, file, title="All kinds", length_unit="um")
    return Page(file)


# ---------------------------------------------------------------------------------- the page


@pytest.mark.slow
def test_every_kind_is_there(results, page):
    assert {result.kind for result in results.values()} == set(kinds.VIEWS)
    for name in results:
        assert name in page.texts
    assert page.texts[0] == "All kinds"
    assert "No figure" not in page.text
    assert not any(tag == "img" for tag, _ in page.tags)


@pytest.mark.slow
def test_the_page_is_well_formed(page):
    assert dict(page.tags)["html"] == {"lang": "en"}
    assert len(page.ids) == len(set(page.ids))
    assert {link.removeprefix("#") for link in page.links} <= set(page.ids)
    levels = [int(tag[1]) for tag, _ in page.tags if re.fullmatch("h[1-6]", tag)]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(later - before <= 1 for before, later in pairwise(levels))
    assert len(page.captions) == sum(tag == "table" for tag, _ in page.tags)
    assert all(page.captions)
    described = [given for tag, given in page.tags if given.get("class") == "plot"]
    assert len(described) == len(page.figures) > 20
    assert all(given["aria-label"] for given in described)


def test_nothing_is_fetched(page):
    assert not any("src" in given for tag, given in page.tags if tag != "img")
    assert not any(tag == "link" for tag, _ in page.tags)
    (policy,) = [given["content"] for tag, given in page.tags if "http-equiv" in given]
    assert policy.startswith("default-src 'none';")
    assert "http" not in policy


def test_results_of_one_kind_and_the_same_dofs_are_drawn_together(page):
    first = page.figures[0]
    # Names of the page, by which its tables and sections call the results, then what differs.
    assert [name for name in names_of(first) if "P = " in name] == [
        "low: P = 6.563 N, H = 5",
        "high: P = 20.313 N, H = 5",
        "griffin: P = 20.313 N, H = 1",
        "exact: P = 20.313 N, exact",
    ]
    assert first["layout"]["yaxis"]["title"]["text"] == "half peak-to-peak of tip [µm]"
    assert page.texts.count("Forced response and Exact response") == 2


def test_numbers_are_those_of_the_results(results, page):
    peak = results["high"].peak("tip")
    assert f"{1e6 * peak.amplitude:#.5g}" in page.texts
    assert f"{results['optimum'].value:.6g}" in page.texts
    stuck = ss.natural_frequencies(BEAM)
    free = ss.natural_frequencies(BEAM, slipping=[0])
    for omega in (*stuck, *free):
        assert f"{omega:#.6g}" in page.texts
    assert "Rayleigh, C = 7.49/s M + 2.6e-05 s K" in page.texts
    assert "3: damper, tip, mode" in page.texts
    assert "24 converged" in page.texts


def test_all_that_is_assumed_and_in_doubt_is_said(results, page):
    for result in results.values():
        for line in result.assumptions:
            assert " ".join(line.split()) in page.texts
    assert "In doubt:" in page.texts
    assert "largest true error, against exact orbits" in page.captions
    assert ss.__version__ in page.texts


@pytest.mark.slow
def test_curves_are_those_of_the_picture(results, tmp_path):
    frf = results["high"]
    ss.report(frf, tmp_path / "a.html", dofs="tip", omega_unit="Hz")
    figure = Page(tmp_path / "a.html").figures[0]
    traces = {trace.get("name"): trace for trace in figure["data"]}
    curve = traces["P = 20.313 N"]
    np.testing.assert_allclose(numbers(curve["x"]), frf.omega / (2 * np.pi), rtol=1e-12)
    np.testing.assert_allclose(numbers(curve["y"]), 1e3 * frf.amplitude("tip"), rtol=1e-12)
    assert figure["layout"]["yaxis"]["title"]["text"].endswith("[mm]")
    low, high = figure["layout"]["yaxis"]["range"]
    assert 10**low < 1e3 * frf.amplitude("tip").min() < 1e3 * frf.amplitude("tip").max() < 10**high
    assert figure["layout"]["xaxis"]["title"]["text"] == "frequency [Hz]"
    assert figure["layout"]["yaxis"]["type"] == "log"
    dashes = {name: traces[name]["line"]["dash"] for name in ("stuck (linear)", "free (linear)")}
    assert len({"solid", curve["line"]["dash"], *dashes.values()}) == 3


@pytest.mark.slow
def test_marks_go_with_the_curve_of_their_colour(results, tmp_path):
    pair = {name: results[name] for name in ("low", "griffin")}
    ss.report(pair, tmp_path / "a.html", dofs=["tip"])
    data = Page(tmp_path / "a.html").figures[0]["data"]
    marks = [trace for trace in data if not trace["showlegend"] and trace["mode"] == "markers"]
    assert len(marks) == 2
    curves = {trace["name"]: trace for trace in data if trace["showlegend"]}
    for mark in marks:
        assert curves[mark["name"]]["legendgroup"] == mark["legendgroup"]


def test_points_that_failed_are_said_and_marked(tmp_path):
    # far fewer iterations than the friction needs
    frf = ss.forced_response(BEAM, [150.0, 180.0, 190.0, 200.0], 9, max_iterations=1)
    failed = int((~frf.arrays.solved).sum())
    assert 0 < failed < 4
    ss.report(frf, tmp_path / "a.html", dofs="tip")
    page = Page(tmp_path / "a.html")
    assert "Failed:" in page.texts
    assert f"{4 - failed} converged, {failed} stalled" in page.text
    assert f"{failed} not solved" in names_of(page.figures[0])


def test_a_curve_without_any_solution_still_has_a_report(tmp_path):
    frf = ss.forced_response(BEAM, [185.0, 190.0], 9, max_iterations=1)
    assert not frf.arrays.solved.any()
    ss.report(frf, tmp_path / "a.html")
    assert "2 stalled" in Page(tmp_path / "a.html").texts


# ---------------------------------------------------------------------------------- hostile names

BAD = ["<script>window.hacked = 1</script>", '"><img src=x onerror="hacked=1">', "</script>&amp;"]


@pytest.fixture(scope="module")
def hostile():
    beam = BEAM.structure
    structure = ss.Structure(beam.mass, beam.stiffness, beam.damping, BAD)
    contact = ss.Jenkins(BAD[0], stiffness=2.4e7, slip_force=246.0, name="<b onclick=x>damper")
    return ss.Model(structure, [contact], [ss.Force(BAD[1], 20.0)])


@pytest.mark.slow
def test_names_are_texts_only(hostile, tmp_path):
    grid = [150.0, 190.0, 230.0]
    given = {
        "<i>one</i>": ss.forced_response(hostile, grid, 3),
        "two": ss.transient(hostile, 170.0, 3),
        "three": ss.damper_curve(hostile, slip_force=[10.0, 100.0], dof=BAD[0]),
    }
    ss.report(given, tmp_path / "a.html", title="</title><script>hacked=1</script>", dofs=BAD)
    page = Page(tmp_path / "a.html")
    scripts = [given for tag, given in page.tags if tag == "script"]
    assert len(scripts) == len(page.figures) + 2
    assert not any(tag in ("img", "i", "b") for tag, _ in page.tags)
    assert "<i>one</i>" in page.texts
    assert BAD[1] in page.texts
    labels = json.dumps(page.figures)
    assert "<script" not in labels
    assert "&lt;script&gt;" in labels


# ---------------------------------------------------------------------------------- a new kind


class Branch(Result):
    kind: ClassVar[str] = "branch"

    def record(self, *, derived=True):
        pytest.fail("a report writes no file")

    @classmethod
    def from_dataset(cls, dataset, model):
        pytest.fail("a report reads no file")


BRANCH = Branch(
    model=BEAM,
    dofs=("tip",),
    interrupted=False,
    timings={},
    counters={},
    diagnostics=(diagnostic("text", "None."),),
)


def test_an_unknown_kind_is_refused_with_the_known_ones(tmp_path):
    with pytest.raises(ss.ModelError, match="nothing is known to show of a branch; known: forced"):
        ss.report(BRANCH, tmp_path / "a.html")


def test_a_new_kind_joins_with_its_view(tmp_path, monkeypatch):
    class BranchView(View):
        def rows(self, result, dofs, length):
            return [("1.25",)]

        def tables(self, results, label, dofs, length_unit):
            rows = [("", row) for row in self.rows(results[0][1], dofs, 1.0)]
            table = tabulated("", (), ("ratio",), (), rows)
            table.title = "turning points"
            return [table]

        def panels(self, results, dofs, output):
            return [lambda *, ax: ax.plot([1, 2], [3, 4], label="sticking")]

        def facts(self, result):
            return [("branches", "2"), ("assumed", "None.")]

        def failures(self, result):
            return ["turned back"]

    module = ModuleType("branch_view")
    module.BranchView = BranchView
    monkeypatch.setitem(sys.modules, "branch_view", module)
    monkeypatch.setitem(kinds.VIEWS, "branch", ("branch_view", "BranchView"))
    ss.report({"lco": BRANCH}, tmp_path / "a.html")
    page = Page(tmp_path / "a.html")
    assert "turning points" in page.captions
    assert {"ratio", "1.25", "branches", "turned back", "Branch", "None."} <= set(page.texts)
    assert len(page.figures) == 1


@pytest.mark.parametrize("dofs", [-1, 3.5, object(), np.zeros((2, 2)), [None], b"tip", ["tip", 3]])
def test_dofs_that_are_no_names_are_refused_in_one_line(dofs, tmp_path):
    frf = ss.forced_response(BEAM, [170.0], 1)
    with pytest.raises(ss.ModelError, match=r"^dofs: ") as refused:
        ss.report(frf, tmp_path / "a.html", dofs=dofs)
    assert "\n" not in str(refused.value)


# ---------------------------------------------------------------------------------- several results


@pytest.mark.parametrize("kind", ["curve", "transient", "boundary", "fitted", "levels"])
def test_figures_of_one_result_have_its_name(results, kind, tmp_path):
    ss.report({"this": results[kind], "that": results[kind]}, tmp_path / "a.html")
    titles = [one["layout"]["title"]["text"] for one in Page(tmp_path / "a.html").figures]
    assert titles[0].startswith("this")
    assert any(title.startswith("that") for title in titles)


@pytest.mark.parametrize("kind", ["low", "exact", "branch", "backbone", "revolving"])
def test_curves_of_one_figure_have_the_names_of_their_results(results, kind, tmp_path):
    ss.report({"this": results[kind], "that": results[kind]}, tmp_path / "a.html")
    assert {"this", "that"} <= set(names_of(Page(tmp_path / "a.html").figures[0]))


def test_a_motion_without_a_picture_costs_no_other_result(results, tmp_path):
    decays = ss.classify(ss.reference.single_dof(), {"mass": 5e-5})
    ss.report({"decays": decays, "settled": results["settled"]}, tmp_path / "a.html")
    assert len(Page(tmp_path / "a.html").figures) == 1
    ss.report({"decays": decays, "curve": results["curve"]}, tmp_path / "b.html")
    page = Page(tmp_path / "b.html")
    assert "No figure: motion: one that decays or grows for ever has no picture" in page.text
    assert len(page.figures) == 1


def test_a_part_of_a_run_says_that_it_is_one(results, tmp_path):
    def stop(share):
        if share > 0.2:
            raise KeyboardInterrupt

    with pytest.raises(ss.Interrupted) as stopped:
        ss.damper_curve(BEAM, slip_force=np.geomspace(1.0, 1e4, 300), dof="tip", progress=stop)
    with pytest.raises(ss.Interrupted) as early:
        ss.transient(BEAM, 170.0, 4000, progress=stop)
    ss.report([stopped.value.result, early.value.result], tmp_path / "a.html")
    page = Page(tmp_path / "a.html")
    assert page.texts.count("The run was interrupted: this is what it had computed.") == 2
    assert "interrupted, interrupted" not in page.text
    assert "Run the analysis again for what is missing." in page.text


def test_what_an_optimum_changes_is_told_from_what_was_given(results, tmp_path):
    ss.report(results["optimum"], tmp_path / "a.html")
    page = Page(tmp_path / "a.html")
    given = "jenkins: jenkins at damper, stiffness 2.4e+07, slip_force 246.048"
    assert page.texts[page.texts.index(given) - 1] == "contact as given"


def test_effort_names_everything_once(results, tmp_path):
    ss.report(results["low"], tmp_path / "a.html")
    assert Page(tmp_path / "a.html").texts.count("iterations") == 1


def test_what_is_in_doubt_is_said_once(results, tmp_path):
    (doubt,) = (one.text for one in results["low"].diagnostics if one.severity == "caution")
    ss.report(results["low"], tmp_path / "a.html")
    assert Page(tmp_path / "a.html").texts.count(doubt) == 1


@pytest.mark.slow
def test_tables_say_what_their_numbers_are(page):
    # relative where others have a length, and no length of a degree of freedom
    assert page.texts.count("rel. error") == 2
    assert "amplitude [m kg^1/2]" in page.texts
