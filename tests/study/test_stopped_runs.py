"""Runs of the command that are stopped at any moment, and run again: as if nothing had happened."""

import os
import random
import signal
import subprocess
import time

import numpy as np
import pytest

import stickslip as ss
from beam_study import COMMAND
from failing_disk import names
from small_study import MISTUNED, PAD

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
    """Start a run, in which Ctrl-C is heeded whatever the parent does with it."""
    command = [*COMMAND, "run", f"{name}.toml", "--no-plot", "--quiet"]
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}

    def heed():
        signal.signal(signal.SIGINT, signal.default_int_handler)

    return subprocess.Popen(command, cwd=folder, preexec_fn=heed, **streams)


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
    started = time.monotonic()
    with begin(unbroken, name) as run:
        assert run.wait() == 0
    whole = time.monotonic() - started
    codes = []
    for number in SIGNALS * 2:
        with begin(stopped, name) as run:
            time.sleep(chance.uniform(0.3, 1.0) * whole)
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
