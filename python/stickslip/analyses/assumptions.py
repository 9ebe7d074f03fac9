"""What an analysis took for granted, and what to look at before its numbers are used."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from stickslip import _core
from stickslip.analyses.doubts import (
    doubts,
    few_modes,
    is_unique,
    rigid_contacts,
    structure_doubts,
    unbounded,
)
from stickslip.analyses.texts import TEXTS, told
from stickslip.checks import listed
from stickslip.model import Coulomb, Model, StructuralDamper, natural_frequencies
from stickslip.model.state import State
from stickslip.results.arrays import STABILITY, UNIQUE, Arrays, amplitude_of
from stickslip.results.damper_curve import DamperArrays
from stickslip.results.diagnostic import Diagnostic, missed_tolerances, present
from stickslip.results.status import Status
from stickslip.settings.balance import ForcedSettings
from stickslip.settings.entries import Span
from stickslip.settings.motion import ClassifySettings, TransientSettings
from stickslip.settings.orbits import ExactSettings

LARGE_ERROR = 0.05
"""Share of the amplitude above which the discarded harmonics are worth a warning."""

COARSE_TURN = 0.5
"""Angle per Runge-Kutta step above which a motion loses accuracy noticeably [rad]."""

_APART = 1.25
"""Ratio of two frequencies from which on they are taken for the ends of a range."""
_SHOWN = 6


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
    """Say what a harmonic balance took for granted; `asked` counts the frequencies of a grid."""
    orbits = solution.counters.get("orbits", 0)
    base = f"modal-base/{model.problem.modal_base}"
    # Numbers far outside any unit overflow when squared; what is not finite then is left out.
    with np.errstate(all="ignore"):
        return present(
            (
                single and told("method/single"),
                not single and _harmonics(settings, arrays, solution.half_wave),
                _static_traction(model, settings, arrays),
                _node_traction(model, settings, arrays),
                settings.bounds and bounds_of(arrays),
                _start_of_march(model),
                bool(model.contacts) and _samples(model, settings, arrays),
                base in TEXTS and told(base, base=model.problem.modal_base),
                direct_assumption(model),
                _frequencies(settings.span, settings.tolerance, arrays, solution, asked),
                orbits > 0
                and told(
                    "exact-orbits",
                    points=orbits,
                    _take="point takes its" if orbits == 1 else "points take their",
                ),
                settings.span is None and _two_frequencies(arrays, asked),
                _observed(model, dofs),
                *doubts(model),
                few_modes(model, arrays.omega),
                not solution.interrupted and unbounded(model, dofs, arrays.omega),
                _truncation(dofs, arrays, single=single),
                rigid_contacts(model, arrays),
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
    with np.errstate(all="ignore"):
        return present(
            (
                told("half-period/half" if solution.half_wave else "half-period"),
                told("harmonics/orbits", most=settings.harmonics),
                _static_traction(model, settings, arrays),
                settings.bounds and bounds_of(arrays),
                settings.bounds and _lost_bounds(arrays),
                _node_traction(model, settings, arrays),
                _start_of_march(model),
                settings.span is not None
                and told("frequencies/balance", tolerance=settings.tolerance, _low=low, _high=high),
                _frequencies(None, settings.tolerance, arrays, solution, asked),
                settings.span is None and _two_frequencies(arrays, asked),
                _observed(model, dofs),
                *doubts(model),
                few_modes(model, arrays.omega),
                not solution.interrupted and unbounded(model, dofs, arrays.omega),
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
    begun = "rest"
    if isinstance(start, State):
        begun = f"a given state, with contact forces up to {_largest_force([start]):g} N"
    elif isinstance(start, Mapping):
        begun = "given displacements, with velocities and contact forces of zero"
    scheme, turn = settings.scheme, turn_per_step(model, settings)
    needed = int(np.ceil(settings.steps * turn / COARSE_TURN))
    open_end = not (history.settled or history.unbounded) and settings.tolerance is None
    return present(
        (
            told("start/contacts" if model.contacts else "start", _begun=begun),
            told(f"time-steps/{scheme}", scheme=scheme, _steps=settings.steps),
            turn > COARSE_TURN and told("coarse-steps", turn=turn, needed=needed),
            open_end and told("no-tolerance"),
            settings.keep is not None
            and settings.keep < settings.periods
            and told("kept-periods", periods=settings.keep),
            _observed(model, dofs),
            *doubts(model),
            few_modes(model, settings.omega),
        )
    )


def free_assumptions(
    model: Model, settings: ClassifySettings, starts: Sequence[object]
) -> tuple[Diagnostic, ...]:
    """Say what a classification of free motions took for granted; `starts` as they were given."""
    forces = len(model.forces)
    states = [start for start in starts if isinstance(start, State)]
    bare = len(starts) - len(states)
    counted = "The start was" if len(starts) == 1 else f"Of {len(starts)} starts {bare} were"
    return present(
        (
            told("method/free"),
            bare > 0
            and bool(model.contacts)
            and told("start/forces", without_forces=bare, _starts=counted),
            bool(states)
            and bool(model.contacts)
            and told("start/given-forces", contact_force=_largest_force(states)),
            forces > 0 and told("forces-left-out", forces=forces),
            told("criterion", tolerance=settings.tolerance, periods=settings.periods),
            told("modes"),
            *structure_doubts(model),
        )
    )


def _largest_force(states: Sequence[State]) -> float:
    """Return the largest contact force of some states [N]."""
    return max(float(np.abs(state.contact_force).max(initial=0.0)) for state in states)


def _static_traction(
    model: Model, settings: ForcedSettings | ExactSettings, arrays: Arrays
) -> Diagnostic | None:
    """Say what contacts that never slip were taken to hold."""
    slips = [
        contact.slips and not contact.components
        for contact in model.contacts
        for _ in range(contact.displacements)
    ]
    shares = arrays.slip_fraction[arrays.solved][:, np.array(slips, dtype=np.bool_)]
    stuck = (shares == 0.0).any(axis=1)
    if all(one.points > 1 or one.components for one in model.contacts) or not stuck.any():
        return None
    held = {
        "centred": "no force at mid-range of its displacement",
        "from_rest": "the force it built up from zero displacement",
    }.get(str(settings.residual), f"{settings.residual} N at mid-range of its displacement")
    return told(
        "static-traction",
        residual=settings.residual,
        points=int(stuck.sum()),
        _held=held,
        _solved=stuck.size,
    )


def bounds_of(arrays: Arrays | DamperArrays, variant: str = "bounds") -> Diagnostic | None:
    """Say what bounds over the residual tractions are worth."""
    none = UNIQUE.index("not asked"), UNIQUE.index("not found")
    known = ~np.isin(arrays.unique, none)
    if not known.any():
        return None
    if arrays.guaranteed[known].all():
        return told("bounds/unique")
    depends = UNIQUE.index("no"), UNIQUE.index("shakedown")
    wide = int(np.isin(arrays.unique[known], depends).sum())
    return told(variant, points=wide, _known=int(known.sum()))


def _lost_bounds(arrays: Arrays) -> Diagnostic | None:
    """Say where an orbit that bounds others was not found."""
    lost = int((arrays.unique == UNIQUE.index("not found")).sum())
    return told("bounds-not-found", points=lost) if lost else None


def _node_traction(
    model: Model, settings: ForcedSettings | ExactSettings, arrays: Arrays
) -> Diagnostic | None:
    """Say what nodes of Coulomb contacts that never slip in both senses were taken to hold."""
    shares = arrays.slip_fraction[arrays.solved]
    stuck = np.zeros(len(shares), np.bool_)
    first = 0
    for contact in model.contacts:
        own = shares[:, first : first + contact.displacements]
        first += contact.displacements
        if isinstance(contact, Coulomb):
            nodes = own.reshape(len(own), contact.points, len(contact.components))
            stuck |= (nodes == 0.0).all(axis=2).any(axis=1)
    if not stuck.any():
        return None
    held = {
        "centred": "no traction at mid-range of their displacement",
        "from_rest": "the traction that the static loads have left",
    }.get(str(settings.residual), f"{settings.residual} N along t or t1 at mid-range")
    return told(
        "static-traction/nodes",
        residual=settings.residual,
        points=int(stuck.sum()),
        _held=held,
        _solved=stuck.size,
    )


def _start_of_march(model: Model) -> Diagnostic | None:
    """Say how contacts of several displacements begin, and what holds dampers."""
    several = [one for one in model.contacts if isinstance(one, StructuralDamper)]
    held = (
        f"; the rows of the stiffness of {one.name!r} do not sum to zero ({one.grounding:.3g} "
        "N/m): it is also held by the ground, and its forces have a resultant"
        for one in several
        if one.grounding
    )
    if several:
        return told("start-of-march", _held="".join(held))
    nodes = any(one.components and not isinstance(one, Coulomb) for one in model.contacts)
    return told("start-of-march/nodes") if nodes else None


def _samples(model: Model, settings: ForcedSettings, arrays: Arrays) -> Diagnostic | None:
    taken = arrays.samples[arrays.solved]
    sampled = listed(list(dict.fromkeys(model.problem.laws_sampled)))
    if settings.march is None and not taken.any():
        return told("samples/fixed", _laws=sampled) if sampled else None
    if not taken.size:
        return None
    least, most = int(taken.min()), int(taken.max())
    chosen = f", chosen per point to a quarter of the tolerance of {settings.tolerance:g}"
    return told(
        "samples",
        least=least,
        most=most,
        _count=f"{least}" if least == most else f"{least} to {most}",
        _chosen="" if isinstance(settings.march, int) else chosen,
        _of=f" of {sampled}" if settings.march is None else "",
    )


def direct_assumption(model: Model) -> Diagnostic | None:
    """Say that points cost factorisations, and why, where no modes carry the compliance."""
    return told("direct-solution") if model.problem.is_direct else None


def arrays_of(solution: _core.Solution, model: Model) -> Arrays:
    """Return the numbers of a curve; a motion that is the only one is stable."""
    arrays = Arrays.of(solution)
    if not is_unique(model):
        return arrays
    states = np.where(arrays.solved, STABILITY.index("stable"), STABILITY.index("not decided"))
    return replace(arrays, stability=states.astype(np.uint8))


def turn_per_step(model: Model, settings: TransientSettings) -> float:
    """Return the angle by which the fastest stuck motion turns in a Runge-Kutta step [rad].

    The highest natural frequency with all contacts stuck times the step; 0 for another scheme.
    """
    if settings.scheme != "rk4":
        return 0.0
    step = 2.0 * np.pi / (settings.omega * settings.steps)
    return step * float(natural_frequencies(model)[-1])


def _two_frequencies(arrays: Arrays, asked: int | None) -> Diagnostic | None:
    """Say that what looks like the ends of a range was not taken for one."""
    if asked != 2 or arrays.omega.size != 2:
        return None
    low, high = sorted(arrays.omega.tolist())
    return told("two-frequencies", low=low, high=high) if high > _APART * low else None


def _harmonics(settings: ForcedSettings, arrays: Arrays, half_wave: bool) -> Diagnostic | None:
    kept = arrays.harmonics[arrays.solved]
    if not kept.size:
        return None
    least, most = int(kept.min()), int(kept.max())
    chosen = f", chosen per point ({least} to {most}) to a tolerance of {settings.tolerance:g}"
    odd = "harmonics/one" if most == 1 else "harmonics/odd"
    return told(
        odd if half_wave else "harmonics",
        least=least,
        most=most,
        _chosen=chosen if settings.harmonics == "auto" else "",
    )


def _frequencies(
    span: Span | None,
    tolerance: float,
    arrays: Arrays,
    solution: _core.Solution,
    asked: int | None,
) -> Diagnostic | None:
    count = int((arrays.status != Status.NOT_COMPUTED.code).sum())
    missing = 0 if asked is None else asked - solution.computed
    if span is None and not missing:
        return None
    variant = "frequencies/cut" if solution.interrupted else "frequencies"
    start, end = span or (0.0, 0.0)
    return told(
        "frequencies/grid" if span is None else variant,
        count=count,
        missing=missing,
        _asked=count + missing,
        _reached=arrays.omega[-1] if count else np.nan,
        _tolerance=tolerance,
        _start=start,
        _end=end,
        _low=min(start, end),
        _high=max(start, end),
    )


def _observed(model: Model, dofs: tuple[str, ...]) -> Diagnostic | None:
    kept, total = len(dofs), len(model.structure)
    names = ", ".join(dofs[:_SHOWN]) + (", ..." if kept > _SHOWN else "")
    return None if kept == total else told("observed-dofs", kept=kept, total=total, _listed=names)


def _truncation(dofs: tuple[str, ...], arrays: Arrays, *, single: bool) -> Diagnostic | None:
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
    remedy = "forced_response keeps more of them" if single else "keep more harmonics there"
    if arrays.samples[point]:
        what = f"{what} and the sampling"
        remedy = "keep more harmonics, or take more samples, there"
    omega = float(arrays.omega[point])
    return told("truncation", dof=dofs[dof], share=share, omega=omega, _what=what, _remedy=remedy)
