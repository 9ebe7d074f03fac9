"""What a fit has to say of itself."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from stickslip.analyses.texts import told
from stickslip.results.diagnostic import Diagnostic, present
from stickslip.results.fit import WIDE, FitArrays, relative_width
from stickslip.settings.fit import FitSettings

_TIED = 0.98
"""Correlation from which only a combination of two parameters is known."""
_MISFIT = 1.5
"""Scatter from which the model does not fit within the noise."""
_EQUAL = 4.0
"""Rise of the misfit up to which another minimum fits nearly as well."""
_AT_ZERO = 1e-6
"""Distance to a bound of zero, relative to that of the bounds, within which a value is there."""
_APART = 0.05
"""Distance between minima, relative to the values, from which they are two."""


def fit_assumptions(
    arrays: FitArrays, settings: FitSettings, *, noise_known: bool, freedom: int
) -> tuple[Diagnostic, ...]:
    """Say what the data leave open, and whether the model fits them."""
    misfit = float((((arrays.predicted - arrays.observed) / arrays.deviation) ** 2).sum())
    scatter = np.sqrt(misfit / freedom) if freedom else np.nan
    missing = int((~arrays.solved).sum())
    return present(
        (
            told(f"intervals/{settings.intervals}", confidence=settings.confidence),
            not noise_known and told("noise-estimated", scatter=float(scatter)),
            *_undetermined(arrays, settings),
            *_tied(arrays, settings),
            *_at_bounds(arrays, settings),
            *_other_minima(arrays, settings),
            noise_known
            and scatter > _MISFIT
            and told("misfit-above-noise", scatter=float(scatter), numbers=arrays.observed.size),
            missing > 0 and told("predictions-missing", count=missing, total=arrays.solved.size),
        )
    )


def _undetermined(arrays: FitArrays, settings: FitSettings) -> list[Diagnostic]:
    widths = relative_width(arrays, settings)
    found = []
    for name, width, (low, high) in zip(settings.parameters, widths, arrays.interval, strict=True):
        if width > WIDE:
            said = "goes on to a bound" if np.isinf(width) else f"is {width:.0%} wide"
            found.append(
                told("not-determined", parameter=name, low=float(low), high=float(high), _said=said)
            )
    return found


def _tied(arrays: FitArrays, settings: FitSettings) -> list[Diagnostic]:
    pairs = combinations(enumerate(settings.parameters), 2)
    return [
        told("tied", one=one, other=other, correlation=float(arrays.correlation[i, j]))
        for (i, one), (j, other) in pairs
        if abs(arrays.correlation[i, j]) > _TIED
    ]


def _at_bounds(arrays: FitArrays, settings: FitSettings) -> list[Diagnostic]:
    found = []
    for (name, ends), value in zip(settings.parameters.items(), arrays.value, strict=True):
        for end in ends:
            near = 1e-3 * abs(end) if end else _AT_ZERO * (ends[1] - ends[0])
            if abs(value - end) <= near:
                found.append(told("at-bound", parameter=name, value=float(value), bound=end))
    return found


def _other_minima(arrays: FitArrays, settings: FitSettings) -> list[Diagnostic]:
    if arrays.minimum.size < 2:
        return []
    best = arrays.minimum_value[0]
    scale = np.where(best == 0.0, 1.0, np.abs(best))
    for height, values in zip(arrays.minimum[1:], arrays.minimum_value[1:], strict=True):
        apart = np.abs(values - best) / scale
        place = int(apart.argmax())
        if height <= arrays.minimum[0] + _EQUAL and apart[place] > _APART:
            name = tuple(settings.parameters)[place]
            return [told("other-minimum", parameter=name, value=float(values[place]))]
    return []
