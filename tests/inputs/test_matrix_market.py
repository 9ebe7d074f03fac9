"""MatrixMarket files, sound and damaged."""

import gzip
import io

import numpy as np
import pytest
import scipy.io
import scipy.sparse

from input_files import write
from stickslip.errors import ModelError
from stickslip.io import read_matrix

K = np.array([[4.0, -1.5, 0.0], [-1.5, 3.0, -1e-12], [0.0, -1e-12, 5e7]])
MTX = "%%MatrixMarket matrix {}\n"
COORDINATE = MTX.format("coordinate real general")


@pytest.mark.parametrize("name", ["k.mtx", "k.mtx.gz", "K.MTX"])
@pytest.mark.parametrize("symmetry", ["general", "symmetric"])
@pytest.mark.parametrize("sparse", [False, True])
def test_matrix_market(tmp_path, name, symmetry, sparse):
    text = io.BytesIO()
    matrix = scipy.sparse.coo_array(K) if sparse else K
    scipy.io.mmwrite(text, matrix, symmetry=symmetry, precision=17)
    content = text.getvalue()
    (tmp_path / name).write_bytes(gzip.compress(content) if name.endswith("gz") else content)
    np.testing.assert_array_equal(read_matrix(tmp_path / name), K)


def test_matrix_market_as_others_write_it(tmp_path):
    text = "%%MATRIXMARKET MATRIX Coordinate Integer Skew-Symmetric\r\n% by hand\r\n%\r\n\r\n"
    text += " 3  3 2 \r\n2 1 5\r\n% more\r\n3 2 -1.5D+02"
    expected = [[0, -5, 0], [5, 0, 150], [0, -150, 0]]
    np.testing.assert_array_equal(read_matrix(write(tmp_path / "g.mtx", text)), expected)
    dense = MTX.format("array real skew-symmetric") + "3 3\n5\n0\n-150\n"
    np.testing.assert_array_equal(read_matrix(write(tmp_path / "g.mtx", dense)), expected)


def test_matrix_market_without_entries(tmp_path):
    text = COORDINATE + "2 3 0\n"
    np.testing.assert_array_equal(read_matrix(write(tmp_path / "z.mtx", text)), np.zeros((2, 3)))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x 1 3.0\n2 2 4.0\n", r"cannot be read as .mtx: no %%MatrixMarket matrix header"),
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
        (COORDINATE + "2 2 1\n1.5 1 1.0\n", "line 3: '1.5' is no whole number"),
        (COORDINATE + "2 2 1\n1 1 x\n", "line 3: 'x' is no real number"),
        (COORDINATE + "2 2 2\n1 1 1\n1 2\n", "line 4: 2 numbers in '1 2', not 3"),
        (COORDINATE + f"2 2 1\n1 1 0.{'0' * 400}1\n", "is too small for a number; write 0"),
        (COORDINATE + f"2 2 1\n1 1 0.{'0' * 250}1e-99\n", "is too small for a number"),
        (COORDINATE + f"2 2 1\n{2**63} 1 1.0\n", f"line 3: '{2**63}' is no whole number"),
        (COORDINATE + "2 2 1\n1 1 nan\n", r"nan at \(0, 0\)"),
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
def test_refuses_matrix_market(tmp_path, text, message):
    with pytest.raises(ModelError, match=message) as refusal:
        read_matrix(write(tmp_path / "k.mtx", text))
    assert "\n" not in str(refusal.value)
