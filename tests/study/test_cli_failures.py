"""The command line when something goes wrong: one line, and the exit code."""

import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import stickslip as ss
from beam_study import COMMAND, invoke, script, study_text


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
        (["run", "."], "error: .: is a folder; give the name of a file in it"),
        (
            ["run", "study.toml", "--out", "study.toml"],
            "error: study.toml: cannot be made (File exists)",
        ),
        (["show", "none.nc"], "error: none.nc: no such file"),
        (["show", "study.toml"], "error: study.toml: "),
        (["plot", "study.toml"], "error: study.toml: "),
        (["schema", "--out", "none/x.json"], "error: none/x.json: there is no folder none;"),
    ],
)
def test_a_bad_argument_ends_with_one_line_and_exit_code_2(folder, arguments, message):
    result = invoke(*arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    (line,) = result.stderr.splitlines()
    assert line.startswith(message)


@pytest.mark.slow
def test_exit_codes_reach_the_shell(folder):
    assert script("--version").returncode == 0
    refused = script("run", "none.toml")
    assert (refused.returncode, refused.stdout) == (2, "")
    assert refused.stderr == "error: none.toml: no such study file\n"


@pytest.mark.slow
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


@pytest.mark.slow
def test_ctrl_c_saves_what_was_computed_and_ends_with_130(folder):
    code = """
import os, signal, sys, time
# a shell in the background has its children ignore Ctrl-C
signal.signal(signal.SIGINT, signal.default_int_handler)
import stickslip.study.analysis as tables
from stickslip.cli import app
whole = tables.forced_response
sent = []
def interrupted(model, *arguments, **options):
    if model.forces[0].amplitude < 10:
        return whole(model, *arguments, **options)
    # The other level has a thread of its own; on a slow machine this one might end before it.
    while not os.path.exists("results/beam-1.nc"):
        time.sleep(0.01)
    told = options["progress"]
    def interrupt(fraction):
        # A second signal, on a slow machine, would end the run at once.
        if fraction > 0 and not sent:
            sent.append(fraction)
            os.kill(os.getpid(), signal.SIGINT)
        told(fraction)
    return whole(model, *arguments, **(options | {"progress": interrupt}))
tables.forced_response = interrupted
app(["run", "study.toml"])
"""
    analysis = "omega = {from = 150, to = 250, points = 20000}\nharmonics = 41\nlevels = [1, 20]"
    (folder / "study.toml").write_text('name = "beam"\n' + study_text(analysis))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 130
    # A slow machine is told first how long it takes.
    *_, first, line = done.stderr.splitlines()
    assert first == "interrupted: saving what was computed"
    assert line.startswith("interrupted: 1 of 2 curves complete in results, the next one as")
    assert sorted(file.name for file in (folder / "results").iterdir()) == [
        "beam-1.nc",
        "beam-20-partial.nc",
    ]
    partial = ss.load(folder / "results" / "beam-20-partial.nc")
    assert partial.interrupted
    assert partial.converged.all()
    assert 0 < partial.omega.size < 20000


@pytest.mark.slow
def test_a_complete_run_removes_what_an_interrupted_one_left(folder):
    analysis = "omega = [170.0]\nharmonics = 3"
    (folder / "study.toml").write_text('name = "beam"\n' + study_text(analysis))
    assert invoke("run", "study.toml", "--no-plot").exit_code == 0
    results = folder / "results"
    first, *_ = sorted(results.iterdir())
    partial = first.with_name(f"{first.stem}-partial.nc")
    shutil.copy(first, partial)  # of a study of this name: it says that it is whole
    assert invoke("run", "study.toml", "--no-plot").exit_code == 0
    assert partial.exists()
    replace(ss.load(partial), interrupted=True).save(partial)
    (results / "other-partial.nc").write_text("of another study")
    assert invoke("run", "study.toml", "--no-plot").exit_code == 0
    assert not partial.exists()
    assert (results / "other-partial.nc").exists()
    partial.write_text("no result")
    assert invoke("run", "study.toml", "--no-plot").exit_code == 0
    assert partial.exists()


@pytest.mark.slow
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


@pytest.mark.slow
def test_a_reader_that_leaves_stops_nothing(folder):
    command = [*COMMAND, "run", "study.toml"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    process.stdout.close()
    complaints = process.stderr.read()
    process.stderr.close()
    assert process.wait() == 0
    assert all(line.startswith("warning: beam-") for line in complaints.splitlines())
    assert (folder / "results" / "beam.png").exists()


@pytest.mark.slow
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
@pytest.mark.parametrize(
    ("arguments", "streams", "code", "message"),
    [
        ("--version", ">/dev/full", 2, "error: standard output: No space left on device; results"),
        ("run --help", ">/dev/full", 2, "error: standard output: No space left on device; results"),
        ("reproduce list", ">/dev/full", 2, "error: standard output: No space left on device; "),
        ("show none.nc", "2>/dev/full", 2, ""),
        ("show none.nc", ">&- 2>&-", 2, ""),
        ("--version", ">&-", 0, ""),
    ],
)
def test_streams_that_take_no_text_leave_the_exit_code(folder, arguments, streams, code, message):
    command = f'"$0" -c "{COMMAND[-1]}" {arguments} {streams}'
    shell = ["sh", "-c", command, sys.executable]
    done = subprocess.run(shell, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (code, "")
    assert done.stderr.startswith(message)
    assert done.stderr.count("\n") == bool(message)
