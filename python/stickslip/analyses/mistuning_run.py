"""The run of a mistuning study: what is computed, and what is there already."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip import _core
from stickslip.analyses.cluster import Batch, Client, compute_on, computed
from stickslip.analyses.pattern_store import Key, PatternStore, Row
from stickslip.analyses.peak_assumptions import mistuning_assumptions
from stickslip.analyses.run import Run
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.errors import ModelError
from stickslip.results.fields import Float
from stickslip.results.mistuning import MistuningArrays, MistuningStudy
from stickslip.results.status import Status
from stickslip.settings.peaks import MistuningSettings

EDGE = 1e-9
"""How far rounding may put a peak outside the range of frequencies, relative."""


class Series(NamedTuple):
    """The disks of one stiffness of the couplings."""

    disk: BladedDisk
    coupling: float
    """Stiffness of the couplings [N/m]; not-a-number: they have several, or there is none."""
    tuned: tuple[Row, ...]
    """Peaks of the tuned disk, one per degree of freedom."""


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
        """Take over what a store holds of this study; refuse a row that cannot be one of it."""
        places = {
            (float(deviation), one.coupling.hex()): (d, c)
            for d, deviation in enumerate(self.deviations)
            for c, one in enumerate(self.series)
        }
        found: dict[tuple[int, ...], dict[int, Row]] = {}
        effort: dict[tuple[int, ...], int] = {}
        for key, dof, row, points in store.rows():
            cause = self._fault(key, dof, row, points)
            if cause is not None:
                raise store.damaged(key.deviation, key.pattern, cause)
            at = places.get((key.deviation, key.coupling.hex()))
            if at is not None and key.pattern < len(self.patterns):
                found.setdefault((*at, key.pattern), {})[dof] = row
                effort[*at, key.pattern] = points
        for place, rows in found.items():
            # A pattern of which a row was deleted is computed again.
            if len(rows) == len(self.dofs):
                self._take(place, rows.items(), effort[place])

    def _fault(self, key: Key, dof: int, row: Row, points: int) -> str | None:
        """Say what no row of this study can hold; stores of the first version have no digests."""
        low, high = self.settings.span
        checks: dict[str, tuple[float, float, float]] = {
            "pattern": (key.pattern, 0, math.inf),
            "dof": (dof, 0, len(self.dofs) - 1),
            "omega": (row.omega, low * (1 - EDGE), high * (1 + EDGE)),
            "amplitude": (row.amplitude, sys.float_info.min, sys.float_info.max),
            "blade": (row.blade, 0, self.disk.sectors - 1),
            "status": (row.status, 0, len(Status) - 1),
            "harmonics": (row.harmonics, 0, self.settings.highest),
            "error_estimate": (row.error_estimate, 0.0, math.inf),
            "points": (points, 0, math.inf),
        }
        for name, (value, least, most) in checks.items():
            if value < least or value > most:
                return f"{name} is {value:.6g}, outside {least:.6g} to {most:.6g}"
        solved = Status.from_code(row.status).solved
        found = [math.isfinite(one) for one in (row.omega, row.amplitude)]
        if found != [solved] * 2 or (solved and row.harmonics == 0):
            return f"it is {Status.from_code(row.status)}, and its numbers are not"
        return None

    def _take(self, place: tuple[int, ...], rows: Iterable[tuple[int, Row]], points: int) -> None:
        for dof, row in rows:
            # A peak that was not found is at no blade.
            blade = row.blade if math.isfinite(row.amplitude) else -1
            for name, value in row._replace(blade=blade)._asdict().items():
                self.arrays[name][*place, dof] = value
        self.known[place] = True
        self.points += points
        self.done += 1

    def run(
        self,
        threads: int | None,
        part: tuple[int, int],
        run: Run,
        store: PatternStore | None,
        client: Client | None,
    ) -> bool:
        """Compute what is missing of a part; False if Ctrl-C has ended it."""
        missing = np.argwhere(~self.known)
        missing = missing[missing[:, 2] % part[1] == part[0]]
        if not missing.size:
            return True

        def deliver(index: int, found: Sequence[_core.Summit], points: int) -> None:
            d, c, p = (int(at) for at in missing[index])
            rows = [Row(*row) for row in found]
            if store is not None:
                key = Key(float(self.deviations[d]), self.series[c].coupling, p)
                try:
                    store.add(key, rows, points)
                except ModelError as error:
                    kept = f"{self.done} of {self.total} disks are stored"
                    raise ModelError(f"{error}; {kept}, run again to go on from there") from None
            self._take((d, c, p), enumerate(rows), points)
            run.reached(self.done / self.total)

        work = Batch(
            disks=tuple(one.disk for one in self.series),
            settings=self.settings,
            groups=[[self.disk.structure.index(dof)] for dof in self.dofs],
            orders=[max(row.harmonics for row in one.tuned) for one in self.series],
            which=missing[:, 1].tolist(),
            deviations=self.deviations[missing[:, 0], np.newaxis] * self.patterns[missing[:, 2]],
            numbers=list(range(len(missing))),
        )
        if client is not None:
            return compute_on(client, computed, work, run, deliver)
        return work.compute(threads or 0, deliver, lambda _: run.heed())

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
            diagnostics=mistuning_assumptions(self.disk, self.settings, arrays, self.dofs),
        )
