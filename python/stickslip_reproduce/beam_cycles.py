"""Limit cycles of the SNECMA beam, which several claims are judged by."""

from __future__ import annotations

from functools import cache

import stickslip as ss
from stickslip_reproduce.chapter_5_modes import STARTS
from stickslip_reproduce.cycles import held

BEAM, NEGATIVE = ss.reference.flutter_beam()
LIMIT = ss.reference.DAMPER_SLIP_FORCE
EVERY = (0.1, 0.15, 0.2, 0.3, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0)
"""Ratios at which the starts of Table 5.2 are tried."""


@cache
def branch(mode: int) -> ss.LimitCycles:
    """Return the exact branch of a mode, all three damped negatively."""
    return ss.limit_cycles(BEAM, NEGATIVE, mode=mode, method="exact")


@cache
def single() -> ss.LimitCycles:
    """Return the exact branch with mode 3 alone damped negatively."""
    return ss.limit_cycles(*ss.reference.flutter_beam(mode=2), mode=2, method="exact")


@cache
def cases(ratio: float, forces: str) -> ss.BasinMap:
    """Return what becomes of the starts of Table 5.2 with a reading of the friction force."""
    driven = ss.destabilised(BEAM, NEGATIVE, ratio)
    return ss.basin_map(driven, starts=[held(driven, start, forces) for start in STARTS])


@cache
def at_one(mode: int) -> ss.LimitCycles:
    """Return the exact cycles of a mode at r = 1, all three damped negatively."""
    return ss.limit_cycles(BEAM, NEGATIVE, mode=mode, ratio=[1.0], method="exact")


RATIOS = (1.0, 2.0, 3.0)
"""Ratios at which cycles of mode 3 alone are tried."""


@cache
def alone() -> ss.LimitCycles:
    """Return the exact cycles with mode 3 alone damped negatively at these ratios."""
    return ss.limit_cycles(*ss.reference.flutter_beam(mode=2), mode=2, ratio=RATIOS, method="exact")
