"""What an analysis took for granted, and what to look at before its numbers are used."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from stickslip.analyses.uniqueness import uniqueness
from stickslip.model import Model, StructuralDamper, natural_frequencies
from stickslip.results.arrays import Arrays, amplitude_of
from stickslip.results.diagnostic import Diagnostic, diagnostic, missed_tolerances, present
from stickslip.results.status import Status

if TYPE_CHECKING:
    from stickslip import _core
    from stickslip.settings.balance import ForcedSettings
    from stickslip.settings.entries import Span
    from stickslip.settings.motion import TransientSettings
    from stickslip.settings.orbits import ExactSettings

__all__ = [
    "LARGE_ERROR",
    "balance_assumptions",
    "direct_assumption",
    "orbit_assumptions",
    "transient_assumptions",
    "turn_per_step",
]

LARGE_ERROR = 0.05
"""Share of the amplitude above which the discarded harmonics are worth a warning."""

COARSE_TURN = 0.5
"""Angle per Runge-Kutta step above which a motion loses accuracy noticeably [rad]."""

_SHOWN = 6
_BASES = {
    "stuck modes": (
        "The damping is proportional on the stuck structure: the compliance is the sum over its "
        "real modes."
    ),
    "free modes": (
        "The damping is proportional on the free structure: the compliance is the sum over its "
        "real modes, the stuck contacts added exactly."
    ),
    "complex modes": (
        "The damping matrix couples the modes, or rounding leaves open whether it does: the "
        "compliance is the sum over the complex modes of the stuck structure."
    ),
    "waves": (
        "All sectors are equal and move alike, one after the other: harmonic k of the motion meets "
        "the disk at nodal diameter k E modulo n. With positive damping that is its only steady "
        "state."
    ),
    "sectors": (
        "The sectors of the ring are solved one by one, and joined exactly where neighbours touch."
    ),
}
_DIRECT = (
    "The damping matrix couples the modes, and the complex modes miss a direct solution by more "
    "than 1e-8, as where two of them nearly coincide, or a dof of hardly any mass makes one much "
    "faster than the others: every point costs a factorisation of the "
    "whole dynamic stiffness per harmonic, and takes longer than modes would. Where the damping "
    "follows a law, give that, Rayleigh or ModalDamping, instead of its matrix."
)


def balance_assumptions(
    model: Model,
    settings: ForcedSettings,
    dofs: tuple[str, ...],
    arrays: Arrays,
    solution: _core.Solution,
    asked: int | None,
    *,
    single: bool = False,
) -> tuple[Diagnostic, ...]:
    """Say what a harmonic balance took for granted.

    `asked` counts the frequencies of a grid. A `single` harmonic says itself that it is one.
    """
    orbits = solution.counters.get("orbits", 0)
    remedy = "forced_response keeps more of them" if single else "keep more harmonics there"
    # Numbers far outside any unit overflow when squared; what is not finite then is left out.
    with np.errstate(all="ignore"):
        return present(
            (
                None if single else _harmonics(settings, arrays, solution.half_wave),
                _static_traction(model, settings, arrays),
                _start_of_march(model),
                bool(model.contacts) and _samples(settings, arrays),
                _base(model),
                direct_assumption(model),
                _frequencies(settings.span, settings.tolerance, arrays, solution, asked),
                orbits > 0
                and diagnostic(
                    "exact-orbits",
                    f"{orbits} {'point takes its' if orbits == 1 else 'points take their'} "
                    "harmonics from the exact orbit, which costs less than a balance of as many.",
                    points=orbits,
                ),
                _observed(model, dofs),
                uniqueness(model),
                _truncation(dofs, arrays, remedy),
                missed_tolerances(arrays.status, "points"),
            )
        )


def orbit_assumptions(
    model: Model,
    settings: ExactSettings,
    dofs: tuple[str, ...],
    arrays: Arrays,
    solution: _core.Solution,
    asked: int,
) -> tuple[Diagnostic, ...]:
    """Say what exact orbits took for granted."""
    low, high = sorted(settings.span or (0.0, 0.0))
    half = (
        "Orbits were sought on half a period: the forces and the friction laws are half-wave "
        "symmetric, and so is the steady motion."
        if solution.half_wave
        else "Only motions of the period of the forces were sought."
    )
    with np.errstate(all="ignore"):
        return present(
            (
                diagnostic("half-period", half),
                diagnostic(
                    "harmonics",
                    f"Harmonics are reported up to {settings.harmonics}; the orbits have no "
                    "truncation.",
                    most=settings.harmonics,
                ),
                _static_traction(model, settings, arrays),
                _start_of_march(model),
                settings.span is not None
                and diagnostic(
                    "frequencies",
                    f"The frequencies between {low:g} and {high:g} rad/s are those that an "
                    f"adaptive harmonic balance chose to a tolerance of {settings.tolerance:g}.",
                    tolerance=settings.tolerance,
                ),
                _frequencies(None, settings.tolerance, arrays, solution, asked),
                _observed(model, dofs),
                uniqueness(model),
                missed_tolerances(arrays.status, "points"),
            )
        )


def transient_assumptions(
    model: Model,
    settings: TransientSettings,
    dofs: tuple[str, ...],
    start: object,
    history: _core.History,
) -> tuple[Diagnostic, ...]:
    """Say what a transient took for granted; `start` as it was given."""
    begun = "rest" if start is None else "a given state"
    if isinstance(start, Mapping):
        begun = "given displacements, without velocities and contact forces"
    mean = (
        "; a contact that never slips keeps for ever the mean force of its start, so that means "
        "depend on it while half ranges do not"
        if model.contacts
        else ""
    )
    stepped = (
        f"The motion was advanced in {settings.steps} Runge-Kutta steps per period; between them "
        "the output is interpolated."
        if settings.scheme == "rk4"
        else "The motion was followed exactly between the instants of stick and slip."
    )
    turn = turn_per_step(model, settings)
    needed = int(np.ceil(settings.steps * turn / COARSE_TURN))
    return present(
        (
            diagnostic("start", f"The run starts from {begun}{mean}."),
            diagnostic("time-steps", stepped, scheme=settings.scheme),
            turn > COARSE_TURN
            and diagnostic(
                "coarse-steps",
                f"The highest stuck natural frequency turns by {turn:.2g} rad in a Runge-Kutta "
                f"step, too much to be followed well; take {needed} steps per period.",
                turn=turn,
                needed=needed,
            ),
            not (history.settled or history.unbounded)
            and settings.tolerance is None
            and diagnostic(
                "no-tolerance",
                "No tolerance was given, so that the last period need not be a steady one; see "
                "change.",
            ),
            settings.keep is not None
            and settings.keep < settings.periods
            and diagnostic(
                "kept-periods",
                f"Time histories and events are kept of the last {settings.keep} periods only.",
                periods=settings.keep,
            ),
            _observed(model, dofs),
            uniqueness(model),
        )
    )


def _static_traction(
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


def _start_of_march(model: Model) -> Diagnostic | None:
    """Say how dampers of several points begin, and what holds them."""
    several = [one for one in model.contacts if isinstance(one, StructuralDamper)]
    told = [
        "The march through a damper of several points begins without slip, so that points which "
        "never slip hold what they built up from zero displacement, and no mean force where the "
        "motion is half-wave symmetric",
        *(
            f"the rows of the stiffness of {one.name!r} do not sum to zero "
            f"({one.grounding:.3g} N/m): it is also held by the ground, and its forces have a "
            "resultant"
            for one in several
            if one.grounding
        ),
    ]
    return diagnostic("start-of-march", f"{'; '.join(told)}.") if several else None


def _samples(settings: ForcedSettings, arrays: Arrays) -> Diagnostic | None:
    taken = arrays.samples[arrays.solved]
    if settings.march is None or not taken.size:
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


def _base(model: Model) -> Diagnostic | None:
    base = model.problem.modal_base
    return diagnostic("modal-base", _BASES[base], base=base) if base in _BASES else None


def direct_assumption(model: Model) -> Diagnostic | None:
    """Say that points cost factorisations, and why, where no modes carry the compliance."""
    return diagnostic("direct-solution", _DIRECT) if model.problem.is_direct else None


def turn_per_step(model: Model, settings: TransientSettings) -> float:
    """Return the angle by which the fastest stuck motion turns in a Runge-Kutta step [rad].

    The highest natural frequency with all contacts stuck times the step; 0 for another scheme.
    """
    if settings.scheme != "rk4":
        return 0.0
    step = 2.0 * np.pi / (settings.omega * settings.steps)
    return step * float(natural_frequencies(model)[-1])


def _harmonics(settings: ForcedSettings, arrays: Arrays, half_wave: bool) -> Diagnostic | None:
    kept = arrays.harmonics[arrays.solved]
    if not kept.size:
        return None
    least, most = int(kept.min()), int(kept.max())
    chosen = (
        f", chosen per point ({least} to {most}) to a tolerance of {settings.tolerance:g}"
        if settings.harmonics == "auto"
        else ""
    )
    if half_wave and most == 1:
        text = (
            "Only harmonic 1 was solved for: the forces and the friction laws are half-wave "
            "symmetric, and harmonics above it were left out."
        )
    elif half_wave:
        text = (
            f"Only the odd harmonics up to {most} were solved for{chosen}: the forces and the "
            "friction laws are half-wave symmetric."
        )
    else:
        text = f"All harmonics from 0 to {most} were solved for{chosen}."
    return diagnostic("harmonics", text, least=least, most=most)


def _frequencies(
    span: Span | None,
    tolerance: float,
    arrays: Arrays,
    solution: _core.Solution,
    asked: int | None,
) -> Diagnostic | None:
    count = int((arrays.status != Status.NOT_COMPUTED.code).sum())
    missing = 0 if asked is None else asked - solution.computed
    reached = f"{arrays.omega[-1] if count else np.nan:.6g} rad/s"
    if span is None:
        if not missing:
            return None
        text = (
            f"The run was interrupted after {count} of {count + missing} frequencies, at {reached}."
        )
    elif solution.interrupted:
        text = (
            f"The run from {span[0]:g} to {span[1]:g} rad/s was interrupted: its {count} "
            f"frequencies, chosen to a tolerance of {tolerance:g}, end at {reached}."
        )
    else:
        low, high = sorted(span)
        text = (
            f"The {count} frequencies between {low:g} and {high:g} rad/s were chosen to a "
            f"tolerance of {tolerance:g}."
        )
    return diagnostic("frequencies", text, count=count, missing=missing)


def _observed(model: Model, dofs: tuple[str, ...]) -> Diagnostic | None:
    total = len(model.structure)
    if len(dofs) == total:
        return None
    listed = ", ".join(dofs[:_SHOWN]) + (", ..." if len(dofs) > _SHOWN else "")
    return diagnostic(
        "observed-dofs",
        f"Only {len(dofs)} of {total} dofs are kept in the result: {listed}.",
        kept=len(dofs),
        total=total,
    )


def _truncation(dofs: tuple[str, ...], arrays: Arrays, remedy: str) -> Diagnostic | None:
    # The exact half range of every dof and point would cost as much as the solution; the root
    # sum of squares finds the point, and only there is the range taken.
    parts = arrays.displacement[:, 1:].real, arrays.displacement[:, 1:].imag
    size = np.sqrt(sum(np.einsum("nkd,nkd->nd", part, part) for part in parts))
    size[~(arrays.solved[:, None] & np.isfinite(size))] = 0.0
    if not size.max(initial=0.0) > 0.0:
        return None
    # What moves by rounding only has no relative error worth naming.
    known = size > np.maximum(1e-6 * size.max(axis=0), 1e-12 * size.max())
    ratio = np.where(known, arrays.error_estimate / np.where(known, size, 1.0), 0.0)
    point, dof = np.unravel_index(int(np.nan_to_num(ratio, nan=0.0).argmax()), ratio.shape)
    series = np.ascontiguousarray(arrays.displacement[point : point + 1, :, dof])
    share = float(arrays.error_estimate[point, dof] / amplitude_of(series, "half_range")[0])
    if not share > LARGE_ERROR:
        return None
    what = "The discarded harmonics"
    if arrays.samples[point]:
        what = f"{what} and the sampling"
        remedy = "keep more harmonics, or take more samples, there"
    return diagnostic(
        "truncation",
        f"{what} could still change {dofs[dof]!r} by {share:.1%} at omega = "
        f"{arrays.omega[point]:.6g} rad/s, the worst point; {remedy}.",
        dof=dofs[dof],
        share=share,
        omega=float(arrays.omega[point]),
    )
