"""Every place that writes a file: on a full, a read-only and a failing disk, and one that is slow.

Studies on such disks are in `tests/study/test_study_writes.py`.
"""

import ast
import errno
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from failing_disk import Disk, names
from stickslip import files
from stickslip.reference import snecma_beam
from stickslip_reproduce.claims_page import write_claims

PACKAGE = Path(ss.__file__).parent


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


def export(frf, target):
    for end, package in ((".parquet", "pyarrow"), (".xlsx", "xlsxwriter")):
        if target.suffix == end:
            pytest.importorskip(package)
    frf.export(target)


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
    **{f"a.{end}": (export, "results/export.py") for end in ("csv", "parquet", "xlsx", "mat")},
    "a.vtu": (mesh, "fe/vtu.py"),
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


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "SIGXFSZ"), reason="the system has no limit of files")
@pytest.mark.parametrize("end", ["csv", "parquet", "xlsx", "mat", "uff"])
def test_no_export_needs_temporary_files(end, frf, tmp_path):
    for one, package in (("parquet", "pyarrow"), ("xlsx", "xlsxwriter")):
        if end == one:
            pytest.importorskip(package)
    frf.save(tmp_path / "a.nc")
    # No file may be longer, neither those of temporary folders.
    command = ["export", "a.nc", "--out", f"a.{end}"]
    code = (
        "import resource; from stickslip.cli import app;"
        f"resource.setrlimit(resource.RLIMIT_FSIZE, (500, 500)); app({command})"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True
    )
    (line,) = done.stderr.splitlines()
    assert done.returncode == 2
    assert line.startswith(f"error: a.{end}: cannot be written (File too large)")
    assert names(tmp_path) == ["a.nc"]


@pytest.mark.slow
@pytest.mark.parametrize("fault", ["full half-way", "read-only", "failing late"])
def test_claims_end_in_one_line(fault, tmp_path, monkeypatch):
    fails, options, message = FAULTS[fault]
    Disk(monkeypatch, fails, **options)
    with pytest.raises(ss.ModelError, match="cannot be written") as refused:
        write_claims([], tmp_path)
    assert message in str(refused.value)


WRITING = {
    *("write_text", "write_bytes", "to_netcdf", "savez", "savez_compressed", "savetxt", "tofile"),
    *("mkdir", "makedirs", "rename", "touch", "copyfile", "copy2", "move", "mkstemp"),
    *("NamedTemporaryFile", "mmwrite", "save_npz", "fdopen", "symlink"),
}


OF_DATASETS = {("results/sweep.py", "rename")}
"""Calls that give variables of a dataset other names."""


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
    claims = "stickslip_reproduce/claims_page.py"
    assert users == {place for _, place in WRITERS.values()} | {claims}


def require_harmless(place, name, call):
    """Refuse a call that writes a file past the one door."""
    assert name not in WRITING or (place, name) in OF_DATASETS, (place, name)
    if name not in ("connect", "savefig", "savemat", "File", "open"):
        return
    told = f"{place}: {ast.unparse(call)}"
    first, *mode = map(ast.unparse, call.args)
    if name == "connect":
        assert place == "analyses/pattern_store.py", told
    elif name == "savefig":
        assert first == "picture", told
    elif name == "savemat":
        assert first == "content", told
    elif name == "File":
        assert mode == ["'r'"] or first in ("content", "io.BytesIO(content)"), told
    elif re.search(r"'[rbt]*[wax+]|O_WRONLY|O_RDWR|O_CREAT", told):
        # Standard output that is not there, or that refused, leads nowhere.
        assert first == "os.devnull", told
