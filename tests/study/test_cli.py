"""The command line: what its commands write and print."""

import json
import shlex
import shutil
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from beam_study import FEW_POINTS, invoke, study_text


@pytest.mark.slow
def test_run_saves_a_file_per_level_a_picture_and_prints_the_peaks(folder):
    result = invoke("run", "study.toml")
    assert result.exit_code == 0
    assert sorted(file.name for file in (folder / "results").iterdir()) == [
        "beam-20.313.nc",
        "beam-6.563.nc",
        "beam.png",
    ]
    heading, *lines = result.stdout.splitlines()
    assert heading.split()[:4] == ["level", "dof", "rad/s", "Hz"]
    assert [line.split()[:2] for line in lines[:4]] == [
        ["6.563", "tip"],
        ["6.563", "damper"],
        ["20.313", "tip"],
        ["20.313", "damper"],
    ]
    saved = ss.load(folder / "results" / "beam-20.313.nc")
    peak = saved.peak("tip")
    _, _, omega, hertz, amplitude, error, harmonics, *converged = lines[2].split()
    assert float(omega) == pytest.approx(peak.omega, rel=1e-5)
    assert float(hertz) == pytest.approx(peak.omega / (2 * np.pi), rel=1e-5)
    assert float(amplitude) == pytest.approx(1e3 * peak.amplitude, rel=1e-4)  # mm
    true = 1e3 * peak.amplitude - 1.455
    assert true < float(error) < 3.0 * true
    assert harmonics == "5"
    assert converged == ["12", "of", "12"]
    assert f"picture: {Path('results', 'beam.png')}" in lines
    assert f"results: {Path('results', 'beam-*.nc')} (2 files)" in lines


def test_a_study_without_levels_gives_one_file(folder):
    text = study_text("omega = [170, 180]\nharmonics = 5")
    (folder / "study.toml").write_text(text)
    result = invoke("run", "study.toml", "--out", "deep/er", "--no-plot")
    assert result.exit_code == 0
    (saved,) = (folder / "deep" / "er").iterdir()
    assert saved.name == f"{folder.name}.nc"
    assert result.stdout.split()[0] == "dof"
    assert "picture" not in result.stdout
    assert f"results: {Path('deep', 'er', saved.name)}" in result.stdout


def test_commands_that_are_told_can_be_copied(folder):
    text = study_text("omega = [170]\nharmonics = 1")
    (folder / "study.toml").write_text('name = "Blade 3, worn"\n' + text)
    lines = invoke("run", "study.toml", "--no-plot").stdout.splitlines()
    file = Path("results", "Blade 3, worn.nc")
    assert f"results: {file}" in lines
    for title, name in (("details", "show"), ("page:  ", "report")):
        (line,) = (one for one in lines if one.startswith(title))
        _, command = line.split(":", 1)
        assert shlex.split(command) == ["stickslip", name, str(file)]
        assert invoke(*shlex.split(command)[1:]).exit_code == 0


@pytest.mark.slow
def test_quiet_prints_nothing_when_all_is_well(folder):
    exact = FEW_POINTS.replace("harmonics = 5", "harmonics = 41")
    (folder / "study.toml").write_text('name = "beam"\n' + study_text(exact))
    result = invoke("run", "study.toml", "--quiet", "--no-plot")
    assert (result.exit_code, result.stdout, result.stderr) == (0, "", "")
    assert (folder / "results" / "beam-6.563.nc").exists()


@pytest.mark.slow
def test_timings_name_the_stages(folder):
    output = invoke("run", "study.toml", "--timings", "--quiet", "--no-plot").stdout
    for stage in (
        "compliance",
        "law (force, tangent)",
        "linear solve",
        "recovery",
        "error estimate",
        "total",
    ):
        assert stage in output
    assert "iterations" in output
    assert "factorisations" in output


def test_long_work_says_once_how_long_the_rest_will_take(capsys, monkeypatch):
    from stickslip.cli import console

    clock = iter([0.0, 1.0, 6.0, 8.0, 9.0])
    monkeypatch.setattr(console.time, "perf_counter", lambda: next(clock))
    with console.progress("blade", wanted=True) as advance:
        for share in (0.001, 0.002, 0.1, 0.2):
            advance(share)
    assert capsys.readouterr().err == "note: blade: about 72 s left (10% in 8 s)\n"


@pytest.mark.slow
def test_units_of_the_output_are_those_asked_for(folder):
    text = study_text("omega = { from = 180, to = 200, points = 5 }\nharmonics = 5")
    output = '[output]\nlength_unit = "um"\nomega_unit = "Hz"'
    (folder / "study.toml").write_text('name = "beam"\n' + text.replace("[output]", output))
    result = invoke("run", "study.toml").stdout
    heading, line, *_ = result.splitlines()
    assert "peak [um]" in heading
    peak = ss.load(folder / "results" / "beam.nc").peak("tip")
    assert float(line.split()[3]) == pytest.approx(1e6 * peak.amplitude, rel=1e-4)
    assert peak.at_edge
    assert line.split()[1] == "200.000*"
    assert "* at an end of the computed frequencies" in result


@pytest.mark.slow
def test_points_that_do_not_converge_are_named_with_advice_and_exit_code_1(folder):
    (folder / "study.toml").write_text(
        'name = "beam"\n' + study_text(FEW_POINTS + "\nmax_iterations = 1")
    )
    result = invoke("run", "study.toml", "--quiet", "--no-plot")
    assert result.exit_code == 1
    assert result.stdout == ""
    warnings = result.stderr.splitlines()
    assert all(line.startswith("warning: beam-") for line in warnings)
    assert "of 12 points stalled, between" in warnings[-1]
    assert "Raise max_iterations" in warnings[-1]
    assert (folder / "results" / "beam-20.313.nc").exists()


@pytest.mark.slow
def test_show_prints_the_model_the_peaks_and_the_assumptions(results):
    result = invoke("show", *sorted(results.glob("*.nc")))
    assert (result.exit_code, result.stderr) == (0, "")
    for text in (
        "beam-6.563.nc",
        "contact    jenkins: jenkins at damper, stiffness 2.4e+07, slip_force 246.048",
        "force      tip: harmonic 1, amplitude 20.313 N, phase 0 rad",
        "points     12 from 150 to 250 rad/s, 12 of 12 converged",
        "harmonics  5",
        "assumed    Only the odd harmonics up to 5",
    ):
        assert text in result.stdout


@pytest.mark.slow
@pytest.mark.parametrize(
    ("options", "name"),
    [
        ([], "beam-20.313-curve.png"),
        (["--dof", "tip", "--hertz", "--linear", "--per-force"], "beam-20.313-curve.png"),
        (["--dof", "tip", "--waveform", "170"], "beam-20.313-waveform.png"),
        (["--dof", "tip", "--rpm"], "beam-20.313-curve.png"),
        (["--loop", "27 Hz", "--contact", "jenkins"], "beam-20.313-loop.png"),
        (["--dof", "tip", "--out", "drawn/beam.svg"], "drawn/beam.svg"),
    ],
)
def test_plot_writes_a_picture(results, tmp_path, monkeypatch, options, name):
    monkeypatch.chdir(tmp_path)
    for file in results.glob("*.nc"):
        shutil.copy(file, tmp_path)
    result = invoke("plot", "beam-20.313.nc", "beam-6.563.nc", *options)
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout == f"picture: {Path(name)}\n"
    assert (tmp_path / name).stat().st_size > 5000


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--dof", "tpi"], "unknown dof 'tpi'; did you mean 'tip'?"),
        (["--waveform", "999"], "--waveform = '999': 999 rad/s lies outside the computed 150 to"),
        (["--loop", "27 N"], "--loop = '27 N' is not a frequency [rad/s]"),
        (["--loop", "1_70"], "--loop = '1_70' has an unknown unit '_70'"),
        (["--loop", "\u0661\u0667\u0660"], "is not a frequency [rad/s]"),
        (["--loop", "170", "--contact", "\u0660"], "unknown contact '\u0660'"),
        (["--loop", "nan"], "--loop = 'nan' is not a frequency [rad/s]"),
        (["--loop", "170", "--contact", "5"], "there is no contact at position 5"),
        (["--loop", "170", "--waveform", "170"], "--waveform and --loop exclude each other"),
        (["--contact", "jenkins"], "--contact: changes nothing of a forced response; leave it out"),
        (["--waveform", "170", "--linear"], "--linear: changes nothing of --waveform; leave it"),
        (["--loop", "170", "--per-force"], "--per-force: changes nothing of --loop; leave it out"),
        (["--loop", "170", "--dof", "tip"], "--dof: changes nothing of --loop; leave it out"),
        (["--hertz", "--rpm"], "--hertz and --rpm exclude each other; give one"),
        (["--out", "beam.xyz"], "beam.xyz: '.xyz' is no format of pictures; known: "),
    ],
)
def test_plot_refuses_what_it_cannot_draw(results, options, message):
    result = invoke("plot", results / "beam-20.313.nc", *options)
    assert (result.exit_code, result.stdout) == (2, "")
    (line,) = result.stderr.splitlines()
    assert message in line


def test_the_schema_is_json(tmp_path):
    result = invoke("schema")
    assert json.loads(result.stdout)["title"] == "stickslip study"
    file = tmp_path / "schema.json"
    assert invoke("schema", "--out", file).stdout == f"schema: {file}\n"
    assert file.read_text() == result.stdout


@pytest.mark.slow
def test_a_peak_beside_unsolved_points_is_marked(folder):
    analysis = "omega = {from = 150, to = 250, points = 60}\nharmonics = 9\nmax_iterations = 1"
    analysis += "\nlevels = [20.313]"
    (folder / "study.toml").write_text('name = "beam"\n' + study_text(analysis))
    result = invoke("run", "study.toml", "--no-plot")
    assert result.exit_code == 1
    assert result.stdout.splitlines()[1].split()[2].endswith("?")
    assert "? beside points that are not solved" in result.stdout
    assert "UserWarning" not in result.stderr


@pytest.mark.slow
def test_doubts_are_told_on_standard_error(folder):
    result = invoke("run", "study.toml", "--quiet", "--no-plot")
    assert result.exit_code == 0
    first, _ = result.stderr.splitlines()
    assert first.startswith(
        "warning: beam-6.563: The discarded harmonics could still change 'mode'"
    )
