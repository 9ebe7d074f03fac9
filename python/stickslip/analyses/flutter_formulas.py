"""Closed forms for one mass with negative damping: one harmonic, and a rigid damper."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from contextlib import suppress
from math import acos, isfinite, pi, sin, sqrt, tanh
from typing import NamedTuple

import numpy as np

from stickslip.errors import ModelError
from stickslip.units import physical_number


class SingleCycle(NamedTuple):
    """A limit cycle of one mass."""

    amplitude: float
    """Amplitude [m]."""
    omega: float
    """Angular frequency [rad/s]."""


def single_harmonic_cycles(
    *, mass: float, damping: float, stiffness: float, contact_stiffness: float, slip_force: float
) -> tuple[SingleCycle, ...]:
    """Limit cycles of one mass by one harmonic, in closed form but for one root.

    With x = A cos(omega t) the damper of stiffness k_d answers with k_d (a cos + b sin). Balance of
    the sine gives the frequency, balance of the cosine the amplitude.

    Parameters
    ----------
    mass, damping, stiffness : float
        m [kg], c [kg/s], negative, and k [N/m].
    contact_stiffness, slip_force : float
        k_d [N/m] and F_d [N] of the damper to ground.

    Returns
    -------
    tuple of SingleCycle
        The sticking and the slipping one by rising amplitude, or none if the negative damping is
        too large.

    Raises
    ------
    ModelError
        If the damping is not below 0, or another value not above 0.

    References
    ----------
    Guillen (1999), eqs. (5.5) to (5.9); corrected: a = (A/pi) (theta - sin(2 theta)/2), and the
    sine balances c omega A = k_d b with both sides below 0.
    """
    from scipy.optimize import brentq, minimize_scalar

    m, k, kd, limit = _positive(
        mass=mass, stiffness=stiffness, contact_stiffness=contact_stiffness, slip_force=slip_force
    )
    c = _negative(damping)
    onset = limit / kd

    def omega(share: float) -> float:
        """Frequency at A = onset / share, eq. (5.9)."""
        return kd * 4.0 / pi * share * (1.0 - share) / -c

    def excess(share: float) -> float:
        """Left side of eq. (5.8) over A."""
        theta = acos(1.0 - 2.0 * share)
        in_phase = kd / pi * (theta - 0.5 * sin(2.0 * theta))
        return k + in_phase - m * omega(share) ** 2

    # share = onset / A runs from 0, endless slip, to 1, the onset of slip; the excess is positive
    # at both ends, and has one minimum in between.
    def cycles() -> tuple[SingleCycle, ...]:
        found = minimize_scalar(excess, bounds=(0, 1), method="bounded", options={"xatol": 1e-12})
        if excess(found.x) > 0.0:
            return ()
        shares = [brentq(excess, found.x, end, xtol=1e-300, rtol=1e-15) for end in (1.0, 0.0)]
        return tuple(SingleCycle(onset / share, omega(share)) for share in shares)

    return _in_numbers(
        cycles, mass=m, damping=c, stiffness=k, contact_stiffness=kd, slip_force=limit
    )


def rigid_limit_cycle(
    *,
    mass: float,
    damping: float,
    stiffness: float,
    slip_force: float,
    single_harmonic: bool = False,
) -> SingleCycle:
    """Limit cycle of one mass with a rigid damper: the slipping one of a very stiff damper.

    Parameters
    ----------
    mass, damping, stiffness : float
        m [kg], c [kg/s], negative, and k [N/m].
    slip_force : float
        F_d [N] of the damper to ground.
    single_harmonic : bool, optional
        By one harmonic, A = -4 F_d / (pi c omega) at omega^2 = k/m, instead of exactly.

    Returns
    -------
    SingleCycle
        It is unstable.

    Raises
    ------
    ModelError
        If the damping is not below 0 or overcritical, or another value not above 0.

    References
    ----------
    Guillen (1999), eqs. (5.16) to (5.20); corrected: the integrand is -F_d/k_d, A = 0 is no
    solution, and (5.20) lacks a minus sign. Exactly A = (F_d/k) coth(Delta/2) with the logarithmic
    increment Delta per half period.
    """
    m, k, limit = _positive(mass=mass, stiffness=stiffness, slip_force=slip_force)
    c = _negative(damping)

    def cycle() -> tuple[SingleCycle, ...]:
        free = sqrt(k / m)
        if single_harmonic:
            return (SingleCycle(-4.0 * limit / (pi * c * free), free),)
        rate = -0.5 * c / m
        if rate >= free:
            return ()
        omega = sqrt(free**2 - rate**2)
        return (SingleCycle(limit / k / tanh(0.5 * rate * pi / omega), omega),)

    found = _in_numbers(cycle, mass=m, damping=c, stiffness=k, slip_force=limit)
    if not found:
        raise ModelError(f"damping: {c:g} kg/s is overcritical, so that nothing oscillates")
    return found[0]


def _in_numbers(
    cycles: Callable[[], tuple[SingleCycle, ...]], **values: float
) -> tuple[SingleCycle, ...]:
    """Return limit cycles, or refuse the values that they do not follow from in floats."""
    with np.errstate(all="ignore"), suppress(ArithmeticError, RuntimeError, ValueError):
        found = cycles()
        if all(isfinite(number) and number > 0.0 for one in found for number in one):
            return found
    listed = ", ".join(f"{name} {value:g}" for name, value in values.items())
    raise ModelError(f"{listed}: of too different size for numbers; look at their units")


_UNITS = defaultdict(lambda: "N/m", mass="kg", slip_force="N")


def _positive(**values: float) -> list[float]:
    numbers = [physical_number(value, _UNITS[name], name) for name, value in values.items()]
    for name, number in zip(values, numbers, strict=True):
        if number <= 0.0:
            raise ModelError(f"{name}: {number:g} must be above 0")
    return numbers


def _negative(damping: float) -> float:
    number = physical_number(damping, "kg/s", "damping")
    if number >= 0.0:
        raise ModelError(f"damping: {number:g} must be below 0; without it nothing is excited")
    return number
