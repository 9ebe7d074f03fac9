"""What a search for peaks took for granted: along a parameter, or over many disks."""

from __future__ import annotations

import numpy as np

from stickslip.analyses.assumptions import LARGE_ERROR, bounds_of, direct_assumption
from stickslip.analyses.doubts import doubts, few_modes, mistuning_unit, structure_doubts
from stickslip.analyses.texts import told
from stickslip.checks import listed
from stickslip.model import Model
from stickslip.results.damper_curve import DamperArrays
from stickslip.results.diagnostic import Diagnostic, missed_tolerances, present
from stickslip.results.fields import Bool
from stickslip.results.mistuning import MistuningArrays
from stickslip.results.status import Status
from stickslip.settings.peaks import DamperSettings, MistuningSettings
from stickslip.settings.variation import Variation


def damper_assumptions(
    model: Model, settings: DamperSettings, arrays: DamperArrays, rigid: float | None
) -> tuple[Diagnostic, ...]:
    """Say what a damper curve took for granted; `rigid` is the stiffness taken for a rigid one."""
    at_edge = f"at {arrays.at_edge.sum()} of {arrays.value.size} values it lies"
    return present(
        (
            _range(settings, "The peak is the highest point", at_edge, arrays.at_edge),
            _common(settings.variation),
            rigid is not None and told("rigid-limit", stiffness=rigid, _twice=2.0 * rigid),
            *_peaks(settings, arrays, "values"),
            _truncation_of_peaks(settings, arrays),
            settings.bounds and bounds_of(arrays, "bounds/peaks"),
            *doubts(model, peaks=True),
            few_modes(model, arrays.omega),
            direct_assumption(model),
        )
    )


def mistuning_assumptions(
    disk: Model, settings: MistuningSettings, arrays: MistuningArrays, dofs: tuple[str, ...]
) -> tuple[Diagnostic, ...]:
    """Say what a mistuning study took for granted."""
    at_edge = (
        f"{arrays.at_edge.sum()} of {arrays.at_edge.size}, and of the tuned disk "
        f"{arrays.tuned_at_edge.sum()} of {arrays.tuned_at_edge.size}, lie"
    )
    edges = np.concatenate((arrays.at_edge.ravel(), arrays.tuned_at_edge.ravel()))
    drawn = settings.distribution
    return present(
        (
            told("patterns/given")
            if drawn is None
            else told("patterns", distribution=drawn, seed=int(settings.seed or 0)),
            told("deviations"),
            _range(settings, "Peaks are the highest points", at_edge, edges),
            *_peaks(settings, arrays, "peaks"),
            _truncation_of_factors(arrays, dofs),
            _deviations(arrays),
            *structure_doubts(disk),
            few_modes(disk, arrays.omega),
        )
    )


def _deviations(arrays: MistuningArrays) -> Diagnostic | None:
    """Say that the root mean square of the blades' deviations looks like percents."""
    typical = float(arrays.deviation.max() * np.sqrt(np.mean(arrays.patterns**2)))
    return mistuning_unit(typical, "The stiffness of a typical blade")


def _peaks(
    settings: DamperSettings | MistuningSettings, arrays: DamperArrays | MistuningArrays, noun: str
) -> tuple[Diagnostic | bool | None, ...]:
    """Say what every search for peaks took for granted; `noun` is what it counts."""
    limited = int((arrays.status == Status.HARMONICS_LIMIT.code).sum())
    return (
        _harmonics(settings, arrays),
        told("static-traction/peaks", residual=settings.residual),
        limited > 0 and told("harmonics-limit", count=limited, _noun=noun),
        missed_tolerances(arrays.status.ravel(), noun),
    )


def _range(
    settings: DamperSettings | MistuningSettings, what: str, at_edge: str, edges: Bool
) -> Diagnostic:
    low, high = settings.span
    count = int(edges.sum())
    if not count:
        return told("peak-range", low=low, high=high, _what=what)
    return told("peak-at-edge", low=low, high=high, count=count, _what=what, _at_edge=at_edge)


def _common(variation: Variation) -> Diagnostic | None:
    if variation.parameter == "level":
        return told("varied-together/level")
    if len(variation.contacts) < 2:
        return None
    return told(
        "varied-together/factor" if variation.common == "factor" else "varied-together",
        _names=listed(variation.names),
        _parameter=variation.parameter,
    )


def _harmonics(
    settings: DamperSettings | MistuningSettings, arrays: DamperArrays | MistuningArrays
) -> Diagnostic | None:
    kept = arrays.harmonics[arrays.solved]
    if not kept.size:
        return None
    least, most = int(kept.min()), int(kept.max())
    if settings.harmonics != "auto":
        return told("harmonics/peaks", least=least, most=most)
    several = "" if least == most else f", at some peaks only up to {least}"
    return told(
        "harmonics/chosen",
        least=least,
        most=most,
        _several=several,
        _tolerance=settings.tolerance,
    )


def _truncation_of_peaks(settings: DamperSettings, arrays: DamperArrays) -> Diagnostic | None:
    known = arrays.solved & (arrays.amplitude > 0.0)
    if not known.any():
        return None
    share = arrays.error_estimate[known] / arrays.amplitude[known]
    worst = int(np.nan_to_num(share, nan=0.0).argmax())
    if not share[worst] > LARGE_ERROR:
        return None
    value = float(arrays.value[known][worst])
    parameter = settings.variation.parameter
    return told("truncation/peak", share=float(share[worst]), value=value, _parameter=parameter)


def _truncation_of_factors(arrays: MistuningArrays, dofs: tuple[str, ...]) -> Diagnostic | None:
    known = arrays.solved
    if not known.any():
        return None
    share = np.where(known, arrays.error_estimate / arrays.amplitude, 0.0)
    tuned = arrays.tuned_error_estimate / arrays.tuned_amplitude
    share = share + tuned[np.newaxis, :, np.newaxis, :]
    worst = np.unravel_index(share.argmax(), share.shape)
    if not share[worst] > LARGE_ERROR:
        return None
    return told("truncation/factors", dof=dofs[worst[-1]], share=float(share[worst]))
