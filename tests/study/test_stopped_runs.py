"""Runs of the command that are stopped at any moment, and run again: as if nothing had happened."""

import importlib
import os
import random
import signal
import subprocess
import sys
import time
from typing import Annotated

import numpy as np
import pytest
import typer
from pydantic import BeforeValidator

import stickslip as ss
from failing_disk import names
from small_study import MISTUNED, PAD
from stickslip.cli.exit_codes import guarded
from stickslip.settings.entries import Table
from stickslip.settings.refusal import validated

UNCERTAIN = (
    PAD
    + """
[analysis]
kind = "uncertainty"
samples = 60
harmonics = 1
parameters = { "pad.slip_force" = { distribution = "uniform", loc = 1.5, scale = 1 } }
quantity = { kind = "highest-peak", dof = "tip", omega = { from = "10 Hz", to = "25 Hz" } }
"""
)
CURVES = (
    PAD
    + """
[analysis]
omega = { from = 60, to = 160, points = 2000 }
harmonics = 5
levels = [0.5, 1.0]
"""
)
STUDIES = {"ring": MISTUNED, "sampled": UNCERTAIN, "curves": CURVES}
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)
CODES = {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGKILL: -signal.SIGKILL}


def begin(folder, name):
    """Start a run, in which Ctrl-C is heeded whatever the parent does with it.

    The command has been loaded when this returns.
    """
    code = "from stickslip.cli import app; print(flush=True); app()"
    command = [sys.executable, "-c", code, "run", f"{name}.toml", "--no-plot", "--quiet"]
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}

    def heed():
        signal.signal(signal.SIGINT, signal.default_int_handler)

    run = subprocess.Popen(command, cwd=folder, preexec_fn=heed, **streams)
    run.stdout.readline()
    return run


def numbers(file):
    dataset = ss.load(file).to_dataset()
    return {
        name: one.values for name, one in dataset.variables.items() if one.dtype.kind in "fciub"
    }


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="there is no SIGKILL")
@pytest.mark.parametrize("name", STUDIES)
def test_a_run_that_was_stopped_anywhere_ends_as_an_unbroken_one(name, tmp_path):
    chance = random.Random(name)
    unbroken, stopped = tmp_path / "unbroken", tmp_path / "stopped"
    for folder in (unbroken, stopped):
        folder.mkdir()
        (folder / f"{name}.toml").write_text(STUDIES[name])
    with begin(unbroken, name) as run:
        started = time.monotonic()
        assert run.wait() == 0
    whole = time.monotonic() - started
    codes = []
    # What one run has stored spares the next: the first ones are stopped early.
    moments = sorted(chance.uniform(0.2, 1.0) * whole for _ in range(6))
    for number, moment in zip(SIGNALS * 2, moments, strict=True):
        with begin(stopped, name) as run:
            time.sleep(moment)
            run.send_signal(number)
            told = run.communicate()[1]
        codes.append(run.returncode)
        assert run.returncode in (0, CODES[number], -number)
        assert "Traceback" not in told
        results = stopped / "results"
        for file in results.glob("*.nc") if results.is_dir() else ():
            assert ss.load(file).interrupted == file.stem.endswith("-partial")
    # Left by a run that was killed while it wrote.
    left = stopped / "results" / ".stickslip-01234567-1-0123abcd.part"
    left.parent.mkdir(exist_ok=True)
    left.write_bytes(b"half a fi")
    os.utime(left, (time.time() - 7200.0,) * 2)
    with begin(stopped, name) as run:
        assert run.wait() == 0
    assert names(stopped / "results") == names(unbroken / "results")
    for file in (unbroken / "results").glob("*.nc"):
        expected, found = numbers(file), numbers(stopped / "results" / file.name)
        assert expected.keys() == found.keys()
        for variable, values in expected.items():
            np.testing.assert_array_equal(found[variable], values, err_msg=variable)
    # Otherwise nothing was stopped.
    assert any(codes)


def swallowing(number):
    """Return the text of a module that loses the exception of a signal while it is imported."""
    return f"""
import signal
import time

try:
    signal.raise_signal({number})
    time.sleep(0.01)
except KeyboardInterrupt:
    pass
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_that_comes_during_an_import_is_not_lost(number, tmp_path, monkeypatch):
    (tmp_path / "swallowing.py").write_text(swallowing(int(number)))
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "swallowing", raising=False)

    @guarded
    def wait():
        import swallowing  # noqa: F401

        time.sleep(20.0)
        raise AssertionError("not stopped")

    with pytest.raises(typer.Exit) as stop:
        wait()
    assert stop.value.exit_code == CODES[number]


def test_a_signal_is_heeded_at_once_where_a_module_that_is_imported_calls(tmp_path, monkeypatch):
    text = """
import signal
import time
from stickslip.cli.exit_codes import guarded

def wait():
    signal.raise_signal(signal.SIGTERM)
    time.sleep(1.0)
    raise AssertionError("not stopped")

guarded(wait)()
"""
    (tmp_path / "calling.py").write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(typer.Exit) as stop:
        importlib.import_module("calling")
    assert stop.value.exit_code == CODES[signal.SIGTERM]


def test_an_error_that_takes_the_place_of_the_signal_is_no_defect():
    @guarded
    def fail():
        try:
            signal.raise_signal(signal.SIGTERM)
        except KeyboardInterrupt:
            raise RuntimeError("half done") from None

    with pytest.raises(typer.Exit) as stop:
        fail()
    assert stop.value.exit_code == CODES[signal.SIGTERM]


def test_a_signal_during_the_check_of_settings_is_no_refused_value():
    def pressed(value):
        signal.raise_signal(signal.SIGINT)
        return value

    class Pressed(Table):
        value: Annotated[float, BeforeValidator(pressed)]

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            validated(Pressed, {"value": 1.0})
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.skipif(os.name != "posix", reason="exit codes of signals")
@pytest.mark.parametrize("module", ["numpy", "typer", "stickslip.cli.run", "stickslip.study"])
def test_ctrl_c_while_the_command_is_loaded_is_a_line(module, tmp_path):
    (tmp_path / "study.toml").write_text(PAD)
    code = f"""
import signal
import sys


class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == {module!r}:
            signal.raise_signal(signal.SIGINT)


sys.meta_path.insert(0, Finder())
from stickslip_command import main

main()
"""
    command = [sys.executable, "-c", code, "run", "study.toml"]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert run.returncode == 130
    assert run.stderr.splitlines() == ["interrupted: nothing more was saved"]
