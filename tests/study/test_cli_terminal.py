"""The command line on a terminal: tables, progress and help."""

import io
import subprocess
import sys
from pathlib import Path

import pytest

import stickslip as ss
from beam_study import COMMAND, invoke
from stickslip.cli import console
from stickslip.views.curves import CurveView


@pytest.mark.slow
def test_plain_output_has_no_colour_no_frame_and_no_trailing_blanks(folder):
    result = invoke("run", "study.toml", "--no-plot", "--timings")
    assert result.exit_code == 0
    assert "\x1b" not in result.stdout
    assert result.stdout.isascii()
    assert all(line == line.rstrip() for line in result.stdout.splitlines())


@pytest.mark.slow
def test_help_of_every_command_ends_with_examples():
    assert "stickslip run" in invoke("--help").stdout
    for command in ("run", "show", "plot", "schema"):
        result = invoke(command, "--help")
        assert result.exit_code == 0
        assert f"stickslip {command}" in result.stdout.split("Examples")[1]


@pytest.mark.slow
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


class Screen(io.StringIO):
    def isatty(self):
        return True


def test_the_bar_appears_only_on_a_terminal_and_only_for_long_work(monkeypatch, capsys):
    with console.progress("beam", wanted=True) as advance:
        advance(0.3)
    assert "beam" not in capsys.readouterr().err
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


@pytest.mark.slow
def test_a_terminal_gets_a_framed_table(results, monkeypatch):
    monkeypatch.setattr(sys, "stdout", Screen())
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "80")
    result = ss.load(results / "beam-20.313.nc")
    console.show_all(CurveView().tables([("a", result)], "level", ["tip"], "mm"))
    assert "─" in sys.stdout.getvalue()
    assert "…" not in sys.stdout.getvalue()
    assert "peak [mm]" in sys.stdout.getvalue()
    monkeypatch.setattr(sys, "stdout", Screen())
    monkeypatch.setenv("COLUMNS", "50")
    console.show_all(CurveView().tables([("a", result)], "level", ["tip"], "mm"))
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


@pytest.mark.slow
def test_only_the_peaks_that_are_shown_are_refined(results, monkeypatch):
    result = ss.load(results / "beam-20.313.nc")
    console.show_all(CurveView().tables([("", result)], "", ["tip", "none"], "m"))
    assert {dof for dof, _ in result._peaks} == {"tip"}


def test_flags_are_shown_without_a_type():
    for command in ("run", "show", "plot", "schema"):
        assert "<bool>" not in invoke(command, "--help").stdout
    assert "<bool>" not in invoke("--help").stdout


@pytest.mark.slow
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
