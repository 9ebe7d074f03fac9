"""Whether a matrix is positive definite, and a stiffness holds every motion, but for rounding."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import Matrix

ROUNDING = 1e-9
"""Rounding may put the zero eigenvalue of an undamped or rigid motion on either side, by this."""
_LARGE = 64
"""Size over its bandwidth from which on a matrix is factored by its bands."""


def scaled_pivots(matrix: Matrix, shift: float = 0.0) -> Matrix | None:
    """Return the pivots of the symmetric part of a matrix, scaled to a diagonal of 1, shape (N,).

    None if it is not positive definite. `shift` is added to the scaled diagonal.
    """
    scale = unit_scale(matrix)
    bands = _bands(matrix)
    try:
        if bands is None:
            scaled = 0.5 * matrix
            scaled = scaled + scaled.T
            scaled *= scale
            scaled *= scale[:, None]
            np.fill_diagonal(scaled, np.diag(scaled) + shift)
            return np.asarray(np.diag(np.linalg.cholesky(scaled)) ** 2)
        from scipy.linalg import cholesky_banded

        for offset, band in enumerate(bands):
            within = len(scale) - offset
            band[:within] *= scale[offset:] * scale[:within]
        bands[0] += shift
        return np.asarray(cholesky_banded(bands, lower=True, check_finite=False)[0] ** 2)
    except np.linalg.LinAlgError:
        return None


def unit_scale(matrix: Matrix) -> Matrix:
    """Return what scales rows and columns of a matrix to a diagonal of 1 or -1, shape (N,)."""
    diagonal = np.abs(np.diag(matrix))
    return np.asarray(1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0)))


def _bands(matrix: Matrix) -> Matrix | None:
    """Return the diagonal and the bands below it, one per row, if few others hold numbers."""
    size = len(matrix)
    if size < _LARGE:
        return None
    from scipy.linalg import bandwidth

    width = max(bandwidth(matrix))
    if width * _LARGE > size:
        return None
    bands = np.zeros((width + 1, size))
    for offset, band in enumerate(bands):
        both = np.diagonal(matrix, -offset) + np.diagonal(matrix, offset)
        band[: size - offset] = 0.5 * both
    return bands


# Share of the lowest elastic omega^2 that rounding leaves of a rigid motion; reductions left 4e-8.
_DRIFT = 1e-7


def unstable_row(stiffness: Matrix, mass: Matrix) -> int | None:
    """Return the row that moves most in the motion that grows fastest; None if none grows."""
    if scaled_pivots(stiffness, ROUNDING) is not None:
        return None
    from scipy.linalg import eigh

    scale = unit_scale(stiffness)
    values, vectors = eigh(stiffness * scale * scale[:, None], subset_by_index=[0, 0])
    if values[0] > -10.0 * ROUNDING:
        return None
    inert: NDArray[np.bool_] = np.asarray(mass.any(axis=1))
    seen, following = _condensed(stiffness, inert)
    if seen is None:
        return int(np.abs(scale * vectors[:, 0]).argmax())
    last = min(len(seen) - 1, 12)  # two bodies have twelve rigid motions
    inertia = mass[np.ix_(inert, inert)]
    squares, motions = eigh(seen, inertia, subset_by_index=[0, last])
    if _rounding(squares):
        return None
    fastest = np.empty(len(mass))
    fastest[inert], fastest[~inert] = motions[:, 0], following @ motions[:, 0]
    return int(np.abs(fastest).argmax())


def _rounding(squares: NDArray[np.float64]) -> bool:
    """Whether rounding explains how fast motions grow, by their omega^2, ascending.

    Where a reduction keeps just the dofs that hold a free structure, rounding is all that is
    left of their stiffness: beside itself it looks large, beside the elastic modes it does not.
    """
    # Rounding puts rigid motions on either side of zero, some much farther away than others.
    largest = np.maximum.accumulate(np.abs(squares[:-1]))
    return bool((largest < _DRIFT * squares[1:]).any())


def _condensed(stiffness: Matrix, inert: NDArray[np.bool_]) -> tuple[Matrix | None, Matrix]:
    """Return the stiffness that dofs with mass see, and how the others follow them.

    Both then have the negative eigenvalues of the whole, by Sylvester's law of inertia. There is
    no such stiffness if the others grow without them.
    """
    own, rest = stiffness[np.ix_(inert, inert)], stiffness[np.ix_(~inert, ~inert)]
    nothing = np.zeros((len(rest), len(own)))
    if not len(rest) or not len(own):
        return own if len(own) else None, nothing
    scale = unit_scale(rest)
    values, vectors = np.linalg.eigh(rest * scale * scale[:, None])
    across = vectors.T @ (scale[:, None] * stiffness[np.ix_(~inert, inert)])
    held = values > 10.0 * ROUNDING
    # What nothing holds must move alone: coupled to the rest it is negative somewhere.
    pull = np.abs(across[~held] * unit_scale(own))
    if values[0] < -10.0 * ROUNDING or pull.max(initial=0.0) > ROUNDING:
        return None, nothing
    across, moved = across[held], across[held] / values[held, None]
    return own - across.T @ moved, -(scale[:, None] * vectors[:, held]) @ moved
