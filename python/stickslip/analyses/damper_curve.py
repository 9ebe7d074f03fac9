"""The peak of a response along a parameter of its dampers."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from stickslip.analyses.arguments import (
    Progress,
    prepare,
    require_forced,
    require_held,
    require_model,
    require_progress,
)
from stickslip.analyses.damper_assumptions import damper_assumptions
from stickslip.analyses.variation import (
    PARAMETERS,
    Contacts,
    chosen_contacts,
    local_stiffness,
    resonance_range,
)
from stickslip.errors import ModelError
from stickslip.interruption import Interruption, stopped
from stickslip.model import Model
from stickslip.results.arrays import Bool, Float
from stickslip.results.damper_curve import DamperArrays, DamperCurve
from stickslip.results.status import Status
from stickslip.settings.entries import Span
from stickslip.settings.peaks import DamperKeys, DamperSettings, PeakSettings
from stickslip.settings.settings import configured
from stickslip.settings.variation import Parameter, Variation

if TYPE_CHECKING:
    from stickslip import _core

__all__ = ["curve_of", "damper_curve", "settings_for"]

RIGID = 250.0
"""Stiffness of a contact, over that of the structure, from which the rigid limit is taken.

The peak is nearly linear in 1/k_d there, so that this and twice this give the limit to about the
square of its inverse, while the harmonics needed stay at some hundred.
"""


@configured(DamperKeys)
def damper_curve(
    model: Model,
    *,
    settings: DamperKeys,
    slip_force: ArrayLike | None = None,
    stiffness: ArrayLike | None = None,
    level: ArrayLike | None = None,
    contacts: Contacts | None = None,
    omega: Span | None = None,
    progress: Progress = None,
) -> DamperCurve:
    """Peak amplitude and frequency against slip force, contact stiffness or level of the forces.

    The peak itself is followed: at every value the highest point over frequency is found from
    some twenty solutions with exact slopes, and the next value starts from them.

    Parameters
    ----------
    slip_force, stiffness, level : array_like, shape (n,)
        Values of one of them, in the order to follow: slip forces F_d [N], stiffnesses k_d [N/m]
        of the contacts, or factors on all forces. An infinite slip force never slips; an infinite
        stiffness is the limit of a rigid contact, and common values above 500 times the stiffness
        of the structure lie on the line in 1/k_d towards it.
    contacts : int, str, (contact, int), or iterable of these, optional
        The contacts that take the value, or points of them as (contact, point). Of a contact with
        several points the slip forces that are finite, unless none is. Default: all contacts; of
        slip forces those that are finite, unless none is.
    omega : (float, float), optional
        Range of frequencies in which the peak is the highest point [rad/s]. Default: from 5 %
        below the free to 5 % above the highest stuck natural frequency of `mode`, over the lowest
        harmonic of the forces.

    Returns
    -------
    DamperCurve
        One entry per value.

    Raises
    ------
    ModelError
        If not exactly one parameter is given, or an argument is of the wrong type or outside its
        range.
    Interrupted
        On Ctrl-C; its `result` holds the values that had been reached.

    References
    ----------
    Guillen (1999), Figs 2.6, 2.10, 2.11, 4.3 to 4.8, there from full sweeps. Griffin (1980): the
    optimal slip force of a blade damper.
    """
    require_model(model)
    require_progress(progress)
    parameter, values = _one_of(slip_force=slip_force, stiffness=stiffness, level=level)
    if parameter == "stiffness" and settings.common == "factor" and np.isinf(values).any():
        raise ModelError(
            "stiffness: an infinite factor has no meaning; give finite ones, or values"
        )
    kept = settings_for(
        model,
        Variation.of(
            parameter=parameter,
            contacts=chosen_contacts(contacts, parameter, model, settings.common),
            common=settings.common,
        ),
        values,
        omega,
        settings,
    )
    start = _rigid_from(model, kept.variation)
    rigid = start if _is_rigid(values, start).any() else None
    prepare(model)
    with Interruption(progress) as watch:
        result = curve_of(model, kept, _peaks(model, kept, values, rigid, watch), rigid)
        if result.interrupted:
            done = int(result.arrays.solved.sum())
            raise stopped("damper curve", f"{done} of {values.size} values", result)
        return watch.completed(result, "damper curve")


def settings_for(
    model: Model,
    variation: Variation,
    values: Float,
    omega: Span | None,
    settings: DamperKeys,
) -> DamperSettings:
    """Return the checked settings of a curve over some values."""
    start = _rigid_from(model, variation)
    finite = values[~_is_rigid(values, start)]
    if variation.parameter == "stiffness" and finite.size < values.size:
        finite = np.append(finite, start)
    if omega is None:
        omega = resonance_range(model, variation, settings.mode, finite)
    elif not isinstance(omega, tuple):
        raise ModelError("omega: give a range (from, to) in rad/s")
    kept = DamperSettings.of(
        **settings.part(PeakSettings), dof=settings.dof, variation=variation, span=omega
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
    from stickslip import _core

    solved = values
    if rigid is not None:
        # A rigid contact stands for two stiff ones.
        stiff = _is_rigid(values, rigid)
        pairs = [
            [rigid, 2.0 * rigid] if instead else [value]
            for value, instead in zip(values, stiff, strict=True)
        ]
        solved = np.concatenate([np.array(pair) for pair in pairs])
    try:
        peaks = _core.damper_curve(
            model.problem,
            settings.variation.varied(model),
            model.structure.index(settings.dof),
            solved,
            settings,
            progress,
        )
    except ModelError:
        raise
    except ValueError as error:
        raise ModelError(str(error)) from error
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
        for name in ("omega", "amplitude"):
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


def _one_of(**given: ArrayLike | None) -> tuple[Parameter, Float]:
    """Return the one parameter that is given, and its values."""
    names = [name for name in PARAMETERS if given[name] is not None]
    if len(names) != 1:
        got = f"{' and '.join(names)} are given" if names else "none is given"
        raise ModelError(f"slip_force, stiffness, level: {got}; give exactly one of them")
    (name,) = names
    try:
        values = np.atleast_1d(np.asarray(given[name]))
    except ValueError:
        raise ModelError(f"{name}: a ragged list; give one list of values") from None
    if values.dtype.kind not in "fiu" or values.ndim != 1 or not values.size:
        raise ModelError(f"{name}: give a list of at least one real number")
    numbers = np.array(values, dtype=np.float64)
    # Zero friction and zero stiffness are legal, no force is no response.
    low = numbers <= 0.0 if name == "level" else numbers < 0.0
    bad = np.flatnonzero(np.isnan(numbers) | low | ((name == "level") & np.isinf(numbers)))
    if bad.size:
        least = "finite factors above 0" if name == "level" else "values from 0 on"
        raise ModelError(f"{name}[{bad[0]}] is {numbers[bad[0]]:g}; give {least}")
    return name, numbers
