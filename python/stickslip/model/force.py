"""Periodic and static forces on a structure."""

from __future__ import annotations

import cmath
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from stickslip.checks import brief, require_keys, set_fields, text, whole_number
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
