"""Harwell-Boeing files, sound and damaged."""

import tracemalloc

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

few = settings(max_examples=40)


def header(kind, rows=2, columns=2, entries=1, formats="(3I4) (3I4) (2E12.4)"):
    numbers = "".join(f"{number:14d}" for number in (rows, columns, entries, 0))
    pad = " " * 11
    return f"title\n{3:14d}{1:14d}{1:14d}{1:14d}\n{kind}{pad}{numbers}\n{formats}\n"


@pytest.mark.parametrize("ending", [".hb", ".rua", ".rb", ".HBF"])
def test_harwell_boeing_unsymmetric(tmp_path, ending):
    unsymmetric = np.array([[1.0, 2.0], [0.0, -3e-9], [0.0, 4.0]])
    file = tmp_path / f"k{ending}"
    scipy.io.hb_write(file, scipy.sparse.csc_array(unsymmetric))
    np.testing.assert_array_equal(read_matrix(file), unsymmetric)


@pytest.mark.parametrize("ending", [".rsa", ".hb", ".psa"])
def test_harwell_boeing_symmetric_is_mirrored(tmp_path, ending):
    np.testing.assert_array_equal(read_matrix(write(tmp_path / f"k{ending}", RSA)), K)


def test_harwell_boeing_of_the_upper_triangle(tmp_path):
    text = header("rsa", entries=3) + "   1   2   4\n   1   1   2\n  1.0000E+00  2.0000E+00\n"
    text = text.replace(f"{3:14d}{1:14d}", f"{4:14d}{1:14d}", 1)
    text = text.replace(f"{1:14d}\n", f"{2:14d}\n", 1) + "  3.0000E+00\n"
    np.testing.assert_array_equal(read_matrix(write(tmp_path / "k.rsa", text)), [[1, 2], [2, 3]])


def test_harwell_boeing_skew_is_mirrored_with_its_sign(tmp_path):
    text = header("RZA") + "   1   2   2\n   2\n  5.0000E+00\n"
    np.testing.assert_array_equal(read_matrix(write(tmp_path / "g.hb", text)), [[0, -5], [5, 0]])


def test_harwell_boeing_integers(tmp_path):
    text = header("ISA", formats="(3I4)  (3I4)  (3I4)") + "   1   2   2\n   2\n   7\n"
    np.testing.assert_array_equal(read_matrix(write(tmp_path / "g.hb", text)), [[0, 7], [7, 0]])


@pytest.mark.slow
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
        (
            header("RSA") + "   1   2   2\n   2\n  5.0x00E+00\n",
            "line 7: '5.0x00E.00' is no real number",
        ),
        (header("RSA") + "   1   2   2\n   2\n         nan\n", r"nan at \(0, 1\)"),
        (header("RSA", entries=4) + BODY, "1 lines of rows announced, 4 fill 2"),
        (
            header("RUA").replace(f"{1:14d}\n", f"{0:14d}\n", 1) + BODY,
            "0 lines of values announced, 1 fill 1",
        ),
        (header("RUA", entries=5) + BODY, "5 entries announced for 2 x 2"),
        (header("RUA", entries=-1) + BODY, "does not hold 3 counts"),
        (header("RSA", formats="(3I4) (3I4)") + BODY, "line 4 does not hold three"),
        (header("RSA", formats="(3I4) (3I4) (A12)") + BODY, r"unsupported number format '\(A12\)'"),
        (header("RSA", formats="(3I4) (3I4) (2P2F12.4)") + BODY, "unsupported number format"),
        (header("RSA", formats="(0I4) (3I4) (2E12.4)") + BODY, "unsupported number format"),
        (
            header("RSA", entries=2) + "   1   2   3\n   2   1\n  5.0000E+00  5.0000E+00\n",
            "entries on both sides of the diagonal",
        ),
        (header("RUA") + BODY + "  6.0000E+00\n", "7 lines announced, 8 present"),
        (header("RUA").replace(f"{3:14d}", f"{4:14d}", 1) + BODY, "4 lines .* but 3 by parts"),
        (header("RUA") + "   1   2   2   9\n   2\n  5.0\n", "3 numbers announced in line"),
        (
            header("RUA", entries=2) + "   1   3   3\n   2   1\n  5.0000E+00  6.0000E+00\n",
            "column 1: row 1 follows row 2; rows must ascend",
        ),
        (
            header("RUA", entries=2) + "   1   3   3\n   2   2\n  5.0000E+00  6.0000E+00\n",
            "column 1: row 2 follows row 2",
        ),
        (header("RUA") + "   1   2   2\n 0_2\n  5.0000E+00\n", "'0_2' stands where a whole"),
        (header("RUA") + "   1   2   2\n   2\n  5_0.0E+00\n", "'5_0.0E.00' is no real number"),
        (header("RUA") + "   1   2   2\n   2\n  1.00E-400\n", "1.00E-400 is too small"),
        (header("RUA") + "   1   2   2\n   2\n  1.000-400\n", "1.000-400 is too small"),
        (header("RZA") + "   1   2   2\n   1\n  5.0000E+00\n", "an entry on the diagonal is not 0"),
    ],
)
def test_refuses_harwell_boeing(tmp_path, text, message):
    with pytest.raises(ModelError, match=message) as refusal:
        read_matrix(write(tmp_path / "k.rsa", text))
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    ("rows", "columns", "entries"),
    [(3, 3, 2 * 10**8), (2 * 10**4, 10**4, 2 * 10**8), (3, 2 * 10**8, 1)],
)
def test_what_a_short_file_cannot_hold_takes_no_room(tmp_path, rows, columns, entries):
    formats = "(999999999I1)   (999999999I1)   (999999999E1.0)"
    file = write(tmp_path / "k.rua", header("RUA", rows, columns, entries, formats) + "1\n1\n1.0\n")
    tracemalloc.start()
    with pytest.raises(ModelError, match=r"\d+ (entries|numbers) announced"):
        read_matrix(file)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 10**7


def scipy_file(tmp_path, size=9):
    random = np.random.default_rng(0).standard_normal((size, size))
    file = tmp_path / "k.rua"
    scipy.io.hb_write(file, scipy.sparse.csc_array(random @ random.T))
    return file, file.read_text().splitlines(keepends=True)


def test_a_line_twice_or_lost_is_refused_wherever_it_stands(tmp_path):
    file, lines = scipy_file(tmp_path)
    sound = read_matrix(file)
    for at in range(len(lines)):
        for damaged in (lines[: at + 1] + lines[at:], lines[:at] + lines[at + 1 :]):
            write(file, "".join(damaged))
            with pytest.raises(ModelError, match="cannot be read as"):
                read_matrix(file)
    write(file, "".join(lines) + "\n  \n")  # blank lines at the end hold nothing
    np.testing.assert_array_equal(read_matrix(file), sound)


def written(kind, values):
    """Return the file of a diagonal matrix, three numbers in a line of columns of 20 characters."""
    size = len(values)
    integers = [
        "".join(f"{one:5d}" for one in row) for row in (range(1, size + 2), range(1, size + 1))
    ]
    fields = [f"{one:20.12E}" if kind in "DE" else f"{one:20.8f}" for one in values]
    lines = ["".join(fields[at : at + 3]) for at in range(0, size, 3)]
    heads = f"{2 + len(lines):14d}{1:14d}{1:14d}{len(lines):14d}"
    sizes = "".join(f"{one:14d}" for one in (size, size, size, 0))
    format_ = f"({size + 1}I5) ({size}I5) (3{kind}20.{12 if kind in 'DE' else 8})"
    text = "\n".join(["title", heads, f"RUA{'':11}{sizes}", format_, *integers, *lines]) + "\n"
    return text.replace("E+", f"{kind}+") if kind == "D" else text


@pytest.mark.parametrize("kind", ["E", "D", "F"])
@pytest.mark.parametrize("size", [3, 8])
def test_a_number_that_is_cut_anywhere_is_refused(tmp_path, kind, size):
    values = np.geomspace(1.2345678, 98765.43, size)
    text = written(kind, values)
    file = write(tmp_path / "k.rua", text)
    np.testing.assert_allclose(read_matrix(file).diagonal(), values, rtol=1e-7)
    lines = text.splitlines()
    # Nothing tells a number without an exponent from its beginning where no other line shows it.
    for number in range(6, len(lines) if kind != "F" or size > 3 else 6):
        for cut in range(1, 20):
            damaged = [*lines]
            damaged[number] = damaged[number][:-cut]
            with pytest.raises(ModelError, match=r"k\.rua"):
                read_matrix(write(file, "\n".join(damaged) + "\n"))


@pytest.mark.parametrize("plain", ["0.0", "1.5", "  2.500000000000", "0.000000000000    "])
def test_numbers_without_an_exponent_in_full_columns_are_read(tmp_path, plain):
    text = written("E", [1.0, 2.0, 3.0, 4.0])
    lines = text.splitlines()
    lines[-2] = lines[-2][:40] + f"{plain:>20}"
    lines[-1] = f"{plain:>20}"
    read = read_matrix(write(tmp_path / "k.rua", "\n".join(lines) + "\n"))
    assert read.diagonal().tolist() == [1.0, 2.0, float(plain), float(plain)]


def test_columns_of_numbers_without_exponents_are_read(tmp_path):
    lines = written("E", [1.0, 2.0, 3.0, 4.0]).splitlines()[:-2]
    text = "\n".join([*lines, "1.0 0.5 3.0", "0.25"]) + "\n"
    read = read_matrix(write(tmp_path / "k.rua", text))
    assert read.diagonal().tolist() == [1.0, 0.5, 3.0, 0.25]
