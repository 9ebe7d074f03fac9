"""What of a model puts its motions in doubt.

It leaves open whether there is one solution, looks like a slip of sign or unit, or has contacts so
stiff that a motion with them may not be found.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from stickslip.analyses.arguments import highest_harmonic
from stickslip.analyses.texts import told
from stickslip.checks import listed
from stickslip.damper.damper import LEFT, RIGHT
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.disk.mistuned import MistunedDisk
from stickslip.model import Contact, Coulomb, Model
from stickslip.model.damping import ModalDamping, eigen_pencil
from stickslip.results.arrays import Arrays
from stickslip.results.diagnostic import Diagnostic
from stickslip.results.fields import Float
from stickslip.results.status import Status

_ROUND, _DEGREES = 15.0, 5.0
"""Phases from the first on that are multiples of the second are taken for degrees."""
_FRICTION = 3.0, 100.0
"""Coefficients between these look like percents; larger ones are those of contacts that stick."""
_FLAT = 0.01, 0.5 * np.pi
"""Degrees between these are taken for radians: so flat a damper is none of friction."""
_PERCENTS = 0.5
"""Deviations of blades from here on are taken for percents: those of one disk are smaller."""
_RIGID_BODY = 1e-8
"""Squared natural frequencies below this share of the highest are those of rigid motion."""
_OTHER = 0.1
"""Share by which a damping ratio may differ from that of its law."""
_USUAL = 2.0
"""Highest frequency of the modes that are kept in a reduction, over the highest of interest."""
_BESIDE = 1e-9
"""Share of a frequency that is rounding, where one is given as a resonance."""
RIGID = 1e5
"""Stiffness of a contact, over that of the structure at its DOFs, up to which motions are found."""


def doubts(model: Model, *, peaks: bool = False) -> tuple[Diagnostic | None, ...]:
    """Say what of laws, damping and stiffness puts a steady motion in doubt."""
    return uniqueness(model, peaks=peaks), *structure_doubts(model)


def structure_doubts(model: Model) -> tuple[Diagnostic | None, ...]:
    """Say what of a structure, its contacts and forces looks like a slip of sign or unit."""
    return *static_doubts(model), _overdamped(model), _wave_damping(model), _degrees(model)


def static_doubts(model: Model) -> tuple[Diagnostic | None, ...]:
    """Say what of it puts a state of rest in doubt: all but damping and phases."""
    return instability(model), _mistuning(model), _friction(model), _flat_faces(model)


def _degrees(model: Model) -> Diagnostic | None:
    """Say that the phase of a force looks like one in degrees.

    Phases in radians of that size come of waves, as multiples of pi: they are no round numbers.
    """
    for position, force in enumerate(model.forces, start=1):
        if abs(force.phase) >= _ROUND and force.phase % _DEGREES == 0.0:
            return told("phase-unit", force=position, dof=force.dof, phase=force.phase)
    return None


def _overdamped(model: Model) -> Diagnostic | None:
    law = model.damping_law
    if not isinstance(law, ModalDamping):
        return None
    ratios = law.ratio if isinstance(law.ratio, tuple) else (law.ratio,)
    ratio = float(max(ratios, default=0.0))
    if ratio < 1.0:
        return None
    return told("overdamped", ratio=ratio, _percent=0.01 * ratio)


def _wave_damping(model: Model) -> Diagnostic | None:
    """Say that the wave which the forces excite is damped otherwise than its law says.

    The law is that of the sector by itself. Where an interface makes most of the stiffness, modes
    of the sector are none of the disk.
    """
    law = model.damping_law
    if not isinstance(model, BladedDisk) or model.interface is None or law is None:
        return None
    harmonic = min((force.harmonic for force in model.forces if force.harmonic), default=1)
    mass, damping, stiffness = model.matrices_at(harmonic)
    try:
        squared, shapes = eigen_pencil(stiffness, mass)
    except np.linalg.LinAlgError:  # a degree of freedom without mass
        return None
    mode = int(np.argmax(squared > _RIGID_BODY * squared[-1]))
    if not squared[mode] > 0.0:
        return None
    omega, shape = float(np.sqrt(squared[mode])), shapes[:, mode]
    ratio = float((shape.conj() @ damping @ shape).real) / (2.0 * omega)
    if isinstance(law, ModalDamping):
        meant = float(np.broadcast_to(law.ratio, squared.shape)[mode])
    else:
        meant = 0.5 * (law.mass / omega + law.stiffness * omega)
    if abs(ratio - meant) <= _OTHER * abs(meant):
        return None
    return told("wave-damping", law=meant, ratio=ratio, diameter=model.diameter(harmonic))


def few_modes(model: Model, omega: ArrayLike, *, forced: bool = True) -> Diagnostic | None:
    """Say that frequencies lie beyond those up to which a reduced structure is accurate.

    They are those of the forces, or of a motion by itself.
    """
    order = highest_harmonic(model) if forced else 1
    highest = order * float(np.nanmax(omega, initial=0.0))
    limit = model.structure.accurate_to
    if highest <= limit:
        return None
    what = f"harmonic {order} of the forces goes up to" if order > 1 else "omega goes up to"
    return told("few-modes", omega=highest, limit=limit, _what=what, _enough=_USUAL * highest)


def mistuning_unit(deviation: float, what: str) -> Diagnostic | None:
    """Say that a deviation of blades looks like one in percent."""
    if abs(deviation) < _PERCENTS:
        return None
    return told("mistuning-unit", _what=what, deviation=deviation, _percent=0.01 * deviation)


def _mistuning(model: Model) -> Diagnostic | None:
    if not isinstance(model, MistunedDisk):
        return None
    for name in ("stiffness", "mass"):
        tuned, *sizes = (
            np.linalg.norm(getattr(one, name)) for one in (model.disk.structure, *model.blades)
        )
        deviations = np.array(sizes) / tuned - 1.0 if tuned else np.zeros(1)
        blade = int(np.abs(deviations).argmax())
        if found := mistuning_unit(deviations[blade], f"The {name} of blade {blade}"):
            return found
    return None


def _friction(model: Model) -> Diagnostic | None:
    least, most = _FRICTION
    for name, contact in zip(model.contact_names, model.contacts, strict=True):
        friction = float(np.max(contact.friction)) if isinstance(contact, Coulomb) else 0.0
        if least <= friction <= most:
            return told("friction-unit", contact=name, friction=friction, _percent=0.01 * friction)
    return None


def _flat_faces(model: Model) -> Diagnostic | None:
    """Say that a face of a damper lies nearly across its load, as with an angle in radians."""
    least, most = _FLAT
    for name, contact in zip(model.contact_names, model.contacts, strict=True):
        if name.rpartition(".")[2] not in (LEFT, RIGHT) or not isinstance(contact, Coulomb):
            continue
        normals = np.atleast_2d(np.array(contact.normal or ()))
        if normals.shape[1] != 2:
            continue
        angle = float(np.degrees(np.arctan2(*np.abs(normals[0]))))
        if least < angle < most:
            return told("angle-unit", contact=name, angle=angle)
    return None


def uniqueness(model: Model, *, peaks: bool = False) -> Diagnostic | None:
    """Say that a solution, or a peak, need not be the only one: laws or damping leave that open.

    The passive structure with laws that are monotone operators has one steady motion.
    """
    open_laws = list(dict.fromkeys(model.problem.laws_not_monotone))
    if open_laws:
        kind = "law-not-monotone/peaks" if peaks else "law-not-monotone"
        return told(kind, _laws=listed(open_laws))
    damped = model.structure.is_damped
    if damped is None:
        return told("undamped-motion")
    return None if damped else told("negative-damping")


def unbounded(model: Model, dofs: Sequence[str], omega: Float) -> Diagnostic | None:
    """Say at which of the frequencies that a curve passes nothing bounds what was observed."""
    if not omega.size or model.structure.is_damped:
        return None
    # A frequency that is given as the resonance lies within rounding of it.
    span = (float(omega.min()) * (1.0 - _BESIDE), float(omega.max()) * (1.0 + _BESIDE))
    lowest = model.problem.unbounded(span)
    found = {dof: at for dof in dofs if (at := lowest[model.structure.index(dof)]) is not None}
    if not found:
        return None
    frequencies = sorted(set(found.values()))
    return told(
        "unbounded-resonance",
        omega=frequencies[0],
        _all=", ".join(f"{one:.6g}" for one in frequencies),
        _dofs=listed(list(found)),
    )


def instability(model: Model) -> Diagnostic | None:
    """Say that the stiffness lets motions grow that nothing but contacts and inertia hold."""
    dof = model.structure.unstable_dof
    return None if dof is None else told("negative-stiffness", dof=dof)


def is_unique(model: Model) -> bool:
    """Tell whether the steady motion is known to be the only one, and stable."""
    return uniqueness(model) is None and instability(model) is None


UNSOLVED = (
    Status.STALLED,
    Status.SAMPLES_LIMIT,
    Status.HARMONICS_LIMIT,
    Status.EFFORT_LIMIT,
    Status.WORK_LIMIT,
)
"""How points end that nearly rigid contacts keep from their solution."""


def rigid_contacts(model: Model, arrays: Arrays) -> Diagnostic | None:
    """Name the contacts that are nearly rigid, where points are not solved to the tolerance."""
    unsolved = int(np.isin(arrays.status, [status.code for status in UNSOLVED]).sum())
    if not unsolved:
        return None
    ratios = {str(contact.name): _ratio(model, contact) for contact in model.contacts}
    rigid = [name for name, ratio in ratios.items() if ratio > RIGID]
    if not rigid:
        return None
    most = max(rigid, key=lambda name: ratios[name])
    return told(
        "rigid-contacts",
        _names=listed(rigid),
        contact=most,
        ratio=ratios[most],
        _limit=RIGID,
        points=unsolved,
        _are="point is" if unsolved == 1 else "points are",
    )


def _ratio(model: Model, contact: Contact) -> float:
    """Return the largest stiffness of a contact over that of the softest DOF that it acts on."""
    held = np.abs(model.structure.stiffness.diagonal())
    places = [np.flatnonzero(row) for row in np.hstack(model.contact_rows(contact))]
    beside = [held[place % held.size].min() if place.size else 0.0 for place in places]
    own = contact.stuck_stiffness.diagonal()
    return max((k / b for k, b in zip(own, beside, strict=True) if b > 0.0), default=0.0)
