"""Files of every kind, damaged: one line says so, or what is read is what the file says."""

import random
import signal
from pathlib import Path

import numpy as np
import pytest

import input_files
from stickslip import ModelError

SEEDS = range(6)
"""Per kind of file, some 200 mutations in all."""

LIMIT = 20
"""Seconds that reading a small file may take on a slow machine."""

COUNTED = [
    "general.mtx",
    "symmetric.mtx",
    "array-general.mtx",
    "array-symmetric.mtx",
    "harwell.rua",
    "bar-substructure.mtx",
    "dense-text.op4",
    "bigmat-text.op4",
    "nonbigmat-text.op4",
    "rows.mapping",
    "frf.uff",
]
"""Text of which lines are counted by something that the file says."""


class Slow(BaseException):
    """Not an Exception: no reader may catch it."""


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sound")
    return folder, input_files.make(folder)


def spoiled(sound, tmp_path, name, content):
    """Read damaged content under the name of its kind; None if it is refused as it should be."""
    folder, readers = sound
    (tmp_path / "bar.dof").write_bytes((folder / "bar.dof").read_bytes())
    (tmp_path / name).write_bytes(content)

    def stop(*_):
        raise Slow

    refusal = None
    before = signal.signal(signal.SIGALRM, stop)
    signal.alarm(LIMIT)
    try:
        return readers[name](tmp_path / name)
    except ModelError as error:
        refusal = str(error)
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
    assert "\n" not in refusal
    assert name in refusal
    return None


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_nothing_but_one_line_is_raised(sound, tmp_path):
    folder, readers = sound
    refused = total = 0
    for name in sorted(readers):
        content = (folder / name).read_bytes()
        for seed in SEEDS:
            _, damaged = input_files.damaged(content, random.Random(f"{name}{seed}"))
            for left in tmp_path.glob("*-journal"):
                left.unlink()
            read = spoiled(sound, tmp_path, name, damaged)
            refused += read is None
            total += 1
            if isinstance(read, np.ndarray):
                assert np.isfinite(read).all(), (name, seed)
    assert total >= 6 * 28
    assert refused > 0.6 * total


@pytest.mark.slow
@pytest.mark.parametrize("name", COUNTED)
def test_a_line_lost_or_twice_is_refused_where_lines_are_counted(sound, tmp_path, name):
    folder, readers = sound
    if name not in readers:
        pytest.skip("pip install 'stickslip[test]'")
    expected = readers[name](folder / name)
    lines = (folder / name).read_bytes().splitlines(keepends=True)
    for at in range(len(lines)):
        for damaged in (lines[: at + 1] + lines[at:], lines[:at] + lines[at + 1 :]):
            read = spoiled(sound, tmp_path, name, b"".join(damaged))
            if read is not None:  # a comment, or a text that says nothing of the numbers
                _assert_same(read, expected)


def _assert_same(read, expected):
    if isinstance(read, np.ndarray):
        np.testing.assert_array_equal(read, expected)
        return
    assert len(read) == len(expected)
    for one, other in zip(read, expected, strict=True):
        np.testing.assert_array_equal(one[1:], other[1:])


def test_every_kind_of_file_is_among_them(sound):
    from stickslip.io.matrices import _READERS

    endings = {Path(name).suffix for name in sound[1]} | {".mtx.gz"}
    alike = {".hb", ".rb", ".rsa", ".hbf", ".psa", ".matrix", ".mmf", ".dmig", ".mas"}
    missing = set(_READERS) - endings - alike - {".full"}
    assert missing <= {".op4"}
