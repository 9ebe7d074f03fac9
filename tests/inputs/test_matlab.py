"""Damaged MATLAB files, which SciPy's compiled reader must not see."""

import io
import random
import struct

import numpy as np
import pytest
import scipy.io
import scipy.sparse

from stickslip import ModelError, read_matrix

K = np.array([[4.0, -1.5, 0.0], [-1.5, 3.0, -1e-12], [0.0, -1e-12, 5e7]])


def saved(**variables):
    content = io.BytesIO()
    scipy.io.savemat(content, variables)
    return content.getvalue()


def read(folder, content):
    (folder / "k.mat").write_bytes(content)
    return read_matrix(folder / "k.mat", "K")


def test_a_file_with_bytes_missing_is_refused(tmp_path):
    content = saved(K=K)
    with pytest.raises(ModelError, match=r"k\.mat: cannot be read as \.mat: the file is damaged"):
        read(tmp_path, content[:172] + content[196:])


@pytest.mark.parametrize(
    ("place", "number", "message"),
    [
        (128, 14_000, "damaged: 120 bytes of type 14000 at byte 0"),
        (128, 9, "an element of type 9 stands where a matrix must be"),
        (132, 10**6, "damaged: 1000000 bytes of type 14 at byte 0"),
        (132, 121, "damaged: 121 bytes of type 14"),
        (136, 5, "a matrix does not begin with its flags"),
        (140, 4, "damaged: "),
        (176, 14, "a matrix is made of elements of types"),
        (176, 11, "damaged: 72 bytes of type 11"),
        (180, 71, "damaged: 71 bytes of type 9"),
    ],
)
def test_a_damaged_tag_is_refused(tmp_path, place, number, message):
    content = bytearray(saved(K=K))
    content[place : place + 4] = struct.pack("<I", number)
    with pytest.raises(ModelError, match=message) as refusal:
        read(tmp_path, content)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("size", [1, 100, 127, 132])
def test_a_file_cut_in_its_header_or_first_tag_is_refused(tmp_path, size):
    with pytest.raises(ModelError, match=r"cannot be read as \.mat: the file"):
        read(tmp_path, saved(K=K)[:size])


@pytest.mark.slow
@pytest.mark.parametrize("matrix", [K, K.astype(np.float32), scipy.sparse.csc_array(K)])
def test_whatever_is_damaged_nothing_else_is_raised(tmp_path, matrix):
    sound = saved(text="text", cell=np.array([[1, "a"]], dtype=object), K=matrix)
    assert read(tmp_path, sound) == pytest.approx(K)
    draw = random.Random(1)
    refused = 0
    for _ in range(300):
        content = bytearray(sound)
        place = draw.randrange(126, len(content))
        if draw.random() < 0.5:
            content[place] = draw.choice([0, 1, 5, 6, 9, 14, 15, 255])
        else:
            del content[place : place + draw.randrange(1, 40)]
        try:
            assert read(tmp_path, content).ndim == 2
        except ModelError:
            refused += 1
    assert refused > 100


def test_big_endian_files_are_read(tmp_path):
    content = bytearray(b"MATLAB 5.0".ljust(124) + struct.pack(">H", 0x0100) + b"MI")
    body = struct.pack(">IIII", 6, 8, 6, 0) + struct.pack(">IIii", 5, 8, 1, 2)
    body += struct.pack(">HH4s", 1, 1, b"K\0\0\0") + struct.pack(">IIdd", 9, 16, 1.5, 2.5)
    content += struct.pack(">II", 14, len(body)) + body
    assert read(tmp_path, content).tolist() == [[1.5, 2.5]]
