import io
import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import stickslip as ss
from stickslip.cli import app, console, curves

EXAMPLE = Path(__file__).parents[1] / "examples" / "snecma-beam"
COMMAND = [sys.executable, "-c", "from stickslip.cli import app; app()"]

FEW_POINTS = (
    "omega = { from = 150, to = 250, points = 12 }\nharmonics = 5\nlevels = [6.563, 20.313]"
)


def study_text(analysis=FEW_POINTS):
    text = (EXAMPLE / "study.toml").read_text()
    head, tail = text.split("[analysis]")
    return f"{head}[analysis]\n{analysis}\n[output]{tail.split('[output]')[1]}"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    for file in ("mass.mtx", "stiffness.mtx"):
        shutil.copy(EXAMPLE / file, tmp_path)
    (tmp_path / "study.toml").write_text('name = "beam"\n' + study_text())
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("results")
    for load in (6.563, 20.313):
        model = ss.reference.snecma_beam(load)
        omega = np.linspace(150, 250, 12)
        ss.forced_response(model, omega, 5).save(folder / f"beam-{load}.nc")
    return folder


def invoke(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def script(*arguments, **options):
    command = [*COMMAND, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


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
    assert float(amplitude) == pytest.approx(peak.amplitude, rel=1e-4)
    assert 0 < float(error) < 0.1 * peak.amplitude
    assert harmonics == "5"
    assert converged == ["12", "of", "12"]
    assert f"picture: {Path('results', 'beam.png')}" in lines
    assert f"results: {Path('results', 'beam-*.nc')} (2 files)" in lines


def test_plain_output_has_no_colour_no_frame_and_no_trailing_blanks(folder):
    result = invoke("run", "study.toml", "--no-plot", "--timings")
    assert result.exit_code == 0
    assert "\x1b" not in result.stdout
    assert result.stdout.isascii()
    assert all(line == line.rstrip() for line in result.stdout.splitlines())


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


def test_quiet_prints_nothing_when_all_is_well(folder):
    exact = FEW_POINTS.replace("harmonics = 5", "harmonics = 41")
    (folder / "study.toml").write_text('name = "beam"\n' + study_text(exact))
    result = invoke("run", "study.toml", "--quiet", "--no-plot")
    assert (result.exit_code, result.stdout, result.stderr) == (0, "", "")
    assert (folder / "results" / "beam-6.563.nc").exists()


def test_timings_name_the_stages(folder):
    output = invoke("run", "study.toml", "--timings", "--quiet", "--no-plot").stdout
    for stage in ("compliance", "law (force, tangent)", "linear solve", "recovery", "total"):
        assert stage in output
    assert "iterations" in output
    assert "factorisations" in output


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


@pytest.mark.parametrize(
    ("written", "instead", "message"),
    [
        ("[[contact]]", "[[contakt]]", "unknown key 'contakt'; did you mean 'contact'?"),
        (
            "slip_force",
            "slipforce",
            "contact 1: unknown key 'slipforce'; did you mean 'slip_force'?",
        ),
        ('"mass.mtx"', '"mas.mtx"', "structure: mass = 'mas.mtx': no such file in "),
        ('"mass.mtx"', '"study.toml"', "study.toml: unknown file ending '.toml'"),
        ('"mass.mtx"', '"broken.mtx"', "broken.mtx: cannot be read as .mtx"),
        ('"mass.mtx"', '"small.mtx"', "structure: dofs: 3 names for 1 dofs"),
        ('"1 N"', '"1 kg"', "force 1: amplitude = '1 kg' is not a force [N]"),
        ('"1 N"', "nan", "force 1: amplitude = nan is not finite"),
        ('"24 kN/mm"', '"24 kN/mn"', "stiffness = '24 kN/mn' has an unknown unit 'kN/mn'"),
        ('dof = "tip"', 'dof = "tpi"', "force 1: unknown dof 'tpi'; did you mean 'tip'?"),
        ('"tip", "mode"', '"tip", "tip"', "structure: dofs: 'tip' is given more than once"),
        ("from = 150", "from = -150", "analysis: omega.from = -150 must be positive"),
        ("harmonics = 5", "harmonics = 5000", "harmonics: 5000 lies above max_harmonics"),
        ("levels = [", "levels = [6.563, ", "analysis: levels holds 6.563 twice"),
        ("[analysis]", "[analysis", "not valid TOML: "),
    ],
)
def test_a_bad_study_ends_with_one_line_and_exit_code_2(folder, written, instead, message):
    (folder / "broken.mtx").write_text("no matrix")
    (folder / "small.mtx").write_text("%%MatrixMarket matrix array real general\n1 1\n1.0\n")
    text = (folder / "study.toml").read_text()
    assert written in text
    (folder / "study.toml").write_text(text.replace(written, instead, 1))
    result = invoke("run", "study.toml")
    assert result.exit_code == 2
    assert result.stdout == ""
    (line,) = result.stderr.splitlines()
    assert line.startswith("error: study.toml: ")
    assert message in line
    assert not list((folder).glob("results/*"))


def test_a_second_contact_of_the_same_name_is_refused(folder):
    text = (folder / "study.toml").read_text()
    contact = text[text.index("[[contact]]") : text.index("[[force]]")] + 'name = "damper"\n'
    (folder / "study.toml").write_text(text.replace("[[force]]", contact * 2 + "[[force]]"))
    result = invoke("run", "study.toml")
    assert result.exit_code == 2
    assert "error: study.toml: contact 3: name = 'damper' is that of contact 2 too" in result.stderr


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run", "none.toml"], "error: none.toml: no such study file"),
        (["run", "."], "error: .: is a folder; name the study file in it"),
        (["run", "study.toml", "--out", "study.toml"], "error: study.toml: File exists"),
        (["show", "none.nc"], "error: none.nc: no such file"),
        (["show", "study.toml"], "error: study.toml: "),
        (["plot", "study.toml"], "error: study.toml: "),
        (["schema", "--out", "none/x.json"], "error: none/x.json: No such file or directory"),
    ],
)
def test_a_bad_argument_ends_with_one_line_and_exit_code_2(folder, arguments, message):
    result = invoke(*arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    (line,) = result.stderr.splitlines()
    assert line.startswith(message)


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


@pytest.mark.parametrize(
    ("options", "name"),
    [
        ([], "beam-20.313-curve.png"),
        (["--dof", "tip", "--hertz", "--linear", "--per-force"], "beam-20.313-curve.png"),
        (["--dof", "tip", "--waveform", "170"], "beam-20.313-waveform.png"),
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
        (["--waveform", "999"], "--waveform = '999' is 999 rad/s, outside the computed 150 to 250"),
        (["--loop", "27 N"], "--loop = '27 N' is not a frequency [rad/s]"),
        (["--loop", "nan"], "--loop = nan is not finite"),
        (["--loop", "170", "--contact", "5"], "there is no contact at position 5"),
        (["--loop", "170", "--waveform", "170"], "--waveform and --loop exclude each other"),
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


def test_help_of_every_command_ends_with_examples():
    assert "stickslip run" in invoke("--help").stdout
    for command in ("run", "show", "plot", "schema"):
        result = invoke(command, "--help")
        assert result.exit_code == 0
        assert f"stickslip {command}" in result.stdout.split("Examples")[1]


def test_version_and_help_load_no_heavy_library():
    code = (
        "import sys\nfrom stickslip.cli import app\n"
        "try: app(['--version'])\n"
        "except SystemExit: pass\n"
        "heavy = {'scipy', 'xarray', 'matplotlib', 'pint', 'pydantic'} & set(sys.modules)\n"
        "sys.exit(str(heavy) if heavy else 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, f"stickslip {ss.__version__}\n")


def test_exit_codes_reach_the_shell(folder):
    assert script("--version").returncode == 0
    refused = script("run", "none.toml")
    assert (refused.returncode, refused.stdout) == (2, "")
    assert refused.stderr == "error: none.toml: no such study file\n"


@pytest.mark.parametrize("debug", [False, True])
def test_a_traceback_is_shown_on_request_only(debug, folder, monkeypatch):
    monkeypatch.setenv("STICKSLIP_DEBUG", str(int(debug)))
    done = script("run", "none.toml")
    assert ("Traceback" in done.stderr) is debug
    assert "none.toml: no such study file" in done.stderr


def test_a_defect_is_one_line_that_says_how_to_report_it(folder, monkeypatch):
    def broken(*_):
        raise ZeroDivisionError("two\nlines")

    monkeypatch.setattr("stickslip.study.Study.load", broken)
    result = invoke("run", "study.toml")
    assert result.exit_code == 70
    (line,) = result.stderr.splitlines()
    assert line.startswith(
        "error: ZeroDivisionError: two lines (this is a defect of stickslip; set"
    )


def test_ctrl_c_saves_what_was_computed_and_ends_with_130(folder):
    code = """
import os, signal, sys
# a shell in the background has its children ignore Ctrl-C
signal.signal(signal.SIGINT, signal.default_int_handler)
import stickslip.study.analysis_tables as tables
from stickslip.cli import app
whole = tables.forced_response
def interrupted(model, *arguments, **options):
    if model.forces[0].amplitude < 10:
        return whole(model, *arguments, **options)
    def interrupt(fraction):
        if fraction > 0:
            os.kill(os.getpid(), signal.SIGINT)
    return whole(model, *arguments, **(options | {"progress": interrupt}))
tables.forced_response = interrupted
app(["run", "study.toml"])
"""
    analysis = "omega = {from = 150, to = 250, points = 4000}\nharmonics = 41\nlevels = [1, 20]"
    (folder / "study.toml").write_text('name = "beam"\n' + study_text(analysis))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 130
    first, *_, line = done.stderr.splitlines()
    assert first == "interrupted: saving what was computed"
    assert line.startswith("interrupted: 1 of 2 curves complete in results, the next one as")
    assert sorted(file.name for file in (folder / "results").iterdir()) == [
        "beam-1.nc",
        "beam-20-partial.nc",
    ]
    partial = ss.load(folder / "results" / "beam-20-partial.nc")
    assert partial.interrupted
    assert partial.converged.all()
    assert 0 < partial.omega.size < 4000


class Screen(io.StringIO):
    def isatty(self):
        return True


def test_the_bar_appears_only_on_a_terminal_and_only_for_long_work(monkeypatch):
    with console.progress("beam", wanted=True) as advance:
        assert advance is None
    for name in ("stdout", "stderr"):
        monkeypatch.setattr(sys, name, Screen())
    monkeypatch.setenv("TERM", "xterm")
    with console.progress("beam", wanted=False) as advance:
        assert advance is None
    with console.progress("beam", wanted=True) as advance:
        advance(0.3)
    assert sys.stderr.getvalue() == ""
    monkeypatch.setattr(console, "_PATIENCE", 0.0)
    with console.progress("beam", wanted=True) as advance:
        advance(0.3)
    assert "beam" in sys.stderr.getvalue()
    assert "30%" in sys.stderr.getvalue()
    assert sys.stdout.getvalue() == ""


def test_a_terminal_gets_a_framed_table(results, monkeypatch):
    monkeypatch.setattr(sys, "stdout", Screen())
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "80")
    result = ss.load(results / "beam-20.313.nc")
    curves.peaks([("a", result)], "level", ["tip"], "mm")
    assert "─" in sys.stdout.getvalue()
    assert "…" not in sys.stdout.getvalue()
    assert "peak [mm]" in sys.stdout.getvalue()
    monkeypatch.setattr(sys, "stdout", Screen())
    monkeypatch.setenv("COLUMNS", "50")
    curves.peaks([("a", result)], "level", ["tip"], "mm")
    heading, line = sys.stdout.getvalue().splitlines()
    assert heading.split() == [
        "level",
        "dof",
        "rad/s",
        "Hz",
        "peak",
        "[mm]",
        "error",
        "[mm]",
        "H",
        "converged",
    ]
    assert line.split()[:2] == ["a", "tip"]


def test_only_the_peaks_that_are_shown_are_refined(results, monkeypatch):
    result = ss.load(results / "beam-20.313.nc")
    curves.peaks([("", result)], "", ["tip", "none"], "m")
    assert {dof for dof, _ in result._peaks} == {"tip"}


def test_a_peak_beside_unsolved_points_is_marked(folder):
    analysis = "omega = {from = 150, to = 250, points = 60}\nharmonics = 9\nmax_iterations = 1"
    analysis += "\nlevels = [20.313]"
    (folder / "study.toml").write_text('name = "beam"\n' + study_text(analysis))
    result = invoke("run", "study.toml", "--no-plot")
    assert result.exit_code == 1
    assert result.stdout.splitlines()[1].split()[2].endswith("?")
    assert "? beside points that are not solved" in result.stdout
    assert "UserWarning" not in result.stderr


def test_doubts_are_told_on_standard_error(folder):
    result = invoke("run", "study.toml", "--quiet", "--no-plot")
    assert result.exit_code == 0
    first, _ = result.stderr.splitlines()
    assert first.startswith(
        "warning: beam-6.563: The discarded harmonics could still change 'mode'"
    )


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run"], "error: Missing argument 'STUDY.toml'"),
        (["run", "study.toml", "--foo"], "error: No such option: --foo"),
        (["rnu"], "error: No such command 'rnu'. Did you mean 'run'?"),
        (["plot", "a.nc", "--dof"], "error: Option '--dof' requires an argument"),
    ],
)
def test_usage_errors_are_one_line(folder, arguments, message):
    result = invoke(*arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    (line,) = result.stderr.splitlines()
    assert line.startswith(message)
    assert script(*arguments).stderr == result.stderr


def test_flags_are_shown_without_a_type():
    for command in ("run", "show", "plot", "schema"):
        assert "<bool>" not in invoke(command, "--help").stdout
    assert "<bool>" not in invoke("--help").stdout


def test_a_full_disk_is_named():
    if not Path("/dev/full").exists():
        pytest.skip("no /dev/full here")
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [*COMMAND, "schema"], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert done.returncode == 2
    assert done.stderr.startswith("error: standard output: No space left on device; ")
    assert len(done.stderr.splitlines()) == 1


def test_a_reader_that_leaves_stops_nothing(folder):
    command = [*COMMAND, "run", "study.toml"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    process.stdout.close()
    complaints = process.stderr.read()
    process.stderr.close()
    assert process.wait() == 0
    assert all(line.startswith("warning: beam-") for line in complaints.splitlines())
    assert (folder / "results" / "beam.png").exists()
