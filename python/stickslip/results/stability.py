"""Whether a motion is stable, unstable, or not decided: three states, never two."""

from __future__ import annotations

from collections import Counter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.results.arrays import Bool, Complex, Int, constant

__all__ = [
    "STATES",
    "States",
    "flag_variable",
    "stability_counts",
    "stability_of",
    "truth_of",
    "worded",
]

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
    """Return the state of every motion by its Floquet multipliers.

    Parameters
    ----------
    multipliers : ndarray of complex128, shape (n, m)
        The neutral ones first.
    neutral : ndarray of int, shape (n,)
        How many are neutral.
    known : ndarray of bool, shape (n,)
        Whether they are known.

    Returns
    -------
    ndarray of str, shape (n,)
        Names of `STATES`. Not decided is what has no multipliers, and what has its largest one on
        the unit circle to rounding, as motions that nothing damps.
    """
    size = np.abs(multipliers)
    moving = np.arange(size.shape[1]) >= neutral[:, None]
    largest = np.where(moving & known[:, None], size, 0.0).max(axis=1, initial=0.0)
    decided = known & ~(np.abs(largest - 1.0) <= _ROUNDING)
    return constant(np.where(decided, np.where(largest < 1.0, "stable", "unstable"), "not decided"))


def truth_of(states: States) -> NDArray[np.object_]:
    """Return True, False or None per motion."""
    values = np.empty(states.shape, dtype=object)
    values[:] = [STATES[name].truth for name in states.tolist()]
    return constant(values)


def stability_counts(states: States) -> str:
    """Return how many motions are in each state, for example "3 stable, 2 not decided"."""
    counts = Counter(states.tolist())
    return ", ".join(f"{counts[name]} {name}" for name in STATES if counts[name]) or "none"


def worded(state: str) -> str:
    """Return the answer to "stable?" of one state: "yes", "no" or "not decided"."""
    return STATES[state].answer


def flag_variable(dimension: str, states: States) -> tuple[str, NDArray[np.int8], dict[str, Any]]:
    """Return the states as a variable of a dataset, with the flags of the CF conventions."""
    return (
        dimension,
        np.array([STATES[name].flag for name in states.tolist()], dtype=np.int8),
        {
            "units": "1",
            "long_name": "whether the motion is stable",
            "flag_values": np.array([state.flag for state in STATES.values()], dtype=np.int8),
            "flag_meanings": " ".join(name.replace(" ", "_") for name in STATES),
        },
    )
