"""How the computation of a point or a run ended, and what to do about it."""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import constant
from stickslip.errors import ModelError


class Ending(StrEnum):
    """How something ended; compares equal to its text (``Status.STALLED == "stalled"``)."""

    advice: str
    """Cause and next action, one sentence each."""

    def __new__(cls, text: str, advice: str = "") -> Self:
        """Return a member, defined by its text and its advice."""
        member = str.__new__(cls, text)
        member._value_ = text
        member.advice = advice
        return member

    @classmethod
    def from_code(cls, code: int) -> Self:
        """Return the member that the compiled core, or a file, writes as a number, from 0."""
        members = tuple(cls)
        if not 0 <= code < len(members):
            raise ModelError(f"status {code} is unknown; known: 0 to {len(members) - 1}")
        return members[code]

    @classmethod
    def array(cls, codes: NDArray[np.integer]) -> NDArray[np.object_]:
        """Return the members that the core writes as these numbers, shape of `codes`."""
        return constant(np.array(tuple(cls), dtype=object)[codes])

    @property
    def code(self) -> int:
        """The number of this member, as written to files."""
        return tuple(type(self)).index(self)


class Status(Ending):
    """How the computation of one point ended; compares equal to its text."""

    CONVERGED = (
        "converged",
        "The balance equations are solved and every tolerance is met. Nothing needs to be done.",
    )
    STALLED = (
        "stalled",
        "The iteration stopped before the balance equations were met. "
        "Raise max_iterations, keep more harmonics, or approach this omega in smaller steps.",
    )
    SINGULAR = (
        "singular",
        "The equations have no unique solution here: an unforced harmonic hits an undamped natural "
        "frequency of the stuck structure, friction does not bound an undamped resonance, or "
        "damping is negative and the curve turns. Add damping or shift this omega slightly.",
    )
    NOT_COMPUTED = (
        "not computed",
        "The run was interrupted before this point was reached. "
        "Run the analysis again for what is missing.",
    )
    HARMONICS_LIMIT = (
        "harmonics limit",
        "max_harmonics was reached before the discarded harmonics met the tolerance. "
        "Read error_estimate, and raise max_harmonics or tolerance, or use exact_response.",
    )
    ORBIT_STALLED = (
        "orbit stalled",
        "Shooting stopped before the orbit closed: at an undamped resonance friction may not bound "
        "the motion. Raise max_iterations, or see with transient whether the motion settles.",
    )
    SAMPLES_LIMIT = (
        "samples limit",
        "max_samples was reached before the sampling error of the marched friction laws met its "
        "share of the tolerance. "
        "Read error_estimate, and raise max_samples or tolerance, or evaluate the laws exactly.",
    )
    STEPS_LIMIT = (
        "steps limit",
        "The orbit was not found within the steps that it is granted: the motion does not settle, "
        "or some of it is much faster than omega. See with transient whether it settles, condense "
        "light dofs statically, or balance harmonics.",
    )
    EFFORT_LIMIT = (
        "effort limit",
        "Given up early: more harmonics, and an exact orbit, would have cost far more than those "
        "that are kept, as where omega is low or contacts are nearly rigid, or more harmonics led "
        "to no motion like this one, as where a curve has many folds. Read error_estimate; "
        "raise tolerance, name in observe only the dofs that matter, give a number of harmonics, "
        "or condense light or nearly rigid dofs statically.",
    )
    FREE = (
        "free",
        "Not solved: contacts alone hold a body, and slip or open until nothing holds its mean "
        "position; its static load, or the asymmetry of its loads or contacts, may make it walk, "
        "and no motion repeats. Lower the static load, ground the body, if softly, raise preload "
        "or friction, begin at an omega where contacts stick and take small steps, or see with "
        "transient where it goes.",
    )
    HISTORY = (
        "history",
        "Not solved: contacts slip until they stick for good, and which of the tractions that "
        "Coulomb allows they keep then depends on how the motion was reached; none that the "
        "balance assumes agrees with it. See one such motion with exact_response, or follow the "
        "history with transient from the state at rest.",
    )
    OTHER_MOTION = (
        "other motion",
        "Not compared: the exact orbit that was found is another one of several motions at this "
        "omega. Certify points where there is one motion, or follow this one with transient.",
    )
    WORK_LIMIT = (
        "work limit",
        "Not solved: the work that is granted to a point with automatic harmonics was spent before "
        "any were solved, as where contacts are nearly rigid, or open and close at low omega. "
        "Give a number of harmonics, which grants whatever it takes, begin at a neighbouring "
        "omega, or condense light or nearly rigid dofs statically.",
    )

    @property
    def solved(self) -> bool:
        """Whether the balance equations hold at this point.

        True for `CONVERGED`, and for `HARMONICS_LIMIT`, `SAMPLES_LIMIT` and `EFFORT_LIMIT`: there
        the equations are solved for the harmonics that were kept and the samples that were taken,
        only more of them would be needed for the tolerance.
        """
        return self is Status.CONVERGED or self in (
            Status.HARMONICS_LIMIT,
            Status.SAMPLES_LIMIT,
            Status.EFFORT_LIMIT,
        )


class TransientStatus(Ending):
    """How a transient ended; compares equal to its text."""

    SETTLED = (
        "settled",
        "The change over a period has come below the tolerance. Nothing needs to be done.",
    )
    NOT_SETTLED = (
        "not settled",
        "The limit of periods was reached before the change over a period met the tolerance. "
        "Continue with start=result.final, or raise periods or tolerance.",
    )
    COMPLETED = (
        "completed",
        "All periods were computed; without a tolerance nothing was asked of the last ones. "
        "Read change to see whether the motion has settled.",
    )
    UNBOUNDED = (
        "unbounded",
        "The motion grew without bound and was cut there: damping is negative, or steps are too "
        "few for rk4. Add damping, raise steps, or use the exact scheme.",
    )
    INTERRUPTED = (
        "interrupted",
        "The run was stopped before its end. Continue with start=result.final.",
    )
    HALTED = (
        "halted",
        "The steps became too short to come to the end of a period, as with slip forces of next to "
        "nothing beside the motion, and the run ended. Leave these contacts out, or take rk4.",
    )


class Settled(NamedTuple):
    """One row of `Transient.summary`."""

    dof: str
    """Degree of freedom."""
    amplitude: float
    """Half peak-to-peak in the last period [m]."""
    change: float
    """Its change from the period before, relative; not-a-number after one period."""


class RestStatus(Ending):
    """How raising static loads has ended; compares equal to its text."""

    CONVERGED = ("converged", "The structure carries its static loads. Nothing needs to be done.")
    FREE = (
        "free",
        "Contacts have let go of a body that nothing else holds, at the share of the loads that "
        "the result has. Lower the loads, raise preload or friction, or ground the body.",
    )
    STALLED = (
        "stalled",
        "No equilibrium follows from the one before: contacts jam or let go at once, at the share "
        "of the loads that the result has. Lower the friction or the loads.",
    )
    NOT_COMPUTED = (
        "not computed",
        "The run was interrupted before the loads were raised. Run the analysis again.",
    )
