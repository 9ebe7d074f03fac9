"""The peak of a response along a parameter of its dampers."""

from __future__ import annotations

from dataclasses import fields

import numpy as np

from stickslip import _core
from stickslip.analyses.arguments import require_forced, require_held
from stickslip.analyses.doubts import is_unique
from stickslip.analyses.peak_assumptions import damper_assumptions
from stickslip.analyses.run import Progress, Run, refusals
from stickslip.analyses.variation import local_stiffness, resonance_range, variation_of
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.results.damper_curve import DamperArrays, DamperCurve
from stickslip.results.fields import Bool, Float
from stickslip.results.status import Status
from stickslip.settings.peaks import DamperKeys, DamperSettings, PeakKeys, PeakSettings
from stickslip.settings.settings import configured
from stickslip.settings.variation import Variation

RIGID = 250.0
"""Stiffness of a contact, over that of the structure, from which the rigid limit is taken.

The peak is nearly linear in 1/k_d there, so that this and twice this give the limit to about the
square of its inverse, while the harmonics needed stay at some hundred.
"""


@configured(DamperKeys)
def damper_curve(model: Model, *, settings: DamperKeys, progress: Progress = None) -> DamperCurve:
    """Peak amplitude and frequency against a parameter of contacts, or the level of the forces.

    The peak itself is followed: at every value the highest point over frequency is found from
    some twenty solutions with exact slopes, and the next value starts from them.

    With ``residual="bounds"`` the tractions that the past may have left in contacts which stick are
    varied over all that Coulomb allows: `lower` and `upper` are the least and the largest peak
    found, `unique` says whether they differ and `guaranteed` whether theory excludes others.

    Returns
    -------
    DamperCurve
        One entry per value.

    References
    ----------
    Guillen (1999), Figs 2.6, 2.10, 2.11, 4.3 to 4.8, there from full sweeps. Griffin (1980): the
    optimal slip force of a blade damper.
    """
    bounded = settings.bounded
    if bounded and settings.measure != "half_range":
        raise ModelError(
            f"measure: {settings.measure!r} has no bounds over residual tractions, which move the "
            'mean as well; leave it at "half_range"'
        )
    settings = settings.nominal(model)
    parameter = settings.varied
    values = getattr(settings, parameter)
    if parameter == "stiffness" and settings.common == "factor" and np.isinf(values).any():
        raise ModelError(
            "stiffness: an infinite factor has no meaning; give finite ones, or values"
        )
    variation = variation_of(model, parameter, settings)
    kept = settings_for(model, variation, values, settings, bounds=bounded)
    start = _rigid_from(model, variation)
    rigid = start if _is_rigid(values, start).any() else None
    with Run("damper curve", progress, model) as run:
        result = curve_of(model, kept, _peaks(model, kept, values, rigid, run), rigid)
        done = int(result.arrays.solved.sum())
        return run.ended(result, f"{done} of {values.size} values")


def settings_for(
    model: Model,
    variation: Variation,
    values: Float,
    settings: PeakKeys,
    *,
    bounds: bool = False,
) -> DamperSettings:
    """Return the checked settings of a curve over some values."""
    start = _rigid_from(model, variation)
    finite = values[~_is_rigid(values, start)]
    if variation.parameter == "stiffness" and finite.size < values.size:
        finite = np.append(finite, start)
    span = settings.omega
    if span is None:
        span = resonance_range(model, variation, settings.mode, finite)
    kept = DamperSettings.of(
        **settings.part(PeakSettings),
        dof=settings.dof,
        variation=variation,
        span=span,
        bounds=bounds,
    )
    model.structure.index(kept.dof)
    require_forced(model, kept)
    require_held(model, kept.residual)
    return kept


def curve_of(
    model: Model,
    settings: DamperSettings,
    peaks: tuple[DamperArrays, _core.Peaks],
    rigid: float | None = None,
) -> DamperCurve:
    """Return the result that the core's peaks make."""
    arrays, solution = peaks
    return DamperCurve.of(
        solution,
        model=model,
        dofs=(settings.dof,),
        settings=settings,
        arrays=arrays,
        diagnostics=damper_assumptions(model, settings, arrays, rigid),
    )


def _peaks(
    model: Model, settings: DamperSettings, values: Float, rigid: float | None, progress: Progress
) -> tuple[DamperArrays, _core.Peaks]:
    solved = values
    if rigid is not None:
        # A rigid contact stands for two stiff ones.
        stiff = _is_rigid(values, rigid)
        pairs = [
            [rigid, 2.0 * rigid] if instead else [value]
            for value, instead in zip(values, stiff, strict=True)
        ]
        solved = np.concatenate([np.array(pair) for pair in pairs])
    with refusals(model):
        peaks = _core.damper_curve(
            model.problem,
            settings.variation.varied(model),
            model.structure.index(settings.dof),
            solved,
            settings,
            progress,
            is_unique(model) if settings.bounds else None,
        )
    arrays = DamperArrays.of(peaks)
    return (arrays if rigid is None else _with_limit(arrays, values, rigid)), peaks


def _rigid_from(model: Model, variation: Variation) -> float:
    """Return the stiffness from which the rigid limit is taken [N/m]; infinity of other values."""
    if variation.parameter != "stiffness" or variation.common == "factor":
        return np.inf
    return RIGID * local_stiffness(model, variation.contacts)


def _is_rigid(values: Float, rigid: float) -> Bool:
    """Return which stiffnesses lie beyond the two that the rigid limit uses, shape (n,)."""
    stiff: Bool = values > 2.0 * rigid
    return stiff


def _with_limit(arrays: DamperArrays, values: Float, rigid: float) -> DamperArrays:
    """Replace every pair of stiff contacts by the line through them, in 1/k_d."""
    stiff = _is_rigid(values, rigid)
    second = np.arange(values.size) + np.cumsum(stiff)
    last = {entry.name: np.array(getattr(arrays, entry.name)[second]) for entry in fields(arrays)}
    for place in np.flatnonzero(stiff):
        two = int(second[place])
        one = two - 1
        share = 2.0 * rigid / values[place]
        for name in ("omega", "amplitude", "lower", "upper"):
            numbers = getattr(arrays, name)
            last[name][place] = numbers[two] + (1.0 - share) * (numbers[two] - numbers[one])
        change = abs(arrays.amplitude[two] - arrays.amplitude[one])
        estimate = arrays.error_estimate
        last["error_estimate"][place] = 2.0 * estimate[two] + estimate[one] + change
        slope = (arrays.amplitude[two] - arrays.amplitude[one]) / (2.0 * rigid)
        last["sensitivity"][place] = share**2 * slope
        if arrays.status[two] == Status.CONVERGED.code:
            last["status"][place] = arrays.status[one]
    return DamperArrays(**{**last, "value": values})
