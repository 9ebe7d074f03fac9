"""Fits from study files: tests in text files and Universal Files, from the file to the picture."""

from __future__ import annotations

import numpy as np
import pytest
from typer.testing import CliRunner

import stickslip as ss
from small_study import PAD
from stickslip.cli import app
from stickslip.settings.refusal import validated
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


TIP = {"file": "a.csv", "dof": "tip"}


@pytest.mark.parametrize(
    ("table", "noise"),
    [
        (TIP | {"noise": "0.01 mm", "length_unit": "mm"}, 1e-5),
        (TIP | {"noise": "0.01 mm"}, 1e-5),
        (TIP | {"noise": 0.01}, 0.01),
        ({"file": "a.csv", "contact": "pad", "noise": "2 N", "length_unit": "mm"}, 2.0),
        ({"file": "a.csv", "contact": "pad", "noise": 2.0, "length_unit": "mm"}, 2.0),
    ],
)
def test_noise_has_the_unit_that_is_written(table, noise, tmp_path):
    rows = "\n".join(f"{at + 1}, {at % 3 + 1}" for at in range(16))
    (tmp_path / "a.csv").write_text(rows, encoding="utf-8")
    assert MeasurementTable(**table).read(tmp_path).noise == pytest.approx(noise)


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ({"noise": 0.01, "length_unit": "mm"}, "write its unit, '0.01 mm' or '0.01 m'"),
        ({"noise": "5 N"}, "noise = '5 N' is not a length"),
        ({"noise": [1]}, r"noise: \[1\] is not a number; give a single one, no list$"),
        ({"at": {"pad.slip_force": "5 m"}}, r"at\['pad.slip_force'\] = '5 m' is not a force"),
        ({"at": {"pad.slip_force": [1]}}, r"at\['pad.slip_force'\]: \[1\] is not a number"),
        ({"at": 5}, "at: 5 is no table"),
    ],
)
def test_noise_and_values_of_another_unit_are_refused(table, said, tmp_path):
    (tmp_path / "a.csv").write_text("1, 2\n3, 4\n", encoding="utf-8")
    with pytest.raises(ss.ModelError, match=said):
        validated(MeasurementTable, TIP | table).read(tmp_path)


@pytest.mark.parametrize(
    ("change", "end"),
    [('relative_noise = "5 N"', "or a plain number"), ("noise = true", "in SI units")],
)
def test_one_refusal_is_counted_once(change, end):
    text = STUDY[: STUDY.index('relative_noise = "1 %"')]
    with pytest.raises(ss.ModelError, match=f"{end}$"):
        Study.parse(text + change)


def at(given: str, parameters: str = '"damping.ratio" = [1e-3, 1e-1]') -> str:
    text = STUDY.replace("level = 3", f"level = 3\nat = {{{given}}}")
    begin, end = text.index("parameters"), text.index("\nintervals")
    return f"{text[:begin]}parameters = {{{parameters}}}{text[end:]}"


def test_values_of_one_test_have_units(folder):
    (folder / "study.toml").write_text(at('"pad.slip_force" = "0.5 N"'), encoding="utf-8")
    study = Study.load(folder / "study.toml")
    analysis = study.tables.analysis
    second = analysis.measurement[1].test(analysis._read[1], study.model, analysis.parameters)
    assert second.model.contacts[0].slip_force == 0.5
    assert second.model.forces[0].amplitude == 3.0


@pytest.mark.parametrize(
    "given", ['"pad.slip_force" = 1', "slip_force = 1", '"pad.slip_force" = 2']
)
def test_what_is_fitted_has_no_value_of_one_test(folder, given):
    text = at(given, '"slip_force" = [0.1, 10]')
    (folder / "study.toml").write_text(text, encoding="utf-8")
    with pytest.raises(ss.ModelError, match=r"and 'slip_force' both set 'pad\.slip_force'"):
        list(Study.load(folder / "study.toml").run())


@pytest.mark.parametrize(("key", "force"), [("", 3.0), ('force = "7 N"', 7.0)])
def test_response_functions_are_times_the_force_of_the_model(folder, key, force):
    pytest.importorskip("pyuff")
    frf = ss.Frf([90.0, 95.0, 99.0], [1e-4, 2e-4, 3e-4], "tip", "tip")
    ss.write_frf(folder / "a.uff", frf)
    table = f'file = "a.uff"\ndof = "tip"\nlevel = 3\n{key}'
    text = STUDY[: STUDY.index("file =")] + table
    (folder / "study.toml").write_text(text, encoding="utf-8")
    study = Study.load(folder / "study.toml")
    analysis = study.tables.analysis
    (made,) = (
        one.test(read, study.model, analysis.parameters)
        for one, read in zip(analysis.measurement, analysis._read, strict=True)
    )
    np.testing.assert_allclose(made.amplitude, force * np.abs(frf.values))
    np.testing.assert_allclose(made.observed, made.amplitude)


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
    structure = ss.Structure([[1.0]], [[1e4]], dofs=["tip"])
    model = ss.Model(structure, forces=[ss.Force("tip", 6.0), ss.Force("tip", 1.0, harmonic=0)])
    own = ss.Measurement.of_frf(frf, "tip", model=model)
    assert own.amplitude.tolist() == pytest.approx([12.0, 12.0])
    with pytest.raises(ss.ModelError, match="force: missing; give its amplitude"):
        ss.Measurement.of_frf(frf, "tip")
    several = model.replaced(forces=[ss.Force("tip", 6.0), ss.Force("tip", 1.0, phase=1.0)])
    with pytest.raises(ss.ModelError, match="the model has 2 forces of harmonic 1"):
        ss.Measurement.of_frf(frf, "tip", model=several)
