"""Files cut short, with flipped bytes, or of another kind: one error each, never a wrong matrix."""

import os
from pathlib import Path

import h5py
import numpy as np
import pytest
import scipy.io
import scipy.sparse

import stickslip as ss
from stickslip.errors import ModelError
from stickslip.io import Frf, read_frf, write_frf

DATA = Path(__file__).parents[1] / "data"

K = np.random.default_rng(0).standard_normal((9, 9))
K = (K @ K.T + np.eye(9)) * 1e7


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """Return a sound file of each format, and the key of its matrix."""
    op4 = pytest.importorskip("pyyeti.nastran.op4", reason="pip install 'stickslip[test]'")
    import pandas
    from pyyeti import nastran

    folder = tmp_path_factory.mktemp("sound")
    sparse = scipy.sparse.csc_array(K)
    np.savez(folder / "np.npz", K=K)
    scipy.io.savemat(folder / "five.mat", {"K": K})
    scipy.io.savemat(folder / "packed.mat", {"K": sparse}, do_compression=True)
    with h5py.File(folder / "seven.mat", "w", userblock_size=512) as file:
        file.create_dataset("K", data=K.T).attrs["MATLAB_class"] = np.bytes_("double")
    scipy.io.mmwrite(folder / "market.mtx", sparse, symmetry="symmetric", precision=17)
    scipy.io.hb_write(folder / "harwell.rua", sparse)
    op4.write(os.fspath(folder / "binary.op4"), {"K": K}, binary=True)
    op4.write(os.fspath(folder / "sparse.op4"), {"K": K}, binary=True, sparse="bigmat")
    op4.write(os.fspath(folder / "text.op4"), {"K": K}, binary=False, digits=16)
    index = pandas.MultiIndex.from_product([(1, 2, 3), (1, 2, 3)], names=["id", "dof"])
    nastran.wtdmig(os.fspath(folder / "k.pch"), {"K": pandas.DataFrame(K, index, index)})
    lower = [(i, j) for i in range(9) for j in range(i + 1)]
    text = "".join(f"{i + 1} {j + 1} {K[i, j]:.15e}\n" for i, j in lower)
    (folder / "abaqus.mtx").write_text(text)
    for name in ("bar.sti", "bar.dof", "bar-substructure.mtx"):
        (folder / name).write_bytes((DATA / name).read_bytes())
    write_frf(folder / "frf.uff", Frf([1.0, 2.0, 3.0], [1.0, 1j, 2.0], "1.1", "2.3"))
    return folder


FORMATS = {
    "np.npz": "K",
    "five.mat": "K",
    "packed.mat": "K",
    "seven.mat": "K",
    "market.mtx": None,
    "harwell.rua": None,
    "binary.op4": "K",
    "sparse.op4": "K",
    "text.op4": "K",
    "k.pch": "K",
    "abaqus.mtx": None,
    "bar.sti": None,
    "bar-substructure.mtx": None,
}

WITHOUT_CHECK_SUM = {"binary.op4", "sparse.op4", "five.mat", "seven.mat"}


def read(path, key):
    return read_frf(path) if path.suffix == ".uff" else ss.read_matrix(path, key)


def spoiled(sound, tmp_path, name, content):
    """Write the bytes under the name of a format, with what lies beside it."""
    file = tmp_path / name
    file.write_bytes(content)
    if name == "bar.sti":
        (tmp_path / "bar.dof").write_bytes((sound / "bar.dof").read_bytes())
    return file


@pytest.mark.parametrize("part", [0.0, 0.02, 0.3, 0.6, 0.9, 0.97, "all but one line", "a byte"])
@pytest.mark.parametrize("name", [*FORMATS, "frf.uff"])
def test_a_file_cut_short_is_refused(sound, tmp_path, name, part):
    content = (sound / name).read_bytes()
    if part == "all but one line":
        content = content[: content.rstrip(b"\n").rfind(b"\n") + 1]
    elif part == "a byte":
        content = content[:-2] if content.endswith(b"\n") else content[:-1]
    else:
        content = content[: int(part * len(content))]
    with pytest.raises(ModelError) as told:
        read(spoiled(sound, tmp_path, name, content), FORMATS.get(name))
    assert "\n" not in str(told.value)
    assert name in str(told.value)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("name", FORMATS)
def test_a_flipped_byte_is_refused_or_does_not_matter(sound, tmp_path, name, seed):
    """A flipped top bit makes text unreadable; in binary files it shows as asymmetry.

    What no reader can see is another number on the diagonal of a file without check sums.
    """
    content = bytearray((sound / name).read_bytes())
    place = int(np.random.default_rng(seed).integers(len(content)))
    content[place] ^= 0x80
    key = FORMATS[name]
    expected = read(sound / name, key)
    try:
        found = read(spoiled(sound, tmp_path, name, bytes(content)), key)
        ss.Structure(np.eye(len(found)), found)  # where a stiffness ends up, and is symmetric
    except ModelError:
        return
    changed = np.abs(found - expected) > 1e-8 * np.abs(expected).max()
    assert changed.sum() <= 1
    assert not (changed & ~np.eye(len(changed), dtype=bool)).any()
    assert not changed.any() or name in WITHOUT_CHECK_SUM


@pytest.mark.parametrize(
    ("name", "other"),
    [
        (name, other)
        for name in [*FORMATS, "frf.uff"]
        for other in ("market.mtx", "binary.op4", "seven.mat", "frf.uff")
        if Path(name).suffix != Path(other).suffix
    ],
)
def test_a_file_of_another_kind_is_refused(sound, tmp_path, name, other):
    content = (sound / other).read_bytes()
    with pytest.raises(ModelError):
        read(spoiled(sound, tmp_path, name, content), FORMATS.get(name))


def test_entries_that_contradict_each_other_are_refused(sound, tmp_path):
    twice = spoiled(sound, tmp_path, "twice.mtx", b"1 1 2.0\n1 1 3.0\n")
    with pytest.raises(ModelError, match="given twice"):
        ss.read_matrix(twice)
    half = spoiled(sound, tmp_path, "half.mtx", b"1 1 2.0\n1 2 3.0\n2 1 3.0\n2 2 4.0\n3 1 1.0\n")
    with pytest.raises(ModelError, match="lacks its mirror entry"):
        ss.read_matrix(half)
    names = spoiled(sound, tmp_path, "bar.sti", (sound / "bar.sti").read_bytes())
    (tmp_path / "bar.dof").write_text("5.1\n5.2\n")
    with pytest.raises(ModelError, match=r"24 rows, but bar\.dof names 2"):
        ss.read_matrix(names)
    (tmp_path / "bar.dof").unlink()
    with pytest.raises(ModelError, match=r"bar\.dof must lie beside it"):
        ss.read_matrix(names)


@pytest.mark.parametrize("part", [0.001, 0.5])
def test_a_crash_of_the_ansys_reader_is_one_error(tmp_path, part):
    reason = "ansys-mapdl-reader is not installed: pip install 'stickslip[ansys]'"
    reader = pytest.importorskip("ansys.mapdl.reader", reason=reason)
    content = (Path(reader.__file__).parent / "examples" / "file.full").read_bytes()
    file = tmp_path / "file.full"
    file.write_bytes(content[: int(part * len(content))])
    with pytest.raises(ModelError, match=r"cannot be read as \.full: .*; write the file again"):
        ss.read_matrix(file, "stiffness")
