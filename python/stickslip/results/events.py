"""When contact points stick and slip: the events, and the states between them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import constant
from stickslip.model import Model
from stickslip.model.contact import OPEN, Contact
from stickslip.results.fields import Float, Int

KINDS = ("sticks", "slips forward", "slips backward", "opens", "slides")
"""What happens, by the code that the core and files have; forward is du/dt > 0, and a node that
slides slips in a plane."""
_DIRECTIONS = (0, 1, -1, OPEN, 1)
"""Direction of slip, or `OPEN`, by the code of an event; see `KINDS`."""


class Event(NamedTuple):
    """One contact point changes between stick and slip."""

    time: float
    """When [s]."""
    contact: str
    """Name of the contact."""
    point: int
    """Point of that contact, counted from 0."""
    kind: str
    """From then on it "sticks", "slips forward" (du/dt > 0), "slips backward", "opens", or, in a
    plane, "slides"."""


@dataclass(frozen=True, eq=False, repr=False)
class Events(Sequence[Event]):
    """Events in the order of time: a sequence of `Event`, and its columns as arrays.

    Parameters
    ----------
    model : Model
        Whose contacts they are.
    time : ndarray of float64, shape (E,)
        When [s].
    number : ndarray of int64, shape (E,)
        Contact point, counted over all contacts.
    code : ndarray of uint8, shape (E,)
        Positions in `KINDS`.
    """

    model: Model
    time: Float
    number: Int
    code: NDArray[np.uint8]

    @classmethod
    def of(cls, model: Model, time: Float, number: Int, code: NDArray[np.uint8]) -> Events:
        """Return the events of nodes by those of their displacements, which change together."""
        if not any(contact.components for contact in model.contacts):
            return cls(model, time, number, code)
        starts = np.cumsum([0] + [contact.displacements for contact in model.contacts])
        first = [
            start + place // width * width
            for start, contact in zip(starts, model.contacts, strict=False)
            for width in (contact.displacements // contact.points,)
            for place in range(contact.displacements)
        ]
        node = np.array(first, dtype=np.int64)[number]
        # The direction of sliding knows more than the normal one: that it slips when it closes.
        slides = {(t, n) for t, n, own in zip(time, node, number == node, strict=True) if own}
        marks = zip(time, node, number == node, strict=True)
        kept = np.array([own or (t, n) not in slides for t, n, own in marks], dtype=np.bool_)
        return cls(model, time[kept], node[kept], code[kept])

    def __repr__(self) -> str:
        return f"Events({len(self)} between stick and slip)"

    def __len__(self) -> int:
        return self.time.size

    def __iter__(self) -> Iterator[Event]:
        rows = zip(self.time, self.contact, self.point, self.kind, strict=True)
        return (
            Event(float(time), str(contact), int(point), str(kind))
            for time, contact, point, kind in rows
        )

    @overload
    def __getitem__(self, place: int) -> Event: ...
    @overload
    def __getitem__(self, place: slice) -> Events: ...
    def __getitem__(self, place: int | slice) -> Event | Events:
        if isinstance(place, slice):
            return Events(self.model, self.time[place], self.number[place], self.code[place])
        chosen = range(len(self))[place]
        (event,) = self[chosen : chosen + 1]
        return event

    @property
    def contact(self) -> NDArray[np.str_]:
        """Name of the contact of each event, shape (E,)."""
        return constant(_owners(self.model)[0][self.number])

    @property
    def point(self) -> Int:
        """Point in its contact of each event, shape (E,)."""
        return constant(_owners(self.model)[1][self.number])

    @property
    def kind(self) -> NDArray[np.str_]:
        """What happens at each event, shape (E,)."""
        return constant(np.array(KINDS, dtype=np.str_)[self.code])

    def count(self, kind: object) -> int:
        """Return how many events are equal to an `Event`, or of a kind of `KINDS`."""
        if isinstance(kind, str):
            return int((self.kind == kind).sum())
        return super().count(kind)


def _owners(model: Model) -> tuple[NDArray[np.str_], Int]:
    """Return the contact and the point in it of every relative displacement of a model."""
    pairs = [
        (name, place * contact.points // contact.displacements)
        for name, contact in zip(model.contact_names, model.contacts, strict=True)
        for place in range(contact.displacements)
    ]
    names = np.array([name for name, _ in pairs], dtype=np.str_)
    return names, np.array([point for _, point in pairs], dtype=np.int64)


@dataclass(frozen=True, eq=False, repr=False)
class ContactStates:
    """What the points of a contact do over a period, from change to change.

    Attributes
    ----------
    start : ndarray of float64, shape (m,)
        Where each phase begins, as a share of the period; the first at 0, the last ends at 1.
    direction : ndarray of int8, shape (m, points)
        1 where a point slips with positive force, -1 with negative force, 0 where it sticks, 2
        where it is open. A point that slips in two directions has 1, whatever its way. A point
        without friction counts as sticking: it carries no force.
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
        slips = np.abs(self.direction[phase]) == 1
        return tuple(int(point) for point in np.flatnonzero(slips))

    def share(self, points: tuple[int, ...]) -> float:
        """Return the share of the period in which exactly these points slip."""
        wanted = tuple(sorted(points))
        chosen = [self.slipping(phase) == wanted for phase in range(self.start.size)]
        return float(self.length[chosen].sum())


def states_at(states: NDArray[np.int8]) -> ContactStates:
    """Return the phases of states at equidistant instants, shape (instants, points)."""
    changed = (states != np.roll(states, 1, axis=0)).any(axis=1)
    changed[0] = True
    start = np.flatnonzero(changed)
    return ContactStates(constant(start / len(states)), constant(states[start]))


def states_of(events: Events, columns: slice, period: float, contact: Contact) -> ContactStates:
    """Return the states of a contact, whose displacements are `columns`, by the events of an orbit.

    Without an event every point sticks.
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
    nodes = np.array(states).reshape(len(states), contact.points, -1)
    # The normal direction knows whether a node is open, the first tangential one whether it slips.
    found = np.where((nodes == OPEN).any(axis=2), np.int8(OPEN), nodes[:, :, 0])
    return ContactStates(np.array(starts), found)


def _written(points: tuple[int, ...]) -> str:
    return "{" + ", ".join(map(str, points)) + "}"
