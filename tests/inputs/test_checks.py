"""The doors that values from outside pass."""

from pathlib import Path

import numpy as np
import pytest

from stickslip.checks import brief, choice, file_path, members, unknown, whole_number
from stickslip.errors import ModelError
from stickslip.study.matrices import neighbour


class Mute:
    def __repr__(self):
        raise RuntimeError("no words")


class Lines:
    def __repr__(self):
        return "one\r\n  two\x85three"


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (1.5, "1.5"),
        ("a  b", "'a  b'"),
        (Mute(), "<Mute>"),
        pytest.param(10**5000, "<int>", id="digits"),
        (Lines(), "one two three"),
        ("x" * 99, "'" + "x" * 56 + "..."),
    ],
)
def test_brief_is_one_short_line_and_never_fails(value, shown):
    assert brief(value) == shown


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("newtn", r"^method: unknown choice 'newtn'; did you mean 'newton'\?$"),
        ("x", "^method: unknown choice 'x'; known: 'newton', 'picard'$"),
        (None, "^method: None is not text; known: 'newton', 'picard'$"),
        (np.array(["newton"]), "is not text"),
        (["newton"], "is not text"),
    ],
)
def test_a_choice_is_one_of_its_names(value, message):
    assert choice("newton", "method", ["newton", "picard"]) == "newton"
    with pytest.raises(ModelError, match=message):
        choice(value, "method", ["newton", "picard"])


def test_names_in_other_letters_are_the_nearest(tmp_path):
    assert unknown("key", "m", ["M", "K"]) == "unknown key 'm'; did you mean 'M'?"
    assert unknown("dof", "ROOT", ["rot", "root"]).endswith("did you mean 'root'?")
    for name in ("M.csv", "K.csv"):
        (tmp_path / name).touch()
    assert neighbour(tmp_path / "k.csv") == "; did you mean 'K.csv'?"
    assert neighbour(tmp_path / "m.csv") == "; did you mean 'M.csv'?"


def test_paths_are_text_or_path_like(tmp_path):
    assert file_path("a.nc", "path") == Path("a.nc")
    assert file_path(tmp_path, "path") == tmp_path
    for value in (None, 3, np.nan, b"a.nc", "", "a\0b", Mute()):
        with pytest.raises(ModelError, match=r"^path: .* give"):
            file_path(value, "path")


def test_members_of_lists_and_their_kin():
    assert members((name for name in "ab"), "x", "[...]") == ("a", "b")
    assert members(np.arange(2), "x", "[...]") == (0, 1)
    for value in (None, "ab", b"ab", np.array(1), 3):
        with pytest.raises(ModelError, match=r"^x: .* is not a list; write \[...\]$"):
            members(value, "x", "[...]")


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (0, "^n: 0 lies below 1; give at least 1$"),
        (8, "^n: 8 is too large; give at most 7$"),
        (1.0, "is not an integer"),
    ],
)
def test_whole_numbers_have_bounds(value, message):
    assert whole_number(np.int8(7), "n", smallest=1, largest=7) == 7
    with pytest.raises(ModelError, match=message):
        whole_number(value, "n", smallest=1, largest=7)
    with pytest.raises(ModelError, match="give at most 2147483647"):
        whole_number(2**31, "n")
