"""Reductions in files: bit by bit, whole or not at all, and damaged ones refused."""

import numpy as np
import pytest
import scipy.sparse
import xarray as xr

import stickslip as ss
from failing_disk import Disk, names
from stickslip.reference import snecma_beam


def chain(size=60, named=True):
    rng = np.random.default_rng(3)
    springs = rng.uniform(1e6, 3e6, size + 1)
    stiffness = scipy.sparse.diags_array(
        [-springs[1:-1], springs[:-1] + springs[1:], -springs[1:-1]], offsets=[-1, 0, 1]
    )
    mass = scipy.sparse.diags_array(rng.uniform(0.5, 2.0, size))
    dofs = [f"{node}.{way}" for node in range(1, size // 2 + 1) for way in (1, 3)]
    boundary = {"tip": dofs[-1], "damper": dofs[8]} if named else {"tip": size - 1}
    return ss.craig_bampton(mass, stiffness, boundary, modes=6, dofs=dofs if named else None)


ARRAYS = ("mass", "stiffness", "rows", "omega", "_basis")


@pytest.mark.parametrize("named", [True, False])
def test_round_trip(named, tmp_path):
    reduced = chain(named=named)
    reduced.save(tmp_path / "chain.nc")
    again = ss.Reduction.load(tmp_path / "chain.nc")
    for name in ARRAYS:
        mine, theirs = getattr(reduced, name), getattr(again, name)
        assert (mine.dtype, mine.shape) == (theirs.dtype, theirs.shape)
        assert mine.tobytes() == theirs.tobytes(), name
        assert not theirs.flags.writeable
    for name in ("full_mass", "full_stiffness"):
        for part in ("data", "indices", "indptr"):
            mine, theirs = (getattr(getattr(one, name), part) for one in (reduced, again))
            assert mine.tobytes() == theirs.tobytes()
    for name in ("dofs", "boundary", "row_names", "size", "asymmetry", "decoupling"):
        assert getattr(again, name) == getattr(reduced, name)
    assert str(again.report(4)) == str(reduced.report(4))
    motion = np.random.default_rng(1).standard_normal((5, len(reduced.dofs)))
    assert again.recover(motion).tobytes() == reduced.recover(motion).tobytes()
    load = np.linspace(0.0, 1.0, reduced.size)
    assert again.forces(load) == reduced.forces(load)
    again.save(tmp_path / "again.nc")
    ss.Reduction.load(tmp_path / "again.nc")


def test_a_response_is_the_same_after_loading(tmp_path):
    reduced = chain()
    reduced.save(tmp_path / "chain.nc")
    first, second = (
        ss.forced_response(
            ss.Model(
                one.structure(ss.ModalDamping(0.001)),
                [ss.Jenkins("damper", stiffness=1e6, slip_force=1.0)],
                [ss.Force("tip", 1.0)],
            ),
            np.linspace(30.0, 90.0, 5),
            3,
        )
        for one in (reduced, ss.Reduction.load(tmp_path / "chain.nc"))
    )
    assert first.arrays.displacement.tobytes() == second.arrays.displacement.tobytes()


def test_a_disk_that_refuses_leaves_what_was_there(tmp_path, monkeypatch):
    target = tmp_path / "chain.nc"
    target.write_bytes(b"as it was")
    with monkeypatch.context() as patch:
        Disk(patch, {"write": 28}, room=100)
        with pytest.raises(ss.ModelError, match="No space left on device"):
            chain().save(target)
    assert names(tmp_path) == ["chain.nc"]
    assert target.read_bytes() == b"as it was"


def test_other_files_are_refused(tmp_path):
    ss.forced_response(snecma_beam(), [150.0], 1).save(tmp_path / "curve.nc")
    chain().save(tmp_path / "chain.nc")
    with pytest.raises(ss.ModelError, match="holds no reduction, but 'forced_response'"):
        ss.Reduction.load(tmp_path / "curve.nc")
    with pytest.raises(ss.ModelError, match=r"read it with stickslip\.Reduction\.load"):
        ss.load(tmp_path / "chain.nc")
    with pytest.raises(ss.ModelError, match="no such file"):
        ss.Reduction.load(tmp_path / "nothing.nc")


def test_a_changed_file_is_refused(tmp_path):
    chain().save(tmp_path / "chain.nc")
    content = bytearray((tmp_path / "chain.nc").read_bytes())
    rng = np.random.default_rng(0)
    for place in rng.integers(0, len(content), 20).tolist():
        changed = content.copy()
        changed[place] ^= 1 << int(rng.integers(8))
        (tmp_path / "bad.nc").write_bytes(changed)
        with pytest.raises(ss.ModelError):
            ss.Reduction.load(tmp_path / "bad.nc")
    (tmp_path / "bad.nc").write_bytes(content[: len(content) // 2])
    with pytest.raises(ss.ModelError):
        ss.Reduction.load(tmp_path / "bad.nc")


def outside(dataset):
    dataset["rows"].values[0] = 10**6


def wild(dataset):
    dataset["mass_indices"].values[0] = 10**6


def torn(dataset):
    dataset["stiffness_indptr"].values[-1] = 10**6


def older(dataset):
    del dataset.attrs["accurate_to"]


CHANGES = {
    "nothing": (lambda dataset: dataset, None),
    "what older ones do not say": (older, None),
    "rows outside": (outside, "the boundary lies outside the full matrices"),
    "indices outside": (wild, "not a complete stickslip reduction"),
    "columns that do not end": (torn, "not a complete stickslip reduction"),
    "no basis": (lambda dataset: dataset.drop_vars("basis"), r"reduction \(\"No variable named"),
    "a mode less": (lambda dataset: dataset.isel(mode=slice(5)), "7 names for 8 columns"),
    "a row less": (lambda dataset: dataset.isel(row=slice(59)), "not a complete"),
    "another size": (lambda dataset: dataset.isel(dof=slice(7)), "names for 7 columns|of shape"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", CHANGES)
def test_a_file_without_its_seal_is_looked_at(name, tmp_path):
    """As one that another program has written anew."""
    change, message = CHANGES[name]
    path = tmp_path / "chain.nc"
    chain().save(path)
    options = {"engine": "h5netcdf", "decode_times": False, "mask_and_scale": False}
    bare = xr.load_dataset(path, **options).drop_dims("seal_byte").copy(deep=True)
    changed = change(bare)
    (bare if changed is None else changed).to_netcdf(path, engine="h5netcdf")
    if message is None:
        assert ss.Reduction.load(path).dofs == chain().dofs
    else:
        with pytest.raises(ss.ModelError, match=message):
            ss.Reduction.load(path)
