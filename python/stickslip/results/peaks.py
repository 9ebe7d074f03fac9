"""The highest point of a response curve, between the points that were computed."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from stickslip.errors import ModelError
from stickslip.results.arrays import Float, Int, Measure

if TYPE_CHECKING:
    from stickslip.results import ForcedResponse

__all__ = ["Peak", "Summary", "highest"]

RIVAL = 0.9
"""Local maxima from this share of the largest may be the true peak once they are refined."""


class Peak(NamedTuple):
    """The highest point of a response curve."""

    omega: float
    """Angular frequency [rad/s]."""
    amplitude: float
    """Amplitude [m]."""
    at_edge: bool
    """Whether it lies at an end of the computed frequencies: the true peak may be outside."""


class Summary(NamedTuple):
    """One row of `ForcedResponse.summary`."""

    dof: str
    """Degree of freedom."""
    omega: float
    """Angular frequency of its peak [rad/s]."""
    amplitude: float
    """Amplitude at its peak, half peak-to-peak [m]."""
    error_estimate: float
    """What the discarded harmonics could still change at the nearest computed point [m]."""
    harmonics: int
    """Highest harmonic kept at the nearest computed point."""
    at_edge: bool
    """Whether the peak lies at an end of the computed frequencies."""


def highest(result: ForcedResponse, dof: str, measure: Measure) -> Peak:
    """Refine every local maximum that may be the highest, and return the highest.

    Parameters
    ----------
    result : ForcedResponse
        The curve. Points that are not solved are passed over.
    dof : str
        An observed degree of freedom.
    measure : {"half_range", "max", "fundamental"}
        Measure of the amplitude.

    Returns
    -------
    Peak
        Not below any computed point.

    Raises
    ------
    ModelError
        If no point is solved.
    """
    omega, amplitude = _curve(result.omega, result.amplitude(dof, measure))
    if not omega.size:
        raise ModelError(
            f"peak of {dof!r}: none of the {result.omega.size} points is solved; see status"
        )
    best = int(amplitude.argmax())
    peak = (float(omega[best]), float(amplitude[best]))
    for top in _rivals(amplitude):
        low, high = omega[max(top - 1, 0)], omega[min(top + 1, omega.size - 1)]
        if low < high and amplitude[top] > 0.0:
            refined = _refined(result, dof, measure, (low, high, omega[top]))
            peak = max(peak, refined, key=lambda point: point[1])
    # The maximisation resolves frequencies to 1e-8.
    at_edge = bool(np.isclose(peak[0], omega[[0, -1]], rtol=1e-7, atol=0.0).any())
    return Peak(*peak, at_edge)


def _curve(omega: Float, amplitude: Float) -> tuple[Float, Float]:
    """Sort the solved points by frequency; of equal frequencies keep the larger amplitude."""
    known = np.isfinite(amplitude)
    omega, amplitude = omega[known], amplitude[known]
    order = np.lexsort((-amplitude, omega))
    omega, first = np.unique(omega[order], return_index=True)
    return omega, amplitude[order][first]


def _rivals(amplitude: Float) -> Int:
    """Positions of the local maxima near the largest; of a plateau the first."""
    before = np.concatenate(([-np.inf], amplitude[:-1]))
    after = np.concatenate((amplitude[1:], [-np.inf]))
    top = (amplitude > before) & (amplitude >= after) & (amplitude >= RIVAL * amplitude.max())
    return np.flatnonzero(top)


def _refined(
    result: ForcedResponse, dof: str, measure: Measure, bracket: tuple[float, float, float]
) -> tuple[float, float]:
    """Return the maximum inside a bracket (low, high, guess)."""
    from stickslip import _core

    settings = result.settings
    low, high, guess = bracket
    try:
        return _core.peak(
            result.model.problem,
            float(low),
            float(high),
            float(guess),
            result.model.structure.index(dof),
            measure,
            settings.fixed_harmonics,
            settings.tolerance,
            settings.residual,
            settings.max_harmonics,
            settings.max_iterations,
        )
    except ValueError as error:
        raise ModelError(f"peak of {dof!r}: {error}") from error
