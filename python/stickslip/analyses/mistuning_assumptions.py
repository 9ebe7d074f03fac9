"""What a mistuning study took for granted."""

from __future__ import annotations

import numpy as np

from stickslip.analyses.assumptions import LARGE_ERROR
from stickslip.analyses.damper_assumptions import peak_assumptions
from stickslip.results.diagnostic import Diagnostic, diagnostic, present
from stickslip.results.mistuning import MistuningArrays
from stickslip.settings.peaks import MistuningSettings

__all__ = ["mistuning_assumptions"]


def mistuning_assumptions(
    settings: MistuningSettings, arrays: MistuningArrays, dofs: tuple[str, ...]
) -> tuple[Diagnostic, ...]:
    """Say what a mistuning study took for granted.

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
    tuple of Diagnostic
        Those that do not apply are left out.
    """
    return present(
        (
            _patterns(settings),
            diagnostic(
                "deviations",
                "The stiffness of whole sectors deviates; couplings, contacts and forces do not.",
            ),
            _range(settings, arrays),
            *peak_assumptions(settings, arrays, "peaks"),
            _truncation(arrays, dofs),
        )
    )


def _patterns(settings: MistuningSettings) -> Diagnostic:
    if settings.distribution is None:
        return diagnostic(
            "patterns", "The patterns were given, in units of the standard deviation."
        )
    return diagnostic(
        "patterns",
        f"Patterns were drawn from a {settings.distribution} distribution of zero mean and unit "
        f"deviation with seed {settings.seed}; those of a single disk have others.",
        distribution=settings.distribution,
        seed=int(settings.seed or 0),
    )


def _range(settings: MistuningSettings, arrays: MistuningArrays) -> Diagnostic:
    low, high = settings.span
    where = f"Peaks are the highest points from {low:.6g} to {high:.6g} rad/s"
    at_edge, tuned = int(arrays.at_edge.sum()), int(arrays.tuned_at_edge.sum())
    if not at_edge and not tuned:
        return diagnostic("peak-range", f"{where}.", low=low, high=high)
    return diagnostic(
        "peak-at-edge",
        f"{where}; {at_edge} of {arrays.at_edge.size}, and of the tuned disk {tuned} of "
        f"{arrays.tuned_at_edge.size}, lie at an end of this range, and the response may be higher "
        "outside: widen omega.",
        low=low,
        high=high,
        count=at_edge + tuned,
    )


def _truncation(arrays: MistuningArrays, dofs: tuple[str, ...]) -> Diagnostic | None:
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
