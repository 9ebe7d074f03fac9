"""Studies beyond one process: a Dask cluster that loses a worker, and parts that are merged."""

from __future__ import annotations

import os
import signal

import numpy as np
import pytest

import stickslip as ss
from stickslip.analyses import cluster, mistuning_run
from stickslip.disk.mistuned import tuned_disk

RING = ss.reference.beam_ring(sectors=12, coupling=7e3, engine_order=3)
KEYS = {"omega": (150.0, 260.0), "patterns": 12, "seed": 1, "harmonics": 1}


@pytest.fixture(scope="module")
def alone():
    return ss.mistuning_study(RING, 0.05, **KEYS)


def same(one, other) -> bool:
    return all(
        np.array_equal(getattr(one.arrays, name), getattr(other.arrays, name), equal_nan=True)
        for name in one.arrays.table()
    )


@pytest.mark.slow
def test_a_cluster_that_loses_a_worker_computes_the_same_bits(alone, tmp_path):
    distributed = pytest.importorskip("distributed")
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50
    )
    with cluster, distributed.Client(cluster) as client:
        victim = next(iter(client.run(os.getpid).values()))
        killed = []

        def kill(share: float) -> None:
            if share > 0.0 and not killed:
                killed.append(victim)
                os.kill(victim, signal.SIGKILL)

        store = tmp_path / "ring.db"
        spread = ss.mistuning_study(RING, 0.05, store=store, client=client, progress=kill, **KEYS)
        again = ss.mistuning_study(RING, 0.05, store=store, **KEYS)
    assert killed
    assert same(spread, alone)
    assert same(again, alone)


def test_portions_merged_are_the_whole(alone, tmp_path):
    for number in range(3):
        part = ss.mistuning_study(
            RING, 0.05, store=tmp_path / f"{number}.db", portion=(number, 3), **KEYS
        )
        assert np.isfinite(part.arrays.amplitude).all(axis=-1).sum() == 4
    counts = ss.merge_stores(tmp_path / "all.db", [tmp_path / f"{n}.db" for n in range(3)])
    assert set(counts.values()) == {4 * len(alone.dofs)}
    whole = ss.mistuning_study(RING, 0.05, store=tmp_path / "all.db", **KEYS)
    assert same(whole, alone)
    assert whole.counters["points"] == alone.counters["points"]


def test_stores_of_other_studies_are_not_merged(tmp_path):
    ss.mistuning_study(RING, 0.05, store=tmp_path / "a.db", **KEYS | {"patterns": 1})
    ss.mistuning_study(RING, 0.05, store=tmp_path / "b.db", **KEYS | {"patterns": 1, "seed": 2})
    with pytest.raises(ss.ModelError, match="seed is 1 there and 2 here"):
        ss.merge_stores(tmp_path / "a.db", [tmp_path / "b.db"])
    with pytest.raises(ss.ModelError, match="no such store"):
        ss.merge_stores(tmp_path / "a.db", [tmp_path / "c.db"])
    (tmp_path / "d.db").write_text("no data base", encoding="utf-8")
    with pytest.raises(ss.ModelError, match="no store"):
        ss.merge_stores(tmp_path / "a.db", [tmp_path / "d.db"])


@pytest.mark.parametrize("portion", [(2, 2), (0, 0), 3, (0.5, 2)])
def test_a_portion_that_is_none_is_refused(portion):
    with pytest.raises(ss.ModelError, match="portion"):
        ss.mistuning_study(RING, 0.05, portion=portion, **KEYS)


class Breaking(ss.ContactLaw):
    """A spring whose code breaks once it is told to."""

    odd = monotone = True
    broken = False

    def stiffness(self):
        return [[10.0]]

    def step(self, before, after, state):
        if Breaking.broken:
            raise RuntimeError("broken")
        force = state + 10.0 * (after - before)
        one = np.ones((1, 1))
        return force, force, ss.Tangents(one, -10.0 * one, 10.0 * one, one, 0.0 * one)


@pytest.mark.slow
@pytest.mark.parametrize("spread", [False, True])
def test_laws_of_disks_of_every_coupling_are_heeded(spread, monkeypatch):
    def breaking(disk):
        monkeypatch.setattr(Breaking, "broken", True)
        return tuned_disk(disk)

    def compute_here(_client, compute, work, *_):
        compute(work.part(slice(1, 2)))
        return True

    monkeypatch.setattr(cluster, "tuned_disk", breaking)
    monkeypatch.setattr(mistuning_run, "compute_on", compute_here)
    blade = ss.Structure(np.eye(1), [[4e4]], [[4.0]], ["x"])
    disk = ss.BladedDisk(
        blade,
        4,
        [ss.Coupling("x", stiffness=1e3)],
        contacts=[Breaking(["x"])],
        forces=[ss.Force("x", 1.0)],
        engine_order=1,
    )
    keys = KEYS | {"patterns": 1, "coupling_stiffness": [1e3, 2e3]}
    with pytest.raises(ss.ModelError, match="step raised RuntimeError: broken"):
        ss.mistuning_study(disk, 0.05, client="here" if spread else None, **keys)
