"""The damper that makes a peak least."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace

import numpy as np

from stickslip import _core
from stickslip.analyses.arguments import highest_harmonic
from stickslip.analyses.damper_curve import curve_of, settings_for
from stickslip.analyses.forced_response import forced_response
from stickslip.analyses.run import Progress, Run, refusals
from stickslip.analyses.texts import told
from stickslip.analyses.variation import chosen_contacts, local_stiffness, variation_of
from stickslip.errors import ModelError
from stickslip.interruption import stopped
from stickslip.model import Model
from stickslip.model.contact import Contact
from stickslip.results.arrays import amplitude_of
from stickslip.results.damper_curve import DamperArrays, DamperCurve, LeastPeak
from stickslip.results.diagnostic import Diagnostic, present
from stickslip.results.optimal_damper import OptimalDamper
from stickslip.settings.peaks import DamperSettings, OptimumKeys
from stickslip.settings.settings import configured
from stickslip.settings.variation import COULOMB, Chosen, Variation, located

STICKS = 1.0
"""Upper bound of a slip force, over the largest force of the stuck contact: from it on nothing
slips, and the peak does not change any more."""
SLIDES = 1e-3
"""Lower bound, likewise, unless a share of the load lies lower."""
LOAD = (0.03, 1e4)
"""Bounds of a slip force, over what stuck contacts bear at the low end of the range, away from
their resonance: the scale of the load, to which the best slip force belongs however light the
damping is. That at resonance rises as the damping falls."""
STIFFNESSES = (1e-2, 250.0)
"""Bounds of a stiffness, over that of the structure at the contact."""


@configured(OptimumKeys)
def optimal_damper(
    model: Model, *, settings: OptimumKeys, progress: Progress = None
) -> OptimalDamper:
    """Find the slip force, stiffness or level at which the peak of a response is least.

    A curve of 40 values shows the local minima; each is closed in on with the exact derivative of
    the peak. The peak is continuous in the parameter, with kinks where two maxima of the response
    swap, and often least in a kink; such a minimum is found as the crossing of two tangents. With
    automatic harmonics minima count as one if the rise between them is below twice the tolerance.
    All contacts that are varied have one common value or factor.

    Returns
    -------
    OptimalDamper
        The least peak, all local minima, and the curve.

    Raises
    ------
    ModelError
        If no peak is found.
    Interrupted
        That is the curve.
    """
    variation = variation_of(model, settings.parameter, settings)
    given = settings.bounds
    if given is None and settings.parameter == "stiffness":
        given = _stiffness_bounds(model, variation)
    if given is None and settings.parameter in COULOMB:
        raise _unbounded(f"there is no default for the {settings.parameter}; give")
    kept = settings_for(model, variation, np.array(given or (1.0,)), settings)
    spans = [given] if given else _load_bounds(model, variation, kept)
    with Run("optimal damper", progress, model) as run:
        result = _least(model, variation, kept, spans[0], run)
        # The scale of the load is too small where the structure hardly passes it on to contacts.
        if result.at_bound and spans[1:]:
            with _keeping(result.curve):
                result = _least(model, variation, kept, spans[1], run)
        return run.completed(result, "optimal damper")


def _unbounded(reason: str) -> ModelError:
    return ModelError(
        f"bounds: {reason} bounds=(lowest, highest)",
        study=f"bounds: {reason} bounds = [lowest, highest]",
    )


@contextmanager
def _keeping(known: DamperCurve) -> Iterator[None]:
    """Leave a search that is stopped with the curve before it, unless its own has more values."""
    try:
        yield
    except KeyboardInterrupt as stop:
        own = getattr(stop, "result", None)
        if isinstance(own, DamperCurve) and own.values.size >= known.values.size:
            raise
        curve = replace(known, interrupted=True)
        raise stopped("optimal damper", f"{known.values.size} peaks", curve) from None


def _least(
    model: Model,
    variation: Variation,
    settings: DamperSettings,
    bounds: tuple[float, float],
    run: Run,
) -> OptimalDamper:
    """Return the least peak between two bounds."""
    with refusals(model):
        minima, peaks = _core.optimal_damper(
            model.problem,
            variation.varied(model),
            model.structure.index(settings.dof),
            bounds,
            settings,
            run,
        )
    curve = curve_of(model, settings, (DamperArrays.of(peaks), peaks))
    if curve.interrupted:
        raise stopped("optimal damper", f"{curve.values.size} peaks", curve)
    rows = zip(*(minima.columns[name] for name in LeastPeak._fields), strict=True)
    found = tuple(LeastPeak(*map(float, row)) for row in rows)
    if not found:
        low, high = bounds
        raise ModelError(
            f"optimal damper: {curve.arrays.solved.sum()} peaks were found between {low:g} and "
            f"{high:g}, none of them a minimum; try other bounds, or damper_curve for the "
            "status of each value"
        )
    result = OptimalDamper.of(found, bounds, curve, ())
    return replace(result, diagnostics=_diagnostics(result))


def _diagnostics(result: OptimalDamper) -> tuple[Diagnostic, ...]:
    low, high = result.bounds
    behind = result.curve.settings.variation.behind
    return present(
        (
            told("coarse-search", low=low, high=high, _behind=behind),
            result.at_bound and told("optimum-at-bound", value=result.value),
            *result.curve.diagnostics,
        )
    )


def _stiffness_bounds(model: Model, variation: Variation) -> tuple[float, float]:
    """Return bounds around the stiffness of the structure."""
    of_structure = _factor if variation.common == "factor" else local_stiffness
    stiffness = of_structure(model, variation.contacts)
    return STIFFNESSES[0] * stiffness, STIFFNESSES[1] * stiffness


def _load_bounds(
    model: Model, variation: Variation, settings: DamperSettings
) -> list[tuple[float, float]]:
    """Return bounds around the scale of the load, and to where nothing slips if that is farther."""
    load, ratio = _stuck_forces(model, variation, settings)
    if not ratio > 0.0:
        raise _unbounded(
            "the contacts bear no force while they stick, so that friction does nothing; check the "
            "forces, or give"
        )
    low, high = SLIDES * ratio, STICKS * ratio
    spans = [(low, high)]
    if load > 0.0:
        low = min(low, LOAD[0] * load)
        spans = [(low, min(high, LOAD[1] * load)), (low, high)]
    by_level = variation.parameter == "level"
    spans = [(1.0 / high, 1.0 / low) if by_level else (low, high) for low, high in spans]
    return spans[:1] if spans[0] == spans[-1] else spans


def _factor(model: Model, contacts: Iterable[Chosen]) -> float:
    """Return the factor that makes contacts as stiff as the structure."""
    factors, springs = [], []
    for ref in contacts:
        contact = model.contacts[located(model, ref)[0]]
        if "stiffness" in contact.factors:
            factors.append(_matrix_factor(model, ref, contact))
        else:
            springs.append(contact.adjustable()["stiffness"][0])
    stiffest = max(springs, default=0.0)
    if stiffest > 0.0:
        factors.append(local_stiffness(model, contacts) / stiffest)
    if not factors or not 0.0 < max(factors) < np.inf:
        raise ModelError("bounds: no factor on a stiffness of 0 changes it; vary its value")
    return max(factors)


def _matrix_factor(model: Model, ref: Chosen, contact: Contact) -> float:
    """Return the inverse of the largest product of a stiffness matrix with a flexibility."""
    held = local_stiffness(model, [ref]) / max(
        float(contact.stuck_stiffness.diagonal().max()), 1e-300
    )
    stiffness = model.structure.stiffness
    try:
        flexibility = sum(
            rows @ np.linalg.solve(stiffness, rows.T) for rows in model.contact_rows(contact)
        )
    except np.linalg.LinAlgError:
        return held
    product = float(np.linalg.eigvals(contact.stuck_stiffness @ flexibility).real.max())
    # Of a structure that is nearly free, rounding decides.
    return 1.0 / product if 0.0 < product * held < 1e10 else held


def _stuck_forces(
    model: Model, variation: Variation, settings: DamperSettings
) -> tuple[float, float]:
    """Return the largest force of a stuck contact at the low end of the range, and anywhere [N].

    Over its own slip force, if that counts.
    """
    varied = variation.contacts or chosen_contacts(model, "slip_force", None, "value")
    stuck = Variation(parameter="slip_force", contacts=varied).apply(model, np.inf)
    harmonics = highest_harmonic(model)
    response = forced_response(stuck, settings.span, harmonics, observe=[settings.dof])
    load = largest = 0.0
    for ref in varied:
        position, point = model.slider(ref)
        place = min(point, model.contacts[position].points - 1)
        column = response.arrays.contact_force[:, :, response._columns(position, place)][:, :, 0]
        share = model.contacts[position].slider_shares[point]
        forces = share * amplitude_of(np.ascontiguousarray(column), "half_range")
        start = forces[np.isfinite(forces)][:1].sum()
        relative = variation.common == "factor" or variation.parameter == "level"
        own = model.contacts[position].slider_limits[point]
        if relative and not 0.0 < own < np.inf:
            continue
        scale = own if relative else 1.0
        load = max(load, float(start) / scale)
        largest = max(largest, float(np.nanmax(forces)) / scale)
    return load, largest
