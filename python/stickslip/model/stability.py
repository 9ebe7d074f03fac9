"""Whether a stiffness holds every motion, apart from rounding."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import Matrix
from stickslip.model.pivots import ROUNDING, scaled_pivots, unit_scale

__all__ = ["unstable_row"]

# Share of the lowest elastic omega^2 that rounding leaves of a rigid motion; reductions left 4e-8.
_DRIFT = 1e-7


def unstable_row(stiffness: Matrix, mass: Matrix) -> int | None:
    """Return the row that moves most where the stiffness is negative; None if it never is."""
    if scaled_pivots(stiffness, ROUNDING) is not None:
        return None
    from scipy.linalg import eigh

    scale = unit_scale(stiffness)
    values, vectors = eigh(stiffness * scale * scale[:, None], subset_by_index=[0, 0])
    if values[0] > -10.0 * ROUNDING or _drifts(stiffness, mass):
        return None
    return int(np.abs(scale * vectors[:, 0]).argmax())


def _drifts(stiffness: Matrix, mass: Matrix) -> bool:
    """Whether rounding explains how fast a motion grows.

    Where a reduction keeps just the dofs that hold a free structure, rounding is all that is
    left of their stiffness: beside itself it looks large, beside the elastic modes it does not.
    """
    from scipy.linalg import eigh

    inert: NDArray[np.bool_] = np.asarray(mass.any(axis=1))
    seen = _condensed(stiffness, inert)
    if seen is None:
        return False
    last = min(len(seen) - 1, 12)  # two bodies have twelve rigid motions
    inertia = mass[np.ix_(inert, inert)]
    squares = eigh(seen, inertia, eigvals_only=True, subset_by_index=[0, last])
    # Rounding puts rigid motions on either side of zero, some much farther away than others.
    largest = np.maximum.accumulate(np.abs(squares[:-1]))
    return bool((largest < _DRIFT * squares[1:]).any())


def _condensed(stiffness: Matrix, inert: NDArray[np.bool_]) -> Matrix | None:
    """Return the stiffness that dofs with mass see; None if the others grow without them.

    Both then have the negative eigenvalues of the whole, by Sylvester's law of inertia.
    """
    own, rest = stiffness[np.ix_(inert, inert)], stiffness[np.ix_(~inert, ~inert)]
    if not len(rest) or not len(own):
        return own if len(own) else None
    scale = unit_scale(rest)
    values, vectors = np.linalg.eigh(rest * scale * scale[:, None])
    across = vectors.T @ (scale[:, None] * stiffness[np.ix_(~inert, inert)])
    held = values > 10.0 * ROUNDING
    # What nothing holds must move alone: coupled to the rest it is negative somewhere.
    pull = np.abs(across[~held] * unit_scale(own))
    if values[0] < -10.0 * ROUNDING or pull.max(initial=0.0) > ROUNDING:
        return None
    across = across[held]
    seen: Matrix = own - across.T @ (across / values[held, None])
    return seen
