"""The numbers of limit cycles along a branch."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import NDArray

from stickslip.results.arrays import Bool, Complex, Float, Int, constant

if TYPE_CHECKING:
    from stickslip import _core

__all__ = ["CHANGE_KINDS", "CycleArrays"]

CHANGE_KINDS = ("fold", "complex pair", "symmetry", "grazing")
"""What can happen where stability changes."""


@dataclass(frozen=True, eq=False)
class CycleArrays:
    """The numbers of n limit cycles, of N degrees of freedom and n_p contact points.

    Coefficients are those of x(t) = Re sum_k X_k exp(i k omega t).
    """

    value: Float
    """(n,) Value of what is followed."""
    ratio: Float
    """(n,) Factor r on the negative damping."""
    omega: Float
    """(n,) Angular frequency [rad/s]."""
    slipping: Bool
    """(n,) Whether the cycle lies beyond the limit, on the slipping side."""
    status: NDArray[np.uint8]
    """(n,) Codes of `Status`."""
    harmonics: Int
    """(n,) Highest harmonic kept, or reported of exact orbits."""
    displacement: Complex
    """(n, H+1, N) Displacement [m]."""
    contact_displacement: Complex
    """(n, H+1, n_p) Relative displacement at the contact points [m]."""
    contact_force: Complex
    """(n, H+1, n_p) Contact force [N]."""
    error_estimate: Float
    """(n, N) What the discarded harmonics could still change [m]; 0 of exact orbits."""
    slip_fraction: Float
    """(n, n_p) Share of the period that the point slips."""
    dissipation: Float
    """(n, n_p) Work lost to friction per cycle [J]."""
    range: Float
    """(n, N, 2) Lowest and highest displacement [m] of exact orbits, not-a-number otherwise."""
    state: Float
    """(n, 2 N + n_p) State at t = 0 of exact orbits, not-a-number otherwise."""
    multipliers: Complex
    """(n, 2 N + n_p - 1) Floquet multipliers over the period, without that of the phase."""
    neutral: Int
    """(n,) How many of them are neutral, exactly 1."""
    closed: Bool
    """(n,) Whether they are those of an exact orbit."""
    turn: Float
    """(2,) Value and frequency where the branch turns for good; not-a-number if nowhere."""
    folds: Float
    """(f, 2) Values and frequencies where it turns."""
    change: Float
    """(c, 2) Values and frequencies where its stability changes."""
    change_after: Int
    """(c,) Position of the cycle before each change."""
    change_kind: Int
    """(c,) Position in `CHANGE_KINDS`."""
    change_unstable: Int
    """(c, 2) Multipliers outside the unit circle before and after."""

    def __post_init__(self) -> None:
        for entry in fields(self):
            array = np.ascontiguousarray(getattr(self, entry.name))
            array.flags.writeable = False
            object.__setattr__(self, entry.name, array)

    def __reduce__(self) -> tuple[type[Self], tuple[object, ...]]:
        # Unpickled arrays would be writeable; going through the constructor makes them constant.
        return type(self), tuple(getattr(self, entry.name) for entry in fields(self))

    @classmethod
    def of(cls, solution: _core.LimitCycles) -> Self:
        """Take over what the core returns.

        Parameters
        ----------
        solution : _core.LimitCycles
            What the core returns.

        Returns
        -------
        CycleArrays
            Copies.
        """
        changes = solution.changes
        kinds = [CHANGE_KINDS.index(kind) for *_, kind, _, _ in changes]
        extra = {
            "turn": np.array(solution.limit or (np.nan, np.nan)),
            "change": np.array([one[:2] for one in changes]).reshape(-1, 2),
            "change_after": np.array([one[2] for one in changes], dtype=np.int64),
            "change_kind": np.array(kinds, dtype=np.int64),
            "change_unstable": np.array([one[4:] for one in changes], dtype=np.int64).reshape(
                -1, 2
            ),
        }
        names = [entry.name for entry in fields(cls) if entry.name not in extra]
        return cls(**{name: np.array(getattr(solution, name)) for name in names}, **extra)

    @property
    def limit(self) -> tuple[float, float] | None:
        """Value and frequency where the branch turns for good, if it does."""
        value, omega = self.turn
        return None if np.isnan(value) else (float(value), float(omega))

    @cached_property
    def known(self) -> Bool:
        """(n,) Whether the multipliers of a cycle are known."""
        return constant(np.isfinite(self.multipliers).all(axis=1) & (self.multipliers.shape[1] > 0))
