"""OUTPUT4 files of every layout, precision, byte order and width, whole and damaged."""

import random
import re

import numpy as np
import pytest

import input_files
import op4_files
import stickslip as ss

K = np.random.default_rng(0).standard_normal((9, 9))
K = (K @ K.T + np.eye(9)) * 1e3
BAND = np.where(abs(np.subtract.outer(range(9), range(9))) < 3, K, 0.0)
BAND[0, 5] = BAND[5, 0] = 7.0
"""Of which a column is made of several strings."""

ROUNDED = 3e-6
"""Of the largest entry: what two triangles may differ by where a file says that it is symmetric."""

EACH = 15
"""Mutations per form, some 500 in all."""


def of(form, matrix):
    return matrix.astype(np.float32).astype(np.float64) if form.words == 1 else matrix


def read(folder, content):
    (folder / "k.op4").write_bytes(content)
    return ss.read_matrix(folder / "k.op4")


def refused(folder, content, expected):
    """Return whether it is refused, in one line; what is read is what was written.

    What no reader can see is a number on the diagonal, and one that rounding would explain.
    """
    try:
        found = read(folder, content)
    except ss.ModelError as error:
        (line,) = str(error).splitlines()
        assert line.startswith(f"{folder / 'k.op4'}: ")
        return True
    assert found.shape == expected.shape
    largest = max(abs(found).max(), abs(expected).max())
    changed = abs(found - expected) > ROUNDED * largest
    assert not (changed & ~np.eye(len(found), dtype=bool)).any()
    assert changed.sum() <= 3
    return False


@pytest.mark.parametrize("form", op4_files.FORMS, ids=str)
def test_every_form_is_read(form, tmp_path):
    for matrix in (of(form, K), of(form, BAND)):
        found = read(tmp_path, op4_files.written(matrix, form))
        # Single precision has 9 digits as text.
        digits = 1e-9 if form.words == 1 and not form.order else 0.0
        assert abs(found - matrix).max() <= digits * abs(matrix).max()


@pytest.mark.slow
@pytest.mark.parametrize("form", op4_files.FORMS, ids=str)
def test_damage_is_refused_or_does_not_matter(form, tmp_path):
    sound = op4_files.written(of(form, BAND), form)
    expected = read(tmp_path, sound)
    draws = [random.Random(f"{form}{seed}") for seed in range(EACH)]
    damaged = [input_files.damaged(sound, draw)[1] for draw in draws]
    assert sum(refused(tmp_path, one, expected) for one in damaged) > 0.6 * EACH


@pytest.mark.slow
@pytest.mark.parametrize("form", [one for one in op4_files.FORMS if one.order], ids=str)
def test_no_changed_count_of_a_binary_file_is_believed(form, tmp_path):
    sound = op4_files.written(of(form, BAND), form)
    expected = read(tmp_path, sound)
    kind = np.dtype(f"{form.order}i4")
    count = 0
    for at in range(0, len(sound) - 3, 4):
        (there,) = np.frombuffer(sound, kind, 1, at).tolist()
        # Halves of real numbers are larger, but for the zeros of short ones.
        if abs(there) < 2**21:
            for number in {there + 1, there - 1, -there, 2 * there, 2**31 - 1} - {there}:
                changed = sound[:at] + np.array([number], kind).tobytes() + sound[at + 4 :]
                count += refused(tmp_path, changed, expected)
    assert count > 100


@pytest.mark.slow
@pytest.mark.parametrize("form", [one for one in op4_files.FORMS if not one.order], ids=str)
def test_no_changed_count_of_a_text_is_believed(form, tmp_path):
    sound = op4_files.written(of(form, BAND), form)
    expected = read(tmp_path, sound)
    places = re.finditer(rb" +-?[0-9]+(?=[ \n|K])", sound)
    count = 0
    for place in places:
        there = int(place[0])
        for number in {there + 1, there - 1, -there, 2 * there, 10**7} - {there}:
            written = str(number).encode().rjust(len(place[0]))
            changed = sound[: place.start()] + written + sound[place.end() :]
            count += refused(tmp_path, changed, expected)
    assert count > 50


def test_the_line_of_a_text_is_named(tmp_path):
    sound = op4_files.written(BAND, op4_files.Form("dense", 2))
    lines = sound.splitlines(keepends=True)
    lines[2] = lines[2].replace(b"E", b"x", 1)
    with pytest.raises(ss.ModelError, match=r"k\.op4: cannot .* line 3: '.*x.*' is no real number"):
        read(tmp_path, b"".join(lines))
