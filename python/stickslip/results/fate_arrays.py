"""What becomes of free motions: classes, the reasons for them, and the numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stickslip.results.arrays import Float, Int, constant
from stickslip.results.variables import Variable

if TYPE_CHECKING:
    from stickslip import _core

__all__ = ["FATE_VARIABLES", "FateArrays", "Motion", "Reason", "require_codes"]


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


@dataclass(frozen=True, eq=False)
class FateArrays:
    """What becomes of n starts.

    n_o dofs are observed; a state (x, v, f) has s = 2 N + n_p numbers.
    """

    start: Float
    """(n, s) States at the start [m, m/s, N]."""
    reason: NDArray[np.uint8]
    """(n,) Codes of `Reason`."""
    mode: Int
    """(n,) Stuck mode with the most kinetic energy at the end, counted from 0; -1 for none."""
    share: Float
    """(n,) Share of the kinetic energy of that mode."""
    omega: Float
    """(n,) Angular frequency of settled motions, others not-a-number [rad/s]."""
    amplitude: Float
    """(n, n_o) Half the range of displacement at the end [m]; not-a-number if unbounded."""
    time: Float
    """(n,) When it was decided [s]."""
    events: Int
    """(n,) Events met until then."""
    final: Float
    """(n, s) States then."""

    def __post_init__(self) -> None:
        for entry in fields(self):
            array = np.ascontiguousarray(getattr(self, entry.name))
            object.__setattr__(self, entry.name, constant(array))

    def __reduce__(self) -> tuple[type[FateArrays], tuple[object, ...]]:
        # Unpickled arrays would be writeable; going through the constructor makes them constant.
        return FateArrays, tuple(getattr(self, entry.name) for entry in fields(self))

    @classmethod
    def of(cls, fates: _core.Fates, start: Float, columns: list[int]) -> FateArrays:
        """Take over what the core returns, of the observed dofs alone."""
        return cls(
            start=start,
            reason=fates.reason,
            mode=fates.mode,
            share=fates.share,
            omega=fates.omega,
            amplitude=fates.amplitude[:, columns],
            time=fates.time,
            events=fates.events,
            final=fates.state,
        )


FATE_VARIABLES: Mapping[str, Variable] = {
    "start": Variable(
        "start", ("start_number", "state_entry"), "1", "state at the start (m, m/s, N)"
    ),
    "reason": Variable("reason", ("start_number",), "1", "why the motion has its class"),
    "mode": Variable("mode", ("start_number",), "1", "stuck mode with the most kinetic energy"),
    "share": Variable("share", ("start_number",), "1", "share of its kinetic energy"),
    "omega": Variable("omega", ("start_number",), "rad/s", "angular frequency of a settled motion"),
    "amplitude": Variable(
        "amplitude", ("start_number", "dof"), "m", "half peak-to-peak amplitude at the end"
    ),
    "decided": Variable("time", ("start_number",), "s", "when it was decided"),
    "events": Variable("events", ("start_number",), "1", "events met until then"),
    "final": Variable(
        "final", ("start_number", "state_entry"), "1", "state at the end (m, m/s, N)"
    ),
}


def require_codes(arrays: FateArrays) -> FateArrays:
    """Refuse reasons that a file of this version cannot hold."""
    if arrays.reason.max(initial=0) >= len(Reason):
        raise ValueError(f"reason {arrays.reason.max()} is unknown")
    return arrays
