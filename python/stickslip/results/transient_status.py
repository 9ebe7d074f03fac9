"""How a transient ended, and what to do about it."""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple

__all__ = ["Settled", "TransientStatus"]


class TransientStatus(StrEnum):
    """How a run ended; a status compares equal to its text."""

    SETTLED = "settled"
    NOT_SETTLED = "not settled"
    COMPLETED = "completed"
    UNBOUNDED = "unbounded"
    INTERRUPTED = "interrupted"
    HALTED = "halted"

    @property
    def advice(self) -> str:
        """Cause and next action, one sentence each."""
        return _ADVICE[self]


_ADVICE = {
    TransientStatus.SETTLED: (
        "The change over a period has come below the tolerance. Nothing needs to be done."
    ),
    TransientStatus.NOT_SETTLED: (
        "The limit of periods was reached before the change over a period met the tolerance. "
        "Continue with start=result.final, or raise periods or tolerance."
    ),
    TransientStatus.COMPLETED: (
        "All periods were computed; without a tolerance nothing was asked of the last ones. "
        "Read change to see whether the motion has settled."
    ),
    TransientStatus.UNBOUNDED: (
        "The motion grew without bound and was cut there: damping is negative, or steps are too "
        "few for rk4. Add damping, raise steps, or use the exact scheme."
    ),
    TransientStatus.INTERRUPTED: (
        "The run was stopped before its end. Continue with start=result.final."
    ),
    TransientStatus.HALTED: (
        "Contacts changed between stick and slip without end at one instant. "
        "Change the start slightly, or take rk4."
    ),
}


class Settled(NamedTuple):
    """One row of `Transient.summary`."""

    dof: str
    """Degree of freedom."""
    amplitude: float
    """Half peak-to-peak in the last period [m]."""
    change: float
    """Its change from the period before, relative; not-a-number after one period."""
