"""Matrix files with one kind of damage each, which had been read as other matrices."""

import numpy as np
import pytest

import stickslip as ss
from stickslip.io import read_matrix

DMIG = """DMIG,K,0,6,2,0
DMIG,K,1,1,,1,1,4.
+,1,2,-1.
DMIG,K,1,2,,1,2,5.
"""


@pytest.fixture
def read(tmp_path):
    def reading(text, name):
        path = tmp_path / name
        path.write_text(text)
        found = read_matrix(path)
        return found.toarray() if hasattr(found, "toarray") else np.asarray(found)

    return reading


def test_the_whole_file_is_read(read):
    assert read(DMIG, "k.pch").tolist() == [[4.0, -1.0], [-1.0, 5.0]]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (DMIG + "+,1,1,-7.\n", "mirror entries differ"),
        (DMIG.replace("+,1,2", "1 1 1.0\n+,1,2"), "continues none"),
        (DMIG.replace("+,1,2", "1,1,2"), "continues none"),
        (DMIG.replace("DMIG,K,1,1,,1,1,4.\n", ""), "a column is missing"),
    ],
)
def test_damaged_dmig_cards_are_refused(read, text, message):
    with pytest.raises(ss.ModelError, match=message):
        read(text, "k.pch")


def test_a_lost_diagonal_is_noticed_where_both_triangles_are_given(read):
    with pytest.raises(ss.ModelError, match="no diagonal"):
        read("1,2,-1.\n2,1,-1.\n2,2,4.\n", "k.mtx")
    # Gyroscopic terms have none.
    assert read("1,2,-1.\n2,1,1.\n", "g.mtx").tolist() == [[0.0, -1.0], [1.0, 0.0]]


def test_a_cut_exponent_of_a_harwell_boeing_file_is_refused(read, tmp_path):
    def file(second):
        return (
            f"{'a matrix':72}key\n{3:14}{1:14}{1:14}{1:14}\n"
            f"{'RSA':14}{2:14}{2:14}{2:14}{0:14}\n{'(3I8)':16}{'(2I8)':16}{'(1P2E30.16)':20}\n"
            f"{1:8}{2:8}{3:8}\n{1:8}{2:8}\n"
            f"{'1.0000000000000000E+00':>30}{second:>30}\n"
        )

    whole = "-4.9959600000000000E+04"
    assert read(file(whole), "k.hb").tolist() == [[1.0, 0.0], [0.0, -49959.6]]
    with pytest.raises(ss.ModelError, match="cut exponent"):
        read(file(whole[:-1]), "k.hb")


MALFORMED = [
    *("N-", "N+", "N*", "N/", "N**", "()", "^", "-", "N--", "--N", "+N", "+ N", "N*+N/N"),
    *("N..", "N.", ".N", "N .", "..N", "N..m/m", "N./m m"),
]


@pytest.mark.parametrize("unit", MALFORMED)
def test_malformed_units_are_refused(unit):
    with pytest.raises(ss.ModelError, match="unit"):
        ss.Force("a", f"1 {unit}")


@pytest.mark.parametrize(
    "unit", ["N.m/m", "kg . m.s^-2", "kg m s^ -2", "kg m s**(-2)", "kg.m.s^-2.0"]
)
def test_points_and_signs_that_say_something_are_read(unit):
    assert ss.Force("a", f"2 {unit}").amplitude == 2.0
