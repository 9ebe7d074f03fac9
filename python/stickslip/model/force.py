"""Periodic and static forces on a structure."""

from __future__ import annotations

import cmath
import re
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from math import pi
from typing import Any

from stickslip.checks import brief, listed, require_keys, set_fields, text, whole_number
from stickslip.errors import ModelError
from stickslip.units import physical_number


@dataclass(frozen=True)
class Force:
    """A periodic force, amplitude * cos(harmonic * omega * t + phase).

    Parameters
    ----------
    dof : str
        Degree of freedom it acts on.
    amplitude : float
        Amplitude [N]; for harmonic 0 the constant force, with its sign.
    phase : float, optional
        Phase lead [rad].
    harmonic : int, optional
        Multiple of the excitation frequency; 0 is a static load.

    Raises
    ------
    ModelError
        If a number is not finite, the harmonic is negative or not an integer, or a static load has
        a phase.
    """

    dof: str
    amplitude: float
    phase: float = 0.0
    harmonic: int = 1

    def __post_init__(self) -> None:
        entry = f"force at {brief(text(self.dof, 'force: dof'))}"
        harmonic = whole_number(self.harmonic, f"{entry}: harmonic")
        phase = physical_number(self.phase, "rad", f"{entry}: phase")
        if harmonic == 0 and phase != 0.0:
            raise ModelError(
                f"{entry}: phase {phase:g} on a static load (harmonic 0); leave the phase out"
            )
        amplitude = physical_number(self.amplitude, "N", f"{entry}: amplitude")
        set_fields(self, amplitude=amplitude, phase=phase, harmonic=harmonic)

    @property
    def coefficient(self) -> complex:
        """The P of Re(P exp(i k omega t)) [N]; the static load itself for harmonic 0."""
        return cmath.rect(self.amplitude, self.phase) if self.phase else complex(self.amplitude)

    def to_spec(self) -> dict[str, object]:
        """Return the force in plain values that any text format can hold."""
        return asdict(self)


def force_from_spec(spec: Mapping[str, Any]) -> Force:
    """Build a force from the plain values of `Force.to_spec`."""
    known = ("dof", "amplitude", "phase", "harmonic")
    require_keys(spec, "force", known, known[:2])
    return Force(**spec)


def engine_order_forces(
    dof: str,
    amplitude: float,
    engine_order: int,
    *,
    dofs: Iterable[str],
    phase: float = 0.0,
    harmonic: int = 1,
) -> list[Force]:
    """Return the forces of an engine order on all sectors of a structure.

    The force on sector i is ahead of that on the first one by 2 pi E i / n. A `BladedDisk` and its
    mistuned assembly do this by themselves; this is for a whole disk from elsewhere.

    Parameters
    ----------
    dof : str
        Name of the degree of freedom with a star for the number of the sector: "*.tip".
    amplitude : float
        Amplitude [N].
    engine_order : int
        E, the waves around the disk of the force of this harmonic.
    dofs : iterable of str
        The degrees of freedom of the structure, ``structure.dofs``.
    phase : float, optional
        Phase lead on the first sector [rad].
    harmonic : int, optional
        Multiple of the excitation frequency.

    Raises
    ------
    ModelError
        If the name has no star, or the sectors are not numbered without a gap.
    """
    entry = f"force at {brief(dof)}"
    if text(dof, "force: dof").count("*") != 1:
        raise ModelError(f'{entry}: write one star for the number of the sector, "*.tip"')
    known = list(dofs)
    pattern = re.compile(re.escape(dof).replace(r"\*", "([0-9]{1,6})"))
    found = {int(match[1]): name for name in known if (match := pattern.fullmatch(name))}
    places = sorted(found)
    if not places:
        raise ModelError(
            f"{entry}: no sectors among {listed(known)}; of a bladed disk a force acts on every "
            f"sector by itself: name the dof without star, {dof.replace('*.', '', 1)!r}"
        )
    if len(places) < 2 or places != list(range(places[0], places[0] + len(places))):
        given = ", ".join(map(str, places))
        raise ModelError(
            f"{entry}: sectors {given} among {listed(known)}; number them without a gap"
        )
    order = whole_number(engine_order, f"{entry}: engine_order")
    lead = physical_number(phase, "rad", f"{entry}: phase")
    return [
        Force(found[place], amplitude, lead + 2.0 * pi * order * count / len(places), harmonic)
        for count, place in enumerate(places)
    ]
