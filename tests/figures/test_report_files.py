"""Reports of files: the command, what is refused, and disks that fail."""

import hashlib
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import stickslip as ss
from report_page import Page
from stickslip.cli import app

BEAM = ss.reference.snecma_beam(20.313)


@pytest.fixture(scope="module")
def results():
    grid = np.linspace(150.0, 250.0, 24)
    return {
        "low": ss.forced_response(ss.reference.snecma_beam(6.563), grid, 5),
        "high": ss.certify(ss.forced_response(BEAM, grid, 5), 3),
    }


@pytest.mark.slow
def test_the_command(results, tmp_path):
    for name in ("low", "high"):
        results[name].save(tmp_path / f"{name}.nc")
    files = [str(tmp_path / f"{name}.nc") for name in ("low", "high")]
    done = CliRunner().invoke(app, ["report", *files, "--title", "Two", "--dof", "tip", "--hertz"])
    assert (done.exit_code, done.stderr) == (0, "")
    assert done.stdout == f"report: {tmp_path / 'report.html'}\n"
    page = Page(tmp_path / "report.html")
    assert page.texts[0] == "Two"
    assert files[0] in page.texts
    assert hashlib.sha256(Path(files[0]).read_bytes()).hexdigest() in page.texts
    assert any(text.endswith(f"by stickslip {ss.__version__}") for text in page.texts)


@pytest.mark.slow
def test_files_of_the_same_name_are_told_apart(results, tmp_path):
    files = []
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        files.append(tmp_path / folder / "run.nc")
        results["low"].save(files[-1])
    ss.report(files, tmp_path / "two.html")
    page = Page(tmp_path / "two.html")
    assert {"a/run", "b/run"} <= set(page.texts)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["none.nc"], "none.nc: no such file"),
        (["cut.nc"], "cut.nc: not a readable NetCDF file, or a damaged one"),
        (["beam.toml"], "beam.toml: a study file, no result; 'stickslip run' computes its"),
        (["changed.nc"], "changed.nc: was changed since it was saved, its digest differs"),
        (["low.nc", "cut.nc"], "cut.nc: not a readable"),
        (["odd.nc"], "odd.nc: holds 'mystery', this version reads"),
        (["low.nc", "--dof", "tpi"], "unknown dof 'tpi'; did you mean 'tip'?"),
        (["low.nc", "--out", "a.pdf"], "a.pdf: a report is a page of HTML; let its name end in"),
        (["low.nc", "--out", "none/a.html"], "there is no folder none; create it first"),
        (["low.nc", "--length-unit", "km"], "unknown choice 'km'"),
    ],
)
def test_refused_in_one_line(results, tmp_path, monkeypatch, arguments, message):
    import xarray as xr

    monkeypatch.chdir(tmp_path)
    results["low"].save("low.nc")
    Path("beam.toml").write_text("[structure]")
    Path("cut.nc").write_bytes(Path("low.nc").read_bytes()[:9000])
    Path("changed.nc").write_bytes(Path("low.nc").read_bytes() + b"\n")
    odd = xr.load_dataset("low.nc", engine="h5netcdf").drop_dims("seal_byte")
    odd.assign_attrs(stickslip_kind="mystery").to_netcdf("odd.nc", engine="h5netcdf")
    before = sorted(tmp_path.iterdir())
    done = CliRunner().invoke(app, ["report", *arguments])
    assert (done.exit_code, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    assert message in line
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ([], "results: empty; give at least one result or file"),
        ({}, "results: empty"),
        (3, "results: 3 is neither a result nor a file of one"),
        ([BEAM], "is neither a result nor a file of one"),
        ({3: "a.nc"}, "name of a result"),
    ],
)
def test_what_is_no_result_is_refused(tmp_path, given, message):
    with pytest.raises(ss.ModelError, match=re.escape(message)):
        ss.report(given, tmp_path / "a.html")
    assert list(tmp_path.iterdir()) == []


def test_whole_or_not_at_all(results, tmp_path, monkeypatch):
    file = tmp_path / "a.html"
    file.write_text("before")

    def fail(handle):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", fail)
    with pytest.raises(ss.ModelError, match=r"a\.html: cannot be written \(No space left"):
        ss.report(results["low"], file)
    assert file.read_text() == "before"
    assert list(tmp_path.iterdir()) == [file]


def test_a_missing_library_is_named(results, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "plotly", None)
    with pytest.raises(ss.ModelError, match=r"plotly is not installed; .*'stickslip\[report\]'"):
        ss.report(results["low"], tmp_path / "a.html")
