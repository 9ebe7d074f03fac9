"""Files that are written whole or not at all, and what killed programs leave of them."""

import os
import subprocess
import sys

import pytest

from stickslip import ModelError
from stickslip.files import whole

KILLED = """
import os, pathlib, signal, sys
from stickslip.files import whole
with whole(pathlib.Path(sys.argv[1])) as temporary:
    temporary.write_text("half")
    os.kill(os.getpid(), signal.SIGKILL)
"""


def write(target, text="whole"):
    with whole(target) as temporary:
        temporary.write_text(text)


@pytest.mark.skipif(os.name == "nt", reason="there is no SIGKILL")
def test_what_a_killed_program_left_is_removed_by_the_next_one(tmp_path):
    target = tmp_path / "beam.nc"
    for _ in range(2):
        subprocess.run([sys.executable, "-c", KILLED, target], check=False)
    left = [file.name for file in tmp_path.iterdir()]
    assert len(left) == 1  # the second removed that of the first
    assert left[0].startswith(".beam.nc.")
    write(tmp_path / "other.nc")
    assert {file.name for file in tmp_path.iterdir()} == {*left, "other.nc"}
    write(target)
    assert {file.name for file in tmp_path.iterdir()} == {"beam.nc", "other.nc"}


def test_what_another_writes_now_is_left_alone(tmp_path):
    target = tmp_path / "beam.nc"
    with whole(target) as one:
        one.write_text("one")
        write(target, "other")
        assert one.exists()
    assert target.read_text() == "one"
    mine = tmp_path / f".beam.nc.{os.getppid()}-0123abcd.part"
    mine.touch()
    write(target)
    assert mine.exists()


def test_unfinished_files_of_earlier_versions_are_removed_when_they_are_old(tmp_path):
    target, left = tmp_path / "beam.nc", tmp_path / ".beam.nc.0123abcd.part"
    left.touch()
    write(target)
    assert left.exists()
    os.utime(left, (0, 0))
    write(target)
    assert not left.exists()


def test_files_of_other_names_are_left_alone(tmp_path):
    names = [".beam.nc.part", ".beam.nc.99999999-0123abcd.part.txt", ".beam-nc.1-0123abcd.part"]
    for name in names:
        (tmp_path / name).touch()
    write(tmp_path / "beam.nc")
    assert {file.name for file in tmp_path.iterdir()} == {*names, "beam.nc"}


@pytest.mark.parametrize("name", ["nul", "NUL.nc", "con.txt", "Aux.png", "com1.htm", "lpt\u00b9"])
def test_names_of_devices_are_refused(tmp_path, name):
    with pytest.raises(ModelError, match="is the name of a device on Windows; give another name"):
        write(tmp_path / name)
    assert not list(tmp_path.iterdir())
