"""Orbits of the pair of chapter VI, which several claims are judged by."""

from __future__ import annotations

from functools import cache
from math import inf

import numpy as np

import stickslip as ss
from stickslip_reproduce.chapter_6 import DOFS, HARMONICS, SPAN
from stickslip_reproduce.resolution import Float

WIDE = (450.0, 760.0)
"""Range that holds the resonance with contact 1 slipping [rad/s]."""

CASES = ((250.0, 15.0), (550.0, 35.0), (550.0, 140.0), (550.0, 550.0))
"""Frequency [rad/s] and force [N] of Figs 6.4 to 6.7."""

LIMITS = np.array([24.6, 100.0, 246.05, inf])
"""Slip forces of the contacts [N]."""


@cache
def orbit(omega: float, force: float) -> ss.ExactResponse:
    """Return the exact orbit of the pair."""
    return ss.exact_response(ss.reference.damped_pair(force), [omega])


@cache
def stuck(omega: float, force: float) -> Float:
    """Return the forces of contacts that never slip, shape (n, 4)."""
    held = with_limits(force, [inf] * 4)
    return np.asarray(ss.forced_response(held, [omega], 1).contact_force(0, 0))


def with_limits(force: float, limits: list[float]) -> ss.Model:
    """Return the pair with other slip forces [N]."""
    pair = ss.reference.damped_pair(force)
    (damper,) = pair.contacts
    other = ss.StructuralDamper(list(DOFS), stiffness=damper.stuck_stiffness, slip_forces=limits)
    return pair.replaced(contacts=[other])


def forces_at(omega: float, force: float) -> Float:
    """Return the forces of the exact orbit, shape (n, 4) [N]."""
    return np.asarray(orbit(omega, force).contact_force(0, 0))


@cache
def curves(force: float) -> ss.ForcedResponse:
    """Return the pair over the range of the figures."""
    return ss.forced_response(ss.reference.damped_pair(force), np.linspace(*SPAN, 201), HARMONICS)


@cache
def sets() -> frozenset[frozenset[int]]:
    """Return the slip configurations of exact orbits from 20 to 120 N, 500 to 700 rad/s."""
    found: set[frozenset[int]] = set()
    for force in (50.0, 60.0, 90.0, 120.0):
        every = ss.exact_response(ss.reference.damped_pair(force), np.linspace(*SPAN, 41))
        for place in range(len(every.omega)):
            found |= {frozenset(one) for one in every.contact_states(0, place).sets}
    return frozenset(found)


def middle(forces: Float) -> Float:
    """Return the middle of the range of every force, shape (4,) [N]."""
    return np.asarray(0.5 * (forces.max(axis=0) + forces.min(axis=0)))
