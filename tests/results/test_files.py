"""Files that are written whole or not at all, and what killed programs leave of them."""

import os
import subprocess
import sys

import pytest

from stickslip import ModelError
from stickslip.files import write

KILLED = """
import os, pathlib, signal, sys
from stickslip.files import write
os.fsync = lambda handle: os.kill(os.getpid(), signal.SIGKILL)
write(pathlib.Path(sys.argv[1]), b"half")
"""


def names(folder):
    return {file.name for file in folder.iterdir()}


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="there is no SIGKILL")
def test_what_killed_programs_left_is_removed_by_the_next_one(tmp_path):
    target = tmp_path / "beam.nc"
    for _ in range(2):
        subprocess.run([sys.executable, "-c", KILLED, target], check=False)
    assert len(names(tmp_path)) == 2
    assert all(name.startswith(".stickslip-") for name in names(tmp_path))
    write(target, b"whole")
    assert names(tmp_path) == {"beam.nc"}


def test_what_another_writes_now_is_left_alone(tmp_path, monkeypatch):
    target = tmp_path / "beam.nc"
    sync = os.fsync

    def write_meanwhile(handle):
        monkeypatch.setattr(os, "fsync", sync)
        write(tmp_path / "other.nc", b"other")
        sync(handle)

    monkeypatch.setattr(os, "fsync", write_meanwhile)
    write(target, b"one")
    assert target.read_bytes() == b"one"
    assert names(tmp_path) == {"beam.nc", "other.nc"}


@pytest.mark.parametrize(
    "name",
    [
        ".stickslip-00000000-1-0123abcd.part",  # of another machine, which shares the disk
        ".stickslip-0123abcd-99999999-0123abcd.part",
        ".beam.nc.0123abcd.part",  # as the first version named them
    ],
)
def test_unfinished_files_of_which_nothing_is_known_are_removed_when_they_are_old(tmp_path, name):
    left = tmp_path / name
    left.touch()
    write(tmp_path / "beam.nc", b"whole")
    assert left.exists()
    os.utime(left, (0, 0))
    write(tmp_path / "beam.nc", b"whole")
    assert not left.exists()


def test_files_of_other_names_are_left_alone(tmp_path):
    others = {".beam.nc.part", ".stickslip-1-2.part.txt", ".beam-nc.1-0123abcd.part"}
    for name in others:
        (tmp_path / name).touch()
        os.utime(tmp_path / name, (0, 0))
    write(tmp_path / "beam.nc", b"whole")
    assert names(tmp_path) == {*others, "beam.nc"}


@pytest.mark.parametrize("name", ["nul", "NUL.nc", "con.txt", "Aux.png", "com1.htm", "lpt\u00b9"])
def test_names_of_devices_are_refused(tmp_path, name):
    with pytest.raises(ModelError, match="is the name of a device on Windows; give another name"):
        write(tmp_path / name, b"")
    assert not names(tmp_path)
