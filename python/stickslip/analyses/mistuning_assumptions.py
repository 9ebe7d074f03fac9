"""What a mistuning study took for granted, in words."""

from __future__ import annotations

from collections import Counter

import numpy as np

from stickslip.analyses.assumptions import LARGE_ERROR
from stickslip.analyses.mistuning_settings import MistuningSettings
from stickslip.results.mistuning_arrays import MistuningArrays
from stickslip.results.status import Status

__all__ = ["mistuning_assumptions"]


def mistuning_assumptions(
    settings: MistuningSettings, arrays: MistuningArrays, dofs: tuple[str, ...]
) -> tuple[str, ...]:
    """Say what a mistuning study took for granted, one text per assumption.

    Parameters
    ----------
    settings : MistuningSettings
        How it was computed.
    arrays : MistuningArrays
        What came out.
    dofs : tuple of str
        The degrees of freedom studied.

    Returns
    -------
    tuple of str
        One sentence or two each; those that do not apply are left out.
    """
    texts = (
        _patterns(settings),
        "The stiffness of whole sectors deviates; couplings, contacts and forces do not.",
        _range(settings, arrays),
        _harmonics(settings, arrays),
        f"A contact that never slips was taken to hold residual={settings.residual!r}.",
        _truncation(arrays, dofs),
        _failures(arrays),
    )
    return tuple(text for text in texts if text)


def _patterns(settings: MistuningSettings) -> str:
    if settings.distribution is None:
        return "The patterns were given, in units of the standard deviation."
    return (
        f"Patterns were drawn from a {settings.distribution} distribution of zero mean and unit "
        f"deviation with seed {settings.seed}; those of a single disk have others."
    )


def _range(settings: MistuningSettings, arrays: MistuningArrays) -> str:
    low, high = settings.span
    where = f"Peaks are the highest points from {low:.6g} to {high:.6g} rad/s"
    at_edge, tuned = int(arrays.at_edge.sum()), int(arrays.tuned_at_edge.sum())
    if not at_edge and not tuned:
        return f"{where}."
    return (
        f"{where}; {at_edge} of {arrays.at_edge.size}, and of the tuned disk {tuned} of "
        f"{arrays.tuned_at_edge.size}, lie at an end of this range, and the response may be higher "
        "outside: widen omega."
    )


def _harmonics(settings: MistuningSettings, arrays: MistuningArrays) -> str:
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


def _truncation(arrays: MistuningArrays, dofs: tuple[str, ...]) -> str:
    known = arrays.solved
    if not known.any():
        return ""
    share = np.where(known, arrays.error_estimate / arrays.amplitude, 0.0)
    tuned = arrays.tuned_error_estimate / arrays.tuned_amplitude
    share = share + tuned[np.newaxis, :, np.newaxis, :]
    worst = np.unravel_index(share.argmax(), share.shape)
    if not share[worst] > LARGE_ERROR:
        return ""
    return (
        f"The discarded harmonics could still change amplification factors by up to "
        f"{share[worst]:.1%} (dof {dofs[worst[-1]]!r}); keep more harmonics."
    )


def _failures(arrays: MistuningArrays) -> str:
    counts = Counter(Status.from_code(int(code)) for code in arrays.status.ravel())
    failed = [f"{count} {status}" for status, count in counts.items() if status != "converged"]
    if not failed:
        return ""
    return f"Of {arrays.status.size} peaks not all met every tolerance: {', '.join(failed)}."
