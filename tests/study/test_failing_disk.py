"""Every command on a disk that fails, fills up or takes little at once, at each of its files."""

import errno
import tempfile
from itertools import count

import numpy as np
import pytest

import stickslip as ss
from beam_study import invoke
from failing_disk import Disk, names
from small_study import SMALL

COMMANDS = {
    "run": ["run", "study.toml", "--out", "out"],
    "certify": ["certify", "a.nc", "--points", "2", "--out", "out/b.nc"],
    "certify in place": ["certify", "out/a.nc", "--points", "2"],
    "schema": ["schema", "--out", "out/schema.json"],
    "report": ["report", "a.nc", "--out", "out/a.html"],
    "csv": ["export", "a.nc", "--out", "out/a.csv"],
    "xlsx": ["export", "a.nc", "--out", "out/a.xlsx"],
    "mat": ["export", "a.nc", "--out", "out/a.mat"],
    "parquet": ["export", "a.nc", "--out", "out/a.parquet"],
    "uff": ["export", "a.nc", "--out", "out/a.uff"],
    "png": ["plot", "a.nc", "--dof", "tip", "--out", "out/a.png"],
    "pdf": ["plot", "a.nc", "--dof", "tip", "--out", "out/a.pdf"],
    "reproduce": ["reproduce", "fig-2.3", "--coarse", "--out", "out"],
}
NEEDED = {"xlsx": "xlsxwriter", "parquet": "pyarrow", "uff": "pyuff"}

REFUSALS = {
    "EIO": ({"write": errno.EIO}, {}, "Input/output error"),
    "EIO half-way": ({"write": errno.EIO}, {"room": 300}, "Input/output error"),
    "EIO of fsync": ({"fsync": errno.EIO}, {}, "Input/output error"),
    "EIO of close": ({"close": errno.EIO}, {}, "Input/output error"),
    "EIO of replace": ({"replace": errno.EIO}, {}, "Input/output error"),
    "ENOSPC in pieces": ({"write": errno.ENOSPC}, {"room": 300, "most": 7}, "No space left"),
    "takes nothing": ({}, {"most": 0}, "Input/output error"),
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "study.toml").write_text(SMALL + "levels = [0.5, 1]\n")
    ss.forced_response(ss.reference.snecma_beam(), [160.0, 170.0, 190.0], 3).save("a.nc")
    return tmp_path


def prepared(folder, command):
    """Make an empty folder for what is written, and return it."""
    out = folder / "out"
    out.mkdir(exist_ok=True)
    for one in out.iterdir():
        one.unlink()
    if command == "certify in place":
        (out / "a.nc").write_bytes((folder / "a.nc").read_bytes())
    return out


def contents(folder):
    return {one.name: one.read_bytes() for one in folder.iterdir()}


@pytest.mark.slow
@pytest.mark.parametrize("command", COMMANDS)
def test_a_failing_disk_ends_in_a_line_at_every_file(command, folder, monkeypatch):
    if command in NEEDED:
        pytest.importorskip(NEEDED[command])
    out = prepared(folder, command)
    before = contents(out)
    done = invoke(*COMMANDS[command])
    assert done.exit_code == 0, done.stderr
    files = {"certify in place": 1}.get(command, len(names(out)))
    for refusal, (fails, options, message) in REFUSALS.items():
        for file in count():
            prepared(folder, command)
            with monkeypatch.context() as patch:
                disk = Disk(patch, fails, after=file, **options)
                done = invoke(*COMMANDS[command])
            assert not any(".stickslip-" in name for name in names(out)), refusal
            if done.exit_code == 0:
                break
            *cautions, line = done.stderr.splitlines()
            assert done.exit_code == 2, (refusal, file)
            assert all(one.startswith("warning: ") for one in cautions)
            assert line.startswith("error: ")
            assert message in line
            # What was written before is whole.
            assert disk.written == len(names(out)) - len(before) or command == "certify in place"
            for one in out.glob("*.nc"):
                assert np.isfinite(ss.load(one).omega).all()
            if command == "certify in place":
                assert contents(out) == before
        # The probe of the folder is refused as the first file is, but not by what fails later.
        assert file >= min(files, 1), refusal


@pytest.mark.slow
@pytest.mark.parametrize("command", COMMANDS)
def test_a_disk_that_takes_little_at_once_gets_all_of_it(command, folder, monkeypatch):
    if command in NEEDED:
        pytest.importorskip(NEEDED[command])
    out = prepared(folder, command)
    with monkeypatch.context() as patch:
        disk = Disk(patch, {}, most=997)
        done = invoke(*COMMANDS[command])
    assert done.exit_code == 0, done.stderr
    written = contents(out)
    assert disk.contents
    assert all(one in (b"", *written.values()) for one in disk.contents)
    assert not any(".stickslip-" in name for name in written)


def test_a_folder_for_temporary_files_is_named_where_it_is_needed(tmp_path, monkeypatch):
    pytest.importorskip("meshio")
    from stickslip.views.picture import drawn_as

    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "missing"))
    frf = ss.forced_response(ss.reference.snecma_beam(), [160.0, 170.0], 1)
    # The explorer sends it to its page.
    picture = drawn_as([lambda ax: frf.plot("tip", ax=ax)], ".png", "a.png")
    assert bytes(picture).startswith(b"\x89PNG")
    nodes = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    mesh = ss.Mesh(nodes, [("quad", [[0, 1, 2, 3]])])
    with pytest.raises(ss.ModelError, match=r"a folder for temporary files, .* TMPDIR") as refused:
        mesh.write_vtu(tmp_path / "a.vtu", {"height": nodes[:, 1]})
    assert len(str(refused.value).splitlines()) == 1
    assert names(tmp_path) == []
