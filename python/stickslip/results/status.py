"""How the computation of one point ended, and what to do about it."""

from __future__ import annotations

from enum import StrEnum

from stickslip.errors import ModelError

__all__ = ["Status"]


class Status(StrEnum):
    """How the computation of one point ended.

    A status compares equal to its text (``Status.STALLED == "stalled"``).
    """

    CONVERGED = "converged"
    STALLED = "stalled"
    SINGULAR = "singular"
    NOT_COMPUTED = "not computed"
    HARMONICS_LIMIT = "harmonics limit"
    ORBIT_STALLED = "orbit stalled"
    SAMPLES_LIMIT = "samples limit"
    STEPS_LIMIT = "steps limit"
    EFFORT_LIMIT = "effort limit"

    @classmethod
    def from_code(cls, code: int) -> Status:
        """Return the status that the compiled core, or a file, writes as a number.

        Parameters
        ----------
        code : int
            0 converged, 1 stalled, 2 singular, 3 not computed, 4 harmonics limit,
            5 orbit stalled, 6 samples limit, 7 steps limit, 8 effort limit.

        Raises
        ------
        ModelError
            If there is no such status.
        """
        if not 0 <= code < len(_MEMBERS):
            raise ModelError(f"status {code} is unknown; known: 0 to {len(_MEMBERS) - 1}")
        return _MEMBERS[code]

    @property
    def code(self) -> int:
        """The number of this status, as written to files."""
        return tuple(type(self)).index(self)

    @property
    def solved(self) -> bool:
        """Whether the balance equations hold at this point.

        True for `CONVERGED`, and for `HARMONICS_LIMIT`, `SAMPLES_LIMIT` and `EFFORT_LIMIT`: there
        the equations are solved for the harmonics that were kept and the samples that were taken,
        only more of them would be needed for the tolerance.
        """
        return self in _SOLVED

    @property
    def advice(self) -> str:
        """Cause and next action, one sentence each."""
        return _ADVICE[self]


_MEMBERS = tuple(Status)
_SOLVED = (
    Status.CONVERGED,
    Status.HARMONICS_LIMIT,
    Status.SAMPLES_LIMIT,
    Status.EFFORT_LIMIT,
)

_ADVICE = {
    Status.CONVERGED: (
        "The balance equations are solved and every tolerance is met. Nothing needs to be done."
    ),
    Status.STALLED: (
        "The iteration stopped before the balance equations were met. "
        "Raise max_iterations, keep more harmonics, or approach this omega in smaller steps."
    ),
    Status.SINGULAR: (
        "The equations have no unique solution here: an unforced harmonic hits an undamped natural "
        "frequency of the stuck structure, friction does not bound an undamped resonance, or "
        "damping is negative and the curve turns. "
        "Add damping or shift this omega slightly."
    ),
    Status.NOT_COMPUTED: (
        "The run was interrupted before this point was reached. "
        "Run the analysis again for the missing omega."
    ),
    Status.HARMONICS_LIMIT: (
        "max_harmonics was reached before the discarded harmonics met the tolerance. "
        "Read error_estimate, and raise max_harmonics or tolerance, or use exact_response."
    ),
    Status.ORBIT_STALLED: (
        "Shooting stopped before the orbit closed: at an undamped resonance friction may not bound "
        "the motion. Raise max_iterations, or see with transient whether the motion settles."
    ),
    Status.SAMPLES_LIMIT: (
        "max_samples was reached before the sampling error of the marched friction laws met its "
        "share of the tolerance. "
        "Read error_estimate, and raise max_samples or tolerance, or evaluate the laws exactly."
    ),
    Status.STEPS_LIMIT: (
        "The orbit was not found within the steps that it is granted: the motion does not settle, "
        "or some of it is much faster than omega. See with transient whether it settles, condense "
        "light dofs statically, or balance harmonics."
    ),
    Status.EFFORT_LIMIT: (
        "Given up early: more harmonics, and an exact orbit, would have cost far more than those "
        "that are kept, as where omega is low or contacts are nearly rigid. Read error_estimate; "
        "raise tolerance, name in observe only the dofs that matter, give a number of harmonics, "
        "or condense light or nearly rigid dofs statically."
    ),
}
