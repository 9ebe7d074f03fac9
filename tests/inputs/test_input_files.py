"""Input that is no plain file, larger than it says, or written as no program writes it."""

import gzip
import io
import os
import re
import socket
import struct
import zipfile
import zlib

import h5py
import numpy as np
import pytest
import scipy.io
import scipy.sparse
import xarray as xr

import stickslip as ss
from stickslip import ModelError
from stickslip.analyses.pattern_store import PatternStore
from stickslip.io import read_dofs, read_frf, read_matrix, source
from stickslip.study import Study

MARKET = b"%%MatrixMarket matrix coordinate real general\n"
ONE = b"2 2 1\n1 1 1.0\n"

STUDY = """\
[structure]
mass = [[1.0]]
stiffness = [[1.0]]
[[force]]
dof = "0"
amplitude = 1.0
[analysis]
omega = [0.5]
harmonics = 1
"""

MATRICES = ["npy", "npz", "mat", "mtx", "mtx.gz", "rua", "op4", "pch", "sti", "full"]

READERS = [
    *[(f"k.{ending}", read_matrix) for ending in MATRICES],
    ("k.dof", read_dofs),
    ("k.uff", read_frf),
    ("k.toml", Study.load),
    ("k.nc", ss.load),
    ("k.db", lambda path: PatternStore(path, {})),
]


def refused(message, call, *arguments, **settings):
    with pytest.raises(ModelError, match=message) as told:
        call(*arguments, **settings)
    assert "\n" not in str(told.value)


# what is no file


@pytest.mark.skipif(os.name == "nt", reason="there are none")
@pytest.mark.parametrize(("name", "read"), READERS)
def test_pipes_devices_sockets_and_folders_are_refused_at_once(tmp_path, name, read, monkeypatch):
    monkeypatch.chdir(tmp_path)  # the names of sockets are short
    kind = "is a pipe, a device or a socket; give a file$"
    os.mkfifo(name)
    refused(kind, read, name)
    os.remove(name)
    os.symlink("/dev/zero", name)
    refused(kind, read, name)
    os.remove(name)
    with socket.socket(socket.AF_UNIX) as one:
        one.bind(name)
        refused(kind, read, name)
    os.remove(name)
    os.mkdir(name)
    refused("is a folder; give the name of a file in it$", read, name)


@pytest.mark.parametrize(("name", "read"), READERS)
def test_names_that_the_system_refuses(name, read):
    refused("cannot be read", read, "x" * 5000 + name)


@pytest.mark.skipif(os.name == "nt", reason="there are none")
def test_a_pipe_beside_a_file_is_refused(tmp_path):
    (tmp_path / "k.sti").write_text("1 1 1.0\n")
    os.mkfifo(tmp_path / "k.dof")
    refused(r"k\.dof: is a pipe", read_matrix, tmp_path / "k.sti")
    os.mkfifo(tmp_path / "m.mtx")
    text = STUDY.replace("mass = [[1.0]]", 'mass = "m.mtx"')
    refused(r"m\.mtx: is a pipe", Study.parse, text, folder=tmp_path)


# what is larger than it says


@pytest.mark.parametrize("sparse", [False, True])
@pytest.mark.parametrize(
    "filling", [b" ", b"\n", b"% \n", b"1 1 1.0\n"], ids=["blanks", "lines", "comments", "entries"]
)
def test_a_packed_text_longer_than_its_entries_is_not_unpacked(tmp_path, filling, sparse):
    file = tmp_path / "k.mtx.gz"
    with gzip.open(file, "wb", compresslevel=1) as packed:
        packed.write(MARKET + ONE)
        packed.write(filling * (2**22 // len(filling)))
    refused("it unpacks to more than 1048832 bytes", read_matrix, file, sparse=sparse)


def test_a_text_without_end_before_its_sizes_is_not_unpacked(tmp_path):
    (tmp_path / "k.mtx.gz").write_bytes(gzip.compress(MARKET + b"%" * 2**22 + b"\n" + ONE))
    refused("size line '%+' does not hold 3 counts", read_matrix, tmp_path / "k.mtx.gz")


@pytest.mark.parametrize("sparse", [False, True])
@pytest.mark.parametrize(
    "text",
    [
        "%%MatrixMarket matrix coordinate real general\n1000000000 1000000000 1\n1 1 1.0\n",
        "%%MatrixMarket matrix coordinate real symmetric\n9999999999 9999999999 1\n1 1 1.0\n",
        "%%MatrixMarket matrix array real general\n100000 100000\n1.0\n",
        "%%MatrixMarket matrix array real symmetric\n100000 100000\n1.0\n",
        "1 1 1.0\n1000000000 1000000000 2.0\n",
    ],
)
def test_sizes_beyond_any_model_are_refused_before_there_is_room_for_them(tmp_path, text, sparse):
    (tmp_path / "k.mtx").write_text(text)
    refused("at most 20000000 rows|in coordinates", read_matrix, tmp_path / "k.mtx", sparse=sparse)


@pytest.mark.parametrize("sparse", [False, True])
@pytest.mark.parametrize("kind", ["coo", "dia"])
def test_sizes_beyond_any_model_in_npz(tmp_path, kind, sparse):
    size = 10**9
    matrix = {
        "coo": lambda: scipy.sparse.coo_array(([1.0], ([0], [0])), shape=(size, size)),
        "dia": lambda: scipy.sparse.dia_array((np.ones((1, 3)), [0]), shape=(size, size)),
    }[kind]()
    scipy.sparse.save_npz(tmp_path / "k.npz", matrix)
    refused("at most 20000000 rows", read_matrix, tmp_path / "k.npz", sparse=sparse)


def test_a_header_that_announces_more_than_the_file_has(tmp_path):
    content = io.BytesIO()
    said = {"descr": "<f8", "fortran_order": False, "shape": (100_000, 100_000)}
    np.lib.format.write_array_header_1_0(content, said)
    content.write(b"\0" * 80)
    announced = "takes 80000000000 bytes, 80 are there"
    (tmp_path / "k.npy").write_bytes(content.getvalue())
    refused(announced, read_matrix, tmp_path / "k.npy")
    with zipfile.ZipFile(tmp_path / "k.npz", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("K.npy", content.getvalue())
    refused(announced, read_matrix, tmp_path / "k.npz")
    np.save(tmp_path / "k.npy", np.eye(2))
    (tmp_path / "k.npy").write_bytes((tmp_path / "k.npy").read_bytes() + b"\0" * 8)
    refused("takes 32 bytes, 40 are there", read_matrix, tmp_path / "k.npy")


@pytest.mark.parametrize("shape", ["(-1, -1)", "(-2, -2)", "(True, 1)"])
def test_a_shape_that_no_array_has_is_named(tmp_path, shape):
    header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}}}".ljust(117) + "\n"
    start = b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode()
    (tmp_path / "k.npy").write_bytes(start + b"\0" * 32)
    refused(re.escape(f"an array of shape {shape}"), read_matrix, tmp_path / "k.npy")


def test_two_arrays_of_one_name_are_refused(tmp_path):
    content = io.BytesIO()
    np.save(content, np.eye(2))
    with zipfile.ZipFile(tmp_path / "k.npz", "w") as archive:
        archive.writestr("K.npy", content.getvalue())
        with pytest.warns(UserWarning, match="Duplicate name"):
            archive.writestr("K.npy", content.getvalue())
    refused("two arrays have the same name", read_matrix, tmp_path / "k.npz", "K")


def test_packed_arrays_unpack_up_to_a_size(tmp_path, monkeypatch):
    ones = np.eye(100)
    np.savez_compressed(tmp_path / "k.npz", K=ones)
    scipy.io.savemat(tmp_path / "k.mat", {"K": ones}, do_compression=True)
    with h5py.File(tmp_path / "seven.mat", "w") as file:
        made = file.create_dataset("K", data=ones, compression="gzip")
        made.attrs["MATLAB_class"] = np.bytes_("double")
    for name in ("k.npz", "k.mat", "seven.mat"):
        np.testing.assert_array_equal(read_matrix(tmp_path / name), ones)
    monkeypatch.setattr(source, "LARGEST_UNPACKED", 50_000)
    for name in ("k.npz", "k.mat", "seven.mat"):
        refused("unpacks to 80[0-9]{3} bytes", read_matrix, tmp_path / name)
    # Each number is read to 8 bytes, however few it has in the file.
    small = ones.astype(np.float32)
    np.savez_compressed(tmp_path / "k.npz", K=small)
    scipy.io.savemat(tmp_path / "k.mat", {"K": small}, do_compression=True)
    with h5py.File(tmp_path / "seven.mat", "w") as file:
        made = file.create_dataset("K", data=small, compression="gzip")
        made.attrs["MATLAB_class"] = np.bytes_("single")
    for name in ("k.npz", "k.mat", "seven.mat"):
        refused("unpacks to 10000 numbers", read_matrix, tmp_path / name)
    scipy.io.savemat(tmp_path / "k.mat", {"K": small})
    np.testing.assert_array_equal(read_matrix(tmp_path / "k.mat"), ones)
    np.savez(tmp_path / "k.npz", K=ones)  # what is not packed may be as large as its file
    np.testing.assert_array_equal(read_matrix(tmp_path / "k.npz"), ones)


def matlab(announced, unpacked):
    """Return a file of a packed element that announces a size and unpacks to another."""
    content = io.BytesIO()
    scipy.io.savemat(content, {"K": np.eye(3)})
    plain = content.getvalue()
    body = plain[128:132] + struct.pack("<I", announced) + plain[136:]
    packed = zlib.compress(body.ljust(unpacked, b"\0"))
    return plain[:128] + struct.pack("<II", 15, len(packed)) + packed


@pytest.mark.parametrize("announced", [120, 4_000_000_000])
def test_a_packed_element_that_goes_on_is_refused(tmp_path, announced):
    (tmp_path / "k.mat").write_bytes(matlab(120, 0))
    np.testing.assert_array_equal(read_matrix(tmp_path / "k.mat"), np.eye(3))
    (tmp_path / "k.mat").write_bytes(matlab(announced, 10_000_000))
    refused("not the 128 announced|unpacks to 4000000008", read_matrix, tmp_path / "k.mat")


def test_a_matlab_4_header_that_announces_more_than_the_file_has(tmp_path):
    header = struct.pack("<5i", 0, 2**30, 2**30, 0, 2)
    (tmp_path / "k.mat").write_bytes(header + b"K\0" + b"\0" * 80)
    refused("9223372036854775830 bytes announced, 102 present", read_matrix, tmp_path / "k.mat")


@pytest.mark.parametrize(
    ("column", "message"),
    [(0, "given twice"), (1, "lies outside 1 to 3"), (2, "lies outside 1 to 3")],
)
def test_a_sparse_matrix_of_matlab_4_names_each_place_once(tmp_path, column, message):
    table = np.array([[1.0, 1, 5], [2, 2, 6], [3, 3, 0]])
    table[1, :2] = [[1, 1], [2, 9], [2.5, 2]][column]
    header = struct.pack("<5i", 2, 3, 3, 0, 2)
    (tmp_path / "k.mat").write_bytes(header + b"K\0" + table.T.tobytes())
    refused(message, read_matrix, tmp_path / "k.mat")


def zeros(mebibytes):
    """Yield what zlib makes of zeros, without a beginning."""
    packer = zlib.compressobj(1, zlib.DEFLATED, -15)
    for _ in range(mebibytes):
        yield packer.compress(b"\0" * 2**20)
    yield packer.flush()


@pytest.mark.slow
def test_numbers_that_an_hdf5_file_announces_and_does_not_hold(tmp_path):
    file = tmp_path / "k.mat"
    with h5py.File(file, "w") as store:
        packed = {"dtype": "f8", "compression": "gzip"}
        store.create_dataset("huge", (200_000, 200_000), chunks=(1000, 1000), **packed)
        store.create_dataset("holes", (100, 100), chunks=(10, 10), **packed)[0, 0] = 1.0
        store.create_dataset("empty", (1000, 1000), dtype="f8")
        store.create_dataset("outside", (9, 9), dtype="f8", external=[("other", 0, 648)])
        store["link"] = h5py.ExternalLink("other", "/K")
        bomb = store.create_dataset("bomb", (10, 10), chunks=(10, 10), **packed)
        bomb.id.write_direct_chunk((0, 0), b"\x78\x9c" + b"".join(zeros(300)))
        group = store.create_group("sparse")
        group.attrs["MATLAB_sparse"] = np.uint64(10**12)
        for part, numbers in (("jc", [0, 1]), ("ir", [0]), ("data", [1.0])):
            group[part] = np.array(numbers)
    for key, message in [
        ("huge", "'huge' unpacks to 320000000000 bytes"),
        ("holes", "'holes' has 100 parts, the file holds 1 of them"),
        ("empty", "'empty' announces 8000000 bytes and holds 0"),
        ("outside", "the numbers of 'outside' are in another file"),
        ("link", "'link' is a link, not a part of the file"),
        ("bomb", "packed bytes are not the 800 announced"),
        ("sparse", "at most 20000000 rows"),
    ]:
        refused(message, read_matrix, file, key, sparse=True)


@pytest.mark.slow
def test_a_damaged_packed_part_of_an_hdf5_file_is_refused(tmp_path):
    file = tmp_path / "k.mat"
    with h5py.File(file, "w") as store:
        made = store.create_dataset("K", data=np.eye(9), compression="gzip", shuffle=True)
        part = made.id.get_chunk_info(0)
    content = file.read_bytes()
    for at in range(part.byte_offset, part.byte_offset + part.size):
        file.write_bytes(content[:at] + bytes([content[at] ^ 0x10]) + content[at + 1 :])
        try:
            found = read_matrix(file)
        except ModelError:
            continue
        np.testing.assert_array_equal(found, np.eye(9))  # bits that zlib does not use
    file.write_bytes(content)
    np.testing.assert_array_equal(read_matrix(file), np.eye(9))


def unseal(file):
    """Write a result as the first version did, without the digest that would show any change."""
    dataset = xr.load_dataset(file, engine="h5netcdf", decode_times=False)
    dataset.drop_dims("seal_byte").to_netcdf(file, engine="h5netcdf")
    return file


@pytest.mark.slow
def test_a_result_that_announces_more_than_it_holds_is_refused(tmp_path):
    file = tmp_path / "k.nc"
    ss.forced_response(Study.parse(STUDY).model, [0.5], harmonics=1).save(file)
    ss.load(unseal(file))
    with h5py.File(file, "r+") as store:
        name = "displacement_real"
        said = dict(store[name].attrs)
        assert said
        del store[name]
        store.create_dataset(name, (10**5,) * 2, dtype="f8", chunks=(1000,) * 2, compression=1)
    refused("it declares more numbers than it can hold", ss.load, file)


@pytest.mark.slow
def test_settings_of_a_result_that_nest_without_end_are_refused(tmp_path):
    file = tmp_path / "k.nc"
    ss.forced_response(Study.parse(STUDY).model, [0.5], harmonics=1).save(file)
    with h5py.File(unseal(file), "r+") as store:
        store.attrs["settings"] = "[" * 60_000
    refused("not a complete stickslip result", ss.load, file)


@pytest.mark.parametrize("version", ["4", "5"])
def test_two_matrices_of_one_name_in_matlab_files(tmp_path, version):
    content = io.BytesIO()
    scipy.io.savemat(content, {"K": np.eye(2)}, format=version)
    one = content.getvalue()
    (tmp_path / "k.mat").write_bytes(one + one[128 if version == "5" else 0 :])
    refused("two matrices have the same name", read_matrix, tmp_path / "k.mat", "K")


# marks


def test_the_mark_of_windows_editors_is_read_over(tmp_path):
    texts = {
        "k.mtx": MARKET + b"1 1 1\n1 1 3.0\n",
        "c.mtx": b"1 1 3.0\n",
        "k.sti": b"1 1 3.0\n",
        "k.dof": b"7.1\n",
        "k.pch": b"DMIG    K       0       6       2       0\nDMIG,K,7,1,,7,1,3.0\n",
        "k.rua": b"t\n" + b"%14d" * 4 % (3, 1, 1, 1) + b"\nRUA" + b"%14d" * 4 % (1, 1, 1, 0)
        + b"\n(2I4) (1I4) (1E12.4)\n   1   2\n   1\n  3.0000E+00\n",
    }  # fmt: skip
    for name, text in texts.items():
        (tmp_path / name).write_bytes(b"\xef\xbb\xbf" + text.replace(b"\n", b"\r\n"))
    for name in texts:
        if name != "k.dof":
            assert read_matrix(tmp_path / name) == [[3.0]], name
    (tmp_path / "study.toml").write_bytes(b"\xef\xbb\xbf" + STUDY.encode())
    assert Study.load(tmp_path / "study.toml").model.structure.dofs == ("0",)


def test_nothing_is_inflated_beyond_its_size():
    packed = zlib.compress(b"x" * 100)
    assert source.inflate(packed, 100) == b"x" * 100
    for size in (99, 101):
        with pytest.raises(ValueError, match=f"not the {size} announced"):
            source.inflate(packed, size)
    with pytest.raises(ValueError, match="not the 100 announced"):
        source.inflate(packed[:-5], 100)
