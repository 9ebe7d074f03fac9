"""The numbers of exact periodic orbits."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import NDArray

from stickslip.results.arrays import Arrays, Complex, Float, Int
from stickslip.results.status import Status

if TYPE_CHECKING:
    from stickslip import _core
    from stickslip.disk.wave_ring import Rotation

__all__ = ["OrbitArrays"]


@dataclass(frozen=True, eq=False)
class OrbitArrays(Arrays):
    """The numbers of exact orbits: those of a forced response, and what only orbits have.

    A state is (x, v, f) of all N degrees of freedom and n_p contact points, s = 2 N + n_p numbers.
    At points without an orbit everything but `omega`, `status`, `residual` and `iterations` is
    not-a-number, and there are no events.
    """

    range: Float
    """(n, n_o, 2) Lowest and highest displacement over the period [m]."""
    state: Float
    """(n, s) State at t = 0 [m, m/s, N]."""
    multipliers: Complex
    """(n, s) Floquet multipliers over the period: the neutral ones, then by falling modulus."""
    neutral: Int
    """(n,) How many multipliers are neutral, exactly 1."""
    work: Float
    """(n,) Work of the external forces per period [J]."""
    viscous: Float
    """(n,) Energy lost to the damping matrix per period [J]."""
    event_offset: Int
    """(n+1,) Events of point i are those from event_offset[i] to event_offset[i+1]."""
    event_time: Float
    """(E,) Time of each event, from 0 to the period [s]."""
    event_point: Int
    """(E,) Contact point of each event, counted over all contacts."""
    event_kind: NDArray[np.uint8]
    """(E,) What happens: 0 sticks, 1 slips forward, 2 slips backward."""

    @classmethod
    def of_orbits(cls, solution: _core.Orbits) -> Self:
        """Take over what the core returns, blanking the numbers that mean nothing.

        Parameters
        ----------
        solution : _core.Orbits
            What the core returns.

        Returns
        -------
        OrbitArrays
            Copies.
        """
        per_point = [entry.name for entry in fields(cls) if not entry.name.startswith("event")]
        values: dict[str, Any] = {name: getattr(solution, name) for name in per_point}
        status = values["status"]
        status[status == Status.STALLED.code] = Status.ORBIT_STALLED.code
        solved = status == Status.CONVERGED.code
        for name in (
            "displacement",
            "contact_displacement",
            "contact_force",
            "error_estimate",
            "slip_fraction",
            "dissipation",
            "range",
            "state",
            "multipliers",
            "work",
            "viscous",
        ):
            blank = complex(np.nan, np.nan) if values[name].dtype.kind == "c" else np.nan
            values[name][~solved] = blank
        values["neutral"][~solved] = 0
        return cls(**values, **_events(solution, solved))

    def of_sector(self, points: int, sectors: int) -> Self:
        """Return what belongs to sector 0 of some equal ones, with the state of all of them.

        Parameters
        ----------
        points : int
            Number of contact points of a sector.
        sectors : int
            How many sectors there are.

        Returns
        -------
        OrbitArrays
            Without the contact points of the other sectors; work and losses are those of one.
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

    def turned(self, rotation: Rotation, number: int, share: float) -> Self:
        """Return the orbits seen from another sector, with series that are turned already.

        Parameters
        ----------
        rotation : Rotation
            The symmetry of the wave.
        number : int
            The sector.
        share : float
            By which part of the period it is ahead.

        Returns
        -------
        OrbitArrays
            States and events of that sector.
        """
        places = np.arange(rotation.sectors) + number
        factors = rotation.wrap ** (places // rotation.sectors)
        per_point = self.contact_force.shape[2] * rotation.sectors
        moved = (self.state.shape[1] - per_point) // 2
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


def _events(solution: _core.Orbits, solved: NDArray[np.bool_]) -> dict[str, NDArray[Any]]:
    """Return the events of the points that are solved."""
    offsets, time, point, kind = solution.events
    counts = np.where(solved, np.diff(offsets), 0)
    chosen = np.repeat(solved, np.diff(offsets))
    return {
        "event_offset": np.concatenate(([0], np.cumsum(counts))).astype(np.int64),
        "event_time": time[chosen],
        "event_point": point[chosen],
        "event_kind": kind[chosen],
    }
