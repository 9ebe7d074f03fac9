"""Every place that writes a file: on a full, a read-only and a failing disk, and one that is slow.

A disk that refuses is played by the calls of the system, which fail for the temporary file alone;
real refusals come from the limit of the size of files, in processes of their own.
"""

import ast
import errno
import os
import re
import shutil
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from beam_study import COMMAND, EXAMPLE, invoke, study_text
from stickslip import files
from stickslip.reference import snecma_beam

PACKAGE = Path(ss.__file__).parent


class Disk:
    """Takes the place of the calls of the system that write a file, and fails as it is told.

    Parameters
    ----------
    monkeypatch : pytest.MonkeyPatch
        Puts everything back.
    fails : dict of int
        Error number by name of the call: open, write, fsync, close, replace.
    room : int, optional
        Bytes that are taken before writing fails.
    most : int, optional
        Bytes that one call takes.
    after : int, optional
        Files that are written well before.
    """

    def __init__(self, monkeypatch, fails, *, room=0, most=2**30, after=0):
        self.fails, self.room, self.most, self.after = fails, room, most, after
        self.handles, self.contents = set(), []
        self.calls = {name: getattr(os, name) for name in ("open", "write", "fsync", "close")}
        self.calls["replace"] = os.replace
        for name in self.calls:
            monkeypatch.setattr(os, name, getattr(self, name))

    def fail(self, name):
        if name in self.fails and self.after <= 0:
            raise OSError(self.fails[name], os.strerror(self.fails[name]))

    def open(self, path, flags, *rest, **options):
        if ".stickslip-" not in str(path):
            return self.calls["open"](path, flags, *rest, **options)
        self.fail("open")
        handle = self.calls["open"](path, flags, *rest, **options)
        self.handles.add(handle)
        self.contents.append(b"")
        return handle

    def write(self, handle, content):
        if handle not in self.handles:
            return self.calls["write"](handle, content)
        if len(content) > self.room or "write" not in self.fails:
            if not self.room:
                self.fail("write")
            content = content[: min(self.most, self.room or self.most)]
        count = self.calls["write"](handle, content)
        self.room = max(self.room - count, 0)
        self.contents[-1] += bytes(content[:count])
        return count

    def fsync(self, handle):
        if handle in self.handles:
            self.fail("fsync")
        self.calls["fsync"](handle)

    def close(self, handle):
        self.calls["close"](handle)
        if handle in self.handles:
            self.handles.remove(handle)
            self.fail("close")

    def replace(self, source, target):
        if ".stickslip-" in str(source):
            self.fail("replace")
            self.after -= 1
        self.calls["replace"](source, target)


FAULTS = {
    "full": ({"write": errno.ENOSPC}, {}, "No space left on device); make room there"),
    "full half-way": ({"write": errno.ENOSPC}, {"room": 100}, "No space left on device"),
    "full for names": ({"open": errno.ENOSPC}, {}, "No space left on device); make room there"),
    "quota": ({"write": errno.EDQUOT}, {"room": 1}, "make room there, or choose another place"),
    "too large": ({"write": errno.EFBIG}, {"room": 9}, "File too large); make room there"),
    "read-only": ({"open": errno.EROFS}, {}, "Read-only file system); choose a place that can"),
    "not ours": ({"open": errno.EACCES}, {}, "Permission denied); choose a place that can be"),
    "failing": ({"write": errno.EIO}, {}, "Input/output error); check the disk, or choose"),
    "failing half-way": ({"write": errno.EIO}, {"room": 700}, "Input/output error); check"),
    "failing late": ({"fsync": errno.EIO}, {}, "Input/output error); check the disk"),
    "failing last": ({"close": errno.EIO}, {}, "Input/output error); check the disk"),
    "full at the end": ({"replace": errno.ENOSPC}, {}, "No space left on device"),
}


@pytest.fixture
def frf():
    return ss.forced_response(snecma_beam(), np.linspace(150.0, 250.0, 12), 3)


def names(folder):
    return sorted(entry.name for entry in folder.iterdir())


@pytest.mark.parametrize("there", [False, True])
@pytest.mark.parametrize("fault", FAULTS)
def test_a_file_is_written_whole_or_not_at_all(fault, there, tmp_path, monkeypatch):
    fails, options, message = FAULTS[fault]
    target = tmp_path / "a.bin"
    if there:
        target.write_bytes(b"as it was")
    with monkeypatch.context() as patch:
        Disk(patch, fails, **options)
        with pytest.raises(ss.ModelError) as refused:
            files.write(target, bytes(range(256)) * 10)
    (line,) = str(refused.value).splitlines()
    assert line.startswith(f"{target}: cannot be written (")
    assert message in line
    assert names(tmp_path) == ["a.bin"] * there
    assert not there or target.read_bytes() == b"as it was"


@pytest.mark.parametrize("most", [1, 7, 1000])
def test_a_disk_that_takes_little_at_once_gets_everything(most, tmp_path, monkeypatch):
    content = bytes(range(256)) * 10
    Disk(monkeypatch, {}, most=most)
    files.write(tmp_path / "a.bin", content)
    assert (tmp_path / "a.bin").read_bytes() == content
    assert names(tmp_path) == ["a.bin"]


def test_a_disk_that_takes_nothing_is_a_failing_one(tmp_path, monkeypatch):
    Disk(monkeypatch, {}, most=0)
    with pytest.raises(ss.ModelError, match="Input/output error"):
        files.write(tmp_path / "a.bin", b"abc")
    assert names(tmp_path) == []


def test_what_killed_runs_have_left_is_removed(tmp_path):
    old, new = (
        tmp_path / f".stickslip-{host}-1-0123abcd.part" for host in ("01234567", "89abcdef")
    )
    for file in (old, new):
        file.write_bytes(b"half a fi")
    os.utime(old, (time.time() - 7200.0,) * 2)
    files.write(tmp_path / "a.bin", b"abc")
    # Another program may be at work on the new one.
    assert names(tmp_path) == [new.name, "a.bin"]


def test_devices_pipes_and_strange_names_are_refused(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "file").write_bytes(b"")
    for target, message in {
        Path("/dev/null"): "is no regular file",
        tmp_path / "pipe": "is no regular file",
        tmp_path: "is a folder",
        tmp_path / "file" / "a": "there is no folder",
        tmp_path / ("a" * 300): "File name too long); choose a shorter name",
    }.items():
        with pytest.raises(ss.ModelError, match=re.escape(message)):
            files.write(target, b"abc")
    # A long name leaves room for no longer one beside it.
    files.write(tmp_path / ("a" * 255), b"abc")
    assert (tmp_path / ("a" * 255)).read_bytes() == b"abc"


# ---------------------------------------------------------------------------------- the places


def save(frf, target):
    frf.save(target)


def report(frf, target):
    ss.report(frf, target)


def picture(frf, target):
    from stickslip.views.picture import draw

    draw([lambda ax: frf.plot("tip", ax=ax)], target)


def vector_picture(frf, target):
    picture(frf, target)


def schema(_, target):
    from stickslip.cli.commands import schema as command

    command.__wrapped__(out=target)


def universal_file(frf, target):
    ss.write_frf(target, ss.Frf.of(frf, "tip", "tip"))


def mesh(_, target):
    skfem = pytest.importorskip("skfem")
    solid = ss.Solid(skfem.MeshHex.init_tensor([0, 1], [0, 1], [0, 1, 2]), 210e9, 0.3, 7850.0)
    solid.write_vtu(target, {"height": solid.nodes[:, 2]})


def reproduced_picture(_, target):
    from stickslip_reproduce.folder import write_picture

    write_picture(reproduced().plot, target)


def reproduced_record(_, target):
    from stickslip_reproduce import COARSE, items
    from stickslip_reproduce.folder import write_record

    write_record(items()["fig-2.3"], reproduced(), 0.0, COARSE, target.parent)


def reproduced_index(_, target):
    from stickslip_reproduce.folder import write_index

    write_index(target.parent)


def reproduced():
    from stickslip_reproduce.numbers import Axis, Fact, Numbers, Panel, Plot, Series

    panel = Panel((Series("curve", [1.0, 2.0], [1.0, 3.0]),))
    return Numbers(Plot(Axis("x"), Axis("y"), (panel,)), (Fact("peak", 3.0, "m"),))


WRITERS = {
    "a.nc": (save, "results/store.py"),
    "a.html": (report, "html/report.py"),
    "a.png": (picture, "views/picture.py"),
    "a.PDF": (vector_picture, "views/picture.py"),
    "a.json": (schema, "cli/commands.py"),
    "a.uff": (universal_file, "io/frf.py"),
    "a.vtu": (mesh, "fe/solid.py"),
    "b.png": (reproduced_picture, "stickslip_reproduce/folder.py"),
    "fig-2.3.json": (reproduced_record, "stickslip_reproduce/folder.py"),
    "index.html": (reproduced_index, "stickslip_reproduce/folder.py"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", WRITERS)
def test_every_writer_ends_in_one_line_and_leaves_what_was_there(name, frf, tmp_path, monkeypatch):
    target, (writer, _) = tmp_path / name, WRITERS[name]
    with monkeypatch.context() as patch:
        slow = Disk(patch, {}, most=5000)
        writer(frf, target)
    whole = target.read_bytes()
    assert slow.contents[-1] == whole != b""
    for fault in ("full half-way", "read-only", "failing late"):
        fails, options, message = FAULTS[fault]
        with monkeypatch.context() as patch:
            Disk(patch, fails, **options)
            with pytest.raises(ss.ModelError) as refused:
                writer(frf, target)
        (line,) = str(refused.value).splitlines()
        assert line.startswith(f"{target}: cannot be written (")
        assert message in line
        assert names(tmp_path) == [name]
        assert target.read_bytes() == whole


WRITING = {
    *("write_text", "write_bytes", "to_netcdf", "savez", "savez_compressed", "savetxt", "tofile"),
    *("mkdir", "makedirs", "rename", "touch", "copyfile", "copy2", "move", "mkstemp"),
    *("NamedTemporaryFile", "mmwrite", "savemat", "save_npz", "fdopen", "symlink"),
}


@pytest.mark.slow
def test_nothing_else_in_the_package_writes_files():
    users = set()
    modules = [*PACKAGE.rglob("*.py"), *PACKAGE.with_name("stickslip_reproduce").rglob("*.py")]
    for module in sorted(modules):
        place = module.relative_to(PACKAGE.parent).as_posix().removeprefix("stickslip/")
        nodes = list(ast.walk(ast.parse(module.read_text(encoding="utf-8"))))
        for node in nodes:
            if isinstance(node, ast.Call) and place != "files.py":
                name = getattr(node.func, "attr", getattr(node.func, "id", ""))
                require_harmless(place, name, node)
            imported = isinstance(node, ast.ImportFrom) and node.module == "stickslip.files"
            if imported and any(alias.name == "write" for alias in node.names):
                users.add(place)
    assert users == {place for _, place in WRITERS.values()}


def require_harmless(place, name, call):
    """Refuse a call that writes a file past the one door."""
    assert name not in WRITING, (place, name)
    if name not in ("connect", "savefig", "File", "open"):
        return
    told = f"{place}: {ast.unparse(call)}"
    first, *mode = map(ast.unparse, call.args)
    if name == "connect":
        assert place == "analyses/pattern_store.py", told
    elif name == "savefig":
        assert first == "picture", told
    elif name == "File":
        assert mode == ["'r'"] or first in ("content", "io.BytesIO(content)"), told
    elif re.search(r"'[rbt]*[wax+]|O_WRONLY|O_RDWR|O_CREAT", told):
        # Standard output that is not there, or that refused, leads nowhere.
        assert first == "os.devnull", told


# ---------------------------------------------------------------------------------- studies


@pytest.fixture
def folder(tmp_path, monkeypatch):
    for file in ("mass.mtx", "stiffness.mtx"):
        shutil.copy(EXAMPLE / file, tmp_path)
    (tmp_path / "study.toml").write_text('name = "beam"\n' + study_text())
    monkeypatch.chdir(tmp_path)
    return tmp_path


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


MISTUNED = """
name = "ring"
[structure]
mass = [[1]]
stiffness = [[1000]]
damping = [[0.3]]
dofs = ["tip"]
[[contact]]
law = "jenkins"
dof = "tip"
stiffness = 100
slip_force = 1
[[force]]
dof = "tip"
amplitude = 1
[[coupling]]
dof = "tip"
stiffness = 50
[disk]
sectors = 6
engine_order = 1
[analysis]
kind = "mistuning-study"
omega = {from = 25, to = 45}
deviation = 0.02
patterns = 60
harmonics = 1
"""


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
