"""Files of every kind of result: bit by bit, also those of the first version."""

import gzip
import json
import zipfile
from dataclasses import fields
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

import stickslip as ss
from stickslip.reference import beam_pair, snecma_beam
from stickslip.results import store
from stickslip.results.result import Result
from stickslip.views import kinds

OLD = Path(__file__).parents[1] / "data" / "forced-response-format-1.nc.gz"


def exact():
    return ss.exact_response(snecma_beam(), np.linspace(150.0, 250.0, 12), observe=["tip"])


def transient():
    return ss.transient(snecma_beam(), 170.0, 9, keep=4, samples=16, start={"tip": 1e-3})


MAKERS = {
    "exact": exact,
    "exact range": lambda: ss.exact_response(snecma_beam(), (190.0, 192.0)),
    "exact pair": lambda: ss.exact_response(beam_pair(), [180.0, 200.0], harmonics=5),
    "exact linear": lambda: ss.exact_response(ss.Model(snecma_beam().structure), [100.0]),
    "transient": transient,
    "transient rk4": lambda: ss.transient(beam_pair(), 170.0, 3, "rk4", tolerance=1e-3),
    "transient linear": lambda: ss.transient(ss.Model(snecma_beam().structure), 170.0, 2),
    "certified": lambda: ss.certify(ss.forced_response(snecma_beam(), (190.0, 192.0)), 3),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", MAKERS)
def test_round_trip(name, tmp_path):
    result = MAKERS[name]()
    result.save(tmp_path / "it.nc")
    again = ss.load(tmp_path / "it.nc")
    assert type(again) is type(result)
    for entry in fields(result.arrays):
        mine, theirs = (getattr(one.arrays, entry.name) for one in (result, again))
        assert mine.dtype == theirs.dtype
        assert mine.shape == theirs.shape, entry.name
        assert mine.tobytes() == theirs.tobytes(), entry.name
        assert not theirs.flags.writeable
    for entry in ("settings", "dofs", "interrupted", "assumptions", "timings", "counters"):
        assert getattr(again, entry) == getattr(result, entry)
    assert again.model.contacts == result.model.contacts


@pytest.mark.slow
def test_what_is_loaded_goes_on(tmp_path):
    result, run = exact(), transient()
    result.save(tmp_path / "a.nc")
    run.save(tmp_path / "b.nc")
    again, later = ss.load(tmp_path / "a.nc"), ss.load(tmp_path / "b.nc")
    assert again.peak("tip") == result.peak("tip")
    np.testing.assert_array_equal(again.contact_force(0, 6), result.contact_force(0, 6))
    assert list(again.events(6)) == list(result.events(6))
    assert later.status == run.status
    assert later.final == run.final
    assert ss.transient(later.model, 170.0, 1, start=later.final).periods == 1


def test_dataset_of_orbits():
    result = exact()
    dataset = result.to_dataset()
    sizes = {"omega": 12, "harmonic": 33, "dof": 1, "point": 1, "side": 2, "multiplier": 7}
    assert sizes.items() <= dict(dataset.sizes).items()
    assert dataset.sizes["event"] == dataset["event_offset"].values[-1]
    names = dataset["state_entry"].values.tolist()
    assert names[0] == "x damper"
    assert names[3] == "v damper"
    assert names[6] == "f jenkins"
    np.testing.assert_array_equal(dataset["amplitude"].sel(dof="tip"), result.amplitude("tip"))
    top = dataset["range"].sel(dof="tip", side="highest")
    np.testing.assert_array_equal(top, result.amplitude("tip", "max"))
    assert all(one.attrs["units"] and one.attrs["long_name"] for one in dataset.variables.values())
    dataset["state"].values[...] = 0.0
    assert result.state(0).vector.any()


def test_dataset_of_a_transient():
    run = transient()
    dataset = run.to_dataset()
    assert dict(dataset.sizes) == {
        "time": 65,
        "dof": 3,
        "point": 1,
        "section": 10,
        "state_entry": 7,
        "period": 9,
        "side": 2,
        "event": len(run.events),
    }
    np.testing.assert_array_equal(dataset["displacement"].sel(dof="tip"), run.displacement("tip"))
    np.testing.assert_array_equal(dataset["amplitude"].sel(dof="tip"), run.amplitudes("tip"))
    assert dataset["contact_force"].attrs["units"] == "N"
    assert all(one.attrs["units"] and one.attrs["long_name"] for one in dataset.variables.values())
    assert json.loads(dataset.attrs["settings"])["keep"] == 4


@pytest.mark.slow
def test_a_file_of_the_first_version_is_read(tmp_path):
    target = tmp_path / "old.nc"
    target.write_bytes(gzip.decompress(OLD.read_bytes()))
    old = ss.load(target)
    assert old.dofs == ("tip",)
    # as the version that wrote the file printed them
    assert old.amplitude("tip").tolist() == pytest.approx(
        [0.0007192351979560482, 0.001477803797348254, 0.001339758490364633], rel=1e-15
    )
    assert old.certificate is None
    now = ss.forced_response(snecma_beam(), old.omega, 3, observe="tip")
    np.testing.assert_allclose(old.amplitude("tip"), now.amplitude("tip"), rtol=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize(
    "kind",
    sorted(
        store.KINDS.keys()
        - {
            "static_response",
            "fit",
            "nonlinear_modes",
            "uncertainty",
            "flutter_map",
            "campbell",
            "speed_response",
            "sweep",
        }
    ),
)
def test_a_file_of_every_first_kind_is_read_shown_and_written_again(kind, tmp_path):
    with zipfile.ZipFile(OLD.with_name("first-version.zip")) as files:
        old = ss.load(files.extract(f"{kind}.nc", tmp_path))
    # Files of the first version hold texts without codes.
    assert {(one.code, one.severity) for one in old.diagnostics} <= {("text", "note")}
    assert kinds.failures(old) == kinds.cautions(old) == []
    old.save(tmp_path / "new.nc")
    again = ss.load(tmp_path / "new.nc")
    assert again.diagnostics == old.diagnostics
    assert kinds.view_of([again]).facts(again) == kinds.view_of([old]).facts(old)


def test_every_kind_has_its_class_and_its_view():
    from importlib import import_module

    from stickslip.views.kinds import VIEWS, View

    assert set(VIEWS) == set(store.KINDS)
    for kind, (module, name) in store.KINDS.items():
        owner = getattr(import_module(module), name)
        assert issubclass(owner, Result)
        assert owner.kind == kind
        module, name = VIEWS[kind]
        assert issubclass(getattr(import_module(module), name), View)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("make", "name"),
    [
        (exact, "state"),
        (exact, "multipliers_imag"),
        (exact, "event_offset"),
        (transient, "poincare"),
        (transient, "time"),
        (transient, "event_kind"),
        (MAKERS["certified"], "certified_error"),
    ],
)
def test_missing_variables_are_named(make, name, tmp_path):
    make().save(tmp_path / "it.nc")
    dataset = xr.load_dataset(tmp_path / "it.nc", engine="h5netcdf", decode_times=False)
    dataset.drop_vars([name, "seal"]).to_netcdf(tmp_path / "part.nc", engine="h5netcdf")
    with pytest.raises(ss.ModelError, match="not a complete stickslip result") as refused:
        ss.load(tmp_path / "part.nc")
    assert "\n" not in str(refused.value)


@pytest.mark.slow
@pytest.mark.parametrize("make", [exact, transient])
def test_arrays_of_another_model_are_refused(make, tmp_path):
    make().save(tmp_path / "it.nc")
    dataset = xr.load_dataset(tmp_path / "it.nc", engine="h5netcdf", decode_times=False)
    specs = [
        spec.replace('"jenkins"}', f'"{n}"}}') for n in "ab" for spec in dataset.contacts.values
    ]
    changed = dataset.drop_dims(["contacts_entry", "seal_byte"]).assign(
        contacts=("contacts_entry", specs)
    )
    changed.to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    message = "1 contact points in the arrays, 2 in the model|7 entries per state, 8 in the model"
    with pytest.raises(ss.ModelError, match=message):
        ss.load(tmp_path / "other.nc")


@pytest.mark.slow
def test_settings_of_another_analysis_are_refused(tmp_path):
    exact().save(tmp_path / "it.nc")
    dataset = xr.load_dataset(tmp_path / "it.nc", engine="h5netcdf", decode_times=False)
    dataset.drop_dims("seal_byte").to_netcdf(tmp_path / "it.nc", engine="h5netcdf")
    with h5py.File(tmp_path / "it.nc", "a") as file:
        settings = json.loads(file.attrs["settings"])
        file.attrs["settings"] = json.dumps(settings | {"method": "newton"})
    with pytest.raises(ss.ModelError, match=r"method: unknown choice 'newton'; known: 'exact'"):
        ss.load(tmp_path / "it.nc")
