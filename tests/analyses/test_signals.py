"""Signals at any moment: every analysis ends, and what was computed is kept."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from beam_study import COMMAND, EXAMPLE, study_text
from stickslip.interruption import Interruption
from stickslip.reference import beam_ring, snecma_beam
from stickslip.results.arrays import Arrays

pytestmark = pytest.mark.timeout(60)

PREAMBLE = '''
import json, os, resource, signal, sys, threading, time
import numpy as np
import stickslip as ss
from stickslip.reference import beam_ring, snecma_beam
signal.signal(signal.SIGINT, signal.default_int_handler)

def chain(n, contacts):
    stiffness = 2.02e4 * np.eye(n) - 1e4 * (np.eye(n, k=1) + np.eye(n, k=-1))
    dofs = [f"x{i}" for i in range(n)]
    structure = ss.Structure(np.eye(n), stiffness, ss.Rayleigh(mass=0.05, stiffness=1e-6), dofs)
    pads = [ss.Jenkins(dofs[3 * i], stiffness=5e3, slip_force=1.0) for i in range(contacts)]
    return ss.Model(structure, pads, [ss.Force(dofs[n // 2], 5.0)])

def press(delay):
    threading.Timer(delay, os.kill, (os.getpid(), signal.SIGINT)).start()

def pressed(analysis, delay=0.3, least=-1.0):
    """What an analysis leaves behind when Ctrl-C is pressed while it runs.

    Without a delay the analysis is given what presses when more than the least share is done.
    """
    try:
        if delay is None:
            presses = iter([press])
            analysis(lambda done: next(presses, lambda _: None)(0.05) if done > least else None)
        else:
            press(delay)
            analysis()
    except ss.Interrupted as stop:
        return type(stop.result).__name__
    except KeyboardInterrupt:
        return "nothing"
    return "not stopped"
'''

# Each would run for minutes. What it leaves behind, and how it is called.
ANALYSES = {
    "forced_response": ("ForcedResponse", "ss.forced_response(big, grid, harmonics=63)"),
    "broyden": ("ForcedResponse", "ss.forced_response(big, grid, 31, method='broyden')"),
    "marched": (
        "ForcedResponse",
        "ss.forced_response(big, grid, 31, evaluation='marched', samples=4096)",
    ),
    "single_harmonic": ("ForcedResponse", "ss.single_harmonic(big, np.tile(grid, 100))"),
    "exact_response": ("ExactResponse", "ss.exact_response(big, grid)"),
    "transient": ("Transient", "ss.transient(big, 0.01, 1000, samples=2)"),
    "rk4": (
        "Transient",
        "ss.transient(big, 0.1, 1000, scheme='rk4', steps=20000, samples=2, progress=p)",
    ),
    "damper_curve": (
        "DamperCurve",
        "ss.damper_curve(big, slip_force=np.geomspace(0.1, 10, 2000), dof='x3', progress=p)",
    ),
    "optimal_damper": ("DamperCurve", "ss.optimal_damper(big, dof='x3', harmonics=15)"),
    "limit_cycles": ("LimitCycles", "ss.limit_cycles(alone, negative, mode=0, harmonics=31)"),
    "exact cycles": ("LimitCycles", "ss.limit_cycles(alone, negative, mode=0, method='exact')"),
    "stability_map": (
        "StabilityMap",
        "ss.stability_map(alone, negative, stiffness=np.geomspace(1e2, 1e5, 300))",
    ),
    "classify": ("MotionClass", "ss.classify(alone, {'x0': 5.0}, periods=10**6)"),
    "basin_map": (
        "BasinMap",
        "ss.basin_map(alone, {'x0': np.arange(30.0), 'x3': np.arange(30.0)}, threads=1, "
        "progress=p)",
    ),
    "mistuning_study": (
        "MistuningStudy",
        "ss.mistuning_study(beam_ring(24, 7e3, 3), 0.05, omega=(150, 260), patterns=500, seed=1, "
        "progress=p)",
    ),
    "certify": ("ForcedResponse", "ss.certify(curve, 'all')"),
    "sensitivity": ("nothing", "[curve.sensitivity('x3') for _ in range(1000)]"),
    "contact_force": ("nothing", "curve.contact_force(0, 0, 10**8)"),
    "natural_frequencies": ("nothing", "ss.natural_frequencies(chain(1500, 2))"),
}


# CPython ends by the signal where Ctrl-C once met an exec(), as of a named tuple in an import,
# though it was caught.
END = "\nsys.stdout.flush()\nos._exit(0)\n"


def child(code, **options):
    return subprocess.run(
        [sys.executable, "-c", PREAMBLE + code + END],
        capture_output=True,
        text=True,
        check=True,
        timeout=50,
        env=os.environ | {"OMP_NUM_THREADS": "1"},
        **options,
    )


@pytest.mark.slow
def test_ctrl_c_stops_every_analysis():
    calls = ",\n".join(f"{name!r}: lambda p=None: {call}" for name, (_, call) in ANALYSES.items())
    code = f"""
big = chain(60, 15)
alone, negative = ss.Model(big.structure, big.contacts), -0.1 * np.eye(60)
grid = np.linspace(10, 260, 5000)
curve = ss.forced_response(chain(40, 10), np.linspace(10, 60, 200), harmonics=5)
calls = {{{calls}}}
# These are prepared for a while, in which there is nothing to keep.
late = {{"basin_map": -1.0, "mistuning_study": -1.0, "rk4": -1.0, "damper_curve": 0.0}}
whens = {{n: (None, late[n]) if n in late else (0.3,) for n in calls}}
print(json.dumps({{n: pressed(call, *whens[n]) for n, call in calls.items()}}))
"""
    left = json.loads(child(code).stdout)
    assert left == {name: kind for name, (kind, _) in ANALYSES.items()}


@pytest.mark.slow
def test_points_that_were_not_computed_take_no_memory():
    code = """
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
grid = np.linspace(100, 250, 1000000)
print(pressed(lambda tell: ss.forced_response(snecma_beam(), grid, 15, progress=tell), None))
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
"""
    kind, kilobytes = child(code).stdout.split()
    assert kind == "ForcedResponse"
    # A million points that say that they were not computed took 0.7 GB.
    assert int(kilobytes) < 400_000


def test_a_signal_behind_the_last_point_loses_nothing(ctrl_c, monkeypatch):
    of, presses = Arrays.of, iter(range(2))

    def converting(solution):
        if next(presses, None) is not None:
            os.kill(os.getpid(), signal.SIGINT)
        return of(solution)

    monkeypatch.setattr(Arrays, "of", converting)
    with pytest.raises(ss.Interrupted, match="when all was computed") as caught:
        ss.forced_response(snecma_beam(), [150.0, 190.0], 3)
    # Ctrl-C while the result is made that was stopped ends that; it can be asked for again.
    with pytest.raises(KeyboardInterrupt):
        _ = caught.value.result
    assert not caught.value.result.interrupted
    assert caught.value.result.converged.all()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.parametrize("how", ["signal", "exception"])
def test_ctrl_c_in_a_callback_keeps_what_was_computed(ctrl_c, how):
    def callback(share):
        if share > 0.0 and how == "exception":
            raise KeyboardInterrupt
        if share > 0.0:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(50)

    with pytest.raises(ss.Interrupted) as caught:
        ss.forced_response(snecma_beam(), np.linspace(150, 250, 200_000), 15, progress=callback)
    assert caught.value.result.interrupted
    assert 0 < caught.value.result.omega.size < 200_000


def test_ctrl_c_at_the_end_of_progress_keeps_the_result():
    def callback(share):
        if share == 1.0:
            raise KeyboardInterrupt

    with pytest.raises(ss.Interrupted) as caught:
        ss.exact_response(snecma_beam(), [190.0], progress=callback)
    assert caught.value.result.converged.all()


@pytest.mark.slow
def test_a_second_signal_is_heeded_at_once(ctrl_c):
    reached = []

    def press_twice():
        with Interruption():
            os.kill(os.getpid(), signal.SIGINT)
            reached.append("first")
            time.sleep(0.6)
            os.kill(os.getpid(), signal.SIGINT)
            reached.append("second")

    with pytest.raises(KeyboardInterrupt):
        press_twice()
    assert reached == ["first"]


def test_handlers_of_the_caller_are_called():
    seen = []
    before = signal.signal(signal.SIGTERM, lambda number, _: seen.append(number))
    try:
        with Interruption() as watch:
            os.kill(os.getpid(), signal.SIGTERM)
            assert seen == []
            watch(0.5)
            assert seen == [signal.SIGTERM]
            os.kill(os.getpid(), signal.SIGTERM)
        assert seen == [signal.SIGTERM] * 2
    finally:
        signal.signal(signal.SIGTERM, before)


LONG = "omega = {from = 150, to = 250, points = 300000}\nharmonics = 31"
SHORT = "omega = {from = 150, to = 250, points = 300}\nharmonics = 31"


def write_study(folder, text):
    for file in ("mass.mtx", "stiffness.mtx"):
        shutil.copy(EXAMPLE / file, folder)
    (folder / "study.toml").write_text('name = "beam"\n' + study_text(text))


def run_study(folder, *, ignored=()):

    def as_in_a_terminal():
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            ignore = number in ignored
            signal.signal(number, signal.SIG_IGN if ignore else signal.SIG_DFL)

    return subprocess.Popen(
        [*COMMAND, "run", "study.toml", "--no-plot"],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=as_in_a_terminal,
    )


@pytest.mark.slow
@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_every_signal_that_ends_a_run_saves_what_was_computed(tmp_path, number, code):
    write_study(tmp_path, LONG)
    process = run_study(tmp_path)
    # The folder is made when the study has been read.
    while process.poll() is None and not (tmp_path / "results").exists():
        time.sleep(0.02)
    time.sleep(1.5)
    process.send_signal(number)
    _, complaints = process.communicate(timeout=50)
    assert process.returncode == code, complaints
    first, last = complaints.splitlines()
    assert first == "interrupted: saving what was computed"
    assert last.startswith("interrupted: 0 of 1 curves complete in results, the next one as far")
    partial = ss.load(tmp_path / "results" / "beam-partial.nc")
    assert partial.interrupted
    assert 0 < partial.omega.size < 300_000


@pytest.mark.slow
def test_signals_that_the_parent_ignores_stay_ignored(tmp_path):
    write_study(tmp_path, SHORT)
    process = run_study(tmp_path, ignored=(signal.SIGINT, signal.SIGHUP))
    while process.poll() is None and not (tmp_path / "results").exists():
        time.sleep(0.02)
    process.send_signal(signal.SIGHUP)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=50)
    assert process.returncode == 0
    assert ss.load(tmp_path / "results" / "beam.nc").omega.size == 300


@pytest.mark.slow
def test_ctrl_c_while_a_file_is_saved_finishes_it(tmp_path, monkeypatch, ctrl_c):
    from typer.testing import CliRunner

    from stickslip.cli import app
    from stickslip.results import store

    write_study(tmp_path, SHORT + "\nlevels = [1, 2]")
    monkeypatch.chdir(tmp_path)
    save = store.save

    def saving(*arguments):
        os.kill(os.getpid(), signal.SIGINT)
        save(*arguments)

    monkeypatch.setattr(store, "save", saving)
    done = CliRunner().invoke(app, ["run", "study.toml", "--no-plot"])
    assert done.exit_code == 130
    # What the other level, in a thread of its own, has come to is kept, too.
    files = {file.name: ss.load(file) for file in Path("results").iterdir()}
    whole = [name for name, result in files.items() if not result.interrupted]
    assert "beam-1.nc" in whole
    assert f"interrupted: {len(whole)} of 2 curves complete in results" in done.stderr
    assert all(result.converged.all() for result in files.values())
    assert all(name.endswith("-partial.nc") for name in files if name not in whole)


@pytest.mark.slow
@pytest.mark.parametrize(
    "call",
    [
        "ss.forced_response(chain(40, 1), np.linspace(300, 900, count), 7)",
        "ss.transient(chain(40, 2), 20.0, count // 10, samples=256, observe=['x1', 'x2', 'x3'])",
    ],
)
def test_the_memory_that_is_reckoned_is_what_is_taken(call, tmp_path):
    code = f"""
from stickslip import memory
def status(name):
    (line,) = [line for line in open("/proc/self/status") if line.startswith(name)]
    return 1024 * int(line.split()[1])
count = 10
result = {call}
result.save({str(tmp_path / "file.nc")!r})
needed, refuse = [], memory.require_numbers
def reckon(numbers, *arguments, core=None):
    needed.append(8 * ((numbers if core is None else core) + memory.COPIES * numbers))
for module in list(sys.modules.values()):
    if getattr(module, "require_numbers", None) is refuse:
        module.require_numbers = reckon
del result
count = 20_000
before = status("VmRSS")
result = {call}
result.save({str(tmp_path / "file.nc")!r})
print(json.dumps([max(needed), status("VmHWM") - before]))
"""
    needed, taken = json.loads(child(code).stdout)
    assert taken <= needed <= 2.5 * taken


def test_a_grid_beyond_the_memory_is_refused_in_one_line(monkeypatch):
    monkeypatch.setattr("stickslip.memory.physical_memory", lambda: 10**9)
    ring = beam_ring(36, 7e3, 3).mistuned(np.zeros(36))
    with pytest.raises(ss.ModelError, match=r"^omega: the result of 200000 points") as refused:
        ss.forced_response(ring, np.linspace(150, 260, 200_000), 7)
    assert "\n" not in str(refused.value)
    with pytest.raises(ss.ModelError, match=r"^patterns: 1000000000 of 36 sectors"):
        ss.mistuning_study(beam_ring(36, 7e3, 3), 0.05, omega=(150, 260), patterns=10**9)
