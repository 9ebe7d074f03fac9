"""Limit cycles of one mass with negative damping, which several claims are judged by."""

from __future__ import annotations

from functools import cache

import stickslip as ss

MODEL, NEGATIVE = ss.reference.flutter_mass()
NOMINAL, LIMIT = ss.reference.DAMPER_STIFFNESS, ss.reference.DAMPER_SLIP_FORCE
FREE = float(ss.natural_frequencies(MODEL, slipping=[0])[0])
STUCK = float(ss.natural_frequencies(MODEL)[0])
TRIED = (0.1, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0)


@cache
def exact() -> ss.LimitCycles:
    """Return the whole exact branch."""
    return ss.limit_cycles(MODEL, NEGATIVE, method="exact")


@cache
def kept(harmonics: int) -> ss.LimitCycles:
    """Return the whole branch of a number of harmonics."""
    return ss.limit_cycles(MODEL, NEGATIVE, harmonics=harmonics)


@cache
def tried() -> ss.LimitCycles:
    """Return the exact cycles at the ratios that are tried."""
    return ss.limit_cycles(MODEL, NEGATIVE, ratio=TRIED, method="exact")
