"""What of a model leaves open whether its steady motion is the only one, and stable."""

from __future__ import annotations

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
    damped = model.structure.is_damped
    if damped is None:
        return told("undamped-motion")
    return None if damped else told("negative-damping")


def instability(model: Model) -> Diagnostic | None:
    """Say that the stiffness lets motions grow that nothing but contacts and inertia hold."""
    dof = model.structure.unstable_dof
    return None if dof is None else told("negative-stiffness", dof=dof)


def is_unique(model: Model) -> bool:
    """Tell whether the steady motion is known to be the only one, and stable."""
    return uniqueness(model) is None and instability(model) is None
