"""Whether a steady state is the only one, as far as contact laws and damping tell."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stickslip.analyses.texts import told
from stickslip.checks import listed
from stickslip.model import Model
from stickslip.results.diagnostic import Diagnostic


def uniqueness(model: Model) -> Diagnostic | None:
    """Say that a solution need not be the only one, if contact laws or damping leave that open.

    The passive structure with laws that are monotone operators has one steady motion.
    """
    open_laws = list(dict.fromkeys(model.problem.laws_not_monotone))
    if open_laws:
        return told("law-not-monotone", _laws=listed(open_laws))
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
        return told("undamped-motion")
    return told("negative-damping")


def _is_positive(matrix: NDArray[np.float64]) -> bool:
    try:
        np.linalg.cholesky(matrix)
    except np.linalg.LinAlgError:
        return False
    return True
