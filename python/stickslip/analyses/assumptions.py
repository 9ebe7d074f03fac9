"""What an analysis took for granted."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from stickslip.analyses.contact_assumptions import (
    contact_assumptions,
    residual_assumption,
    start_assumption,
)
from stickslip.analyses.uniqueness import uniqueness
from stickslip.model import Model, natural_frequencies
from stickslip.results.arrays import Arrays, amplitude_of
from stickslip.results.diagnostic import Diagnostic, diagnostic, missed_tolerances, present
from stickslip.results.status import Status

if TYPE_CHECKING:
    from stickslip.settings.balance import ForcedSettings
    from stickslip.settings.motion import TransientSettings
    from stickslip.settings.orbits import ExactSettings

__all__ = [
    "assumptions_of",
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


def assumptions_of(
    model: Model,
    settings: ForcedSettings,
    dofs: tuple[str, ...],
    arrays: Arrays,
    *,
    half_wave: bool,
    missing: int = 0,
    interrupted: bool = False,
    single: bool = False,
    orbits: int = 0,
) -> tuple[Diagnostic, ...]:
    """Say what a forced response took for granted.

    Parameters
    ----------
    model : Model
        What was computed.
    settings : ForcedSettings
        How.
    dofs : tuple of str
        The observed degrees of freedom.
    arrays : Arrays
        What came out.
    half_wave : bool
        Whether only odd harmonics were solved for.
    missing : int, optional
        Number of points asked for that are not among the arrays.
    interrupted : bool, optional
        Whether the run was stopped before its end.
    single : bool, optional
        Whether the method knows one harmonic only, and says so itself.
    orbits : int, optional
        Number of points whose harmonics are those of exact orbits.

    Returns
    -------
    tuple of Diagnostic
        Those that do not apply are left out.
    """
    # Numbers far outside any unit overflow when squared; what is not finite then is left out.
    with np.errstate(all="ignore"):
        return present(
            (
                None if single else _harmonics(settings, arrays, half_wave),
                *contact_assumptions(model, settings, arrays),
                _base(model),
                direct_assumption(model),
                _frequencies(settings, arrays, missing, interrupted=interrupted),
                _orbits(orbits),
                _observed(model, dofs),
                uniqueness(model),
                _truncation(dofs, arrays, _OTHER_METHOD if single else "keep more harmonics there"),
                missed_tolerances(arrays.status, "points"),
            )
        )


def orbit_assumptions(
    model: Model,
    settings: ExactSettings,
    dofs: tuple[str, ...],
    arrays: Arrays,
    *,
    half_wave: bool,
    missing: int = 0,
) -> tuple[Diagnostic, ...]:
    """Say what exact orbits took for granted.

    Parameters
    ----------
    model, settings, dofs, arrays, half_wave, missing
        As of `assumptions_of`; `half_wave` says that orbits were sought on half a period.

    Returns
    -------
    tuple of Diagnostic
        Those that do not apply are left out.
    """
    half = (
        "Orbits were sought on half a period: the forces and the friction laws are half-wave "
        "symmetric, and so is the steady motion."
        if half_wave
        else "Only motions of the period of the forces were sought."
    )
    chosen = None
    if settings.span is not None:
        low, high = sorted(settings.span)
        chosen = diagnostic(
            "frequencies",
            f"The frequencies between {low:g} and {high:g} rad/s are those that an adaptive "
            f"harmonic balance chose to a tolerance of {settings.tolerance:g}.",
            tolerance=settings.tolerance,
        )
    without_span = settings.model_copy(update={"span": None})
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
                residual_assumption(model, settings, arrays),
                start_assumption(model),
                chosen,
                _frequencies(without_span, arrays, missing, interrupted=missing > 0),
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
    *,
    settled: bool,
    unbounded: bool,
) -> tuple[Diagnostic, ...]:
    """Say what a transient took for granted.

    Parameters
    ----------
    model : Model
        What was computed.
    settings : TransientSettings
        How.
    dofs : tuple of str
        The observed degrees of freedom.
    start : object
        What the run was started from, as it was given.
    settled, unbounded : bool
        How it ended.

    Returns
    -------
    tuple of Diagnostic
        Those that do not apply are left out.
    """
    begun = "rest" if start is None else "a given state"
    if isinstance(start, Mapping):
        begun = "given displacements, without velocities and contact forces"
    history = (
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
    open_end = not settled and not unbounded and settings.tolerance is None
    with np.errstate(all="ignore"):
        return present(
            (
                diagnostic("start", f"The run starts from {begun}{history}."),
                diagnostic("time-steps", stepped, scheme=settings.scheme),
                _coarse_steps(model, settings),
                diagnostic("no-tolerance", _UNASKED) if open_end else None,
                _kept(settings),
                _observed(model, dofs),
                uniqueness(model),
            )
        )


def _base(model: Model) -> Diagnostic | None:
    base = model.problem.modal_base
    return diagnostic("modal-base", _BASES[base], base=base) if base in _BASES else None


def direct_assumption(model: Model) -> Diagnostic | None:
    """Say that points cost factorisations, and why, where no modes carry the compliance.

    Parameters
    ----------
    model : Model
        What was computed.

    Returns
    -------
    Diagnostic or None
        None where modes serve.
    """
    return diagnostic("direct-solution", _DIRECT) if model.problem.is_direct else None


def turn_per_step(model: Model, settings: TransientSettings) -> float:
    """Return the angle by which the fastest stuck motion turns in a Runge-Kutta step [rad].

    Parameters
    ----------
    model : Model
        What moves.
    settings : TransientSettings
        The frequency of the forces and the steps per period.

    Returns
    -------
    float
        Highest natural frequency with all contacts stuck times the step; 0 for another scheme.
    """
    if settings.scheme != "rk4":
        return 0.0
    step = 2.0 * np.pi / (settings.omega * settings.steps)
    return step * float(natural_frequencies(model)[-1])


def _coarse_steps(model: Model, settings: TransientSettings) -> Diagnostic | None:
    turn = turn_per_step(model, settings)
    if not turn > COARSE_TURN:
        return None
    needed = int(np.ceil(settings.steps * turn / COARSE_TURN))
    return diagnostic(
        "coarse-steps",
        f"The highest stuck natural frequency turns by {turn:.2g} rad in a Runge-Kutta step, too "
        f"much to be followed well; take {needed} steps per period.",
        turn=turn,
        needed=needed,
    )


_OTHER_METHOD = "forced_response keeps more of them"
_UNASKED = "No tolerance was given, so that the last period need not be a steady one; see change."


def _kept(settings: TransientSettings) -> Diagnostic | None:
    if settings.keep is None or settings.keep >= settings.periods:
        return None
    return diagnostic(
        "kept-periods",
        f"Time histories and events are kept of the last {settings.keep} periods only.",
        periods=settings.keep,
    )


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
    settings: ForcedSettings | ExactSettings, arrays: Arrays, missing: int, *, interrupted: bool
) -> Diagnostic | None:
    count = int((arrays.status != Status.NOT_COMPUTED.code).sum())
    reached = f"{arrays.omega[-1] if count else np.nan:.6g} rad/s"
    if settings.span is None:
        if not missing:
            return None
        text = (
            f"The run was interrupted after {count} of {count + missing} frequencies, at {reached}."
        )
    elif interrupted:
        start, end = settings.span
        text = (
            f"The run from {start:g} to {end:g} rad/s was interrupted: its {count} frequencies, "
            f"chosen to a tolerance of {settings.tolerance:g}, end at {reached}."
        )
    else:
        low, high = sorted(settings.span)
        text = (
            f"The {count} frequencies between {low:g} and {high:g} rad/s were chosen to a "
            f"tolerance of {settings.tolerance:g}."
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


def _orbits(count: int) -> Diagnostic | None:
    if not count:
        return None
    return diagnostic(
        "exact-orbits",
        f"{count} {'point takes its' if count == 1 else 'points take their'} harmonics from the "
        "exact orbit, which costs less than a balance of as many.",
        points=count,
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
