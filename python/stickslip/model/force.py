"""Periodic and static forces on a structure."""

from __future__ import annotations

import cmath
from collections.abc import Mapping
from dataclasses import dataclass

from stickslip.checks import brief, real_number, text, unknown, whole_number
from stickslip.errors import ModelError

__all__ = ["Force", "force_from_spec"]


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
        text(self.dof, "force: dof")
        entry = f"force at {brief(self.dof)}"
        harmonic = whole_number(self.harmonic, f"{entry}: harmonic")
        phase = real_number(self.phase, f"{entry}: phase")
        if harmonic == 0 and phase != 0.0:
            raise ModelError(
                f"{entry}: phase {phase:g} on a static load (harmonic 0); leave the phase out"
            )
        object.__setattr__(self, "amplitude", real_number(self.amplitude, f"{entry}: amplitude"))
        object.__setattr__(self, "phase", phase)
        object.__setattr__(self, "harmonic", harmonic)

    @property
    def coefficient(self) -> complex:
        """The P of Re(P exp(i k omega t)) [N]; the static load itself for harmonic 0."""
        return cmath.rect(self.amplitude, self.phase) if self.phase else complex(self.amplitude)

    def to_spec(self) -> dict[str, object]:
        """Return the force in plain values that any text format can hold.

        Returns
        -------
        dict
            `dof`, `amplitude`, `phase`, `harmonic`. See `force_from_spec`.
        """
        return {
            "dof": self.dof,
            "amplitude": self.amplitude,
            "phase": self.phase,
            "harmonic": self.harmonic,
        }


def force_from_spec(spec: Mapping[str, object]) -> Force:
    """Build a force from the plain values of `Force.to_spec`.

    Parameters
    ----------
    spec : mapping
        `dof`, `amplitude` and, optionally, `phase` and `harmonic`.

    Returns
    -------
    Force
        The force.

    Raises
    ------
    ModelError
        If a key is unknown or missing, or a value is refused by `Force`.
    """
    keys = ("dof", "amplitude", "phase", "harmonic")
    for key in spec:
        if key not in keys:
            raise ModelError(f"force: {unknown('key', key, keys)}")
    for key in keys[:2]:
        if key not in spec:
            raise ModelError(f"force: {key} is missing; give {key}")
    dof = text(spec["dof"], "force: dof")
    entry = f"force at {brief(dof)}"
    return Force(
        dof,
        real_number(spec["amplitude"], f"{entry}: amplitude"),
        real_number(spec.get("phase", 0.0), f"{entry}: phase"),
        whole_number(spec.get("harmonic", 1), f"{entry}: harmonic"),
    )
