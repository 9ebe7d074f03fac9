"""Matrices from files of every kind, sound and damaged."""

import builtins
import contextlib
import gzip

import h5py
import numpy as np
import pytest
import scipy.io
import scipy.sparse
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from input_files import write
from stickslip.errors import ModelError
from stickslip.io import read_matrix

K = np.array([[4.0, -1.5, 0.0], [-1.5, 3.0, -1e-12], [0.0, -1e-12, 5e7]])


few = settings(max_examples=40)


# sound files


def test_npy(tmp_path):
    np.save(tmp_path / "k.npy", K)
    np.testing.assert_array_equal(read_matrix(tmp_path / "k.npy"), K)
    np.testing.assert_array_equal(read_matrix(str(tmp_path / "k.npy")), K)


def test_npz_with_and_without_key(tmp_path):
    np.savez(tmp_path / "both.npz", mass=2 * K, stiffness=K)
    np.savez_compressed(tmp_path / "one.npz", stiffness=K)
    np.testing.assert_array_equal(read_matrix(tmp_path / "both.npz", "mass"), 2 * K)
    np.testing.assert_array_equal(read_matrix(tmp_path / "one.npz"), K)
    np.testing.assert_array_equal(read_matrix(tmp_path / "one.npz", key="stiffness"), K)


@pytest.mark.parametrize("kind", ["csr", "csc", "coo", "dia", "bsr"])
def test_npz_of_scipy_sparse(tmp_path, kind):
    scipy.sparse.save_npz(tmp_path / "k.npz", scipy.sparse.coo_array(K).asformat(kind))
    np.testing.assert_array_equal(read_matrix(tmp_path / "k.npz"), K)


@pytest.mark.parametrize("version", ["4", "5"])
@pytest.mark.parametrize("sparse", [False, True])
def test_mat(tmp_path, version, sparse):
    stiffness = scipy.sparse.csc_array(K) if sparse else K
    scipy.io.savemat(tmp_path / "k.mat", {"M": 2 * K, "K": stiffness}, format=version)
    read = read_matrix(tmp_path / "k.mat", "K")
    np.testing.assert_array_equal(read, K)
    assert read.dtype == np.float64
    assert read.flags.c_contiguous


def test_mat_of_one_variable_needs_no_key(tmp_path):
    scipy.io.savemat(tmp_path / "k.mat", {"K": K}, do_compression=True)
    np.testing.assert_array_equal(read_matrix(tmp_path / "k.mat"), K)


def matlab_73(file, **variables):
    """Write a MATLAB 7.3 file as MATLAB does: 512 bytes of its own, then HDF5 by columns."""
    h5py = pytest.importorskip("h5py")
    with h5py.File(file, "w", userblock_size=512) as store:
        store.create_group("#refs#")
        for name, matrix in variables.items():
            if scipy.sparse.issparse(matrix):
                group = store.create_group(name)
                group.attrs["MATLAB_class"] = np.bytes_("double")
                group.attrs["MATLAB_sparse"] = np.uint64(matrix.shape[0])
                group["jc"] = matrix.indptr.astype(np.uint64)
                if matrix.nnz:
                    group["ir"] = matrix.indices.astype(np.uint64)
                    group["data"] = matrix.data
                continue
            if np.iscomplexobj(matrix):
                parts = np.dtype([("real", "f8"), ("imag", "f8")])
                matrix = matrix.view(parts)
            store[name] = matrix.T
            kind = "char" if matrix.dtype == np.uint16 else "double"
            store[name].attrs["MATLAB_class"] = np.bytes_(kind)
        store.create_group("a_struct").attrs["MATLAB_class"] = np.bytes_("struct")
    content = bytearray(file.read_bytes())
    content[:19] = b"MATLAB 7.3 MAT-file"
    file.write_bytes(content)
    return file


def test_mat_73(tmp_path):
    wide = K[:2]
    file = matlab_73(
        tmp_path / "k.mat",
        K=K,
        wide=wide,
        sparse=scipy.sparse.csc_array(wide),
        none=scipy.sparse.csc_array((2, 3)),
    )
    np.testing.assert_array_equal(read_matrix(file, "K"), K)
    np.testing.assert_array_equal(read_matrix(file, "wide"), wide)
    np.testing.assert_array_equal(read_matrix(file, "sparse"), wide)
    np.testing.assert_array_equal(read_matrix(file, "none"), np.zeros((2, 3)))


def test_mat_73_of_other_programs(tmp_path):
    with h5py.File(tmp_path / "k.mat", "w", userblock_size=512) as file:
        file.create_dataset("K", data=K.T).attrs["MATLAB_class"] = "double"
        file["none"] = np.array([0, 3], np.uint64)
        file["none"].attrs["MATLAB_empty"] = np.uint8(1)
    np.testing.assert_array_equal(read_matrix(tmp_path / "k.mat", "K"), K)
    with pytest.raises(ModelError, match="'none' is empty; save the matrix again"):
        read_matrix(tmp_path / "k.mat", "none")


@pytest.mark.parametrize(
    ("key", "message"),
    [
        ("Z", r"'Z': complex entries; give real matrices"),
        ("text", r"'text' is a char; save the matrix by itself"),
        ("a_struct", r"'a_struct' is a struct; save the matrix by itself"),
        ("k", r"unknown key 'k'; did you mean 'K'"),
        ("q", r"unknown key 'q'; known: 'K', 'Z', 'a_struct', 'text'"),
        (None, r"it holds 'K', 'Z', 'a_struct', 'text'; choose one with key"),
    ],
)
def test_mat_73_refuses(tmp_path, key, message):
    file = matlab_73(tmp_path / "k.mat", K=K, Z=K + 0j, text=np.array([[75]], dtype=np.uint16))
    with pytest.raises(ModelError, match=message):
        read_matrix(file, key)


finite = st.floats(allow_nan=False, allow_infinity=False, width=64)


@pytest.mark.slow
@few
@given(arrays(np.float64, st.tuples(st.integers(1, 5), st.integers(1, 5)), elements=finite))
def test_npz_and_mat_keep_every_bit(tmp_path_factory, matrix):
    folder = tmp_path_factory.mktemp("bits")
    np.savez(folder / "m.npz", m=matrix)
    scipy.io.savemat(folder / "m.mat", {"m": matrix})
    np.testing.assert_array_equal(read_matrix(folder / "m.npz"), matrix)
    np.testing.assert_array_equal(read_matrix(folder / "m.mat"), matrix)


# what is refused


def test_refusals_of_names(tmp_path):
    np.save(tmp_path / "k.npy", K)
    write(tmp_path / "k.txt", "1 2\n3 4\n")
    write(tmp_path / "k", "1 2\n3 4\n")
    for name, message in [
        ("nothing.npz", r"nothing\.npz: no such file; check the path$"),
        ("k.txt", r"k\.txt: unknown file ending '\.txt'"),
        ("k.mtz", r"unknown file ending '\.mtz'; did you mean '\.mtx'\?"),
        ("k", "unknown file ending ''; known: '.npy', '.npz'"),
        ("k.npy.gz", r"unknown file ending '\.gz'"),
    ]:
        with pytest.raises(ModelError, match=message):
            read_matrix(tmp_path / name)
    (tmp_path / "folder.mat").mkdir()
    with pytest.raises(ModelError, match=r"folder\.mat: is a folder; give the name of a file in"):
        read_matrix(tmp_path / "folder.mat")


@pytest.mark.parametrize("path", [np.nan, None, 3, b"k.npy", "", "k\0.npy"])
def test_refuses_what_is_no_path(path):
    with pytest.raises(ModelError, match=r"^path: .* (not a path|no file name); give"):
        read_matrix(path)


@pytest.mark.parametrize("key", [3, b"K", ["K"], np.array("K"), ""])
def test_refuses_what_is_no_key(tmp_path, key):
    np.savez(tmp_path / "k.npz", K=K)
    with pytest.raises(ModelError, match=r"k\.npz: key: .* (not text|empty); give a name"):
        read_matrix(tmp_path / "k.npz", key)


def test_causes_are_cut_to_one_short_line(tmp_path, monkeypatch):
    def fail(*_, **__):
        raise RuntimeError("long\n" * 1000)

    np.save(tmp_path / "k.npy", K)
    monkeypatch.setattr(np, "load", fail)
    with pytest.raises(ModelError) as refusal:
        read_matrix(tmp_path / "k.npy")
    assert "\n" not in str(refusal.value)
    assert len(str(refusal.value)) < len(str(tmp_path)) + 150


def test_refusals_of_keys(tmp_path):
    np.savez(tmp_path / "both.npz", mass=K, stiffness=K)
    np.savez(tmp_path / "none.npz")
    np.save(tmp_path / "k.npy", K)
    scipy.sparse.save_npz(tmp_path / "sparse.npz", scipy.sparse.csr_array(K))
    scipy.io.savemat(tmp_path / "both.mat", {"mass": K, "stiffness": K})
    scipy.io.mmwrite(tmp_path / "k.mtx", K)
    write(tmp_path / "k.rsa", "")
    one = "the file holds one matrix; leave key out"
    for name, key, message in [
        ("both.npz", None, "it holds 'mass', 'stiffness'; choose one with key"),
        ("both.npz", "stifness", "unknown key 'stifness'; did you mean 'stiffness'"),
        ("both.npz", "K", "unknown key 'K'; known: 'mass', 'stiffness'"),
        ("none.npz", None, "it holds nothing"),
        ("both.mat", None, "it holds 'mass', 'stiffness'; choose one with key"),
        ("both.mat", "mas", "unknown key 'mas'; did you mean 'mass'"),
        ("both.mat", "__header__", "unknown key '__header__'"),
        ("k.npy", "K", one),
        ("sparse.npz", "K", one),
        ("k.mtx", "K", one),
        ("k.rsa", "K", one),
    ]:
        with pytest.raises(ModelError, match=message):
            read_matrix(tmp_path / name, key)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (K + 0j, "complex entries; give real matrices"),
        (np.ones(3), r"1 dimension\(s\), shape \(3,\)"),
        (np.ones((2, 2, 2)), r"3 dimension\(s\)"),
        (np.array([["a", "b"]]), "entries of type <U1 are not real numbers"),
        (np.array([[1.0, np.nan]]), r"nan at \(0, 1\); every entry"),
        (np.array([[1.0], [-np.inf]]), r"-inf at \(1, 0\)"),
    ],
)
def test_refusals_of_values(tmp_path, value, message):
    np.save(tmp_path / "k.npy", value)
    np.savez(tmp_path / "k.npz", K=value)
    with pytest.raises(ModelError, match=rf"k\.npy: {message}") as refusal:
        read_matrix(tmp_path / "k.npy")
    assert "\n" not in str(refusal.value)
    with pytest.raises(ModelError, match=r"k\.npz: 'K': "):
        read_matrix(tmp_path / "k.npz", "K")


def test_refuses_pickles_unopened(tmp_path):
    class Trap:
        def __reduce__(self):
            return (builtins.exit, (1,))

    np.save(tmp_path / "k.npy", np.array([[Trap()]], dtype=object), allow_pickle=True)
    np.savez(tmp_path / "k.npz", K=np.array([[Trap()]], dtype=object))
    for name in ("k.npy", "k.npz"):
        with pytest.raises(ModelError, match=r"cannot be read as .*allow_pickle=False"):
            read_matrix(tmp_path / name)


def test_refuses_mat_variables_that_are_no_matrix(tmp_path):
    variables = {"s": {"a": 1.0}, "c": np.array([["a", 1]], dtype=object), "t": "text", "z": K + 1j}
    scipy.io.savemat(tmp_path / "k.mat", variables)
    for key, message in [
        ("s", "'s' is a struct; save the matrix by itself"),
        ("c", "'c' is a cell"),
        ("t", "'t' is a char"),
        ("z", "'z': complex entries"),
    ]:
        with pytest.raises(ModelError, match=message):
            read_matrix(tmp_path / "k.mat", key)


def test_refuses_sparse_matrices_too_large(tmp_path):
    scipy.sparse.save_npz(tmp_path / "k.npz", scipy.sparse.eye_array(5001).tocsr())
    with pytest.raises(ModelError, match=r"5001 rows are too many .*reduce the model first"):
        read_matrix(tmp_path / "k.npz")


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sound")
    np.save(folder / "k.npy", K)
    np.savez(folder / "k.npz", K=K)
    scipy.sparse.save_npz(folder / "sparse.npz", scipy.sparse.csr_array(K))
    scipy.io.savemat(folder / "k.mat", {"K": K})
    scipy.io.savemat(folder / "small.mat", {"K": K}, do_compression=True)
    scipy.io.mmwrite(folder / "k.mtx", scipy.sparse.coo_array(K), symmetry="symmetric")
    (folder / "k.mtx.gz").write_bytes(gzip.compress((folder / "k.mtx").read_bytes()))
    scipy.io.hb_write(folder / "k.rua", scipy.sparse.csc_array(K))
    matlab_73(folder / "k73.mat", K=K)
    return folder


NAMES = [
    "k.npy",
    "k.npz",
    "sparse.npz",
    "k.mat",
    "small.mat",
    "k.mtx",
    "k.mtx.gz",
    "k.rua",
    "k73.mat",
]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("share", [0.0, 0.1, 0.3, 0.5, 0.6])
def test_truncated_files_are_refused(sound, tmp_path, name, share):
    content = (sound / name).read_bytes()
    (tmp_path / name).write_bytes(content[: int(share * len(content))])
    with pytest.raises(ModelError) as refusal:
        read_matrix(tmp_path / name, "K" if name.endswith("73.mat") else None)
    assert "\n" not in str(refusal.value)


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
@few
@given(data=st.data())
def test_damaged_files_raise_nothing_else(sound, tmp_path_factory, name, data):
    content = bytearray((sound / name).read_bytes())
    for _ in range(3):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    file = tmp_path_factory.getbasetemp() / f"damaged-{name}"
    file.write_bytes(content)
    with contextlib.suppress(ModelError):
        assert np.isfinite(read_matrix(file)).all()
