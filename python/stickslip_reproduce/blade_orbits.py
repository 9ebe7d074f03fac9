"""Exact orbits of the open blade, which several claims are judged by."""

from __future__ import annotations

from functools import cache

import numpy as np

import stickslip as ss
from stickslip_reproduce.resolution import Float

BLADE = (0.95, 1.05)
"""Range of the blade, over its slipping and stuck first natural frequencies."""


@cache
def blade_at_optimum() -> tuple[ss.ExactResponse, ss.ForcedResponse]:
    """Return exact orbits and one harmonic of the open blade at its best slip force."""
    blade = ss.reference.turbine_blade()
    low = BLADE[0] * float(ss.natural_frequencies(blade, slipping=[0])[0])
    high = BLADE[1] * float(ss.natural_frequencies(blade)[0])
    best = ss.optimal_damper(blade, dof="tip", omega=(low, high), mode=0)
    model = ss.reference.turbine_blade(best.slip_force)
    omega: Float = np.linspace(low, high, 200)
    return ss.exact_response(model, omega), ss.forced_response(model, omega, 1)
