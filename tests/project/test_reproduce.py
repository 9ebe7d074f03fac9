"""Every reproduction at reduced resolution, with its key numbers; the catalogue and the command.

Numbers without a remark are those of exact orbits, computed independently of this package.
"""

import re
import runpy
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from beam_study import invoke
from key_numbers import KEY_NUMBERS
from stickslip.errors import ModelError
from stickslip_reproduce import (
    COARSE,
    SUBJECTS,
    Axis,
    Fact,
    Numbers,
    Panel,
    Plot,
    Series,
    Table,
    chosen,
    costs,
    heading,
    items,
    write,
)
from stickslip_reproduce.claims import claims
from stickslip_reproduce.curves import settled
from stickslip_reproduce.drawing import draw
from stickslip_reproduce.folder import records
from stickslip_reproduce.numbered import NUMBERED

pytestmark = pytest.mark.slow

DOCS = Path(__file__).parents[2] / "docs"
FUTURE_WORK = ("microslip", "normal-load", "two-directions", "wedge", "damper-mass")
ERROR = "error of the tip peak to exact [%]"


@cache
def computed(name):
    return items()[name].compute(COARSE)


@pytest.fixture(params=list(items()))
def name(request):
    return request.param


def test_key_numbers(name):
    for what, (value, tolerance) in KEY_NUMBERS[name].items():
        assert computed(name).fact(what) == pytest.approx(value, rel=tolerance), what


def test_numbers_are_complete_and_drawn(name, tmp_path):
    item, numbers = items()[name], computed(name)
    for panel in numbers.plot.panels:
        for series in panel.series:
            assert np.isfinite(series.y).all(), series.label
    assert all(np.isfinite(fact.value) for fact in numbers.facts)
    figure = draw(numbers.plot)
    for ax, panel in zip(figure.axes, numbers.plot.panels, strict=True):
        assert len(ax.lines) == len(panel.series)
    write(item, numbers, 0.5, COARSE, tmp_path)
    lines = (tmp_path / f"{name}.csv").read_text(encoding="utf-8").splitlines()
    points = sum(series.x.size for panel in numbers.plot.panels for series in panel.series)
    assert len(lines) - 1 == (len(numbers.table.rows) if numbers.table else points)
    assert records(tmp_path)[name]["resolution"] == "reduced"
    assert f"{name}.png" in (tmp_path / "index.html").read_text("utf-8")
    assert sorted(file.suffix for file in tmp_path.iterdir()) == [".csv", ".html", ".json", ".png"]


@pytest.mark.parametrize(
    ("model", "dof"),
    [(ss.reference.single_dof(2.0), "mass"), (ss.reference.snecma_beam(16.563), "damper")],
)
def test_settled_motion_is_the_exact_orbit(model, dof):
    omega = [66.0, 194.0, 250.0]
    displacement, damper = settled(model, omega, dof)
    exact = ss.exact_response(model, omega)
    np.testing.assert_allclose(displacement, exact.amplitude(dof), rtol=1e-4)
    np.testing.assert_allclose(damper, exact.damper_amplitude((0, 0)), rtol=1e-3)


def test_table_2_3_against_print_and_exact_orbits():
    table = computed("table-2.3").table
    assert len(table.rows) == 8 * 2 * 3
    rows = [dict(zip(table.columns, row, strict=True)) for row in table.rows]
    integrated = [row for row in rows if row["what"] == "time integration"]
    assert max(abs(row["ours to exact [%]"]) for row in integrated) < 0.003
    assert max(abs(row["ours to printed [%]"]) for row in integrated) < 1.1
    single = [row for row in rows if row["what"] == "single harmonic"]
    assert max(abs(row["ours to printed [%]"]) for row in single) < 0.7


def test_table_4_1_has_all_methods():
    table = computed("table-4.1").table
    methods = table.column("method")
    assert methods == ["Broyden", "Newton"] * 9 + [
        "exact orbits",
        "exact flow from rest",
        "Runge-Kutta",
    ]
    assert table.column("ours: Runge-Kutta takes [times]")[-1] == 1.0
    errors = dict(
        zip(zip(methods, table.column("H"), strict=True), table.column(ERROR), strict=True)
    )
    assert errors["Broyden", 15] == pytest.approx(errors["Newton", 15], abs=1e-6)
    assert abs(errors["Runge-Kutta", None]) < 0.01
    assert errors["Newton", 1] < -2.0


def test_blade_at_optimal_damping_against_exact_orbits_and_runge_kutta():
    for name in ("fig-4.12", "fig-4.13"):
        assert 0.0 < computed(name).fact("largest difference of Runge-Kutta to exact orbits") < 0.02
        of_nine = "largest difference of 9 harmonics to exact orbits, over the peak"
        assert 0.0 < computed(name).fact(of_nine) < 2.0


def test_curves_of_one_wave_are_those_of_all_beams():
    for name in ("fig-4.16", "fig-4.17"):
        assert computed(name).fact("largest difference between beams") < 1e-9


def test_catalogue_is_the_dissertations():
    figures = [
        (2, 3, 6), (2, 8, 11), (4, 1, 8), (4, 10, 13), (4, 16, 22), (5, 1, 28), (6, 4, 11),
    ]  # fmt: skip
    expected = {
        f"fig-{chapter}.{number}"
        for chapter, first, last in figures
        for number in range(first, last + 1)
    } | {f"table-{number}" for number in ("2.3", "4.1", "5.2", "5.3", "6.4")}
    expected |= {f"7.2-{topic}" for topic in FUTURE_WORK}
    assert set(SUBJECTS) == expected
    assert set(items()) <= expected
    assert set(items()) == set(KEY_NUMBERS), "every reproduction has its key numbers"
    assert list(items()) == [name for name in SUBJECTS if name in items()]
    assert set(costs()) == set(items()), "run docs/make_gallery.py"


def test_items_say_what_to_see_and_show_their_code():
    for item in items().values():
        assert item.see.endswith(".")
        assert item.code.startswith("def ")
        assert "ss." in item.code, item.name
        assert all(line.endswith(".") for line in (*item.corrected, *item.inferred))


def test_names_are_checked():
    with pytest.raises(ModelError, match=r"did you mean 'fig-2.3'"):
        chosen(["fig-2.33"])
    missing = [name for name in SUBJECTS if name not in items()]
    for name in missing[:1]:
        with pytest.raises(ModelError, match="not reproduced yet"):
            chosen([name])
    assert [item.name for item in chosen(["fig-2.3", "table-2.3", "fig-2.3"])] == [
        "fig-2.3",
        "table-2.3",
    ]
    assert [item.name for item in chosen(["all"])] == list(items())


def test_command_lists_status_and_cost():
    outcome = invoke("reproduce")
    assert outcome.exit_code == 0
    assert invoke("reproduce", "list").output == outcome.output
    lines = {line.split()[0]: line for line in outcome.output.splitlines()}
    for name in SUBJECTS:
        assert ("done" in lines[name]) == (name in items())
        assert ("not yet" in lines[name]) == (name not in items())
    assert f"{len(items())} of {len(SUBJECTS)}" in outcome.output
    assert f"{len(claims())} claims" in outcome.output
    for name, (_, place) in NUMBERED.items():
        assert re.search(rf"^{re.escape(name)} .*: {re.escape(place)}$", outcome.output, re.M)


def test_command_adds_to_a_folder(tmp_path):
    for name in ("fig-2.3", "fig-4.18"):
        outcome = invoke("reproduce", name, "--coarse", "--out", tmp_path)
        assert outcome.exit_code == 0, outcome.output
    assert "phase between adjacent beams: 20 deg (printed 20)" in outcome.output
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert "fig-2.3.png" in page
    assert "fig-4.18.png" in page
    assert list(records(tmp_path)) == ["fig-2.3", "fig-4.18"]


def test_command_refuses_in_one_line(tmp_path):
    outcome = invoke("reproduce", "figure 2.3", "--out", tmp_path / "new")
    assert outcome.exit_code == 2
    assert outcome.output.startswith("error: unknown table or figure 'figure 2.3'")
    assert not (tmp_path / "new").exists()
    (tmp_path / "fig-2.4.json").write_text("{}")
    outcome = invoke("reproduce", "fig-2.3", "--coarse", "--out", tmp_path)
    assert outcome.exit_code == 2
    assert "not a record of a reproduction; delete it" in outcome.output


def test_interruption_keeps_what_is_complete(tmp_path, monkeypatch):
    from stickslip_reproduce import chapter_4_rings
    from stickslip_reproduce.catalogue import items as known

    def stopped(resolution):
        raise KeyboardInterrupt

    item = known()["fig-4.18"]
    assert chapter_4_rings.figure_4_18 is item
    monkeypatch.setitem(known(), "fig-4.18", type(item)(name="fig-4.18", see="", compute=stopped))
    outcome = invoke("reproduce", "fig-2.3", "fig-4.18", "--coarse", "--out", tmp_path)
    assert outcome.exit_code == 130
    assert "1 of 2 complete" in outcome.output
    assert {file.name for file in tmp_path.iterdir()} == {
        "fig-2.3.png",
        "fig-2.3.csv",
        "fig-2.3.json",
        "index.html",
    }


def test_failed_write_leaves_the_old_file(tmp_path, monkeypatch):
    numbers = Numbers(Plot(Axis("x"), Axis("y"), (Panel((Series("a", [0, 1], [1, 2]),)),)))
    item = items()["fig-2.3"]
    write(item, numbers, 0.0, COARSE, tmp_path)
    before = {file.name: file.read_bytes() for file in tmp_path.iterdir()}

    def broken(self, target):
        raise OSError("no space left")

    monkeypatch.setattr("os.replace", broken)
    with pytest.raises(ss.ModelError, match="no space"):
        write(item, numbers, 1.0, COARSE, tmp_path)
    assert {file.name: file.read_bytes() for file in tmp_path.iterdir()} == before


def test_numbers_are_checked_and_frozen():
    with pytest.raises(ValueError, match="series 'a'"):
        Series("a", [0.0, 1.0], [1.0])
    with pytest.raises(ValueError, match="columns"):
        Table(("a", "b"), ((1.0,),))
    plot = Plot(Axis("x"), Axis("y"), ())
    with pytest.raises(ValueError, match="same name"):
        Numbers(plot, (Fact("a", 1.0), Fact("a", 2.0)))
    series = Series("a", [0.0, 1.0], [1.0, np.nan])
    with pytest.raises(ValueError, match="read-only"):
        series.y[0] = 2.0


def test_what_is_not_a_number_is_left_empty(tmp_path):
    plot = Plot(Axis("x"), Axis("y"), (Panel((Series("a", [0, 1], [1, 2]),)),))
    facts = (Fact("nothing", float("nan"), "m"),)
    write(items()["fig-2.3"], Numbers(plot, facts), 0.0, COARSE, tmp_path)
    (fact,) = records(tmp_path)["fig-2.3"]["facts"]
    assert fact["value"] is None


def test_gallery_holds_what_the_catalogue_has():
    folder = DOCS / "assets" / "reproduction"
    known = records(folder)
    assert set(known) == set(items()), "run docs/make_gallery.py"
    for name, record in known.items():
        assert (folder / f"{name}.png").is_file()
        assert record["resolution"] == "full"
        facts = {fact["what"]: fact["value"] for fact in record["facts"]}
        for what, (value, tolerance) in KEY_NUMBERS[name].items():
            assert facts[what] == pytest.approx(value, rel=tolerance), (name, what)


def test_pages_are_written_from_the_catalogue():
    hook = runpy.run_path(str(DOCS / "gallery.py"))["written"]
    coverage = hook("# Coverage\n\n{{ coverage }}\n").splitlines()
    for name in SUBJECTS:
        (line,) = [
            line
            for line in coverage
            if f"{heading(name)}]" in line or f"| {heading(name)} |" in line
        ]
        assert ("done" in line) == (name in items())
        assert ("not yet" in line) == (name not in items())
    gallery = hook("{{ gallery }}")
    for name, item in items().items():
        assert f"assets/reproduction/{name}.png" in gallery
        assert item.see in gallery
        assert item.code in gallery
        assert all(line in gallery for line in item.corrected)
    assert "| Runge-Kutta |" in hook("{{ table table-4.1 }}")
    assert hook("text with {{ braces }}") == "text with {{ braces }}"
