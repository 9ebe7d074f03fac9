"""Columns of results: arrays, documentation, datasets, files and checks from one definition."""

from __future__ import annotations

import pickle
from importlib import import_module
from typing import ClassVar

import numpy as np
import pytest
import xarray as xr

import stickslip as ss
from stickslip.reference import snecma_beam
from stickslip.results import store
from stickslip.results.arrays import Arrays
from stickslip.results.fields import Code, Columns, Float, Int, Shown, column
from stickslip.results.result import ColumnResult

OWNERS = [getattr(import_module(module), name) for module, name in store.KINDS.values()]
KINDS = [owner.columns for owner in OWNERS if issubclass(owner, ColumnResult)]


class Marks(Columns):
    """The numbers of marks."""

    labels: ClassVar = {"side": ("left", "right")}

    size: Float = column("mark side", "m", "size of the {thing}", least=0.0)
    place: Int = column("mark", "1", "dof of the mark", least=0, most="dof", file_name="dof_place")
    kind: Code = column("mark", "1", "kind of the mark", codes=("open", "half closed"))
    later: Float = column(
        "mark", "N", "what older files lack", absent=lambda given: np.ones(given.sizes["mark"])
    )


def marks(**changed):
    values = {
        "size": [[1.0, np.nan], [0.0, 2.0]],
        "place": np.array([0, 2]),
        "kind": np.array([0, 1], np.uint8),
        "later": [3.0, 4.0],
    }
    return Marks(**values | changed)


def dataset(**changed):
    return xr.Dataset(marks(**changed).variables({"thing": "mark"}), coords={"dof": list("abc")})


def test_a_column_is_a_variable_and_comes_back_bit_by_bit():
    own, stored = marks(), dataset()
    assert stored["size"].attrs == {"units": "m", "long_name": "size of the mark"}
    assert stored["kind"].attrs["flag_meanings"] == "open half_closed"
    assert "dof_place" in stored
    assert "place" not in stored
    for again in (Marks.read(stored), pickle.loads(pickle.dumps(own))):
        for name in Marks.table():
            assert getattr(again, name).tobytes() == getattr(own, name).tobytes()
            assert not getattr(again, name).flags.writeable
    copied = own.variables({"thing": "mark"})["size"][1]
    copied[...] = 7.0
    assert own.size[0, 0] == 1.0


def test_a_column_is_taken_over_by_its_name():
    class Solution:
        columns: ClassVar = {
            "size": np.zeros((1, 2)),
            "place": np.array([1]),
            "unknown": np.ones(1),
        }

    made = Marks.of(Solution(), kind=np.zeros(1, np.uint8), later=np.ones(1))
    assert made.place.tolist() == [1]
    with pytest.raises(KeyError, match="later"):
        Marks.of(Solution(), kind=np.zeros(1, np.uint8))


@pytest.mark.parametrize(
    ("stored", "message"),
    [
        (lambda: dataset(size=[[-1.0, 1.0], [0.0, 0.0]]), "size = -1, outside 0 to inf"),
        (lambda: dataset(place=np.array([0, 3])), "dof_place = 3, outside 0 to 2"),
        (lambda: dataset(kind=np.array([0, 2], np.uint8)), "kind 2 is unknown"),
        (lambda: dataset(place=np.array([0.0, 1.0])), "dof_place holds float64 instead of int64"),
        (
            lambda: dataset().transpose("side", "mark", "dof"),
            r"size has dimensions \('side', 'mark'\)",
        ),
        (lambda: dataset().drop_vars("kind"), "kind"),
    ],
)
def test_what_a_column_cannot_hold_is_refused(stored, message):
    with pytest.raises((KeyError, ValueError), match=message):
        Marks.read(stored())


def test_a_column_says_what_an_older_file_has():
    assert Marks.read(dataset().drop_vars("later")).later.tolist() == [1.0, 1.0]


@pytest.mark.parametrize("columns", KINDS)
def test_documentation_lists_every_column(columns):
    for name, entry in columns.table().items():
        assert f"\n{name} : ndarray of " in columns.__doc__
        assert entry.unit
        assert entry.meaning


@pytest.mark.parametrize("owner", [one for one in OWNERS if issubclass(one, ColumnResult)])
def test_what_is_shown_is_a_column_and_says_which(owner):
    shown = [one for base in owner.__mro__ for one in vars(base).values() if isinstance(one, Shown)]
    for one in shown:
        assert one.name in owner.columns.table()
        assert one.__doc__.endswith(".")


def test_what_is_shown_is_the_array_itself():
    curve = ss.forced_response(snecma_beam(), [150.0, 190.0], 3)
    assert curve.omega is curve.arrays.omega
    assert type(curve).omega.__doc__ == "Angular frequency of the excitation [rad/s]."


@pytest.mark.slow
def test_the_error_of_samples_is_part_of_the_estimate(tmp_path):
    grid = np.linspace(180.0, 200.0, 5)
    marched = ss.forced_response(snecma_beam(), grid, 5, evaluation="marched", samples=64)
    plain = ss.forced_response(snecma_beam(), grid, 5)
    assert (plain.arrays.sampling_error == 0.0).all()
    assert (marched.arrays.sampling_error > 0.0).all()
    assert (marched.arrays.sampling_error <= marched.arrays.error_estimate).all()
    marched.save(tmp_path / "it.nc")
    again = ss.load(tmp_path / "it.nc").arrays.sampling_error
    assert again.tobytes() == marched.arrays.sampling_error.tobytes()


def test_files_without_the_error_of_samples_do_not_know_it():
    stored = ss.forced_response(snecma_beam(), [150.0, 190.0], 3).to_dataset()
    again = Arrays.read(stored.drop_vars("sampling_error"))
    assert np.isnan(again.sampling_error).all()
    assert again.sampling_error.shape == again.error_estimate.shape
