"""Exact orbits of the beam of chapters II to IV, which several claims are judged by."""

from __future__ import annotations

from functools import cache

import stickslip as ss

NEAR = (100.0, 300.0)
"""Frequencies about its resonance [rad/s]."""

EIGHT = ss.reference.SNECMA_LOADS
"""Loads of the dissertation [N]."""

FORCE = 20.313
"""The one of them at which the stiffness varies, and the rings are driven [N]."""

SLIPPING, STUCK = (
    float(one[0])
    for one in (
        ss.natural_frequencies(ss.reference.snecma_beam(), slipping=[0]),
        ss.natural_frequencies(ss.reference.snecma_beam()),
    )
)
"""First natural frequencies [rad/s]."""


@cache
def optimum(dof: str) -> ss.OptimalDamper:
    """Return the best load over all, converged."""
    return ss.optimal_damper(ss.reference.snecma_beam(1.0), dof=dof, parameter="level", mode=0)


@cache
def exact(load: float) -> ss.ExactResponse:
    """Return exact orbits of the beam around its resonance."""
    return ss.exact_response(ss.reference.snecma_beam(load), NEAR)
