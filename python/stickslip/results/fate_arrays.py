"""What becomes of free motions: classes, the reasons for them, and the numbers."""

from __future__ import annotations

from enum import StrEnum
from typing import Self

from stickslip.results.arrays import SHARE
from stickslip.results.fields import Code, Columns, Float, Int, column
from stickslip.results.status import Ending


class Motion(StrEnum):
    """What becomes of a free motion; compares equal to its text."""

    DECAYING = "decaying"
    SETTLED = "settled"
    APERIODIC = "aperiodic"
    UNBOUNDED = "unbounded"
    UNDECIDED = "undecided"


class Reason(Ending):
    """Why a motion was given its class; compares equal to its text."""

    motion: Motion
    """The class."""

    def __new__(cls, text: str, motion: Motion, advice: str) -> Self:
        """Return a member, defined by its text, the class and its advice."""
        member = str.__new__(cls, text)
        member._value_ = text
        member.motion, member.advice = motion, advice
        return member

    HELD = (
        "held",
        Motion.DECAYING,
        "No contact slips any more, and the stuck structure is damped. Nothing needs to be done.",
    )
    PASSIVE = (
        "passive",
        Motion.DECAYING,
        "The damping takes energy out of every motion, so that it dies away, though not within the "
        "span. Raise periods to see it stick.",
    )
    CLOSED = (
        "closed",
        Motion.SETTLED,
        "The motion repeats itself, and the closing error falls. Nothing needs to be done.",
    )
    WANDERS = (
        "wanders",
        Motion.APERIODIC,
        "The motion did not repeat itself within the span, and its size no longer changed. Read "
        "its lines; raise periods to see whether it settles after all.",
    )
    OUTGROWN = (
        "outgrown",
        Motion.UNBOUNDED,
        "Negative damping does more work than friction can take at this size, so that the motion "
        "grows for ever. Lower the ratio, or start with less.",
    )
    OVERFLOW = (
        "overflow",
        Motion.UNBOUNDED,
        "The motion grew out of the range of numbers. Lower the ratio, or start with less.",
    )
    SETTLING = (
        "settling",
        Motion.UNDECIDED,
        "The motion was still settling at the end of the span. Raise periods, or go on with "
        "start=result.final.",
    )
    GROWING = (
        "growing",
        Motion.UNDECIDED,
        "The motion was still growing at the end of the span. Raise periods, or go on with "
        "start=result.final.",
    )
    FALLING = (
        "falling",
        Motion.UNDECIDED,
        "The motion was still falling at the end of the span. Raise periods, or go on with "
        "start=result.final.",
    )
    MONOTONE = (
        "monotone",
        Motion.UNDECIDED,
        "The motion did not swing often enough to be judged. Raise periods, or ground the "
        "structure.",
    )
    CONTRADICTION = (
        "contradiction",
        Motion.UNDECIDED,
        "Contacts changed between stick and slip without end at one instant. Change the start "
        "slightly.",
    )
    INTERRUPTED = (
        "interrupted",
        Motion.UNDECIDED,
        "The run was stopped before this was decided. Run it again.",
    )
    FADED = (
        "faded",
        Motion.DECAYING,
        "Next to nothing is left of the motion about an equilibrium away from the origin. Nothing "
        "needs to be done.",
    )
    CRAWLING = (
        "crawling",
        Motion.UNDECIDED,
        "Contacts whose slip force is next to nothing beside the motion left no steps that come to "
        "the end. Leave these contacts out, or start with less.",
    )


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
