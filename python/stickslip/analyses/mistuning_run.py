"""The run of a mistuning study: what is computed, and what is there already."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.analyses.mistuning_assumptions import mistuning_assumptions
from stickslip.analyses.mistuning_disks import Series
from stickslip.analyses.mistuning_settings import MistuningSettings
from stickslip.analyses.pattern_store import Key, PatternStore, Row
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.errors import ModelError
from stickslip.interruption import Interruption
from stickslip.results.arrays import Float
from stickslip.results.mistuning import MistuningStudy
from stickslip.results.mistuning_arrays import MistuningArrays
from stickslip.results.status import Status

__all__ = ["Work"]

OFTEN = 0.1
"""Seconds between two calls of a progress callback."""


class Work:
    """What is computed, and what is there already."""

    def __init__(
        self,
        disk: BladedDisk,
        settings: MistuningSettings,
        dofs: tuple[str, ...],
        deviations: Float,
        series: Sequence[Series],
        patterns: Float,
    ) -> None:
        self.disk, self.settings, self.dofs = disk, settings, dofs
        self.deviations, self.series, self.patterns = deviations, series, patterns
        shape = deviations.size, len(series), len(patterns)
        self.total, self.done, self.points = math.prod(shape), 0, 0
        self.known = np.zeros(shape, dtype=bool)
        missing = Row(np.nan, np.nan, -1, Status.NOT_COMPUTED.code, 0, np.nan, at_edge=False)
        kinds = {"blade": np.int64, "status": np.uint8, "harmonics": np.int64, "at_edge": np.bool_}
        self.arrays: dict[str, NDArray[Any]] = {
            name: np.full((*shape, len(dofs)), value, dtype=kinds.get(name, np.float64))
            for name, value in missing._asdict().items()
        }

    def recall(self, store: PatternStore) -> None:
        """Take over what a store holds of this study."""
        places = {
            (float(deviation), one.coupling.hex()): (d, c)
            for d, deviation in enumerate(self.deviations)
            for c, one in enumerate(self.series)
        }
        for key, dof, row, points in store.rows():
            at = places.get((key.deviation, key.coupling.hex()))
            if at is None or key.pattern >= len(self.patterns):
                continue
            place = (*at, key.pattern)
            if not self.known[place]:
                self.known[place] = True
                self.points += points
                self.done += 1
            self._set((*place, dof), row)

    def _set(self, place: tuple[int, ...], row: Row) -> None:
        # A peak that was not found is at no blade.
        blade = row.blade if math.isfinite(row.amplitude) else -1
        for name, value in row._replace(blade=blade)._asdict().items():
            self.arrays[name][place] = value

    def run(self, threads: int, watch: Interruption, store: PatternStore | None) -> bool:
        """Compute what is missing; False if Ctrl-C has ended it."""
        from stickslip import _core
        from stickslip.disk.family import family

        missing = np.argwhere(~self.known)
        if not missing.size:
            return True
        report = _reporter(watch)

        def deliver(index: int, found: list[_core.Summit], points: int) -> None:
            d, c, p = (int(at) for at in missing[index])
            rows = [Row(*row) for row in found]
            if store is not None:
                key = Key(float(self.deviations[d]), self.series[c].coupling, p)
                store.add(key, rows, points)
            for dof, row in enumerate(rows):
                self._set((d, c, p, dof), row)
            self.known[d, c, p] = True
            self.points += points
            self.done += 1
            report(self.done / self.total)

        try:
            return _core.mistuning_study(
                [family(one.disk) for one in self.series],
                missing[:, 1].tolist(),
                self.deviations[missing[:, 0], np.newaxis] * self.patterns[missing[:, 2]],
                self.settings.quest(self.disk, [[dof] for dof in self.dofs]),
                [max(row.harmonics for row in one.tuned) for one in self.series],
                threads,
                deliver,
                lambda _: watch.heed(),
            )
        except ModelError:
            raise
        except ValueError as error:
            raise ModelError(str(error)) from error

    def result(self, seconds: float, *, interrupted: bool) -> MistuningStudy:
        """Return what is there."""
        tuned = {
            f"tuned_{name}": np.array(
                [[getattr(row, name) for row in s.tuned] for s in self.series]
            )
            for name in ("omega", "amplitude", "harmonics", "error_estimate", "at_edge")
        }
        arrays = MistuningArrays(
            deviation=self.deviations,
            coupling=np.array([one.coupling for one in self.series]),
            patterns=self.patterns,
            **self.arrays,
            **tuned,
        )
        return MistuningStudy(
            model=self.disk,
            dofs=self.dofs,
            settings=self.settings,
            arrays=arrays,
            interrupted=interrupted,
            timings={"total": seconds},
            counters={"disks": self.done, "points": self.points},
            assumptions=mistuning_assumptions(self.settings, arrays, self.dofs),
        )


def _reporter(watch: Interruption) -> Callable[[float], None]:
    """Return what tells a callback how far a run is, not too often."""
    last = time.monotonic()

    def report(share: float) -> None:
        nonlocal last
        if time.monotonic() - last >= OFTEN:
            last = time.monotonic()
            watch(share)

    return report
