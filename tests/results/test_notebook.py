"""What notebooks show of results."""

import re
from html import unescape
from importlib import import_module
from itertools import islice

import numpy as np
import pytest

import stickslip as ss
from stickslip.reference import snecma_beam
from stickslip.results.store import KINDS
from stickslip.views.kinds import view_of

GRID = np.linspace(170.0, 200.0, 9)
BEAM = snecma_beam()
RESULTS = {
    "curve": lambda: ss.forced_response(BEAM, GRID, 3),
    "orbits": lambda: ss.exact_response(BEAM, GRID[:2]),
    "transient": lambda: ss.transient(BEAM, omega=170.0, periods=5),
    "curve of a damper": lambda: ss.damper_curve(BEAM, slip_force=[100, 300.0], dof="tip"),
    "mode": lambda: ss.nonlinear_modes(BEAM, amplitude=np.geomspace(1e-6, 1e-4, 30)),
    "rest": lambda: ss.static_response(BEAM),
    "sweep": lambda: ss.sweep(BEAM, lambda m: ss.forced_response(m, GRID, 1), level=[1, 2]),
}


def cells(page):
    rows = re.findall("<tr>(.*?)</tr>", page)
    return [[unescape(one) for one in re.findall("<t[hd][^>]*>(.*?)</t[hd]>", row)] for row in rows]


@pytest.mark.parametrize("kind", RESULTS)
def test_notebooks_show_the_tables_of_the_terminal(kind):
    result = RESULTS[kind]()
    page = result._repr_html_()
    assert unescape(page).startswith(f"<p><code>{result!r}</code></p>")
    dofs = [dof for dof in ("tip", "damper") if dof in result.dofs]
    tables = view_of([result]).tables([("", result)], "", dofs, "auto")
    expected = []
    for table in tables:
        rows = zip(*(column.cells for column in table.columns), strict=True)
        expected += [[column.header for column in table.columns], *map(list, islice(rows, 20))]
    assert cells(page) == expected


def test_long_tables_say_how_long_they_are():
    assert "<p>... 30 rows in all</p>" in RESULTS["mode"]()._repr_html_()
    assert "rows in all" not in RESULTS["curve"]()._repr_html_()


def test_cautions_and_names_are_shown_as_they_are():
    structure = ss.Structure([[1.0]], [[1e4]], [[-1.0]], ["a<b>"])
    contact = ss.Jenkins("a<b>", stiffness=1e3, slip_force=1.0)
    model = ss.Model(structure, [contact], [ss.Force("a<b>", 0.5)])
    page = ss.forced_response(model, [50.0, 60.0], 1)._repr_html_()
    assert "⚠ The damping is negative for some motion" in page
    assert "a&lt;b&gt;" in page
    assert "<b>" not in page


def test_a_result_without_a_view_is_left_to_its_text(monkeypatch):
    result = RESULTS["rest"]()
    monkeypatch.setattr(type(result), "kind", "unheard_of")
    assert result._repr_html_() is None


def test_every_kind_of_result_has_a_plot():
    for module, kind in KINDS.values():
        assert callable(getattr(import_module(module), kind).plot)


def test_texts_of_what_is_no_result_are_short():
    disk = ss.BladedDisk(
        BEAM.structure, 6, contacts=BEAM.contacts, forces=BEAM.forces, engine_order=1
    )
    assert repr(disk.nodal_diameters()) == "NodalDiameters(0 to 3 of 6 sectors, 3 modes each)"
    peaks = ss.design_map(
        lambda slip_force, stiffness: BEAM.replaced(
            contacts=[ss.Jenkins("damper", stiffness=stiffness, slip_force=slip_force)]
        ),
        {"slip_force": [100.0, 300.0], "stiffness": [1e7, 2e7]},
        dof="tip",
        omega=(150, 260),
    )
    assert repr(peaks) == (
        "DesignMap(2 values of slip_force, 2 values of stiffness, 4 peaks of 'tip' found)"
    )
    level = ss.damper_curve(BEAM, level=[1, 5], dof="tip")
    assert "from 1 to 5 (all found)" in repr(level)
    best = ss.optimal_damper(BEAM, dof="tip", parameter="level", bounds=(1, 5))
    assert f"(level = {best.value:.6g}: peak" in repr(best)
    for result in (level, best):
        assert not any("[1]" in cell for row in cells(result._repr_html_()) for cell in row)


@pytest.mark.parametrize("name", ["a.csv", "b.XLSX", "c.mat"])
def test_a_result_is_not_saved_under_the_ending_of_another_format(tmp_path, name):
    result = RESULTS["rest"]()
    with pytest.raises(ss.ModelError, match=r"save writes NetCDF, \.nc; .* is what export writes"):
        result.save(tmp_path / name)
    assert not (tmp_path / name).exists()
