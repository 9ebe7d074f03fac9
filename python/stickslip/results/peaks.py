"""The highest point of a response curve, between the points that were computed."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from typing import NamedTuple, TypeAlias, get_args

import numpy as np

from stickslip import _core
from stickslip.calls import outside
from stickslip.checks import brief, choice
from stickslip.disk.wave_ring import moving
from stickslip.errors import ModelError
from stickslip.model.pace import refusal
from stickslip.results.arrays import Measure
from stickslip.results.fields import Bool, Float, Int
from stickslip.results.periodic import Sweep, key_of
from stickslip.results.status import Status

RIVAL = 0.9
"""Local maxima from this share of the largest may be the true peak once they are refined."""

SAME = 1e-10
"""Share by which a peak has to exceed the computed points to count as higher."""

Bracket: TypeAlias = tuple[float, float, float]
"""Lowest and highest frequency, and a guess between them [rad/s]."""
Refine: TypeAlias = "Callable[[Peaks, str, Measure, Bracket], tuple[float, float]]"
"""Returns the frequency and the amplitude of the maximum inside a bracket."""


class Peak(NamedTuple):
    """The highest point of a response curve."""

    omega: float
    """Angular frequency [rad/s]."""
    amplitude: float
    """Amplitude [m]; infinite where neither damping nor friction bounds the response."""
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


class Peaks(Sweep):
    """The part of a sweep that concerns its highest points."""

    @cached_property
    def _peaks(self) -> dict[tuple[str, Measure], Peak]:
        return {}

    @cached_property
    def _unbounded(self) -> list[float | None]:
        """Frequencies in the range of the points at which nothing bounds the degrees of freedom."""
        span = (float(self.omega.min()), float(self.omega.max()))
        return self.model.problem.unbounded(span)

    def peak(self, dof: str, measure: Measure = "half_range") -> Peak:
        """Return the highest point of the response curve, between the computed points.

        The balance equations are solved anew over the range of the computed points: at every
        resonance that may be the highest, in whatever state of the contacts, and wherever the curve
        between two points may be higher. Where solutions need not be unique the peak is that of the
        computed branch instead: of the parabola along it through the three highest points.

        `omega`, `amplitude` (not below any computed point, infinite where neither damping nor
        friction bounds it), `at_edge` and `beside_gap`.

        Raises ModelError if no point is solved.

        Warns
        -----
        UserWarning
            If a point beside the maximum is not solved, or nothing bounds the response.
        """
        key_of(dof, measure)
        return self._peaks_of([dof], measure)[0]

    def peak_index(self, dof: str) -> int:
        """Return the position of the solved point beside a peak, on its branch if the curve folds.

        Raises ModelError if no point is solved.
        """
        return _nearest(self, dof, self.peak(dof))

    def _peaks_of(self, dofs: Sequence[str], measure: Measure) -> list[Peak]:
        """Return the peaks of several degrees of freedom, found together."""
        if self.model.problem.laws_not_monotone:
            return [_of_branch(self, dof, measure) for dof in dofs]
        groups = [[dof] for dof in dofs if (dof, measure) not in self._peaks]
        found = summits(self, groups, measure) if groups else []
        for (dof,), (_, peak) in zip(groups, found, strict=True):
            self._peaks[dof, measure] = peak
        return [self._peaks[dof, measure] for dof in dofs]

    def _highest_of(self, dofs: Sequence[str], measure: Measure) -> tuple[int, Peak]:
        """Return which of some degrees of freedom has the highest peak, and the peak."""
        if self.model.problem.laws_not_monotone:
            peaks = [_of_branch(self, dof, measure) for dof in dofs]
            return max(enumerate(peaks), key=lambda one: one[1].amplitude)
        return summits(self, [dofs], measure)[0]

    def summary(self, dofs: Iterable[str] | str | None = None) -> list[Summary]:
        """Return the peaks of degrees of freedom, one row each.

        Empty if no point is solved.

        Raises ModelError if there is no such degree of freedom, or it was not observed.

        Parameters
        ----------
        dofs : iterable of str, optional
            Observed degrees of freedom. Default: all.
        """
        return rows(self, self.dofs if dofs is None else dofs)


def highest(result: Peaks, dof: str, measure: Measure, refine: Refine) -> Peak:
    """Refine every local maximum that may be the highest, and return the highest.

    Points that are not solved are passed over, and warned of where they lie beside the peak. It is
    infinite where nothing bounds the response.
    """
    omega, amplitude, gap = _curve(result, dof, measure)
    if unbounded := _unbounded_peak(result, dof):
        return unbounded
    best = int(amplitude.argmax())
    beside_gap = bool(gap[best])
    peak = (float(omega[best]), float(amplitude[best]))
    for top in _rivals(amplitude):
        beside_gap = beside_gap or bool(gap[top])
        low, high = omega[max(top - 1, 0)], omega[min(top + 1, omega.size - 1)]
        if low < high and amplitude[top] > 0.0:
            found = refine(result, dof, measure, (float(low), float(high), float(omega[top])))
            peak = max(peak, found, key=lambda point: point[1])
    return _told(result, dof, omega, peak, beside_gap)


def _of_branch(result: Peaks, dof: str, measure: Measure) -> Peak:
    """Return the highest point of a branch, unless nothing bounds the response on any."""
    return _unbounded_peak(result, dof) or along(result, dof, measure)


def _unbounded_peak(result: Peaks, dof: str) -> Peak | None:
    """Return the peak of a degree of freedom that nothing bounds; None if something does."""
    omega = result._unbounded[result.model.structure.index(dof)]
    return None if omega is None else _without_bound(dof, omega)


def along(result: Peaks, dof: str, measure: Measure) -> Peak:
    """Return the highest point of a branch, by the parabola along it through its highest points."""
    return highest_of(result, dof, result.amplitude(dof, measure))


def highest_of(result: Peaks, dof: str, amplitude: Float) -> Peak:
    """Return the highest point of a line along a branch, by a parabola through its highest points.

    Along the branch and not over frequency, in which it may turn back.
    """
    omega = result.omega
    if not np.isfinite(amplitude).any():
        raise ModelError(f"peak of {dof!r}: none of the {omega.size} points is solved; see status")
    best, last = int(np.nanargmax(amplitude)), omega.size - 1
    top = (float(omega[best]), float(amplitude[best]))
    if best in (0, last):
        return Peak(*top, at_edge=True)
    around = slice(best - 1, best + 2)
    if not np.isfinite(amplitude[around]).all():
        return _told(result, dof, omega, top, beside_gap=True)
    apart = result.arrays.jump | result.arrays.further
    if apart[best : best + 2].any():
        return Peak(*top, at_edge=top[0] in (omega.min(), omega.max()))
    x, y = omega[around] / top[0] - 1.0, amplitude[around] / top[1] - 1.0
    before, after = np.hypot(np.diff(x), np.diff(y))
    if not (before and after):
        return Peak(*top, at_edge=False)
    # Parabolas through the points at -before, 0 and after.
    rise, bend = _parabola(y, before, after)
    at = 0.0 if bend >= 0.0 else min(max(-0.5 * rise / bend, -before), after)
    drift, turn = _parabola(x, before, after)
    # Where the points are far apart along the branch it bends farther than they go.
    omega_top = top[0] * (1.0 + at * (drift + at * turn))
    return Peak(
        float(np.clip(omega_top, omega[around].min(), omega[around].max())),
        max(top[1] * (1.0 + at * (rise + at * bend)), top[1]),
        at_edge=False,
    )


def _parabola(values: Float, before: float, after: float) -> tuple[float, float]:
    """Return slope and half the curvature at the middle of three points, which is zero."""
    left, right = -values[0] / before, values[2] / after
    bend = (right - left) / (before + after)
    return float(left + before * bend), float(bend)


def summits(
    result: Peaks, groups: Sequence[Sequence[str]], measure: Measure
) -> list[tuple[int, Peak]]:
    """Return the highest point of each group of degrees of freedom, by harmonic balance.

    With its degree of freedom, by its position among the group. The range of the computed points
    is searched; no peak is below any of them.
    """
    choice(measure, "measure", get_args(Measure))
    rows: list[_core.Summit] = []
    low, high = float(result.omega.min()), float(result.omega.max())
    if low < high and result.arrays.solved.any():
        settings = result.settings
        groups_of = [[result.model.structure.index(dof) for dof in dofs] for dofs in groups]
        try:
            rows = _core.summits(
                result.model.problem, groups_of, measure, (low, high), settings, settings
            )
        except ValueError as error:
            raise ModelError(f"peak of {groups[0][0]!r}: {error}") from error
    return [
        _summit(result, dofs, measure, rows[position] if rows else None)
        for position, dofs in enumerate(groups)
    ]


def _summit(
    result: Peaks, dofs: Sequence[str], measure: Measure, row: _core.Summit | None
) -> tuple[int, Peak]:
    """Return the higher of what was computed and what was found between."""
    curves = [_curve(result, dof, measure) for dof in dofs]
    index = int(np.argmax([amplitude.max() for _, amplitude, _ in curves]))
    omega, amplitude, gap = curves[index]
    best = int(amplitude.argmax())
    peak = (float(omega[best]), float(amplitude[best]))
    beside_gap = bool(gap[_rivals(amplitude)].any())
    if row is not None:
        found, status = row[:2], Status.from_code(row[3])
        if status == Status.SINGULAR and np.isfinite(found[0]):
            return index, _without_bound(dofs[index], found[0])
        beside_gap = beside_gap or not status.solved
        if found[1] > peak[1] * (1.0 + SAME):
            index, peak = row[2], found
    return index, _told(result, dofs[index], omega, peak, beside_gap)


def _told(
    result: Peaks, dof: str, omega: Float, peak: tuple[float, float], beside_gap: bool
) -> Peak:
    """Return a peak, and warn of what it may have missed."""
    # The maximisation resolves frequencies to 1e-8.
    at_edge = bool(np.isclose(peak[0], omega[[0, -1]], rtol=1e-7, atol=0.0).any())
    if beside_gap:
        unsolved = int((~result.arrays.solved).sum())
        text = (
            f"{unsolved} of {result.omega.size} points are not solved, some of them beside the "
            "maximum, which may be higher there; see status for the remedy"
        )
        if not unsolved:
            text = (
                "between the computed points the response could not be solved everywhere, and may "
                "be higher there; compute more points to see where and why"
            )
        warnings.warn(f"peak of {dof!r}: {text}", stacklevel=outside())
    return Peak(*peak, at_edge, beside_gap)


def _without_bound(dof: str, omega: float) -> Peak:
    """Return the peak of a resonance that nothing bounds, and warn of it."""
    warnings.warn(
        f"peak of {dof!r}: neither damping nor friction bounds the resonance at {omega:.6g} rad/s; "
        "add damping, or more friction",
        stacklevel=outside(),
    )
    return Peak(omega, np.inf, at_edge=False)


def rows(result: Peaks, dofs: Iterable[str] | str) -> list[Summary]:
    """Return the peaks of degrees of freedom with the numbers of the nearest solved points."""
    if not isinstance(dofs, Iterable):
        raise ModelError(f"dofs: {brief(dofs)} is not a list of names; leave it out for all")
    names = (dofs,) if isinstance(dofs, str) else tuple(dofs)
    for dof in names:
        result.amplitude(dof)  # refuses what is unknown
    if not result.arrays.solved.any():
        return []
    peaks = result._peaks_of(names, "half_range")
    return [_row(result, dof, peak) for dof, peak in zip(names, peaks, strict=True)]


def _row(result: Peaks, dof: str, peak: Peak) -> Summary:
    near = _nearest(result, dof, peak)
    return Summary(
        dof,
        peak.omega,
        peak.amplitude,
        float(result.error_estimate(dof)[near]),
        int(result.harmonics[near]),
        peak.at_edge,
        peak.beside_gap,
    )


def _nearest(result: Peaks, dof: str, peak: Peak) -> int:
    """Return the position of the solved point beside a peak, on its branch of a folded curve."""
    solved = np.flatnonzero(result.arrays.solved)
    omega = result.omega[solved]
    near = int(np.abs(omega - peak.omega).argmin())
    steps = np.diff(omega)
    if np.isfinite(peak.amplitude) and (steps > 0.0).any() and (steps < 0.0).any():
        # Of the points about its frequency, on every branch, that with the nearest amplitude.
        ahead = (omega[:-1] - peak.omega) * (omega[1:] - peak.omega) <= 0.0
        about = np.union1d(np.flatnonzero(np.append(ahead, False) | np.append(False, ahead)), near)
        heights = result.amplitude(dof)[solved][about]
        near = int(about[np.abs(heights - peak.amplitude).argmin()])
    return int(solved[near])


def _curve(result: Peaks, dof: str, measure: Measure) -> tuple[Float, Float, Bool]:
    """Sort the solved points by frequency, and tell which of them have an unsolved neighbour.

    Of equal frequencies the larger amplitude is kept.
    """
    omega, amplitude = result.omega, result.amplitude(dof, measure)
    if not np.isfinite(amplitude).any():
        raise ModelError(f"peak of {dof!r}: none of the {omega.size} points is solved; see status")
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


def of_orbits(result: Peaks, dof: str, measure: Measure, bracket: Bracket) -> tuple[float, float]:
    """Return frequency and amplitude of the maximum inside a bracket, by exact orbits."""
    low, high, guess = bracket
    problem, rotation = moving(result.model, half_wave=result.half_wave)
    try:
        return _core.exact_peak(
            problem,
            (low, guess, high),
            result.model.structure.index(dof),
            measure,
            result.settings,
            rotation,
        )
    except ValueError as error:
        raise ModelError(f"peak of {dof!r}: {refusal(error, result.model)}") from error
