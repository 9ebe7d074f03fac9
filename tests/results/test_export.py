"""Results for other programs: what is read back has the numbers of the result."""

import csv
import os
import re
import subprocess
import sys
from dataclasses import fields, replace
from functools import partial

import numpy as np
import pandas as pd
import pytest
from scipy.io import loadmat

import stickslip as ss
from beam_study import invoke
from stickslip.reference import beam_pair, beam_ring, flutter_mass, snecma_beam
from stickslip.results import export
from stickslip.results.arrays import Arrays
from stickslip.results.fields import Float, column
from stickslip.results.table import Tables

BEAM = snecma_beam()
GRID = np.linspace(150.0, 250.0, 12)


def transient():
    return ss.transient(BEAM, 170.0, 9, keep=4, samples=16, start={"tip": 1e-3})


def patterns():
    return ss.mistuning_study(
        beam_ring(), 0.05, patterns=3, omega=(180.0, 230.0), dofs=["damper"], harmonics=1
    )


def statics():
    load = ss.Force("tip", 10.0, harmonic=0)
    return ss.static_response(ss.Model(BEAM.structure, BEAM.contacts, [load]))


def starts():
    lively = ss.destabilised(*flutter_mass(), 0.5)
    return ss.basin_map(lively, {"mass": [1e-5, 1e-4], 0: [2e-5, 2e-4]})


KINDS = {
    "curve": (lambda: ss.forced_response(BEAM, GRID, 5), "omega-dof"),
    "pair": (lambda: ss.forced_response(beam_pair(), GRID, 3), "omega-dof"),
    "exact": (lambda: ss.exact_response(BEAM, GRID), "omega-dof"),
    "transient": (transient, "time-dof"),
    "damper curve": (
        lambda: ss.damper_curve(BEAM, slip_force=np.geomspace(10.0, 1e3, 4), dof="tip"),
        "value",
    ),
    "optimum": (lambda: ss.optimal_damper(BEAM, dof="tip", bounds=(50.0, 1e3)), "value"),
    "cycles": (lambda: ss.limit_cycles(*flutter_mass(), harmonics=5), "cycle-dof"),
    "modes": (
        lambda: ss.nonlinear_modes(BEAM, amplitude=np.geomspace(1e-4, 1e-2, 5), harmonics=3),
        "mode_point-dof",
    ),
    "patterns": (patterns, "deviation-coupling_stiffness-pattern-dof"),
    "statics": (statics, "dof"),
    "starts": (starts, "start_number-dof"),
    "map": (lambda: ss.stability_map(*flutter_mass(), stiffness=[1.2e7, 2.4e7]), "value"),
}


@pytest.fixture(scope="module")
def results():
    return {name: make() for name, (make, _) in KINDS.items()}


@pytest.fixture(scope="module")
def sweeps():
    """Over the same frequencies, and over frequencies of their own."""
    forces = [50.0, 200.0, 800.0]
    return [
        ss.sweep(BEAM, partial(ss.forced_response, omega=omega, harmonics=3), slip_force=forces)
        for omega in (GRID, (180.0, 200.0))
    ]


@pytest.fixture(scope="module")
def frf(results):
    return results["curve"]


def same(mine, theirs):
    """Compare two columns, numbers bit by bit."""
    mine, theirs = np.asarray(mine), np.asarray(theirs)
    if mine.dtype.kind == "f":
        blank = np.isnan(mine)
        assert theirs.dtype == mine.dtype
        np.testing.assert_array_equal(blank, np.isnan(theirs))
        assert mine[~blank].tobytes() == theirs[~blank].tobytes()
    else:
        assert mine.tolist() == theirs.tolist()


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_every_variable_is_in_one_table_with_its_numbers(kind, results):
    """By xarray's own way of making tables, which knows nothing of ours."""
    dataset, tables = results[kind].to_dataset(), results[kind].tables()
    for name, variable in dataset.data_vars.items():
        table = tables["-".join(map(str, variable.dims)) or "values"]
        assert len(table) == variable.size
        theirs = variable.values.ravel()
        if "flag_meanings" in variable.attrs:
            words = variable.attrs["flag_meanings"].split()
            known = dict(zip(variable.attrs["flag_values"].tolist(), words, strict=True))
            assert table[name].tolist() == [known[code] for code in theirs.tolist()]
        elif theirs.dtype.kind == "c":
            same(theirs.real, table[f"{name}_real"])
            same(theirs.imag, table[f"{name}_imag"])
        else:
            same(theirs, table[name])
        frame = variable.to_dataframe(name="it") if variable.dims else None
        for dim in variable.dims if frame is not None else ():
            same(frame.index.get_level_values(dim), table[dim])
    for table in tables.values():
        assert set(table.attrs["units"]) == set(table.attrs["meanings"]) == set(table.columns)
        assert all(table.attrs["units"].values())
        assert all(table.attrs["meanings"].values())


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_the_main_table(kind, results):
    result, name = results[kind], KINDS[kind][1]
    pd.testing.assert_frame_equal(result.to_pandas(), result.tables()[name])


def test_a_curve_as_a_table(frf):
    table = frf.to_pandas()
    assert list(table.columns[:4]) == ["omega", "dof", "harmonics_kept", "status"]
    tip = table[table["dof"] == "tip"]
    same(tip["omega"], frf.omega)
    same(tip["amplitude"], frf.amplitude("tip"))
    same(tip["error_estimate"], frf.error_estimate("tip"))
    assert tip["status"].tolist() == [str(one) for one in frf.status]
    harmonics = frf.to_pandas("omega-harmonic-dof")
    third = harmonics[(harmonics["dof"] == "tip") & (harmonics["harmonic"] == 3)]
    same(third["displacement_imag"], frf.coefficients("tip")[:, 3].imag)
    assert table.attrs["units"]["amplitude"] == "m"


@pytest.mark.slow
def test_a_sweep_is_one_table_with_its_parameter(sweeps, tmp_path):
    for sweep in sweeps:
        table = sweep.to_pandas()
        assert list(table.columns[:3]) == ["slip_force", "omega", "dof"]
        assert table.attrs["units"]["slip_force"] == "N"
        assert set(table.attrs["units"]) == set(table.attrs["meanings"]) == set(table.columns)
        assert len(table) == sweep.tables().rows("omega-dof")
        for value, one in zip(sweep.values, sweep.results, strict=True):
            own = table[table["slip_force"] == value].drop(columns="slip_force")
            mine = one.to_pandas()
            pd.testing.assert_frame_equal(own.reset_index(drop=True), mine, check_exact=True)
        sweep.export(tmp_path / "a.csv")
        head = (tmp_path / "a.csv").read_text().splitlines()[0]
        assert head.startswith("slip_force [N],omega [rad/s],dof,")
        sweep.export(tmp_path / "a.mat")
        amplitude = sweep.to_dataset()["amplitude"].values
        np.testing.assert_array_equal(loadmat(tmp_path / "a.mat")["amplitude"], amplitude)
    pytest.importorskip("openpyxl")
    pytest.importorskip("xlsxwriter")
    sweeps[0].export(tmp_path / "a.xlsx")
    assert len(pd.read_excel(tmp_path / "a.xlsx", sheet_name="omega-dof")) == 3 * 36


def test_events_know_their_orbit(results):
    exact = results["exact"]
    events = exact.to_pandas("event")
    for index, omega in enumerate(exact.omega):
        own = events[events["event_omega"] == omega]
        assert own["event_time"].tolist() == [one.time for one in exact.events(index)]


def test_tables_do_not_touch_the_result(frf):
    table = frf.to_pandas()
    table["amplitude"] = 0.0
    assert (frf.amplitude("tip") > 0.0).all()


def test_a_new_column_is_exported_by_itself(frf, tmp_path):
    class Longer(Arrays):
        temperature: "Float" = column("*", "K", "temperature of the contact")

    own = {one.name: getattr(frf.arrays, one.name) for one in fields(frf.arrays)}
    longer = replace(frf, arrays=Longer(**own, temperature=np.arange(12.0)))
    longer.export(tmp_path / "a.csv")
    written = pd.read_csv(tmp_path / "a.csv")
    assert written["temperature [K]"].tolist() == np.repeat(np.arange(12.0), 3).tolist()


# ---------------------------------------------------------------------------------- the formats


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_csv_has_every_bit(kind, results, tmp_path):
    for name, table in results[kind].tables().items():
        results[kind].export(tmp_path / "a.csv", name)
        with open(tmp_path / "a.csv", newline="", encoding="utf-8") as file:
            head, *rows = csv.reader(file)
        assert len(rows) == len(table)
        for mine, theirs, *read in zip(table.columns, head, *rows, strict=True):
            unit = table.attrs["units"][mine]
            assert theirs == (mine if unit == "1" else f"{mine} [{unit}]")
            if table[mine].dtype.kind == "f":
                same(table[mine], [float(one or "nan") for one in read])
            else:
                assert read == [str(one) for one in table[mine].tolist()]


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_parquet_has_every_bit(kind, results, tmp_path):
    pytest.importorskip("pyarrow")
    for name, table in results[kind].tables().items():
        results[kind].export(tmp_path / "a.parquet", name)
        read = pd.read_parquet(tmp_path / "a.parquet")
        for mine, theirs in zip(table.columns, read.columns, strict=True):
            assert table[mine].dtype == read[theirs].dtype
            same(table[mine], read[theirs])


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_excel_has_sixteen_digits(kind, results, tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    pytest.importorskip("xlsxwriter")
    results[kind].export(tmp_path / "a.xlsx")
    book, tables = openpyxl.load_workbook(tmp_path / "a.xlsx"), results[kind].tables()
    about, *sheets = book.sheetnames
    assert about == "about"
    told = list(book["about"].values)
    assert told[0] == ("sheet", "table", "column", "unit", "meaning")
    names = dict.fromkeys(row[:2] for row in told[1:])
    assert [sheet for sheet, _ in names] == sheets
    assert [table for _, table in names] == list(tables)
    for sheet, name in names:
        (head, *rows), table = book[sheet].values, tables[name]
        assert list(head) == list(export.headed(table).columns)
        assert len(rows) == len(table)
        for number, one in enumerate(table.columns):
            read = [row[number] for row in rows]
            if table[one].dtype.kind == "f":
                numbers = np.array([np.nan if cell is None else float(cell) for cell in read])
                digits = [float(f"{cell:.16g}") for cell in table[one].tolist()]
                np.testing.assert_array_equal(numbers, digits)
            else:
                assert [cell or "" for cell in read] == [cell or "" for cell in table[one].tolist()]


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_matlab_has_every_bit(kind, results, tmp_path):
    results[kind].export(tmp_path / "a.mat")
    read = loadmat(tmp_path / "a.mat")
    for name, variable in results[kind].to_dataset().variables.items():
        mine = np.atleast_1d(variable.values)
        mine = mine[:, None] if mine.ndim == 1 else mine
        if mine.dtype.kind in "fciub":
            assert read[name].shape == mine.shape, name
            assert read[name].astype(mine.dtype).tobytes() == mine.tobytes(), name
        else:
            assert [str(one[0]) for one in read[name].ravel()] == mine.ravel().tolist()
        assert str(read["units"][name][0, 0][0]) == variable.attrs["units"]
        assert str(read["dimensions"][name][0, 0].squeeze()) in (" ".join(variable.dims), "[]")


def test_texts_are_no_formulas(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    pytest.importorskip("xlsxwriter")
    structure = ss.Structure([[2.0]], [[8.0]], [[0.4]], dofs=["=1+1"])
    model = ss.Model(structure, [], [ss.Force("=1+1", 1.0)])
    ss.forced_response(model, [1.0, 2.0], 1).export(tmp_path / "a.xlsx")
    cell = openpyxl.load_workbook(tmp_path / "a.xlsx")["omega-dof"]["B2"]
    assert (cell.value, cell.data_type) == ("=1+1", "s")


def test_names_of_sheets_are_short_and_different():
    names = ["about", "a" * 40, "a" * 41, "omega-dof"]
    titles = export._titles(names)
    assert len({*titles, "about"}) == 5
    assert max(map(len, titles)) <= 31
    assert titles[3] == "omega-dof"


# ---------------------------------------------------------------------------------- nonsense


@pytest.mark.parametrize(
    ("name", "table", "message"),
    [
        ("a.cvs", None, "a.cvs: unknown format '.cvs'; did you mean '.csv'?"),
        ("a", None, "unknown format ''"),
        ("a.csv", "omega-dfo", "table: 'omega-dfo' is none of the result; it has omega, "),
        ("a.csv", 3, "table: 3 is not text"),
        ("a.mat", "omega", "table: 'omega', but .mat files hold no tables; leave it out"),
        ("no/a.csv", None, "there is no folder"),
    ],
)
def test_nonsense_is_refused_in_one_line(name, table, message, frf, tmp_path):
    with pytest.raises(ss.ModelError, match=re.escape(message)) as refused:
        frf.export(tmp_path / name, table)
    assert len(str(refused.value).splitlines()) == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("name", "package"), [("parquet", "pyarrow"), ("xlsx", "xlsxwriter")])
def test_a_missing_package_is_named_with_its_extra(name, package, frf, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(ss.ModelError) as refused:
        frf.export(tmp_path / f"a.{name}")
    assert f"need the package {package}: pip install 'stickslip[export]'" in str(refused.value)


def test_a_table_too_long_for_a_sheet_is_refused(frf, tmp_path, monkeypatch):
    pytest.importorskip("xlsxwriter")
    monkeypatch.setattr(export, "_ROWS", 13)
    with pytest.raises(ss.ModelError, match="has 216 rows, a sheet 12; export it"):
        frf.export(tmp_path / "a.xlsx")
    frf.export(tmp_path / "a.xlsx", "omega")
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.xlsx"]


def test_what_a_cell_cannot_hold_is_refused(tmp_path, monkeypatch):
    pytest.importorskip("xlsxwriter")
    # Results saved by earlier versions may have such names.
    monkeypatch.setattr("stickslip.checks._NO_TEXT", frozenset())
    structure = ss.Structure([[2.0]], [[8.0]], [[0.4]], dofs=["a\x01"])
    curve = ss.forced_response(ss.Model(structure, [], [ss.Force("a\x01", 1.0)]), [1.0], 1)
    with pytest.raises(ss.ModelError, match="a cell cannot hold"):
        curve.export(tmp_path / "a.xlsx")


@pytest.mark.slow
def test_pandas_waits_for_its_use():
    code = "import sys, stickslip.results.export; print('pandas' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


# ---------------------------------------------------------------------------------- the command


@pytest.fixture
def folder(frf, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    frf.save("low.nc")
    frf.save("high.nc")
    return tmp_path


def test_the_command_writes_beside_the_results(folder, frf):
    done = invoke("export", "low.nc", "high.nc", "--to", "csv")
    assert done.exit_code == 0, done.stderr
    assert done.stdout.split() == ["export:", "low.csv", "export:", "high.csv"]
    expected = export.headed(frf.to_pandas()).to_csv(index=False, lineterminator="\n")
    assert (folder / "low.csv").read_text() == (folder / "high.csv").read_text() == expected


def test_the_command_writes_all_tables(folder, frf):
    assert invoke("export", "low.nc", "--to", "csv", "--table", "all").exit_code == 0
    assert sorted(path.stem for path in folder.glob("*.csv")) == sorted(
        f"low-{name}" for name in frf.tables()
    )
    assert invoke("export", "low.nc", "--out", "some.mat").exit_code == 0
    assert os.path.isfile("some.mat")
    for path in folder.glob("*.csv"):
        assert len(pd.read_csv(path)) == Tables(frf.to_dataset()).rows(path.stem[4:])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "export: give --to, as csv, or --out, as beam.csv"),
        (["--to", "csv", "--out", "a.csv"], "export: give --to, as csv, or --out, as beam.csv"),
        (["high.nc", "--out", "a.csv"], "--out = 'a.csv' is one file; give --to for several"),
        (["--out", "a.csv", "--table", "all"], "is one file; give --to for several"),
        (["--to", "exel"], "--to: unknown format '.exel'"),
        (
            ["--to", "csv", "--table", "omega-dfo"],
            "'omega-dfo' is none of the result; it has omega,",
        ),
        (["nowhere.nc", "--to", "csv"], "nowhere.nc: no such file"),
    ],
)
def test_the_command_refuses_in_one_line(folder, arguments, message):
    done = invoke("export", "low.nc", *arguments)
    assert done.exit_code == 2
    (line,) = done.stderr.splitlines()
    assert line.startswith("error: ")
    assert message in line
