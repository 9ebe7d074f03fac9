"""Whether a steady state is the only one, as far as contact laws and damping tell."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import listed
from stickslip.model import Model
from stickslip.results.arrays import STABILITY, Arrays
from stickslip.results.diagnostic import Diagnostic, diagnostic

if TYPE_CHECKING:
    from stickslip import _core


def uniqueness(model: Model) -> Diagnostic | None:
    """Say that a solution need not be the only one, if contact laws or damping leave that open.

    The passive structure with laws that are monotone operators has one steady motion.
    """
    open_laws = list(dict.fromkeys(model.problem.laws_not_monotone))
    if open_laws:
        return diagnostic(
            "law-not-monotone",
            f"The contact law {listed(open_laws)} is not monotone in the motion: the solution may "
            "be unstable or not the only one.",
        )
    damping = model.structure.damping
    # Gyroscopic terms are skew and do no work: only the symmetric part takes energy out.
    symmetric = 0.5 * (damping + damping.T)
    diagonal = np.abs(np.diag(symmetric))
    scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    scaled = symmetric * scale * scale[:, None]
    # Rounding may put the zero eigenvalue of an undamped motion on either side.
    identity = np.eye(len(scaled))
    if _is_positive(scaled - 1e-13 * identity):
        return None
    if _is_positive(scaled + 1e-9 * identity):
        return diagnostic(
            "undamped-motion",
            "The damping leaves some motion undamped: a steady state that friction does not damp "
            "either may not be the only one.",
        )
    return diagnostic(
        "negative-damping",
        "The damping is negative for some motion: the solution may be unstable or not the only "
        "one.",
    )


def arrays_of(solution: _core.Solution, model: Model) -> Arrays:
    """Return the numbers of a curve; a motion that is the only one is stable."""
    arrays = Arrays.of(solution)
    if uniqueness(model) is not None:
        return arrays
    states = np.where(arrays.solved, STABILITY.index("stable"), STABILITY.index("not decided"))
    return replace(arrays, stability=states.astype(np.uint8))


def _is_positive(matrix: NDArray[np.float64]) -> bool:
    try:
        np.linalg.cholesky(matrix)
    except np.linalg.LinAlgError:
        return False
    return True
