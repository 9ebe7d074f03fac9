"""Whether a motion is stable, unstable, or not decided: three states, never two."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import constant
from stickslip.results.arrays import ExactColumns
from stickslip.results.fields import Bool, Complex, Int

States = NDArray[np.str_]
"""A name of `STATES` per motion."""

# Orbits close to this share of their size, and multipliers are known no better.
_ROUNDING = 1e-10


class _State(NamedTuple):
    truth: bool | None
    """What `stable` says."""
    flag: int
    """What files say."""
    answer: str
    """What tables say."""


STATES: dict[str, _State] = {
    "stable": _State(True, 1, "yes"),
    "unstable": _State(False, 0, "no"),
    "not decided": _State(None, -1, "not decided"),
}
"""The states, in the order in which they are told."""


def stability_of(multipliers: Complex, neutral: Int, known: Bool) -> States:
    """Return the state of every motion by its Floquet multipliers, the neutral ones first.

    Not decided is what has no multipliers, and what has its largest one on the unit circle to
    rounding, as motions that nothing damps.
    """
    size = np.abs(multipliers)
    moving = np.arange(size.shape[1]) >= neutral[:, None]
    largest = np.where(moving & known[:, None], size, 0.0).max(axis=1, initial=0.0)
    decided = known & ~(np.abs(largest - 1.0) <= _ROUNDING)
    return constant(np.where(decided, np.where(largest < 1.0, "stable", "unstable"), "not decided"))


def truths(states: States) -> NDArray[np.object_]:
    """Return states as True, False or None."""
    values = np.empty(states.shape, dtype=object)
    values[:] = [STATES[name].truth for name in states.tolist()]
    return constant(values)


class FloquetStability:
    """The part of a result that concerns the stability of its motions."""

    arrays: ExactColumns

    @property
    def multipliers(self) -> Complex:
        """Floquet multipliers over the full period, one row per motion.

        First the `neutral` ones, then by falling modulus: what a small disturbance is multiplied by
        in a period. A contact that slips forgets its force, which gives a multiplier of zero. Of
        limit cycles the trivial 1 of the phase is left out. Not-a-number where they are not known.
        """
        return self.arrays.multipliers

    @property
    def neutral(self) -> Int:
        """How many multipliers are neutral, exactly 1, per motion. They decide nothing.

        A contact that never slips keeps any small change of its mean force for ever, and the motion
        around it is the same. A structure that nothing holds stays where it is pushed to, or drifts
        on where nothing slows it: its vibration is the same too.
        """
        return self.arrays.neutral

    @cached_property
    def stability(self) -> States:
        """State of each motion, "stable", "unstable" or "not decided".

        Stable are motions whose multipliers but the neutral ones lie inside the unit circle. Not
        decided are those without multipliers, as points that are not solved, travelling waves and
        cycles with ``stability=False``, and those whose largest multiplier is 1 to rounding, as of
        structures without damping whose contacts stick.
        """
        return stability_of(self.multipliers, self.neutral, self.arrays.known)

    @cached_property
    def stable(self) -> NDArray[np.object_]:
        """`stability` as True, False or None (not decided) per motion.

        Of Python's objects: write ``result.stable == True`` or ``result.stability == "stable"`` to
        choose motions.
        """
        return truths(self.stability)

    def _stable(self, dimension: str) -> dict[Hashable, Any]:
        """Return the states as a variable of a dataset, with the flags of the CF conventions."""
        flags = np.array([STATES[name].flag for name in self.stability.tolist()], dtype=np.int8)
        about = {
            "units": "1",
            "long_name": "whether the motion is stable",
            "flag_values": np.array([state.flag for state in STATES.values()], dtype=np.int8),
            "flag_meanings": " ".join(name.replace(" ", "_") for name in STATES),
        }
        return {"stable": (dimension, flags, about)}


def stability_counts(states: States) -> str:
    """Return how many motions are in each state, for example "3 stable, 2 not decided"."""
    counts = Counter(states.tolist())
    return ", ".join(f"{counts[name]} {name}" for name in STATES if counts[name]) or "none"
