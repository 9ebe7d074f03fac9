"""Fits from study files: tests in text files and Universal Files, from the file to the picture."""

from __future__ import annotations

import numpy as np
import pytest
from typer.testing import CliRunner

import stickslip as ss
from small_study import PAD
from stickslip.cli import app
from stickslip.study import Study
from stickslip.study.measurement_table import MeasurementTable

STUDY = (
    PAD
    + """
[analysis]
kind = "fit"
parameters = {"pad.stiffness" = [1e2, 1e5], slip_force = [0.1, 10], "damping.ratio" = [1e-3, 1e-1]}
intervals = "covariance"

[[analysis.measurement]]
file = "low.csv"
dof = "tip"
level = 0.5
relative_noise = "1 %"
frequency_unit = "Hz"
length_unit = "mm"

[[analysis.measurement]]
file = "high.csv"
dof = "tip"
level = 3
at = {"pad.slip_force" = 1.0}
relative_noise = "1 %"
frequency_unit = "Hz"
length_unit = "mm"
"""
)


@pytest.fixture
def folder(tmp_path):
    structure = ss.Structure([[1.0]], [[1e4]], ss.ModalDamping(0.01), ["tip"])
    rng = np.random.default_rng(1)
    omega = np.linspace(80.0, 140.0, 40)
    for name, level in (("low", 0.5), ("high", 3.0)):
        pad = ss.Jenkins("tip", stiffness=4000.0, slip_force=1.0)
        model = ss.Model(structure, [pad], [ss.Force("tip", amplitude=level)])
        seen = ss.exact_response(model, omega).amplitude("tip")
        seen = seen * (1.0 + 0.01 * rng.standard_normal(40))
        rows = [f"{w / (2.0 * np.pi):.9g}, {1e3 * a:.9g}" for w, a in zip(omega, seen, strict=True)]
        text = "\n".join(["# test bench 7", "frequency, amplitude", *rows])
        (tmp_path / f"{name}.csv").write_text(text, encoding="utf-8")
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    return tmp_path


@pytest.mark.slow
def test_a_study_fits_files(folder):
    (result,) = Study.load(folder / "study.toml").run()
    assert result.values["pad.stiffness"] == pytest.approx(4000.0, rel=0.02)
    assert result.values["slip_force"] == pytest.approx(1.0, rel=0.02)
    assert result.values["damping.ratio"] == pytest.approx(0.01, rel=0.1)
    assert result.names == ("low", "high")


@pytest.mark.slow
def test_the_command_tabulates_draws_and_reports(folder, monkeypatch):
    monkeypatch.chdir(folder)
    done = CliRunner().invoke(app, ["run", "study.toml", "--out", "out"])
    assert done.exit_code == 0, done.output
    assert "pad.stiffness" in done.output
    saved = next((folder / "out").glob("*.nc"))
    shown = CliRunner().invoke(app, ["show", str(saved)])
    assert shown.exit_code == 0, shown.output
    assert "slip_force" in shown.output
    report = CliRunner().invoke(app, ["report", str(saved), "--out", "report.html"])
    assert report.exit_code == 0, report.output
    assert next((folder / "out").glob("*.png")).stat().st_size > 0


@pytest.mark.slow
def test_a_backbone_is_a_file_of_three_columns(folder):
    structure = ss.Structure([[1.0]], [[1e4]], ss.ModalDamping(0.005), ["tip"])
    pad = ss.Jenkins("tip", stiffness=4000.0, slip_force=1.0)
    modes = ss.nonlinear_modes(ss.Model(structure, [pad]), amplitude=np.geomspace(1e-4, 4e-3, 12))
    columns = modes.displacement_amplitude("tip"), modes.omega / (2 * np.pi), modes.damping_ratio
    rows = [f"{1e3 * a:.9g}; {f:.9g}; {z:.9g}" for a, f, z in zip(*columns, strict=True)]
    (folder / "decay.csv").write_text("amplitude; f; zeta\n" + "\n".join(rows), encoding="utf-8")
    table = """
[[analysis.measurement]]
file = "decay.csv"
dof = "tip"
mode = 0
frequency_unit = "Hz"
length_unit = "mm"
frequency_noise = "0.1 %"
damping_noise = "2 %"
"""
    text = STUDY[: STUDY.index("[[analysis.measurement]]")] + table
    text = text.replace(', "damping.ratio" = [1e-3, 1e-1]', "").replace(
        'intervals = "covariance"', 'intervals = "covariance"\nharmonics = 5'
    )
    (folder / "study.toml").write_text(text, encoding="utf-8")
    (result,) = Study.load(folder / "study.toml").run()
    assert result.values["pad.stiffness"] == pytest.approx(4000.0, rel=5e-3)
    assert result.values["slip_force"] == pytest.approx(1.0, rel=5e-3)
    assert result.names == ("decay",)
    result.save(folder / "fit.nc")
    out = str(folder / "report.html")
    shown = CliRunner().invoke(app, ["report", str(folder / "fit.nc"), "--out", out])
    assert shown.exit_code == 0, shown.output
    for given, said in (
        ('damping_noise = "2 %"\nnoise = 1', "'noise' is for amplitudes and forces"),
        ('damping_noise = "2 %"\ncontact = "pad"', "'mode' is for a backbone"),
    ):
        bad = text.replace('damping_noise = "2 %"', given)
        (folder / "study.toml").write_text(bad, encoding="utf-8")
        with pytest.raises(ss.ModelError, match=said):
            Study.load(folder / "study.toml")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (('dof = "tip"\nlevel = 3', "level = 3"), "give one of 'dof' and 'contact'"),
        (('file = "high.csv"', 'file = "none.csv"'), "no such file"),
        (('"pad.stiffness" = [1e2, 1e5]', '"pat.stiffness" = [1e2, 1e5]'), "unknown contact"),
        (('length_unit = "mm"', 'length_unit = "kg"'), "length_unit"),
        (('length_unit = "mm"', 'force = "20 N"'), "'force' is for a Universal File; leave it out"),
        (('length_unit = "mm"', "harmonics = 3"), "'harmonics' is for the loop of a contact"),
        (('"low.csv"', '"low.unv"'), "'frequency_unit' is for frequencies of a text file"),
        (
            ('"low.csv"\ndof = "tip"', '"low.csv"\nmode = 0'),
            "'relative_noise' is for amplitudes and forces",
        ),
    ],
)
def test_bad_tables_are_refused(folder, change, said):
    (folder / "study.toml").write_text(STUDY.replace(*change), encoding="utf-8")
    with pytest.raises(ss.ModelError, match=said):
        list(Study.load(folder / "study.toml").run())


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ({"file": "a.unv", "dof": "tip", "measure": "max"}, "'measure' is for amplitudes of"),
        ({"file": "a.uff", "dof": "tip", "length_unit": "mm"}, "'length_unit' is for displacem"),
        ({"file": "a.csv", "mode": 0, "length_unit": "mm"}, "'length_unit' is for displacements"),
        ({"file": "a.csv", "contact": "pad", "frequency_unit": "Hz"}, "'frequency_unit' is for"),
        ({"file": "a.unv", "dof": "tip", "measure": "fundamental", "force": 2.0}, ""),
        ({"file": "a.csv", "mode": 0, "dof": "tip", "length_unit": "mm"}, ""),
    ],
)
def test_keys_that_change_nothing_are_refused(table, said):
    if not said:
        MeasurementTable(**table)
        return
    with pytest.raises(ValueError, match=said):
        MeasurementTable(**table)


def test_a_line_that_is_no_pair_is_named(folder):
    (folder / "low.csv").write_text("1, 2\n3\n", encoding="utf-8")
    with pytest.raises(ss.ModelError, match="line 2"):
        Study.load(folder / "study.toml")


def test_a_frequency_response_function_is_a_measurement():
    omega = np.array([0.0, 1.0, 2.0])
    frf = ss.Frf(omega, np.array([0.0, 2.0, 8.0]), "7.3", "7.3", "acceleration")
    one = ss.Measurement.of_frf(frf, "tip", 3.0, relative_noise=0.05)
    assert one.omega.tolist() == [1.0, 2.0]
    assert one.amplitude.tolist() == pytest.approx([6.0, 6.0])
    assert one.measure == "fundamental"
