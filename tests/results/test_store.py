"""Datasets and files: everything is in them, exactly, or one line says why not."""

import json
from dataclasses import fields

import h5py
import numpy as np
import pytest
import xarray as xr

import stickslip as ss
from stickslip.reference import snecma_beam
from stickslip.results import store
from stickslip.results.arrays import Arrays

GRID = np.linspace(150.0, 250.0, 12)


@pytest.fixture(scope="module")
def frf():
    return ss.forced_response(snecma_beam(), GRID[::-1], 5, residual=1.5, observe=["tip", "damper"])


@pytest.fixture(scope="module")
def content(frf, tmp_path_factory):
    target = tmp_path_factory.mktemp("saved") / "beam.nc"
    frf.save(target)
    return target.read_bytes()


@pytest.fixture
def path(content, tmp_path):
    target = tmp_path / "beam.nc"
    target.write_bytes(content)
    return target


@pytest.fixture
def unsealed(path):
    """As the first version wrote files: nothing but the values says that they are right."""
    xr.load_dataset(path, engine="h5netcdf", decode_times=False).drop_dims("seal_byte").to_netcdf(
        path, engine="h5netcdf"
    )
    return path


def assert_same(one, other):
    for entry in fields(Arrays):
        mine, theirs = (getattr(result.arrays, entry.name) for result in (one, other))
        assert mine.dtype == theirs.dtype
        assert mine.shape == theirs.shape
        assert mine.tobytes() == theirs.tobytes(), entry.name
    for name in ("settings", "dofs", "half_wave", "interrupted", "assumptions"):
        assert getattr(one, name) == getattr(other, name)
    assert dict(one.timings) == dict(other.timings)
    assert dict(one.counters) == dict(other.counters)
    assert one.model.contacts == other.model.contacts
    assert one.model.forces == other.model.forces
    assert one.model.structure.dofs == other.model.structure.dofs
    for name in ("mass", "damping", "stiffness"):
        mine, theirs = (getattr(result.model.structure, name) for result in (one, other))
        assert mine.tobytes() == theirs.tobytes()


# ---------------------------------------------------------------------------------- datasets


def test_dataset(frf):
    dataset = frf.to_dataset()
    assert dict(dataset.sizes) == {"omega": 12, "harmonic": 6, "dof": 2, "point": 1}
    tip = dataset["displacement"].sel(dof="tip").sel(omega=200.0, method="nearest")
    np.testing.assert_array_equal(tip, frf.coefficients("tip")[frf.index(200.0)])
    np.testing.assert_array_equal(dataset["amplitude"].sel(dof="tip"), frf.amplitude("tip"))
    np.testing.assert_array_equal(dataset["dissipation"][:, 0], frf.dissipation((0, 0)))
    units = {name: variable.attrs["units"] for name, variable in dataset.variables.items()}
    assert units == {
        "omega": "rad/s",
        "harmonic": "1",
        "dof": "1",
        "point": "1",
        "contact": "1",
        "displacement": "m",
        "contact_displacement": "m",
        "contact_force": "N",
        "amplitude": "m",
        "error_estimate": "m",
        "sampling_error": "m",
        "slip_fraction": "1",
        "dissipation": "J",
        "residual": "1",
        "iterations": "1",
        "harmonics_kept": "1",
        "samples": "1",
        "status": "1",
        "fold": "1",
        "jump": "1",
        "further": "1",
        "stability": "1",
        "lower": "m",
        "upper": "m",
        "unique": "1",
        "guaranteed": "1",
    }
    assert all(variable.attrs["long_name"] for variable in dataset.variables.values())
    flags = dataset["status"].attrs
    assert flags["flag_values"].tolist() == list(range(13))
    assert flags["flag_meanings"].split() == [
        "converged",
        "stalled",
        "singular",
        "not_computed",
        "harmonics_limit",
        "orbit_stalled",
        "samples_limit",
        "steps_limit",
        "effort_limit",
        "free",
        "history",
        "other_motion",
        "work_limit",
    ]
    assert dataset.attrs["stickslip_version"] == ss.__version__
    assert json.loads(dataset.attrs["settings"])["residual"] == 1.5
    told = json.loads(dataset.attrs["diagnostics"])
    assert tuple(one["text"] for one in told) == frf.assumptions
    assert {"harmonics", "modal-base"} <= {one["code"] for one in told}
    assert json.loads(dataset.attrs["timings"])["total"] > 0.0


def test_dataset_is_a_copy_in_effect(frf):
    for name in frf.to_dataset().data_vars:
        frf.to_dataset()[name].values[0] = 2
    dataset, fresh = frf.to_dataset(), frf.to_dataset()
    for name, variable in dataset.data_vars.items():
        variable.values[...] = 2
        assert not (fresh[name].values == 2).all(), name
    assert not (frf.omega == 2.0).any()
    np.testing.assert_array_equal(fresh["status"], frf.arrays.status)


def test_points_are_named_by_their_contact():
    single = snecma_beam()
    model = ss.Model(
        ss.join({"1": single.structure, "2": single.structure}),
        [
            ss.Jenkins("1.damper", stiffness=2.4e7, slip_force=246.0),
            ss.Jenkins("1.tip", "2.tip", stiffness=1e5, slip_force=50.0, name="shroud"),
        ],
        [ss.Force("1.tip", 10.0)],
    )
    dataset = ss.forced_response(model, [200.0], 3).to_dataset()
    assert dataset["point"].values.tolist() == ["jenkins", "shroud"]
    assert dataset["contact"].values.tolist() == ["jenkins", "shroud"]


# ---------------------------------------------------------------------------------- files


@pytest.mark.slow
def test_round_trip(frf, path):
    loaded = ss.load(path)
    assert_same(frf, loaded)
    assert loaded.peak("tip") == frf.peak("tip")
    np.testing.assert_array_equal(loaded.contact_force(0, 4), frf.contact_force(0, 4))
    assert not loaded.omega.flags.writeable
    assert ss.load(str(path)).status == frf.status


@pytest.mark.slow
@pytest.mark.parametrize(
    "make",
    [
        lambda: ss.forced_response(snecma_beam(), (180.0, 190.0)),
        lambda: ss.forced_response(snecma_beam(), GRID, 9, max_iterations=1),
        lambda: ss.forced_response(snecma_beam(), [190.0], max_harmonics=3, tolerance=1e-7),
        lambda: ss.forced_response(ss.Model(snecma_beam().structure), GRID, 1),
        lambda: ss.forced_response(
            ss.Model(
                ss.Structure([[1.0]], [[4.0]], [[0.1]], ["Schaufel 1, Spitze μ"]),
                [ss.Jenkins("Schaufel 1, Spitze μ", stiffness=1.0, slip_force=np.inf, name="Fuß")],
                [ss.Force("Schaufel 1, Spitze μ", 1 / 3, 0.1)],
            ),
            [1.0, 1.0, 0.5],
            3,
        ),
    ],
    ids=["range", "stalled", "limit", "linear and unforced", "names"],
)
def test_round_trip_of(make, tmp_path):
    result = make()
    result.save(tmp_path / "it.nc")
    assert_same(result, ss.load(tmp_path / "it.nc"))


@pytest.mark.slow
def test_round_trip_of_an_interrupted_run(tmp_path):
    def stop(_):
        raise KeyboardInterrupt

    with pytest.raises(ss.Interrupted) as caught:
        ss.forced_response(
            snecma_beam(), np.linspace(180, 200, 6000), 35, observe="tip", progress=stop
        )
    partial = caught.value.result
    assert partial.converged.all()
    partial.save(tmp_path / "partial.nc")
    loaded = ss.load(tmp_path / "partial.nc")
    assert_same(partial, loaded)
    assert loaded.interrupted
    assert loaded.peak("tip") == partial.peak("tip")


@pytest.mark.slow
def test_many_contacts(tmp_path):
    """Texts longer than the 64 kB that HDF5 allows an attribute."""
    n = 250
    names = [f"blade-{i}-of-the-disk-with-a-long-name-{'x' * 200}" for i in range(n)]
    structure = ss.Structure(np.eye(n), 4 * np.eye(n), 0.1 * np.eye(n), names)
    contacts = [ss.Jenkins(name, stiffness=1.0, slip_force=1.0) for name in names]
    result = ss.forced_response(ss.Model(structure, contacts, [ss.Force(names[0], 1.0)]), [1.0], 1)
    result.save(tmp_path / "disk.nc")
    assert_same(result, ss.load(tmp_path / "disk.nc"))


@pytest.mark.slow
def test_any_reader_opens_the_file(frf, path):
    with h5py.File(path) as file:
        # Complex numbers would be compounds, which NetCDF readers refuse.
        assert all(variable.dtype.kind != "V" for variable in file.values())
        real = file["displacement_real"][:, 1, 0]
        assert file["displacement_real"].attrs["units"] in ("m", b"m")
        assert json.loads(file["contacts"][0])["law"] == "jenkins"
        np.testing.assert_array_equal(file["stiffness"][:], frf.model.structure.stiffness)
    np.testing.assert_array_equal(real, frf.coefficients("tip")[:, 1].real)
    with xr.open_dataset(path, engine="h5netcdf") as dataset:
        assert dataset["error_estimate"].attrs["units"] == "m"
        assert "amplitude" not in dataset
    with h5py.File(path) as file:
        assert file["displacement_real"].compression_opts == 1
    amplitude = ss.load(path).to_dataset()["amplitude"]
    np.testing.assert_array_equal(amplitude, frf.to_dataset()["amplitude"])


# ---------------------------------------------------------------------------------- writing


@pytest.mark.slow
def test_nothing_but_the_file_is_left(frf, tmp_path):
    frf.save(tmp_path / "a.nc")
    frf.save(tmp_path / "a.nc")
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.nc"]


def test_failed_write_changes_nothing(frf, path, monkeypatch):
    before = path.read_bytes()

    def fail(handle):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", fail)
    with pytest.raises(ss.ModelError, match=r"cannot be written \(No space left on device\)"):
        frf.save(path)
    assert path.read_bytes() == before
    assert [entry.name for entry in path.parent.iterdir()] == ["beam.nc"]


def test_interrupted_write_changes_nothing(frf, path, monkeypatch):
    def fail(handle):
        raise KeyboardInterrupt

    monkeypatch.setattr("os.fsync", fail)
    with pytest.raises(KeyboardInterrupt):
        frf.save(path)
    assert [entry.name for entry in path.parent.iterdir()] == ["beam.nc"]


def test_wrong_targets(frf, tmp_path):
    with pytest.raises(ss.ModelError, match="is a folder; give the name of a file in it"):
        frf.save(tmp_path)
    with pytest.raises(ss.ModelError, match=r"there is no folder .*missing; create it first"):
        frf.save(tmp_path / "missing" / "a.nc")


# ---------------------------------------------------------------------------------- reading


def assert_refused(path, message):
    with pytest.raises(ss.ModelError, match=message) as caught:
        ss.load(path)
    assert "\n" not in str(caught.value)
    assert str(path) in str(caught.value)


def test_no_file(tmp_path):
    assert_refused(tmp_path / "none.nc", "no such file")
    assert_refused(tmp_path, "is a folder")


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.0, 0.001, 0.3, 0.9, 0.999])
def test_truncated_file(path, share):
    content = path.read_bytes()
    path.write_bytes(content[: int(share * len(content))])
    assert_refused(path, "not a readable NetCDF file, or a damaged one|was changed since it was")


def test_text_file(tmp_path):
    (tmp_path / "a.nc").write_text("omega;amplitude\n1;2\n")
    assert_refused(tmp_path / "a.nc", "not a readable NetCDF file")


def test_flipped_bits_are_noticed(path):
    with h5py.File(path) as file:
        chunk = file["stiffness"].id.get_chunk_info(0)
    content = bytearray(path.read_bytes())
    content[chunk.byte_offset + chunk.size // 2] ^= 0x10
    path.write_bytes(content)
    assert_refused(path, "beam.nc: was changed since it was saved, its digest differs; take a")


def test_foreign_file(tmp_path):
    xr.Dataset({"a": ("x", [1.0])}).to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    assert_refused(tmp_path / "a.nc", "a NetCDF file, but not a stickslip result")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("attribute", "value", "message"),
    [
        (
            "stickslip_format",
            store.FORMAT + 1,
            r"in format 3, this version reads format 1 to 2; upgr",
        ),
        ("stickslip_format", "new", r"in format new, this version reads format 1"),
        ("stickslip_kind", "wave_fronts", r"holds 'wave_fronts', this version reads 'forced_"),
        ("settings", "{", r"not a complete stickslip result"),
        ("settings", "{}", r"not a complete stickslip result \('span'\)"),
        ("settings", '{"span": null, "tolerance": 3}', r"\(tolerance: 3; give a fraction"),
    ],
)
def test_changed_attributes(unsealed, attribute, value, message):
    with h5py.File(unsealed, "a") as file:
        file.attrs[attribute] = value
    assert_refused(unsealed, message)


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["mass", "contacts", "displacement_imag", "displacement_real", "status", "row"]
)
def test_missing_variables(unsealed, name):
    with h5py.File(unsealed, "a") as file:
        del file[name]
    assert_refused(unsealed, "not a complete stickslip result|damaged")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("dof", [b"tip", b"elsewhere"], "unknown dof 'elsewhere'"),
        ("status", [99] * 12, "status 99 is unknown"),
        ("contacts", [b'{"law": "velcro", "dofs": ["tip"], "parameters": {}}'], "law 'velcro'"),
        ("contacts", [b"{"], "not a complete stickslip result"),
    ],
)
def test_parts_that_do_not_fit(unsealed, name, value, message):
    with h5py.File(unsealed, "a") as file:
        file[name][:] = value
    assert_refused(unsealed, message)


@pytest.mark.slow
def test_arrays_of_another_model(unsealed, tmp_path):
    dataset = xr.load_dataset(unsealed, engine="h5netcdf")
    specs = [
        spec.replace('"jenkins"}', f'"{n}"}}') for n in "ab" for spec in dataset.contacts.values
    ]
    changed = dataset.drop_dims("contacts_entry").assign(contacts=("contacts_entry", specs))
    changed.to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    assert_refused(tmp_path / "a.nc", "1 contact points in the arrays, 2 in the model")


@pytest.mark.parametrize("wrong", [None, 3, "", b"beam.nc", ["beam.nc"]])
def test_what_is_no_path(frf, wrong):
    with pytest.raises(ss.ModelError, match="path: "):
        ss.load(wrong)
    with pytest.raises(ss.ModelError, match="path: "):
        frf.save(wrong)
