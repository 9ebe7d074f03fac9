"""When contact points begin to stick and to slip."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from stickslip.model import Model
from stickslip.results.arrays import Float, Int, constant

__all__ = ["KINDS", "Event", "Events"]

KINDS = ("sticks", "slips forward", "slips backward")
"""What happens, by the code that the core and files have; forward is du/dt > 0."""


class Event(NamedTuple):
    """One contact point changes between stick and slip."""

    time: float
    """When [s]."""
    contact: str
    """Name of the contact."""
    point: int
    """Point of that contact, counted from 0."""
    kind: str
    """From then on it "sticks", "slips forward" (du/dt > 0) or "slips backward"."""


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
    """Return the contact and the place in it of every contact point of a model."""
    pairs = [
        (name, point)
        for name, contact in zip(model.contact_names, model.contacts, strict=True)
        for point in range(contact.points)
    ]
    names = np.array([name for name, _ in pairs], dtype=np.str_)
    return names, np.array([point for _, point in pairs], dtype=np.int64)
