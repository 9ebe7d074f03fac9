"""Whether matrices are positive definite, by their bands where they hold few numbers."""

from __future__ import annotations

import numpy as np

from stickslip.checks import Matrix

__all__ = ["ROUNDING", "scaled_pivots", "unit_scale"]

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
