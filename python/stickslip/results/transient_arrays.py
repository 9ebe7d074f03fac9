"""The numbers of a motion from a start state."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import NDArray

from stickslip.results.arrays import Float, Int

if TYPE_CHECKING:
    from stickslip import _core

__all__ = ["TransientArrays"]


@dataclass(frozen=True, eq=False)
class TransientArrays:
    """The numbers of a transient: n instants kept, P periods computed.

    n_o dofs are observed; there are n_p contact points; a state (x, v, f) of all N degrees of
    freedom has s = 2 N + n_p numbers.
    """

    time: Float
    """(n,) Time since the start [s]."""
    displacement: Float
    """(n, n_o) Displacement of the observed dofs [m]."""
    velocity: Float
    """(n, n_o) Velocity of the observed dofs [m/s]."""
    contact_force: Float
    """(n, n_p) Contact forces [N]."""
    contact_displacement: Float
    """(n, n_p) Relative displacement at the contact points [m]."""
    poincare: Float
    """(P+1, s) State at the start and after each period [m, m/s, N]."""
    range: Float
    """(P, n_o, 2) Lowest and highest displacement in each period [m]."""
    change: Float
    """(P,) Change of the state over each period, relative to the motion in it."""
    event_time: Float
    """(E,) Time of each event since the start [s]."""
    event_point: Int
    """(E,) Contact point of each event, counted over all contacts."""
    event_kind: NDArray[np.uint8]
    """(E,) What happens: 0 sticks, 1 slips forward, 2 slips backward."""

    def __post_init__(self) -> None:
        for entry in fields(self):
            array = np.ascontiguousarray(getattr(self, entry.name))
            array.flags.writeable = False
            object.__setattr__(self, entry.name, array)

    def __reduce__(self) -> tuple[type[TransientArrays], tuple[object, ...]]:
        # Unpickled arrays would be writeable; going through the constructor makes them constant.
        return TransientArrays, tuple(getattr(self, entry.name) for entry in fields(self))

    @classmethod
    def of(cls, history: _core.History) -> Self:
        """Take over what the core returns.

        Parameters
        ----------
        history : _core.History
            What the core returns.

        Returns
        -------
        TransientArrays
            The same arrays, read-only.
        """
        time, point, kind = history.events
        # A period that was cut has no change, and its range means nothing.
        complete = history.change.size
        return cls(
            time=history.time,
            displacement=history.displacement,
            velocity=history.velocity,
            contact_force=history.force,
            contact_displacement=history.contact_displacement,
            poincare=history.poincare,
            range=history.range[:complete],
            change=history.change,
            event_time=time,
            event_point=point,
            event_kind=kind,
        )
