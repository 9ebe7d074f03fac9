"""What the flow does to a wave of a tuned disk: damping ratios and modal forces as they are given.

All are one thing, the complex force ``p L p^H x`` on a blade whose displacement is x, with a
coefficient L and a direction p per nodal diameter; see `AerodynamicForces`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from numbers import Real
from typing import NamedTuple, Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import as_list, brief, finite_complex, set_fields
from stickslip.errors import ModelError
from stickslip.model.structure import Structure
from stickslip.units import physical_number

Values: TypeAlias = ArrayLike | Mapping[int, complex]
"""A number per nodal diameter: those of 0 to n-1, or by the signed nodal diameter."""


class Family(NamedTuple):
    """The waves of one mode of a tuned disk without flow, its contacts as they were chosen."""

    structure: Structure
    """A sector by itself."""
    omega: NDArray[np.float64]
    """(n,) Natural frequencies of the waves of nodal diameter 0 to n-1 [rad/s]."""
    momentum: NDArray[np.complex128]
    """(n, N) M phi of every wave, phi of unit modal mass of a sector."""


class AerodynamicForces(NamedTuple):
    """Force ``p L p^H x`` of the flow on a blade in a wave, x its displacement.

    Re L is a stiffness less, Im L over omega a damping less.
    """

    coefficients: NDArray[np.complex128]
    """(n,) L by nodal diameter, 0 to n-1."""
    directions: NDArray[np.complex128]
    """(n, N) p."""


class Aerodynamics(Protocol):
    """What can be said of the flow: influence coefficients, damping ratios, modal forces."""

    def forces(self, family: Family) -> AerodynamicForces:
        """Return the forces on the waves of a family."""


@dataclass(frozen=True)
class AerodynamicDamping:
    """Aerodynamic damping per nodal diameter, as flow codes print it.

    Negative damping feeds the wave. At nodal diameter d each sector is ahead of the one before by
    the inter-blade phase angle 2 pi d / n, so that for d from 1 to n/2 crests run towards falling
    sector numbers; -d is n - d, and runs the other way round.

    Parameters
    ----------
    ratio : array_like, shape (n,), or mapping of int to float
        Fraction of critical damping, of the nodal diameters 0 to n-1, or by signed nodal diameter.
    decrement : array_like, shape (n,), or mapping of int to float
        Instead: logarithmic decrement per period, 2 pi zeta / (1 - zeta^2)^(1/2).

    Raises
    ------
    ModelError
        If not exactly one is given, or a number is not finite, or a ratio not between -1 and 1.
    """

    ratio: Values | None = None
    decrement: Values | None = None

    def __post_init__(self) -> None:
        if (self.ratio is None) == (self.decrement is None):
            raise ModelError("aerodynamic damping: give exactly one of ratio and decrement")
        name = "ratio" if self.decrement is None else "decrement"
        kept = _kept(getattr(self, name), f"aerodynamic damping: {name}", real=True)
        if name == "ratio" and any(abs(value) >= 1.0 for value in kept.values()):
            raise ModelError(
                "aerodynamic damping: ratio: give fractions of critical damping between -1 and 1, "
                "0.01 for one per cent"
            )
        object.__setattr__(self, name, kept)

    def at(self, sectors: int) -> NDArray[np.float64]:
        """Return the damping ratios of the nodal diameters 0 to n-1, shape (n,)."""
        if self.ratio is not None:
            return _placed(self.ratio, sectors, "aerodynamic damping: ratio").real
        decrement = _placed(self.decrement, sectors, "aerodynamic damping: decrement").real
        return decrement / np.hypot(2.0 * np.pi, decrement)

    def forces(self, family: Family) -> AerodynamicForces:
        """Return forces that give every wave of a family its damping ratio."""
        ratio = self.at(family.omega.size)
        coefficients = np.asarray(-2j * ratio * family.omega**2, dtype=np.complex128)
        return AerodynamicForces(coefficients, family.momentum)


@dataclass(frozen=True)
class ModalForces:
    """Complex modal forces of the flow on a mode that moves, per nodal diameter, and speed.

    The wave moves as phi e^(i omega t) with phi of unit modal mass per sector; the modal force is
    phi^H f, f being the force on one sector. A positive imaginary part feeds the wave. Modal forces
    of a mode with the modal mass m at the displacement q are theirs over m q.

    Parameters
    ----------
    values : array_like, shape (n,) or (S, n), or mapping of int to complex
        Modal force [1/s^2] of the nodal diameters 0 to n-1, or by signed nodal diameter; with
        `speeds` a row per speed.
    speeds : array_like, shape (S,), optional
        Rising speeds of rotation [rad/s] of the rows; `at_speed` gives the forces at one.

    Raises
    ------
    ModelError
        If a number is not finite, speeds do not rise, or there is not one row per speed.
    """

    values: Values
    speeds: ArrayLike | None = None

    def __post_init__(self) -> None:
        if self.speeds is None:
            object.__setattr__(self, "values", _kept(self.values, "modal forces", real=False))
            return
        try:
            speeds = np.array(self.speeds, dtype=np.float64)
            values = np.array(self.values, dtype=np.complex128)
        except (TypeError, ValueError, OverflowError):
            raise ModelError("modal forces: give numbers of shape (S, n) and speeds (S,)") from None
        if speeds.ndim != 1 or values.ndim != 2 or len(values) != speeds.size or not values.size:
            raise ModelError(
                f"modal forces: shape {values.shape} at speeds of shape {speeds.shape}; give a row "
                "of n per speed"
            )
        if not (np.isfinite(speeds).all() and np.isfinite(values).all()):
            raise ModelError("modal forces: every number must be finite")
        if not (np.diff(speeds) > 0.0).all():
            raise ModelError("modal forces: speeds do not rise; sort them")
        set_fields(self, speeds=speeds, values=values)

    def at_speed(self, speed: float) -> ModalForces:
        """Return the forces at a speed of rotation [rad/s], linear between two of the speeds.

        Raises ModelError if there are no speeds, or it lies outside them.
        """
        rate = physical_number(speed, "rad/s", "speed")
        if self.speeds is None:
            raise ModelError("at_speed: these modal forces have no speeds; give speeds=[...]")
        speeds, values = np.asarray(self.speeds), np.asarray(self.values)
        if not speeds[0] <= rate <= speeds[-1]:
            raise ModelError(
                f"speed: {rate:g} rad/s lies outside {speeds[0]:g} to {speeds[-1]:g} rad/s"
            )
        return ModalForces([np.interp(rate, speeds, column) for column in values.T])

    def forces(self, family: Family) -> AerodynamicForces:
        """Return the forces on the waves of a family."""
        if self.speeds is not None:
            raise ModelError("modal forces: they depend on speed; give modal_forces.at_speed(...)")
        return AerodynamicForces(
            _placed(self.values, family.omega.size, "modal forces"), family.momentum
        )


def _kept(given: object, name: str, *, real: bool) -> dict[int, complex]:
    """Return checked numbers by nodal diameter."""
    pairs = given.items() if isinstance(given, Mapping) else _numbered(given, name)
    kept: dict[int, complex] = {}
    for place, value in pairs:
        if isinstance(place, bool) or not isinstance(place, int | np.integer):
            raise ModelError(f"{name}: nodal diameter {brief(place)} is no whole number")
        number = finite_complex(value)
        if number is None or (real and not isinstance(value, Real)):
            raise ModelError(
                f"{name}: {brief(value)} at nodal diameter {place}; give a finite "
                f"{'real' if real else 'real or complex'} number"
            )
        kept[int(place)] = number.real if real else number
    if not kept:
        raise ModelError(f"{name}: none; give a number per nodal diameter")
    return kept


def _numbered(given: object, name: str) -> list[tuple[int, object]]:
    found = as_list(given)
    if found is None:
        raise ModelError(f"{name}: {brief(given)}; give a number per nodal diameter, 0 to n-1")
    return list(enumerate(found))


def _placed(given: object, sectors: int, name: str) -> NDArray[np.complex128]:
    """Return numbers by nodal diameter as those of 0 to n-1, where -d is n - d."""
    assert isinstance(given, Mapping)
    found = np.full(sectors, np.nan, dtype=np.complex128)
    for place, value in given.items():
        if not -sectors < place < sectors:
            raise ModelError(
                f"{name}: nodal diameter {place}; {sectors} sectors have 0 to {sectors - 1}, "
                "or signed ones"
            )
        at = place % sectors
        if np.isfinite(found[at]) and found[at] != value:
            raise ModelError(f"{name}: nodal diameter {place} is given twice, also as {at}")
        found[at] = value
    missing = np.flatnonzero(~np.isfinite(found))
    if missing.size:
        listed = ", ".join(map(str, missing[:6]))
        reason = f"{name}: none at nodal diameter {listed}; give all of 0 to {sectors - 1}, or"
        raise ModelError(f"{reason} ss.InfluenceCoefficients", study=f"{reason} influence instead")
    return found
