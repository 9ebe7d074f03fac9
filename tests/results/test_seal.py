"""Result files that were changed: they load as they were saved, or are refused in one line."""

import io
import json
import random

import h5py
import numpy as np
import pytest
import xarray as xr

import stickslip as ss
from mutations import mutated
from stickslip.reference import snecma_beam
from stickslip.results import seal


@pytest.fixture(scope="module")
def content(tmp_path_factory):
    target = tmp_path_factory.mktemp("saved") / "beam.nc"
    ss.exact_response(snecma_beam(), [180.0, 190.0], harmonics=3).save(target)
    return target.read_bytes()


@pytest.fixture(scope="module")
def unsealed(content):
    """Return the file as the first version wrote it."""
    plain, options = io.BytesIO(content), {"engine": "h5netcdf", "decode_times": False}
    bare = xr.load_dataset(plain, mask_and_scale=False, **options).drop_dims("seal_byte")
    return bytes(bare.to_netcdf(engine="h5netcdf"))


@pytest.fixture
def path(content, tmp_path):
    target = tmp_path / "beam.nc"
    target.write_bytes(content)
    return target


def ended(path):
    """Return the result, and the message with which loading ended if it did not end well."""
    try:
        return ss.load(path), None
    except ss.ModelError as error:
        return None, str(error)


def bytes_of(result):
    """Return everything that a result holds."""
    dataset = result.to_dataset(derived=False)
    numbers = [variable.values.tobytes() for variable in dataset.variables.values()]
    return numbers, json.dumps(dataset.attrs, default=str), repr(result.model.contacts)


@pytest.mark.slow
def test_every_change_of_a_byte_is_noticed(content, path):
    chance, whole = random.Random(11), bytes_of(ss.load(path))
    ends = {"same": 0, "refused": 0}
    for _ in range(50):
        path.write_bytes(mutated(content, chance))
        result, line = ended(path)
        ends["same" if line is None else "refused"] += 1
        if line is None:
            assert bytes_of(result) == whole
        else:
            assert line.startswith(f"{path}: ")
            assert "\n" not in line
    assert ends["refused"] > 40


@pytest.mark.slow
@pytest.mark.parametrize(
    "change",
    [
        lambda file: file.attrs.__setitem__("settings", "{}"),
        lambda file: file.attrs.__setitem__("interrupted", 1),
        lambda file: file["omega"].__setitem__(0, -5.0),
        lambda file: file["omega"].__setitem__(0, 180.5),
        lambda file: file["status"].__setitem__(0, 4),
        lambda file: file["stiffness"].__setitem__((0, 0), 1e308),
        lambda file: file.__delitem__("seal"),
        lambda file: file["seal"].__setitem__(slice(None), 0),
        lambda file: file["seal"].__setitem__(slice(32, None), 0),
    ],
)
def test_every_edit_is_noticed(path, change):
    with h5py.File(path, "a") as file:
        change(file)
    _, line = ended(path)
    assert line == (
        f"{path}: was changed since it was saved, its digest differs; take a copy of the file as "
        "it was, or compute and save it again"
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "entry", "value", "message"),
    [
        ("omega", 0, -5.0, "omega = -5, outside 0 to inf"),
        ("event_point", 0, 99999, "event_point = 99999, outside 0 to 0"),
        ("event_kind", 0, 5, "event_kind 5 is unknown"),
        ("event_offset", 1, 2**40, "event_offset does not divide the "),
        ("slip_fraction", (0, 0), 1.5, "slip_fraction = 1.5, outside 0 to 1"),
        ("error_estimate", (0, 0), -1.0, "error_estimate = -1, outside 0 to inf"),
        ("harmonics_kept", 0, -1, "harmonics_kept = -1, outside 0 to inf"),
        ("status", 0, 99, "status 99 is unknown"),
        ("neutral", 0, -1, "neutral = -1, outside 0 to inf"),
    ],
)
def test_values_of_a_file_without_a_seal_are_checked(
    unsealed, path, monkeypatch, name, entry, value, message
):
    # What another process would see of these is nothing.
    monkeypatch.setattr("stickslip.results.store.require_harmless", lambda _: None)
    path.write_bytes(unsealed)
    assert ended(path)[1] is None
    with h5py.File(path, "a") as file:
        file[name][entry] = value
    _, line = ended(path)
    assert line.startswith(f"{path}: not a complete stickslip result ({message}")
    assert "\n" not in line


@pytest.mark.slow
@pytest.mark.parametrize("name", ["omega", "displacement_real", "status", "event_point", "mass"])
@pytest.mark.parametrize("kind", ["S4", "u8", "f4"])
def test_variables_of_another_type_are_refused(unsealed, path, monkeypatch, name, kind):
    monkeypatch.setattr("stickslip.results.store.require_harmless", lambda _: None)
    plain, options = io.BytesIO(unsealed), {"engine": "h5netcdf", "mask_and_scale": False}
    dataset = xr.load_dataset(plain, decode_times=False, **options)
    before = dataset[name]
    if before.dtype.kind == np.dtype(kind).kind:
        kind = "i2"
    other = (before.dims, np.nan_to_num(before.values).astype(kind))
    dataset.drop_vars(name).assign({name: other}).to_netcdf(path, engine="h5netcdf")
    _, line = ended(path)
    assert line.startswith(f"{path}: not a complete stickslip result ({name} holds ")
    assert "\n" not in line


@pytest.mark.slow
def test_a_file_without_a_seal_is_as_it_was_or_refused(unsealed, path):
    chance = random.Random(5)
    for _ in range(4):
        path.write_bytes(mutated(unsealed, chance))
        _, line = ended(path)
        assert line is None or "\n" not in line


@pytest.mark.slow
def test_a_file_that_keeps_its_reader_busy_is_given_up(path, monkeypatch):
    monkeypatch.setattr(seal, "_PATIENCE", 0.5)
    monkeypatch.setattr(seal, "_READ", "while True: pass")
    path.write_bytes(path.read_bytes().replace(seal._MARK, bytes(len(seal._MARK))))
    _, line = ended(path)
    assert "a damaged one (not read within 0.5" in line
    monkeypatch.setattr(seal, "_READ", "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)")
    assert "a damaged one (its reader crashed)" in ended(path)[1]


def test_more_numbers_than_the_file_can_hold_are_never_unpacked(path):
    with h5py.File(path, "w") as file:
        file.create_dataset("omega", shape=(2**33,), dtype="f8", chunks=(2**20,), compression=9)
    assert path.stat().st_size < 100_000
    assert "it declares more numbers than it can hold" in ended(path)[1]


@pytest.mark.slow
def test_a_sealed_file_is_read_without_another_process(path, monkeypatch):
    def refuse(*_, **__):
        raise AssertionError

    monkeypatch.setattr(seal.subprocess, "run", refuse)
    assert ss.load(path).converged.all()
