"""What a search for peaks took for granted: along a parameter, or over many disks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stickslip.analyses.assumptions import LARGE_ERROR, direct_assumption
from stickslip.analyses.uniqueness import uniqueness
from stickslip.checks import listed
from stickslip.model import Model
from stickslip.results.arrays import Bool
from stickslip.results.diagnostic import Diagnostic, diagnostic, missed_tolerances, present
from stickslip.results.status import Status

if TYPE_CHECKING:
    from stickslip.results.damper_curve import DamperArrays
    from stickslip.results.mistuning import MistuningArrays
    from stickslip.settings.peaks import DamperSettings, MistuningSettings

__all__ = ["damper_assumptions", "mistuning_assumptions"]


def damper_assumptions(
    model: Model, settings: DamperSettings, arrays: DamperArrays, rigid: float | None
) -> tuple[Diagnostic, ...]:
    """Say what a damper curve took for granted; `rigid` is the stiffness taken for a rigid one."""
    at_edge = f"at {arrays.at_edge.sum()} of {arrays.value.size} values it lies"
    return present(
        (
            _range(settings, "The peak is the highest point", at_edge, arrays.at_edge),
            _common(settings),
            rigid is not None
            and diagnostic(
                "rigid-limit",
                f"Stiffnesses above {2.0 * rigid:.4g} N/m were not solved: an infinite stiffness "
                f"is the limit of {rigid:.4g} and {2.0 * rigid:.4g} N/m, some hundred times the "
                "stiffness of the structure at the contact, taken as linear in 1/k_d, and finite "
                "ones lie on the same line; the error estimate holds the whole last change.",
                stiffness=rigid,
            ),
            *_peaks(settings, arrays, "values"),
            _truncation_of_peaks(settings, arrays),
            uniqueness(model),
            direct_assumption(model),
        )
    )


def mistuning_assumptions(
    settings: MistuningSettings, arrays: MistuningArrays, dofs: tuple[str, ...]
) -> tuple[Diagnostic, ...]:
    """Say what a mistuning study took for granted."""
    at_edge = (
        f"{arrays.at_edge.sum()} of {arrays.at_edge.size}, and of the tuned disk "
        f"{arrays.tuned_at_edge.sum()} of {arrays.tuned_at_edge.size}, lie"
    )
    edges = np.concatenate((arrays.at_edge.ravel(), arrays.tuned_at_edge.ravel()))
    return present(
        (
            diagnostic("patterns", "The patterns were given, in units of the standard deviation.")
            if settings.distribution is None
            else diagnostic(
                "patterns",
                f"Patterns were drawn from a {settings.distribution} distribution of zero mean and "
                f"unit deviation with seed {settings.seed}; those of a single disk have others.",
                distribution=settings.distribution,
                seed=int(settings.seed or 0),
            ),
            diagnostic(
                "deviations",
                "The stiffness of whole sectors deviates; couplings, contacts and forces do not.",
            ),
            _range(settings, "Peaks are the highest points", at_edge, edges),
            *_peaks(settings, arrays, "peaks"),
            _truncation_of_factors(arrays, dofs),
        )
    )


def _peaks(
    settings: DamperSettings | MistuningSettings, arrays: DamperArrays | MistuningArrays, noun: str
) -> tuple[Diagnostic | bool | None, ...]:
    """Say what every search for peaks took for granted; `noun` is what it counts."""
    limited = int((arrays.status == Status.HARMONICS_LIMIT.code).sum())
    return (
        _harmonics(settings, arrays),
        diagnostic(
            "static-traction",
            f"A contact that never slips was taken to hold residual={settings.residual!r}.",
            residual=settings.residual,
        ),
        limited > 0
        and diagnostic(
            "harmonics-limit",
            f"{limited} {noun} at the limit of harmonics; raise max_harmonics.",
            count=limited,
        ),
        missed_tolerances(arrays.status.ravel(), noun),
    )


def _range(
    settings: DamperSettings | MistuningSettings, what: str, at_edge: str, edges: Bool
) -> Diagnostic:
    low, high = settings.span
    where = f"{what} from {low:.6g} to {high:.6g} rad/s"
    if not edges.any():
        return diagnostic("peak-range", f"{where}.", low=low, high=high)
    return diagnostic(
        "peak-at-edge",
        f"{where}; {at_edge} at an end of this range, and the response may be higher outside: "
        "widen omega.",
        low=low,
        high=high,
        count=int(edges.sum()),
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


def _truncation_of_peaks(settings: DamperSettings, arrays: DamperArrays) -> Diagnostic | None:
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
    return diagnostic(
        "truncation",
        f"The discarded harmonics could still change amplification factors by up to "
        f"{share[worst]:.1%} (dof {dofs[worst[-1]]!r}); keep more harmonics.",
        dof=dofs[worst[-1]],
        share=float(share[worst]),
    )
