"""What a damper curve took for granted, in words."""

from __future__ import annotations

from collections import Counter

import numpy as np

from stickslip.analyses.assumptions import LARGE_ERROR, direct_assumption
from stickslip.analyses.damper_settings import DamperSettings
from stickslip.analyses.uniqueness import damping_assumption
from stickslip.checks import listed
from stickslip.model import Model
from stickslip.results.damper_curve import DamperArrays
from stickslip.results.status import Status

__all__ = ["damper_assumptions"]


def damper_assumptions(
    model: Model, settings: DamperSettings, arrays: DamperArrays, rigid: float | None
) -> tuple[str, ...]:
    """Say what a damper curve took for granted, one text per assumption.

    Parameters
    ----------
    model : Model
        What was computed.
    settings : DamperSettings
        How.
    arrays : DamperArrays
        What came out.
    rigid : float or None
        The stiffness that stands for a rigid contact, if there is one [N/m].

    Returns
    -------
    tuple of str
        One sentence or two each; those that do not apply are left out.
    """
    texts = (
        _range(settings, arrays),
        _common(settings),
        _rigid(rigid),
        _harmonics(settings, arrays),
        f"A contact that never slips was taken to hold residual={settings.residual!r}.",
        _truncation(settings, arrays),
        damping_assumption(model.structure.damping),
        direct_assumption(model),
        _failures(arrays),
    )
    return tuple(text for text in texts if text)


def _range(settings: DamperSettings, arrays: DamperArrays) -> str:
    low, high = settings.span
    where = f"The peak is the highest point from {low:.6g} to {high:.6g} rad/s"
    at_edge = int(arrays.at_edge.sum())
    if not at_edge:
        return f"{where}."
    return (
        f"{where}; at {at_edge} of {arrays.value.size} values it lies at an end of this range, and "
        "the response may be higher outside: widen omega."
    )


def _common(settings: DamperSettings) -> str:
    variation = settings.variation
    if variation.parameter == "level":
        return "The level multiplies every force, static ones included."
    if len(variation.contacts) < 2:
        return ""
    names = listed(variation.names)
    if variation.common == "factor":
        return f"Each of {names} has its own {variation.parameter} times the factor."
    return f"All of {names} have the same {variation.parameter}."


def _rigid(rigid: float | None) -> str:
    if rigid is None:
        return ""
    return (
        f"Stiffnesses above {2.0 * rigid:.4g} N/m were not solved: an infinite stiffness is the "
        f"limit of {rigid:.4g} and {2.0 * rigid:.4g} N/m, some hundred times the stiffness of the "
        "structure at the contact, taken as linear in 1/k_d, and finite ones lie on the same line; "
        "the error estimate holds the whole last change."
    )


def _harmonics(settings: DamperSettings, arrays: DamperArrays) -> str:
    kept = arrays.harmonics[arrays.solved]
    if not kept.size:
        return ""
    if settings.harmonics == "auto":
        low, high = kept.min(), kept.max()
        several = "" if low == high else f", at some peaks only up to {low}"
        return (
            f"Harmonics up to {high} were kept{several}, chosen at each peak to a tolerance of "
            f"{settings.tolerance:g}."
        )
    return f"Harmonics up to {settings.harmonics} were kept."


def _truncation(settings: DamperSettings, arrays: DamperArrays) -> str:
    known = arrays.solved & (arrays.amplitude > 0.0)
    if not known.any():
        return ""
    share = arrays.error_estimate[known] / arrays.amplitude[known]
    worst = int(np.nan_to_num(share, nan=0.0).argmax())
    if not share[worst] > LARGE_ERROR:
        return ""
    return (
        f"The discarded harmonics could still change the peak by {share[worst]:.1%} at "
        f"{settings.variation.parameter} = {arrays.value[known][worst]:.6g}, the worst value; keep "
        "more harmonics."
    )


def _failures(arrays: DamperArrays) -> str:
    counts = Counter(Status.from_code(int(code)) for code in arrays.status)
    failed = [f"{count} {status}" for status, count in counts.items() if status != "converged"]
    if not failed:
        return ""
    return f"Of {arrays.value.size} values not all met every tolerance: {', '.join(failed)}."
