"""The numbers of a motion from a start state."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar

from stickslip.results.arrays import Code, Float, Int
from stickslip.results.events import KINDS
from stickslip.results.fields import Columns, column

__all__ = ["TransientArrays"]


class TransientArrays(Columns):
    """The numbers of a transient; a state is (x, v, f) of all dofs and contact points."""

    labels: ClassVar[Mapping[str, Sequence[str]]] = {"side": ("lowest", "highest")}

    time: Float = column("time", "s", "time since the start", least=0.0)
    displacement: Float = column("time dof", "m", "displacement")
    velocity: Float = column("time dof", "m/s", "velocity")
    contact_force: Float = column(
        "time point", "N", "contact force against the relative displacement"
    )
    contact_displacement: Float = column("time point", "m", "relative displacement at the contacts")
    poincare: Float = column(
        "section state_entry",
        "1",
        "state at the start and after each period (x in m, v in m/s, f in N)",
    )
    range: Float = column("period dof side", "m", "lowest and highest displacement in each period")
    change: Float = column(
        "period", "1", "change of the state over the period, relative to the motion"
    )
    event_time: Float = column("event", "s", "time of the event since the start", least=0.0)
    event_point: Int = column(
        "event", "1", "contact point, over all contacts", least=0, most="point"
    )
    event_kind: Code = column("event", "1", "what happens", codes=KINDS)
