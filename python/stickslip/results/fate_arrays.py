"""What becomes of free motions: classes, the reasons for them, and the numbers."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum

from stickslip.results.arrays import SHARE, Code, Float, Int
from stickslip.results.fields import Columns, column

__all__ = ["FateArrays", "Motion", "Reason"]


class Motion(StrEnum):
    """What becomes of a free motion; compares equal to its text."""

    DECAYING = "decaying"
    SETTLED = "settled"
    APERIODIC = "aperiodic"
    UNBOUNDED = "unbounded"
    UNDECIDED = "undecided"


class Reason(StrEnum):
    """Why a motion was given its class; compares equal to its text."""

    HELD = "held"
    PASSIVE = "passive"
    CLOSED = "closed"
    WANDERS = "wanders"
    OUTGROWN = "outgrown"
    OVERFLOW = "overflow"
    SETTLING = "settling"
    GROWING = "growing"
    FALLING = "falling"
    MONOTONE = "monotone"
    CONTRADICTION = "contradiction"
    INTERRUPTED = "interrupted"

    @property
    def code(self) -> int:
        """Number by which arrays and files hold it."""
        return list(Reason).index(self)

    @property
    def motion(self) -> Motion:
        """The class."""
        return _MEANING[self][0]

    @property
    def advice(self) -> str:
        """Cause and next action, one sentence each."""
        return _MEANING[self][1]


_NOTHING = "Nothing needs to be done."
_MEANING: Mapping[Reason, tuple[Motion, str]] = {
    Reason.HELD: (
        Motion.DECAYING,
        f"No contact slips any more, and the stuck structure is damped. {_NOTHING}",
    ),
    Reason.PASSIVE: (
        Motion.DECAYING,
        "The damping takes energy out of every motion, so that it dies away, though not within the "
        "span. Raise periods to see it stick.",
    ),
    Reason.CLOSED: (
        Motion.SETTLED,
        f"The motion repeats itself, and the closing error falls. {_NOTHING}",
    ),
    Reason.WANDERS: (
        Motion.APERIODIC,
        "The motion did not repeat itself within the span, and its size no longer changed. Read "
        "its lines; raise periods to see whether it settles after all.",
    ),
    Reason.OUTGROWN: (
        Motion.UNBOUNDED,
        "Negative damping does more work than friction can take at this size, so that the motion "
        "grows for ever. Lower the ratio, or start with less.",
    ),
    Reason.OVERFLOW: (
        Motion.UNBOUNDED,
        "The motion grew out of the range of numbers. Lower the ratio, or start with less.",
    ),
    Reason.SETTLING: (
        Motion.UNDECIDED,
        "The motion was still settling at the end of the span. Raise periods, or go on with "
        "start=result.final.",
    ),
    Reason.GROWING: (
        Motion.UNDECIDED,
        "The motion was still growing at the end of the span. Raise periods, or go on with "
        "start=result.final.",
    ),
    Reason.FALLING: (
        Motion.UNDECIDED,
        "The motion was still falling at the end of the span. Raise periods, or go on with "
        "start=result.final.",
    ),
    Reason.MONOTONE: (
        Motion.UNDECIDED,
        "The motion did not swing often enough to be judged. Raise periods, or ground the "
        "structure.",
    ),
    Reason.CONTRADICTION: (
        Motion.UNDECIDED,
        "Contacts changed between stick and slip without end at one instant. Change the start "
        "slightly.",
    ),
    Reason.INTERRUPTED: (
        Motion.UNDECIDED,
        "The run was stopped before this was decided. Run it again.",
    ),
}


class FateArrays(Columns):
    """What becomes of free motions; a state is (x, v, f) of all dofs and contact points."""

    start: Float = column("start_number state_entry", "1", "state at the start (m, m/s, N)")
    reason: Code = column("start_number", "1", "why the motion has its class", codes=Reason)
    mode: Int = column(
        "start_number",
        "1",
        "stuck mode with the most kinetic energy at the end, counted from 0; -1 for none",
        least=-1,
        most="row",
    )
    share: Float = column("start_number", "1", "share of its kinetic energy", least=0.0, most=SHARE)
    omega: Float = column(
        "start_number", "rad/s", "angular frequency of a settled motion", least=0.0
    )
    amplitude: Float = column(
        "start_number dof", "m", "half peak-to-peak amplitude at the end", least=0.0
    )
    time: Float = column("start_number", "s", "when it was decided", least=0.0, file_name="decided")
    events: Int = column("start_number", "1", "events met until then", least=0)
    final: Float = column("start_number state_entry", "1", "state at the end (m, m/s, N)")
