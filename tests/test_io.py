"""Matrices from files of every kind, sound and damaged."""

import builtins
import contextlib
import gzip
import io
import sys

import numpy as np
import pytest
import scipy.io
import scipy.sparse
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from stickslip.errors import ModelError
from stickslip.io import read_matrix
from stickslip.io.harwell_boeing import read_harwell_boeing

K = np.array([[4.0, -1.5, 0.0], [-1.5, 3.0, -1e-12], [0.0, -1e-12, 5e7]])

# 1-based compressed columns of the lower triangle of K, numbers without blanks between them,
# exponents with D or without a letter, a right-hand side to be left out: HBMAT at its worst.
RSA = """\
Stiffness                                                               STIF
             7             1             1             2             3
RSA                        3             3             5             0
(4I3)           (5I2)           (1P,3D12.5)         (3D12.5)
F                          1             0
  1  3  5  6
 1 2 2 3 3
 4.00000D+00-1.50000D+00 3.00000D+00
-1.0000-0012 5.00000D+07
 0.00000D+00
 0.00000D+00
 1.00000D+00
"""

MTX = "%%MatrixMarket matrix {}\n"
COORDINATE = MTX.format("coordinate real general")

few = settings(max_examples=40, deadline=None)


@pytest.fixture
def folder(tmp_path):
    return tmp_path


def header(kind, rows=2, columns=2, entries=1, formats="(3I4) (3I4) (2E12.4)"):
    numbers = "".join(f"{number:14d}" for number in (rows, columns, entries, 0))
    pad = " " * 11
    return f"title\n{3:14d}{1:14d}{1:14d}{1:14d}\n{kind}{pad}{numbers}\n{formats}\n"


def write(file, text):
    file.write_text(text)
    return file


# sound files


def test_npy(folder):
    np.save(folder / "k.npy", K)
    np.testing.assert_array_equal(read_matrix(folder / "k.npy"), K)
    np.testing.assert_array_equal(read_matrix(str(folder / "k.npy")), K)


def test_npz_with_and_without_key(folder):
    np.savez(folder / "both.npz", mass=2 * K, stiffness=K)
    np.savez_compressed(folder / "one.npz", stiffness=K)
    np.testing.assert_array_equal(read_matrix(folder / "both.npz", "mass"), 2 * K)
    np.testing.assert_array_equal(read_matrix(folder / "one.npz"), K)
    np.testing.assert_array_equal(read_matrix(folder / "one.npz", key="stiffness"), K)


@pytest.mark.parametrize("kind", ["csr", "csc", "coo", "dia", "bsr"])
def test_npz_of_scipy_sparse(folder, kind):
    scipy.sparse.save_npz(folder / "k.npz", scipy.sparse.coo_array(K).asformat(kind))
    np.testing.assert_array_equal(read_matrix(folder / "k.npz"), K)


@pytest.mark.parametrize("version", ["4", "5"])
@pytest.mark.parametrize("sparse", [False, True])
def test_mat(folder, version, sparse):
    stiffness = scipy.sparse.csc_array(K) if sparse else K
    scipy.io.savemat(folder / "k.mat", {"M": 2 * K, "K": stiffness}, format=version)
    read = read_matrix(folder / "k.mat", "K")
    np.testing.assert_array_equal(read, K)
    assert read.dtype == np.float64
    assert read.flags.c_contiguous


def test_mat_of_one_variable_needs_no_key(folder):
    scipy.io.savemat(folder / "k.mat", {"K": K}, do_compression=True)
    np.testing.assert_array_equal(read_matrix(folder / "k.mat"), K)


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


def test_mat_73(folder):
    wide = K[:2]
    file = matlab_73(
        folder / "k.mat",
        K=K,
        wide=wide,
        sparse=scipy.sparse.csc_array(wide),
        none=scipy.sparse.csc_array((2, 3)),
    )
    np.testing.assert_array_equal(read_matrix(file, "K"), K)
    np.testing.assert_array_equal(read_matrix(file, "wide"), wide)
    np.testing.assert_array_equal(read_matrix(file, "sparse"), wide)
    np.testing.assert_array_equal(read_matrix(file, "none"), np.zeros((2, 3)))


@pytest.mark.parametrize(
    ("key", "message"),
    [
        ("Z", r"'Z': complex entries; give real matrices"),
        ("text", r"'text' is a char; save the matrix by itself"),
        ("a_struct", r"'a_struct' is a struct; save the matrix by itself"),
        ("k", r"unknown key 'k'; known: 'K', 'Z', 'a_struct', 'text'"),
        (None, r"it holds 'K', 'Z', 'a_struct', 'text'; choose one with key"),
    ],
)
def test_mat_73_refuses(folder, key, message):
    file = matlab_73(folder / "k.mat", K=K, Z=K + 0j, text=np.array([[75]], dtype=np.uint16))
    with pytest.raises(ModelError, match=message):
        read_matrix(file, key)


def test_mat_73_without_h5py_says_what_to_do(folder, monkeypatch):
    write(folder / "k.mat", "")
    (folder / "k.mat").write_bytes(b"MATLAB 7.3".ljust(512) + b"\x89HDF\r\n\x1a\n")
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(ModelError, match="needs the package h5py; install it, or save with -v7"):
        read_matrix(folder / "k.mat")


@pytest.mark.parametrize("name", ["k.mtx", "k.mtx.gz", "K.MTX"])
@pytest.mark.parametrize("symmetry", ["general", "symmetric"])
@pytest.mark.parametrize("sparse", [False, True])
def test_matrix_market(folder, name, symmetry, sparse):
    text = io.BytesIO()
    matrix = scipy.sparse.coo_array(K) if sparse else K
    scipy.io.mmwrite(text, matrix, symmetry=symmetry, precision=17)
    content = text.getvalue()
    (folder / name).write_bytes(gzip.compress(content) if name.endswith("gz") else content)
    np.testing.assert_array_equal(read_matrix(folder / name), K)


def test_matrix_market_as_others_write_it(folder):
    text = "%%MATRIXMARKET MATRIX Coordinate Integer Skew-Symmetric\r\n% by hand\r\n%\r\n\r\n"
    text += " 3  3 2 \r\n2 1 5\r\n% more\r\n3 2 -1.5D+02"
    expected = [[0, -5, 0], [5, 0, 150], [0, -150, 0]]
    np.testing.assert_array_equal(read_matrix(write(folder / "g.mtx", text)), expected)
    dense = MTX.format("array real skew-symmetric") + "3 3\n5\n0\n-150\n"
    np.testing.assert_array_equal(read_matrix(write(folder / "g.mtx", dense)), expected)


def test_matrix_market_without_entries(folder):
    text = COORDINATE + "2 3 0\n"
    np.testing.assert_array_equal(read_matrix(write(folder / "z.mtx", text)), np.zeros((2, 3)))


@pytest.mark.parametrize("ending", [".hb", ".rua", ".rb", ".HBF"])
def test_harwell_boeing_unsymmetric(folder, ending):
    unsymmetric = np.array([[1.0, 2.0], [0.0, -3e-9], [0.0, 4.0]])
    file = folder / f"k{ending}"
    scipy.io.hb_write(file, scipy.sparse.csc_array(unsymmetric))
    np.testing.assert_array_equal(read_matrix(file), unsymmetric)


@pytest.mark.parametrize("ending", [".rsa", ".hb", ".psa"])
def test_harwell_boeing_symmetric_is_mirrored(folder, ending):
    np.testing.assert_array_equal(read_matrix(write(folder / f"k{ending}", RSA)), K)


def test_harwell_boeing_of_the_upper_triangle(folder):
    text = header("rsa", entries=3) + "   1   2   4\n   1   1   2\n  1.0000E+00  2.0000E+00\n"
    text = text.replace(f"{1:14d}\n", f"{2:14d}\n", 1) + "  3.0000E+00\n"
    np.testing.assert_array_equal(read_matrix(write(folder / "k.rsa", text)), [[1, 2], [2, 3]])


def test_harwell_boeing_skew_is_mirrored_with_its_sign(folder):
    text = header("RZA") + "   1   2   2\n   2\n  5.0000E+00\n"
    np.testing.assert_array_equal(read_matrix(write(folder / "g.hb", text)), [[0, -5], [5, 0]])


def test_harwell_boeing_integers(folder):
    text = header("ISA", formats="(3I4)  (3I4)  (3I4)") + "   1   2   2\n   2\n   7\n"
    np.testing.assert_array_equal(read_matrix(write(folder / "g.hb", text)), [[0, 7], [7, 0]])


finite = st.floats(allow_nan=False, allow_infinity=False, width=64)


@few
@given(arrays(np.float64, st.tuples(st.integers(1, 5), st.integers(1, 5)), elements=finite))
def test_npz_and_mat_keep_every_bit(tmp_path_factory, matrix):
    folder = tmp_path_factory.mktemp("bits")
    np.savez(folder / "m.npz", m=matrix)
    scipy.io.savemat(folder / "m.mat", {"m": matrix})
    np.testing.assert_array_equal(read_matrix(folder / "m.npz"), matrix)
    np.testing.assert_array_equal(read_matrix(folder / "m.mat"), matrix)


@few
@given(
    arrays(
        np.float64,
        st.integers(1, 6).map(lambda size: (size, size)),
        elements=st.sampled_from([0.0, 0.0, 1.0, -2.5e-101, 3.25e120, 7.0]),
    )
)
def test_harwell_boeing_keeps_symmetric_matrices(tmp_path_factory, matrix):
    lower = scipy.sparse.csc_array(np.tril(matrix + np.eye(len(matrix))))
    integers = [[number + 1 for number in block] for block in (lower.indptr, lower.indices)]
    # Fortran's 3-digit exponents lose their letter.
    fields = [f"{value:26.16e}".replace("e-101", "-101").replace("e", "D") for value in lower.data]
    blocks = [*([f"{number:8d}" for number in block] for block in integers), fields]
    counts = "".join(f"{len(block):14d}" for block in blocks)
    sizes = "".join(f"{number:14d}" for number in (*lower.shape, lower.nnz, 0))
    lines = ["title", f"{sum(map(len, blocks)):14d}{counts}", f"RSA{'':11}{sizes}"]
    lines += [
        "(1I8)           (1I8)           (1P,1D26.16)",
        *(field for block in blocks for field in block),
    ]
    file = write(tmp_path_factory.mktemp("hb") / "k.rsa", "\n".join(lines))
    full = lower.toarray() + np.tril(lower.toarray(), -1).T
    np.testing.assert_array_equal(read_harwell_boeing(file).toarray(), full)


# what is refused


def test_refusals_of_names(folder):
    np.save(folder / "k.npy", K)
    write(folder / "k.txt", "1 2\n3 4\n")
    write(folder / "k", "1 2\n3 4\n")
    for name, message in [
        ("nothing.npz", r"nothing\.npz: no such file; check the path$"),
        ("k.txt", r"k\.txt: unknown file ending '\.txt'"),
        ("k.mtz", r"unknown file ending '\.mtz'; did you mean '\.mtx'\?"),
        ("k", "unknown file ending ''; known: '.npy', '.npz'"),
        ("k.npy.gz", r"unknown file ending '\.gz'"),
    ]:
        with pytest.raises(ModelError, match=message):
            read_matrix(folder / name)
    (folder / "folder.mat").mkdir()
    with pytest.raises(ModelError, match="no such file"):
        read_matrix(folder / "folder.mat")


def test_refusals_of_keys(folder):
    np.savez(folder / "both.npz", mass=K, stiffness=K)
    np.savez(folder / "none.npz")
    np.save(folder / "k.npy", K)
    scipy.sparse.save_npz(folder / "sparse.npz", scipy.sparse.csr_array(K))
    scipy.io.savemat(folder / "both.mat", {"mass": K, "stiffness": K})
    scipy.io.mmwrite(folder / "k.mtx", K)
    write(folder / "k.rsa", RSA)
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
            read_matrix(folder / name, key)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (K + 0j, "complex entries; give real matrices"),
        (np.ones(3), r"1 dimension\(s\), shape \(3,\)"),
        (np.ones((2, 2, 2)), r"3 dimension\(s\)"),
        (np.array([["a", "b"]]), "entries of type <U1 are not real numbers"),
        (np.array([[1.0, np.nan]]), "nan in row 0, column 1, counted from 0"),
        (np.array([[1.0], [-np.inf]]), "-inf in row 1, column 0"),
    ],
)
def test_refusals_of_values(folder, value, message):
    np.save(folder / "k.npy", value)
    np.savez(folder / "k.npz", K=value)
    with pytest.raises(ModelError, match=rf"k\.npy: {message}") as refusal:
        read_matrix(folder / "k.npy")
    assert "\n" not in str(refusal.value)
    with pytest.raises(ModelError, match=r"k\.npz: 'K': "):
        read_matrix(folder / "k.npz", "K")


def test_refuses_pickles_unopened(folder):
    class Trap:
        def __reduce__(self):
            return (builtins.exit, (1,))

    np.save(folder / "k.npy", np.array([[Trap()]], dtype=object), allow_pickle=True)
    np.savez(folder / "k.npz", K=np.array([[Trap()]], dtype=object))
    for name in ("k.npy", "k.npz"):
        with pytest.raises(ModelError, match=r"cannot be read as .*allow_pickle=False"):
            read_matrix(folder / name)


def test_refuses_mat_variables_that_are_no_matrix(folder):
    variables = {"s": {"a": 1.0}, "c": np.array([["a", 1]], dtype=object), "t": "text", "z": K + 1j}
    scipy.io.savemat(folder / "k.mat", variables)
    for key, message in [
        ("s", "'s' is a struct; save the matrix by itself"),
        ("c", "'c' is a cell"),
        ("t", "'t' is a char"),
        ("z", "'z': complex entries"),
    ]:
        with pytest.raises(ModelError, match=message):
            read_matrix(folder / "k.mat", key)


def test_refuses_sparse_matrices_too_large(folder):
    scipy.sparse.save_npz(folder / "k.npz", scipy.sparse.eye_array(5001).tocsr())
    with pytest.raises(ModelError, match=r"5001 rows are too many .*reduce the model first"):
        read_matrix(folder / "k.npz")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1 1 3.0\n2 2 4.0\n", r"cannot be read as .mtx: no %%MatrixMarket .*Abaqus"),
        ("", "no %%MatrixMarket matrix header"),
        (MTX.format("coordinate complex general") + "1 1 1\n1 1 1 1\n", "matrix is complex"),
        (MTX.format("array complex hermitian") + "1 1\n1 1\n", "matrix is complex"),
        (MTX.format("coordinate pattern general") + "1 1 1\n1 1\n", "pattern without values"),
        (MTX.format("coordinate real diagonal") + "1 1 1\n1 1\n", "unknown kind of matrix"),
        (MTX.format("coordinate quad general") + "1 1 1\n1 1 1\n", "unknown kind .* 'quad'"),
        (MTX.format("element real general") + "1 1 1\n1 1 1\n", "unknown layout 'element'"),
        (COORDINATE + "2 2 2\n1 1 1.0\n", "2 entries announced, 1 present"),
        (COORDINATE + "2 2 0\n1 1 1.0\n", "0 entries announced, 1 present"),
        (COORDINATE + "2 2 2\n", "2 entries announced, 0 present"),
        (COORDINATE, "size line '' does not hold 3 counts"),
        (COORDINATE + "2 2\n1 1 1.0\n", "size line '2 2' does not hold 3 counts"),
        (COORDINATE + "2 2 -1\n", "does not hold 3 counts"),
        (COORDINATE + "2 2 1\n3 1 1.0\n", "row index lies outside 1 to 2"),
        (COORDINATE + "2 2 1\n1 0 1.0\n", "column index lies outside 1 to 2"),
        (COORDINATE + "2 2 1\n1.5 1 1.0\n", "could not convert string '1.5' to int64"),
        (COORDINATE + "2 2 1\n1 1 x\n", "could not convert string 'X' to float64"),
        (COORDINATE + "2 2 2\n1 1 1\n1 2\n", "columns"),
        (COORDINATE + "2 2 1\n1 1 nan\n", "nan in row 0"),
        (COORDINATE + "9999 9999 1\n1 1 1\n", "9999 rows"),
        (MTX.format("coordinate real symmetric") + "2 3 1\n1 1 1\n", "symmetric, but 2 x 3"),
        (MTX.format("array real symmetric") + "2 2\n1\n2\n", "3 entries announced, 2 present"),
        (MTX.format("array real symmetric") + "2 3\n1\n2\n3\n", "symmetric, but 2 x 3"),
        (MTX.format("array real general") + "2 2\n1\n2\n3\n", "4 entries announced, 3"),
        (
            MTX.format("coordinate real symmetric") + "2 2 2\n1 2 1\n2 1 1\n",
            "entries on both sides of the diagonal",
        ),
    ],
)
def test_refuses_matrix_market(folder, text, message):
    with pytest.raises(ModelError, match=message) as refusal:
        read_matrix(write(folder / "k.mtx", text))
    assert "\n" not in str(refusal.value)


BODY = "   1   2   2\n   2\n  5.0000E+00\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "header has 4 lines, the file 0"),
        ("binary\x00\n" * 9, "does not hold 4 counts"),
        (header("CSA") + BODY, r"complex \(type CSA\)"),
        (header("RHA") + BODY, r"complex \(type RHA\)"),
        (header("PSA") + BODY, r"pattern without values \(type PSA\)"),
        (header("RSE") + BODY, r"elemental \(type RSE\); export it assembled"),
        (header("XYZ") + BODY, "unknown matrix type 'XYZ'"),
        (header("RSA", rows=3) + BODY, "symmetric, but 3 x 2"),
        (header("RSA") + "   1   2   2\n   2\n", "7 lines announced, 6 present"),
        (header("RSA") + "   1   2\n   2\n  5.0\n", "3 numbers announced in line '1 2'"),
        (header("RSA") + "   1   2   2\n   3\n  5.0000E+00\n", "row index lies outside 1 to 2"),
        (header("RSA") + "   1   2   2\n   0\n  5.0000E+00\n", "row index lies outside 1 to 2"),
        (header("RSA") + "   1   2   3\n   2\n  5.0000E+00\n", "column pointers do not ascend"),
        (header("RSA") + "   1   3   2\n   2\n  5.0000E+00\n", "column pointers do not ascend"),
        (header("RSA") + "   1   2   2\n   2\n  5.0x00E+00\n", "could not convert"),
        (header("RSA") + "   1   2   2\n   2\n         nan\n", "nan in row 0, column 1"),
        (header("RSA", entries=4) + BODY, "3 numbers announced in line '2'"),
        (header("RUA").replace(f"{1:14d}\n", f"{0:14d}\n", 1) + BODY, "1 numbers .* 0 present"),
        (header("RUA", entries=-1) + BODY, "does not hold 3 counts"),
        (header("RSA", formats="(3I4) (3I4)") + BODY, "line 4 does not hold three"),
        (header("RSA", formats="(3I4) (3I4) (A12)") + BODY, r"unsupported number format '\(A12\)'"),
        (header("RSA", formats="(3I4) (3I4) (2P2F12.4)") + BODY, "unsupported number format"),
        (header("RSA", formats="(0I4) (3I4) (2E12.4)") + BODY, "unsupported number format"),
        (
            header("RSA", entries=2) + "   1   2   3\n   2   1\n  5.0000E+00  5.0000E+00\n",
            "entries on both sides of the diagonal",
        ),
    ],
)
def test_refuses_harwell_boeing(folder, text, message):
    with pytest.raises(ModelError, match=message) as refusal:
        read_matrix(write(folder / "k.rsa", text))
    assert "\n" not in str(refusal.value)


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
    write(folder / "k.rsa", RSA)
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
    "k.rsa",
    "k73.mat",
]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("share", [0.0, 0.1, 0.3, 0.5, 0.6])
def test_truncated_files_are_refused(sound, folder, name, share):
    content = (sound / name).read_bytes()
    (folder / name).write_bytes(content[: int(share * len(content))])
    with pytest.raises(ModelError) as refusal:
        read_matrix(folder / name, "K" if name.endswith("73.mat") else None)
    assert "\n" not in str(refusal.value)


# SciPy's reader of uncompressed MATLAB files can crash on damaged lengths: those are left out.
@pytest.mark.parametrize("name", [name for name in NAMES if name != "k.mat"])
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
