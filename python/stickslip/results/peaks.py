"""The highest point of a response curve, between the points that were computed."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from stickslip.checks import brief
from stickslip.errors import ModelError
from stickslip.results.arrays import Bool, Float, Int, Measure

if TYPE_CHECKING:
    from stickslip.results import ForcedResponse

__all__ = ["Peak", "Summary", "highest", "highest_of", "of_orbits", "refined", "rows"]

RIVAL = 0.9
"""Local maxima from this share of the largest may be the true peak once they are refined."""

Bracket: TypeAlias = tuple[float, float, float]
"""Lowest and highest frequency, and a guess between them [rad/s]."""
Refine: TypeAlias = "Callable[[ForcedResponse, str, Measure, Bracket], tuple[float, float]]"
"""Returns the frequency and the amplitude of the maximum inside a bracket."""


class Peak(NamedTuple):
    """The highest point of a response curve."""

    omega: float
    """Angular frequency [rad/s]."""
    amplitude: float
    """Amplitude [m]."""
    at_edge: bool
    """Whether it lies at an end of the computed frequencies: the true peak may be outside."""
    beside_gap: bool = False
    """Whether a point beside it is not solved: the true peak may be there."""


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
    beside_gap: bool = False
    """Whether a point beside the peak is not solved."""


def highest(result: ForcedResponse, dof: str, measure: Measure, refine: Refine) -> Peak:
    """Refine every local maximum that may be the highest, and return the highest.

    Parameters
    ----------
    result : ForcedResponse
        The curve. Points that are not solved are passed over, and warned of where they lie beside
        the peak.
    dof : str
        An observed degree of freedom.
    measure : {"half_range", "max", "fundamental"}
        Measure of the amplitude.
    refine : callable
        Returns the frequency and the amplitude of the maximum inside a bracket.

    Returns
    -------
    Peak
        Not below any computed point.

    Raises
    ------
    ModelError
        If no point is solved.
    """
    omega, amplitude, gap = _curve(result.omega, result.amplitude(dof, measure))
    if not omega.size:
        raise ModelError(
            f"peak of {dof!r}: none of the {result.omega.size} points is solved; see status"
        )
    best = int(amplitude.argmax())
    beside_gap = bool(gap[best])
    peak = (float(omega[best]), float(amplitude[best]))
    for top in _rivals(amplitude):
        beside_gap = beside_gap or bool(gap[top])
        low, high = omega[max(top - 1, 0)], omega[min(top + 1, omega.size - 1)]
        if low < high and amplitude[top] > 0.0:
            found = refine(result, dof, measure, (float(low), float(high), float(omega[top])))
            peak = max(peak, found, key=lambda point: point[1])
    # The maximisation resolves frequencies to 1e-8.
    at_edge = bool(np.isclose(peak[0], omega[[0, -1]], rtol=1e-7, atol=0.0).any())
    if beside_gap:
        unsolved = int((~result.arrays.solved).sum())
        warnings.warn(
            f"peak of {dof!r}: {unsolved} of {result.omega.size} points are not solved, some of "
            "them beside the maximum, which may be higher there; see status for the remedy",
            stacklevel=3,
        )
    return Peak(*peak, at_edge, beside_gap)


def highest_of(result: ForcedResponse, dofs: Sequence[str], measure: Measure) -> tuple[int, Peak]:
    """Return which of some degrees of freedom has the highest peak, and the peak.

    All of them are followed together, by harmonic balance over the range of the computed points.

    Parameters
    ----------
    result : ForcedResponse
        The curves.
    dofs : sequence of str
        Observed degrees of freedom.
    measure : {"half_range", "max", "fundamental"}
        Measure of the amplitude.

    Returns
    -------
    index : int
        Position among `dofs`.
    peak : Peak
        Not below any computed point.

    Raises
    ------
    ModelError
        If no point is solved, or the core refuses.
    """
    from stickslip import _core

    heights = np.stack([result.amplitude(dof, measure) for dof in dofs])
    known = np.isfinite(heights).all(axis=0)
    index = int(heights[:, known].max(axis=1).argmax()) if known.any() else 0
    low, high = (result.omega[known].min(), result.omega[known].max()) if known.any() else (0, 0)
    found: tuple[float, float] | None = None
    if low < high:
        settings = result.settings
        quest: _core.Quest = {
            "groups": [[result.model.structure.index(dof) for dof in dofs]],
            "measure": measure,
            "omega": (float(low), float(high)),
            "harmonics": settings.fixed_harmonics,
            "tolerance": settings.tolerance,
            "residual": settings.residual,
            "max_harmonics": settings.max_harmonics,
            "max_iterations": settings.max_iterations,
        }
        try:
            ((omega, amplitude, member, *_),) = _core.summits(
                result.model.problem, quest, settings.march, settings.max_samples
            )
        except ValueError as error:
            raise ModelError(f"peak of {dofs[index]!r}: {error}") from error
        # A part that could not be solved leaves no peak: then that of the computed points counts.
        if amplitude >= heights[:, known].max():
            index, found = member, (omega, amplitude)

    def refine(
        result: ForcedResponse, dof: str, measure: Measure, bracket: Bracket
    ) -> tuple[float, float]:
        return found or refined(result, dof, measure, bracket)

    return index, highest(result, dofs[index], measure, refine)


def rows(result: ForcedResponse, dofs: Iterable[str] | str) -> list[Summary]:
    """Return the peaks of degrees of freedom with the numbers of the nearest solved points.

    Parameters
    ----------
    result : ForcedResponse
        The curves.
    dofs : iterable of str, or str
        Observed degrees of freedom.

    Returns
    -------
    list of Summary
        Empty if no point is solved.

    Raises
    ------
    ModelError
        If there is no such degree of freedom, or it was not observed.
    """
    if not isinstance(dofs, Iterable):
        raise ModelError(f"dofs: {brief(dofs)} is not a list of names; leave it out for all")
    names = (dofs,) if isinstance(dofs, str) else tuple(dofs)
    for dof in names:
        result.amplitude(dof)  # refuses what is unknown
    return [_row(result, dof) for dof in names] if result.arrays.solved.any() else []


def _row(result: ForcedResponse, dof: str) -> Summary:
    peak = result.peak(dof)
    solved = np.flatnonzero(result.arrays.solved)
    near = int(solved[np.abs(result.omega[solved] - peak.omega).argmin()])
    return Summary(
        dof,
        peak.omega,
        peak.amplitude,
        float(result.error_estimate(dof)[near]),
        int(result.harmonics[near]),
        peak.at_edge,
        peak.beside_gap,
    )


def _curve(omega: Float, amplitude: Float) -> tuple[Float, Float, Bool]:
    """Sort the solved points by frequency, and tell which of them have an unsolved neighbour.

    Of equal frequencies the larger amplitude is kept.
    """
    order = np.lexsort((-amplitude, omega))
    omega, first = np.unique(omega[order], return_index=True)
    amplitude = amplitude[order][first]
    known = np.isfinite(amplitude)
    around = np.concatenate(([True], known, [True]))
    gap = ~(around[:-2] & around[2:])
    return omega[known], amplitude[known], gap[known]


def _rivals(amplitude: Float) -> Int:
    """Positions of the local maxima near the largest; of a plateau the first."""
    before = np.concatenate(([-np.inf], amplitude[:-1]))
    after = np.concatenate((amplitude[1:], [-np.inf]))
    top = (amplitude > before) & (amplitude >= after) & (amplitude >= RIVAL * amplitude.max())
    return np.flatnonzero(top)


def refined(
    result: ForcedResponse, dof: str, measure: Measure, bracket: Bracket
) -> tuple[float, float]:
    """Return frequency and amplitude of the maximum inside a bracket, by harmonic balance.

    Raises
    ------
    ModelError
        If the core refuses.
    """
    from stickslip import _core

    settings = result.settings
    low, high, guess = bracket
    try:
        return _core.peak(
            result.model.problem,
            low,
            high,
            guess,
            result.model.structure.index(dof),
            measure,
            settings.fixed_harmonics,
            settings.tolerance,
            settings.residual,
            settings.method,
            settings.jacobian,
            settings.march,
            settings.max_harmonics,
            settings.max_samples,
            settings.max_iterations,
        )
    except ValueError as error:
        raise ModelError(f"peak of {dof!r}: {error}") from error


def of_orbits(
    result: ForcedResponse, dof: str, measure: Measure, bracket: Bracket
) -> tuple[float, float]:
    """Return frequency and amplitude of the maximum inside a bracket, by exact orbits."""
    from stickslip import _core

    settings = result.settings
    low, high, guess = bracket
    try:
        return _core.exact_peak(
            result.model.problem,
            low,
            high,
            guess,
            result.model.structure.index(dof),
            measure,
            settings.residual,
            settings.max_iterations,
        )
    except ValueError as error:
        raise ModelError(f"peak of {dof!r}: {error}") from error
