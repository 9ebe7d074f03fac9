"""Which points of a contact stick and slip, and when."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stickslip.results.arrays import Float
from stickslip.results.events import Events

__all__ = ["ContactStates", "states_of"]

_DIRECTIONS = (0, 1, -1)
"""Direction of slip by the code of an event; see `events.KINDS`."""


@dataclass(frozen=True, eq=False, repr=False)
class ContactStates:
    """What the points of a contact do over a period, from change to change.

    Attributes
    ----------
    start : ndarray of float64, shape (m,)
        Where each phase begins, as a share of the period; the first at 0, the last ends at 1.
    direction : ndarray of int8, shape (m, points)
        1 where a point slips with positive force, -1 with negative force, 0 where it sticks. A
        point without friction counts as sticking: it carries no force.
    """

    start: Float
    direction: NDArray[np.int8]

    def __repr__(self) -> str:
        sets = ", ".join(_written(points) for points in self.sets)
        return f"ContactStates({self.start.size} phases; slip sets {sets})"

    @property
    def length(self) -> Float:
        """Share of the period that each phase takes, shape (m,)."""
        return np.diff(self.start, append=1.0)

    @property
    def sets(self) -> tuple[tuple[int, ...], ...]:
        """The different sets of points that slip at once, in order of first appearance.

        The empty set stands for phases in which every point sticks.
        """
        sets = (self.slipping(phase) for phase in range(self.start.size))
        return tuple(dict.fromkeys(sets))

    def slipping(self, phase: int) -> tuple[int, ...]:
        """Return the points that slip in a phase, counted from 0."""
        return tuple(int(point) for point in np.flatnonzero(self.direction[phase]))

    def share(self, points: tuple[int, ...]) -> float:
        """Return the share of the period in which exactly these points slip."""
        wanted = tuple(sorted(points))
        chosen = [self.slipping(phase) == wanted for phase in range(self.start.size)]
        return float(self.length[chosen].sum())


def states_of(events: Events, columns: slice, period: float) -> ContactStates:
    """Return the states of the contact points `columns` along an orbit, by its events.

    Parameters
    ----------
    events : Events
        Those of one period.
    columns : slice
        The points of a contact among all points.
    period : float
        [s].

    Returns
    -------
    ContactStates
        The phases; without an event every point sticks.
    """
    places = range(columns.start, columns.stop)
    own = [row for row, place in enumerate(events.number) if place in places]
    changes = [(events.time[row] / period, events.number[row], events.code[row]) for row in own]
    state = np.zeros(len(places), dtype=np.int8)
    for _, place, code in changes:
        # The period begins as it ends.
        state[place - columns.start] = _DIRECTIONS[code]
    starts, states = [0.0], [state.copy()]
    for time, place, code in changes:
        state[place - columns.start] = _DIRECTIONS[code]
        if time > starts[-1]:
            starts.append(float(time))
            states.append(state.copy())
        else:
            states[-1] = state.copy()
    return ContactStates(np.array(starts), np.array(states))


def _written(points: tuple[int, ...]) -> str:
    return "{" + ", ".join(map(str, points)) + "}"
