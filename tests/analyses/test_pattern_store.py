"""Stores of mistuning studies: killed runs go on, other studies and other files are refused."""

import random
import signal
import sqlite3
import subprocess
import sys
import textwrap
from contextlib import closing

import numpy as np
import pytest

import stickslip as ss
from stickslip.analyses import pattern_store
from stickslip.analyses.pattern_store import Key, PatternStore, Row

PATTERNS = 250

# A process that imports the package once and then, told to on its standard input, lets a copy of
# itself run the study, which writes a line whenever it has handed a disk to the store.
RUNNER = """
import os, signal, sys, time
import stickslip as ss
from stickslip import _core
from stickslip.analyses.pattern_store import PatternStore
from stickslip.disk import mistuned
ss.mistuning_study, ss.reference.beam_ring
store, log, patterns = sys.argv[1], sys.argv[2], int(sys.argv[3])
add = PatternStore.add
def logged(self, key, rows, points):
    add(self, key, rows, points)
    os.write(out, b"%d\\n" % key.pattern)
PatternStore.add = logged
for line in sys.stdin:
    child = os.fork()
    if child == 0:
        out = os.open(log, os.O_WRONLY | os.O_APPEND | os.O_CREAT)
        ring = ss.reference.beam_ring(6, 7e3, 1)
        ss.mistuning_study(
            ring, 0.05, omega=(150, 260), patterns=patterns, seed=1, harmonics=3, threads=2,
            store=store,
        )
        os._exit(0)
    delay, begun = map(float, line.split())
    size = os.path.getsize(log) if os.path.exists(log) else 0
    while begun and (os.path.getsize(log) if os.path.exists(log) else 0) == size:
        time.sleep(0.001)
    if delay > 0.0:
        time.sleep(delay)
        os.kill(child, signal.SIGKILL)
    print(os.waitpid(child, 0)[1], flush=True)
"""


def study(**options):
    settings = {"omega": (150, 260), "patterns": PATTERNS, "seed": 1, "harmonics": 3}
    ring = ss.reference.beam_ring(6, 7e3, 1)
    return ss.mistuning_study(ring, 0.05, **(settings | options))


def small(store, **options):
    return study(**({"store": store, "patterns": 3, "threads": 1} | options))


def stored(path):
    with closing(sqlite3.connect(path)) as base:
        # A run killed at the very beginning has made a file, but no tables.
        if not base.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]:
            return set()
        return {row[0] for row in base.execute("SELECT pattern FROM summit")}


@pytest.mark.slow
def test_a_study_killed_twenty_times_is_the_unbroken_one(tmp_path):
    store, log, chance = tmp_path / "study.db", tmp_path / "log", random.Random(3)
    command = [sys.executable, "-c", textwrap.dedent(RUNNER), store, log, str(PATTERNS)]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    kept, steps = set(), 0
    with subprocess.Popen(command, **pipes) as runner:
        # Every other run is killed at any moment, the others once disks come in; a delay of
        # nothing is the run that is let through.
        kills = [(chance.uniform(0.001, 0.08), number % 2) for number in range(20)]
        for delay, begun in [*kills, (0.0, 0)]:
            runner.stdin.write(f"{delay} {begun}\n")
            runner.stdin.flush()
            status = int(runner.stdout.readline())
            assert status == (signal.SIGKILL if delay else 0)
            handed = {int(line) for line in log.read_text().split()} if log.exists() else set()
            there = stored(store) if store.exists() else set()
            # What has been handed over is there, whatever happened since.
            assert handed | kept <= there
            steps += there != kept
            kept = there
        runner.stdin.close()
    assert kept == set(range(PATTERNS))
    # The kills were spread over the run.
    assert steps >= 11
    # Nothing that was stored has been computed again.
    lines = log.read_text().split()
    assert len(lines) == len(set(lines)) <= PATTERNS
    continued, unbroken = study(store=store), study()
    for name in ("omega", "amplitude", "blade", "status", "harmonics", "error_estimate"):
        mine, theirs = (getattr(one.arrays, name) for one in (continued, unbroken))
        assert mine.tobytes() == theirs.tobytes(), name
    assert continued.counters == unbroken.counters


@pytest.mark.slow
def test_a_store_grows_with_its_study(tmp_path):
    store = tmp_path / "study.db"
    first = small(store)
    more = small(store, patterns=5, coupling_stiffness=[3e3, 7e3])
    assert stored(store) == set(range(5))
    assert np.array_equal(more.amplitude("tip")[0, 1, :3], first.amplitude("tip")[0, 0])
    again = small(store, patterns=5, coupling_stiffness=[7e3, 3e3])
    assert np.array_equal(again.amplitude("tip")[0, ::-1], more.amplitude("tip")[0])
    assert again.counters["disks"] == 10
    # A smaller study takes what it needs.
    assert small(store, patterns=1).counters["disks"] == 1


def test_ctrl_c_leaves_the_store_to_go_on_from(tmp_path):
    def stop(share):
        raise KeyboardInterrupt

    store = tmp_path / "study.db"
    with pytest.raises(ss.Interrupted, match=r"study.db goes on from there") as caught:
        study(store=store, progress=stop, patterns=500)
    done = caught.value.result.counters["disks"]
    assert 0 < done < 500
    assert len(stored(store)) == done
    assert study(store=store, patterns=done + 1).counters["disks"] == done + 1


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"seed": 2}, "holds another study (seed is 1 there and 2 here)"),
        ({"omega": (150, 270)}, "omega is [150.0, 260.0] there and [150.0, 270.0] here"),
        ({"harmonics": 5}, "harmonics is 3 there and 5 here"),
        ({"dofs": "tip"}, "dofs is ['tip', 'damper'] there and ['tip'] here"),
        ({"patterns": np.zeros((1, 6))}, "patterns is 'drawn' there and "),
    ],
)
def test_the_store_of_another_study_says_what_differs(tmp_path, options, message):
    store = tmp_path / "study.db"
    small(store)
    before = store.read_bytes()
    with pytest.raises(ss.ModelError) as refused:
        small(store, **options)
    assert message in str(refused.value)
    assert str(refused.value).startswith(f"{store}: holds another study (")
    assert store.read_bytes() == before


def test_another_disk_is_another_study(tmp_path):
    store = tmp_path / "study.db"
    small(store)
    louder = ss.reference.beam_ring(6, 7e3, 1).scaled(force=2.0)
    with pytest.raises(ss.ModelError, match=r"forces is .* there and .* here"):
        ss.mistuning_study(
            louder, 0.05, omega=(150, 260), patterns=1, seed=1, harmonics=3, store=store
        )


@pytest.mark.slow
def test_files_that_are_no_stores_are_refused_in_one_line(tmp_path):
    store = tmp_path / "study.db"
    small(store)
    whole = store.read_bytes()

    def refused(message):
        with pytest.raises(ss.ModelError, match=message) as caught:
            small(store)
        assert "\n" not in str(caught.value)

    with closing(sqlite3.connect(store)) as base:
        base.execute("PRAGMA user_version = 3")
    refused("a store of format 3, this version of stickslip reads format 1 to 2; upgrade stickslip")
    store.write_bytes(b"not a data base, " * 300)
    refused("no store, or a damaged one")
    for start in (0, 30, 4096, 9000, len(whole) - 4096):
        store.write_bytes(whole[:start] + bytes(255 - b for b in whole[start : start + 900]))
        with pytest.raises(ss.ModelError):
            small(store)
    store.unlink()
    with closing(sqlite3.connect(store)) as base:
        base.execute("CREATE TABLE mine (x)")
    before = store.read_bytes()
    refused("is no store of a mistuning study; give another name, nothing was changed")
    assert store.read_bytes() == before
    store.unlink()
    store.mkdir()
    refused("is a folder; give the name of a file in it")


def test_every_bit_comes_back(tmp_path):
    rows = [
        Row(0.1, 1.0 / 3.0, 7, 0, 3, 5e-324, at_edge=True),
        Row(np.nan, np.nan, 0, 1, 0, np.nan, at_edge=False),
        Row(np.pi, 1.7e308, 35, 4, 255, np.inf, at_edge=False),
    ]
    with PatternStore(tmp_path / "a.db", {"a": 1}) as store:
        store.add(Key(0.07, np.nan, 3), rows, 21)
    with PatternStore(tmp_path / "a.db", {"a": 1}) as store:
        found = list(store.rows())
    assert [row for _, _, row, _ in found[:1]] == rows[:1]
    assert found[2][2] == rows[2]
    assert np.isnan(found[1][2].amplitude)
    assert all(key.deviation == 0.07 and np.isnan(key.coupling) for key, *_ in found)
    assert {points for *_, points in found} == {21}


@pytest.mark.slow
def test_ctrl_c_is_heard_while_another_program_holds_the_store(tmp_path, monkeypatch):
    store = tmp_path / "study.db"
    small(store, patterns=1)
    looks = 0

    def look():
        nonlocal looks
        looks += 1
        if looks == 3:
            raise KeyboardInterrupt

    with closing(sqlite3.connect(store, isolation_level=None)) as other:
        other.execute("BEGIN EXCLUSIVE")
        with pytest.raises(KeyboardInterrupt):
            PatternStore(store, {}, look)
        monkeypatch.setattr(pattern_store, "_PATIENCE", 0.1)
        with pytest.raises(ss.ModelError, match=r"locked.*see that no other program holds it"):
            small(store, patterns=1)
        monkeypatch.setattr(pattern_store, "_PATIENCE", 30.0)
        monkeypatch.setattr(
            pattern_store, "sleep", lambda _: other.in_transaction and other.execute("COMMIT")
        )
        assert small(store, patterns=2).counters["disks"] == 2
