"""What a harmonic balance took for granted at the contacts, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stickslip.model import Model, StructuralDamper
from stickslip.results.arrays import Arrays
from stickslip.results.diagnostic import Diagnostic, diagnostic

if TYPE_CHECKING:
    from stickslip.settings.balance import ForcedSettings
    from stickslip.settings.orbits import ExactSettings

__all__ = ["contact_assumptions", "residual_assumption", "start_assumption"]


def contact_assumptions(
    model: Model, settings: ForcedSettings, arrays: Arrays
) -> tuple[Diagnostic | None, ...]:
    """Say what was assumed of residual forces, starts and sampling; None where nothing was."""
    return (
        residual_assumption(model, settings, arrays),
        start_assumption(model),
        _evaluation(model, settings, arrays),
    )


def residual_assumption(
    model: Model, settings: ForcedSettings | ExactSettings, arrays: Arrays
) -> Diagnostic | None:
    """Say what contacts that never slip were taken to hold."""
    stuck = (arrays.slip_fraction[arrays.solved] == 0.0).any(axis=1)
    if all(contact.points > 1 for contact in model.contacts) or not stuck.any():
        return None
    held = {
        "centred": "no force at mid-range of its displacement",
        "from_rest": "the force it built up from zero displacement",
    }.get(str(settings.residual), f"{settings.residual} N at mid-range of its displacement")
    return diagnostic(
        "static-traction",
        f"A contact that never slips was taken to hold {held} (residual={settings.residual!r}, "
        f"of effect at {stuck.sum()} of {stuck.size} points); residual_bounds gives what it could "
        "hold.",
        residual=settings.residual,
        points=int(stuck.sum()),
    )


def start_assumption(model: Model) -> Diagnostic | None:
    """Say how dampers of several points begin, and what holds them."""
    several = [one for one in model.contacts if isinstance(one, StructuralDamper)]
    if not several:
        return None
    held = [
        f"the rows of the stiffness of {one.name!r} do not sum to zero ({one.grounding:.3g} N/m): "
        "it is also held by the ground, and its forces have a resultant"
        for one in several
        if one.grounding
    ]
    told = [
        "The march through a damper of several points begins without slip, so that points which "
        "never slip hold what they built up from zero displacement, and no mean force where the "
        "motion is half-wave symmetric",
        *held,
    ]
    return diagnostic("start-of-march", f"{'; '.join(told)}.")


def _evaluation(model: Model, settings: ForcedSettings, arrays: Arrays) -> Diagnostic | None:
    if settings.march is None or not model.contacts:
        return None
    taken = arrays.samples[arrays.solved]
    if not taken.size:
        return None
    least, most = int(taken.min()), int(taken.max())
    count = f"{least}" if least == most else f"{least} to {most}"
    chosen = (
        f", chosen per point to a quarter of the tolerance of {settings.tolerance:g}"
        if settings.march == "auto"
        else ""
    )
    return diagnostic(
        "samples",
        f"The contact forces were marched through {count} samples per period{chosen}; the error "
        "of the sampling is part of the error estimate.",
        least=least,
        most=most,
    )
