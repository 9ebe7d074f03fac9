"""Matrices in text whose numbers are written as no program writes them."""

import pytest

from stickslip import ModelError
from stickslip.io import read_matrix


def refused(message, path):
    with pytest.raises(ModelError, match=message) as told:
        read_matrix(path)
    assert "\n" not in str(told.value)


@pytest.mark.parametrize("number", ["1_0", "\u0663", "\uff13", "1e-400", "0x10", "1.0.0"])
@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("k.mtx", "%%MatrixMarket matrix coordinate real general\n1 1 1\n1 1 {}\n"),
        ("k.mtx", "%%MatrixMarket matrix array real general\n1 1\n{}\n"),
        ("k.mtx", "1 1 {}\n"),
        ("k.mtx", "1,1,1,1, {}\n"),
        ("k.mtx", "** 1,\n1\n*MATRIX,TYPE=STIFFNESS\n {},\n"),
        ("k.pch", "DMIG    K       0       6       2       0\nDMIG,K,7,1,,7,1,{}\n"),
    ],
)
def test_numbers_that_no_program_writes_are_refused(tmp_path, name, text, number):
    (tmp_path / name).write_text(text.format("3.0"), encoding="utf-8")
    assert read_matrix(tmp_path / name) == [[3.0]]
    (tmp_path / name).write_text(text.format(number), encoding="utf-8")
    refused("cannot be read as", tmp_path / name)


@pytest.mark.parametrize("name", ["1_0", "\u0663"])
def test_counts_that_no_program_writes_are_refused(tmp_path, name):
    text = "%%MatrixMarket matrix coordinate real general\n{0} {0} 1\n1 1 1\n"
    (tmp_path / "k.mtx").write_text(text.format(name), encoding="utf-8")
    refused("does not hold 3 counts", tmp_path / "k.mtx")


def test_entries_twice_beside_the_kind_or_no_integers_are_refused(tmp_path):
    for kind, body, message in [
        ("coordinate real general", "2 2 2\n1 1 1\n1 1 1\n", r"entry \(1, 1\) is given twice"),
        ("coordinate real symmetric", "2 2 2\n2 1 1\n2 1 1\n", r"entry \(2, 1\) is given twice"),
        ("coordinate real skew-symmetric", "2 2 1\n1 1 1\n", "on the diagonal is not 0"),
        ("coordinate integer general", "2 2 1\n1 1 1.5\n", "integers announced"),
    ]:
        (tmp_path / "k.mtx").write_text(f"%%MatrixMarket matrix {kind}\n{body}")
        refused(message, tmp_path / "k.mtx")


def test_an_empty_field_is_refused(tmp_path):
    (tmp_path / "k.mtx").write_text("1,,1,1,1, 3.0\n")
    refused("nothing stands between two commas|6 numbers", tmp_path / "k.mtx")
    (tmp_path / "k.mtx").write_text("1,1,1,1, 3.0\n1,,2,1, 3.0\n")
    refused("nothing stands between two commas", tmp_path / "k.mtx")
