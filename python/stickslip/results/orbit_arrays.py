"""The numbers of exact periodic orbits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from stickslip.results.arrays import Arrays, Code, ExactColumns, Float, Int
from stickslip.results.events import KINDS
from stickslip.results.fields import Computed, column
from stickslip.results.status import Status

if TYPE_CHECKING:
    import xarray as xr

    from stickslip.disk.wave_ring import Rotation

__all__ = ["OrbitArrays"]


class OrbitArrays(Arrays, ExactColumns):
    """The numbers of exact orbits: those of a forced response, and what only orbits have.

    At points without an orbit
    everything but `omega`, `status`, `residual` and `iterations` is not-a-number, and there are no
    events.
    """

    labels: ClassVar[Mapping[str, Sequence[str]]] = {"side": ("lowest", "highest")}

    residual: Float = column(
        "*", "1", "gap of the orbit after a period, relative to the motion", least=0.0
    )
    error_estimate: Float = column(
        "* dof", "m", "what the gap of the orbit could still change", least=0.0
    )
    work: Float = column("*", "J", "work of the external forces per period")
    viscous: Float = column("*", "J", "energy lost to damping per period")
    event_offset: Int = column("boundary", "1", "first event of each point", least=0)
    event_time: Float = column("event", "s", "time of the event in the period", least=0.0)
    event_point: Int = column(
        "event", "1", "contact point, over all contacts", least=0, most="point"
    )
    event_kind: Code = column("event", "1", "what happens", codes=KINDS)

    @classmethod
    def of(cls, solution: Computed, **more: NDArray[Any]) -> Self:
        """Take over what the core returns, blanking the numbers that mean nothing."""
        values = {**solution.columns, **more}
        status, counts = values["status"], values.pop("event_count")
        status[status == Status.STALLED.code] = Status.ORBIT_STALLED.code
        solved = status == Status.CONVERGED.code
        chosen = np.repeat(solved, counts)
        for name in ("event_time", "event_point", "event_kind"):
            values[name] = values[name][chosen]
        values["event_offset"] = np.append(0, np.cumsum(np.where(solved, counts, 0)))
        # Orbits are not marched.
        values["sampling_error"] = np.zeros_like(values["error_estimate"])
        told = ("omega", "residual")
        for name, entry in cls.table().items():
            kind = values[name].dtype.kind
            if entry.dims[0] == cls.along and kind in "fc" and name not in told:
                values[name][~solved] = complex(np.nan, np.nan) if kind == "c" else np.nan
        values["neutral"][~solved] = 0
        return cls(**{name: values[name] for name in cls.table()})

    @classmethod
    def read(cls, dataset: xr.Dataset, **more: Any) -> Self:
        """Return the columns that a dataset holds; see `Columns.read`."""
        arrays = super().read(dataset, **more)
        ends, events = arrays.event_offset, arrays.event_time.size
        divided = ends.size == arrays.omega.size + 1 and ends[0] == 0 and ends[-1] == events
        if not divided or (np.diff(ends) < 0).any():
            raise ValueError(f"event_offset does not divide the {events} events")
        return arrays

    def of_sector(self, points: int, sectors: int) -> Self:
        """Return what belongs to sector 0 of some equal ones, with the state of all of them.

        `points` counts the contact points of a sector; work and losses are those of one.
        """
        own = self.event_point < points
        return replace(
            self,
            contact_displacement=self.contact_displacement[..., :points],
            contact_force=self.contact_force[..., :points],
            slip_fraction=self.slip_fraction[:, :points],
            dissipation=self.dissipation[:, :points],
            work=self.work / sectors,
            viscous=self.viscous / sectors,
            event_offset=np.concatenate(([0], np.cumsum(own)))[self.event_offset],
            event_time=self.event_time[own],
            event_point=self.event_point[own],
            event_kind=self.event_kind[own],
        )

    def turned(self, rotation: Rotation, number: int, share: float, dofs: int) -> Self:
        """Return the orbits seen from another sector, with series that are turned already.

        The sector is ahead by a share of the period, and has so many degrees of freedom.
        """
        places = np.arange(rotation.sectors) + number
        factors = rotation.wrap ** (places // rotation.sectors)
        moved = rotation.sectors * dofs
        parts = np.split(self.state, [moved, 2 * moved], axis=1)
        blocks = [part.reshape(len(part), rotation.sectors, -1) for part in parts]
        ahead = [block[:, places % rotation.sectors] * factors[:, None] for block in blocks]
        period = 2.0 * np.pi / self.omega
        point = np.repeat(np.arange(self.omega.size), np.diff(self.event_offset))
        time = (self.event_time - share * period[point]) % period[point]
        order = np.lexsort((time, point))
        return replace(
            self,
            state=np.concatenate([block.reshape(len(block), -1) for block in ahead], axis=1),
            event_time=time[order],
            event_point=self.event_point[order],
            event_kind=self.event_kind[order],
        )
