"""What a search for peaks took for granted: along a parameter, or over many disks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stickslip.analyses.assumptions import LARGE_ERROR, direct_assumption
from stickslip.analyses.uniqueness import uniqueness
from stickslip.checks import listed
from stickslip.model import Model
from stickslip.results.diagnostic import Diagnostic, diagnostic, missed_tolerances, present
from stickslip.results.status import Status

if TYPE_CHECKING:
    from stickslip.results.damper_curve import DamperArrays
    from stickslip.results.mistuning import MistuningArrays
    from stickslip.settings.peaks import DamperSettings, MistuningSettings

__all__ = ["damper_assumptions", "peak_assumptions"]


def damper_assumptions(
    model: Model, settings: DamperSettings, arrays: DamperArrays, rigid: float | None
) -> tuple[Diagnostic, ...]:
    """Say what a damper curve took for granted.

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
    tuple of Diagnostic
        Those that do not apply are left out.
    """
    return present(
        (
            _range(settings, arrays),
            _common(settings),
            _rigid(rigid),
            *peak_assumptions(settings, arrays, "values"),
            _truncation(settings, arrays),
            uniqueness(model),
            direct_assumption(model),
        )
    )


def peak_assumptions(
    settings: DamperSettings | MistuningSettings, arrays: DamperArrays | MistuningArrays, noun: str
) -> tuple[Diagnostic | None, ...]:
    """Say what every search for peaks took for granted; `noun` is what it counts."""
    limited = int((arrays.status == Status.HARMONICS_LIMIT.code).sum())
    return (
        _harmonics(settings, arrays),
        diagnostic(
            "static-traction",
            f"A contact that never slips was taken to hold residual={settings.residual!r}.",
            residual=settings.residual,
        ),
        diagnostic(
            "harmonics-limit",
            f"{limited} {noun} at the limit of harmonics; raise max_harmonics.",
            count=limited,
        )
        if limited
        else None,
        missed_tolerances(arrays.status.ravel(), noun),
    )


def _range(settings: DamperSettings, arrays: DamperArrays) -> Diagnostic:
    low, high = settings.span
    where = f"The peak is the highest point from {low:.6g} to {high:.6g} rad/s"
    at_edge = int(arrays.at_edge.sum())
    if not at_edge:
        return diagnostic("peak-range", f"{where}.", low=low, high=high)
    return diagnostic(
        "peak-at-edge",
        f"{where}; at {at_edge} of {arrays.value.size} values it lies at an end of this range, and "
        "the response may be higher outside: widen omega.",
        low=low,
        high=high,
        count=at_edge,
    )


def _common(settings: DamperSettings) -> Diagnostic | None:
    variation = settings.variation
    names = listed(variation.names)
    if variation.parameter == "level":
        text = "The level multiplies every force, static ones included."
    elif len(variation.contacts) < 2:
        return None
    elif variation.common == "factor":
        text = f"Each of {names} has its own {variation.parameter} times the factor."
    else:
        text = f"All of {names} have the same {variation.parameter}."
    return diagnostic("varied-together", text)


def _rigid(rigid: float | None) -> Diagnostic | None:
    if rigid is None:
        return None
    return diagnostic(
        "rigid-limit",
        f"Stiffnesses above {2.0 * rigid:.4g} N/m were not solved: an infinite stiffness is the "
        f"limit of {rigid:.4g} and {2.0 * rigid:.4g} N/m, some hundred times the stiffness of the "
        "structure at the contact, taken as linear in 1/k_d, and finite ones lie on the same line; "
        "the error estimate holds the whole last change.",
        stiffness=rigid,
    )


def _harmonics(
    settings: DamperSettings | MistuningSettings, arrays: DamperArrays | MistuningArrays
) -> Diagnostic | None:
    kept = arrays.harmonics[arrays.solved]
    if not kept.size:
        return None
    low, high = int(kept.min()), int(kept.max())
    text = f"Harmonics up to {settings.harmonics} were kept."
    if settings.harmonics == "auto":
        several = "" if low == high else f", at some peaks only up to {low}"
        text = (
            f"Harmonics up to {high} were kept{several}, chosen at each peak to a tolerance of "
            f"{settings.tolerance:g}."
        )
    return diagnostic("harmonics", text, least=low, most=high)


def _truncation(settings: DamperSettings, arrays: DamperArrays) -> Diagnostic | None:
    known = arrays.solved & (arrays.amplitude > 0.0)
    if not known.any():
        return None
    share = arrays.error_estimate[known] / arrays.amplitude[known]
    worst = int(np.nan_to_num(share, nan=0.0).argmax())
    if not share[worst] > LARGE_ERROR:
        return None
    value = float(arrays.value[known][worst])
    return diagnostic(
        "truncation",
        f"The discarded harmonics could still change the peak by {share[worst]:.1%} at "
        f"{settings.variation.parameter} = {value:.6g}, the worst value; keep more harmonics.",
        share=float(share[worst]),
        value=value,
    )
