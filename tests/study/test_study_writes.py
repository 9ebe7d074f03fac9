"""Studies on a full, a read-only and a failing disk.

Real refusals come from the limit of the size of files, in processes of their own.
"""

import errno
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import stickslip as ss
from beam_study import COMMAND, invoke
from failing_disk import Disk, names
from small_study import MISTUNED
from stickslip.reference import snecma_beam


@pytest.mark.slow
@pytest.mark.parametrize("written", [0, 1, 2])
def test_a_study_keeps_what_is_whole_and_ends_with_code_2(written, folder, monkeypatch):
    with monkeypatch.context() as patch:
        Disk(patch, {"write": errno.ENOSPC}, after=written)
        result = invoke("run", "study.toml")
    assert result.exit_code == 2
    *cautions, line = result.stderr.splitlines()
    assert all(one.startswith("warning: ") for one in cautions)
    file = ["beam-6.563.nc", "beam-20.313.nc", "beam.png"][written]
    path = Path("results", file)
    assert line.startswith(f"error: {path}: cannot be written (No space left on device); make room")
    if written < 2:
        assert line.endswith(f"; {written} of 2 curves complete in results")
        assert result.stdout == ""
    else:
        # The picture alone is missing: tables and files are told as ever.
        assert "results: " in result.stdout
        assert "picture: " not in result.stdout
    assert names(folder / "results") == sorted(["beam-6.563.nc", "beam-20.313.nc"][:written])
    for one in (folder / "results").iterdir():
        assert ss.load(one).converged.all()


def test_a_folder_that_takes_no_files_is_refused_before_anything_is_computed(folder, monkeypatch):
    def computed(*_):
        raise AssertionError

    monkeypatch.setattr("stickslip.study.Study.run", computed)
    with monkeypatch.context() as patch:
        Disk(patch, {"open": errno.EROFS})
        result = invoke("run", "study.toml")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == (
        "error: results: cannot be written to (Read-only file system); choose a place that can be "
        "written\n"
    )
    (folder / "file").write_bytes(b"")
    for out in ("file", "file/results"):
        result = invoke("run", "study.toml", "--out", out)
        assert result.exit_code == 2
        (line,) = result.stderr.splitlines()
        assert line.startswith(f"error: {Path(out)}: cannot be made (")
        assert line.endswith("); name a folder, not a file")


@pytest.mark.slow
def test_an_interrupted_study_on_a_full_disk_ends_in_one_line(folder, monkeypatch):
    def interrupted(*_):
        part = replace(ss.forced_response(snecma_beam(), [190.0], 3), interrupted=True)
        raise ss.Interrupted("stopped", part)

    monkeypatch.setattr("stickslip.study.Study.run", lambda *_: map(interrupted, [0]))
    with monkeypatch.context() as patch:
        Disk(patch, {"write": errno.ENOSPC})
        result = invoke("run", "study.toml")
    assert result.exit_code == 2
    first, line = result.stderr.splitlines()
    assert first == "interrupted: saving what was computed"
    path = Path("results", "beam-6.563-partial.nc")
    assert line.startswith(f"error: {path}: cannot be written (No space left on device)")


def limited(size, *arguments):
    """Run the command where no file can grow beyond a size, which the system itself enforces."""
    limit = f"import resource; resource.setrlimit(resource.RLIMIT_FSIZE, ({size}, {size}))"
    command = [sys.executable, "-c", f"{limit}; {COMMAND[-1]}", *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="the limit of the size of files is of Linux")
def test_a_limit_of_the_system_stops_a_study_in_one_line(folder):
    done = limited(20_000, "run", "study.toml")
    assert (done.returncode, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    assert line.startswith("error: results/beam-6.563.nc: cannot be written (File too large); make")
    assert names(folder / "results") == []
    (folder / "ring.toml").write_text(MISTUNED)
    done = limited(12_288, "run", "ring.toml")
    assert (done.returncode, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    assert line.startswith("error: ring.toml: results/ring.db: cannot be used as a store (")
    assert "of 60 disks are stored, run again to go on from there" in line
    stored = int(line.split("; ")[-1].split()[0])
    assert 0 < stored < 60
    result = invoke("run", "ring.toml")
    assert (result.exit_code, result.stderr) == (0, "")
    study = ss.load(folder / "results" / "ring.nc")
    assert study.counters["disks"] == 60
