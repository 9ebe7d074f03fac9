"""Responses of rings of 36 beams, which several claims are judged by."""

from __future__ import annotations

import time
from functools import cache

import numpy as np

import stickslip as ss
from stickslip_reproduce.chapter_4_rings import SECTORS, SPAN
from stickslip_reproduce.resolution import Float

SEEDS = range(8)
COUPLINGS = ss.reference.RING_COUPLINGS
TOLERANCE = 2e-2
"""Accuracy of the curves: far below what any verdict depends on."""


def ring(coupling: float, seed: int) -> ss.MistunedDisk:
    """Return the ring of engine order 3, mistuned by 7 %."""
    tuned = ss.reference.beam_ring(coupling=coupling, engine_order=3)
    return tuned.mistuned(ss.mistuning_pattern(SECTORS, 0.07, "uniform", seed=seed))


@cache
def response(coupling: float, seed: int) -> ss.ForcedResponse:
    """Return all 36 beams of a mistuned ring, 3 harmonics by Broyden's method."""
    observe = [f"{beam}.{dof}" for beam in range(SECTORS) for dof in ("damper", "tip")]
    return ss.forced_response(
        ring(coupling, seed), SPAN, 3, method="broyden", tolerance=TOLERANCE, observe=observe
    )


@cache
def tuned_peak(coupling: float, dof: str) -> float:
    """Return the peak of the tuned ring [m]."""
    tuned = ss.reference.beam_ring(coupling=coupling, engine_order=3)
    wave = ss.forced_response(tuned, SPAN, 3, tolerance=TOLERANCE)
    return wave.peak(dof).amplitude


def peaks(coupling: float, seed: int, dof: str = "damper") -> Float:
    """Return the peaks of the beams, shape (36,)."""
    return np.asarray(response(coupling, seed).blade_amplitudes(dof).max(axis=0))


@cache
def factors(seed: int, dof: str) -> tuple[float, ...]:
    """Return the magnification factor at every coupling."""
    return tuple(
        float(peaks(coupling, seed, dof).max()) / tuned_peak(coupling, dof)
        for coupling in COUPLINGS
    )


@cache
def histories() -> tuple[ss.ForcedResponse, ...]:
    """Return the ring of Fig. 4.19 with 1 and 9 harmonics and converged."""
    observe = [f"{beam}.damper" for beam in range(SECTORS)]
    model = ring(7e3, 0)
    return tuple(
        ss.forced_response(model, [200.0], kept, observe=observe, tolerance=1e-3)
        for kept in (1, 9, "auto")
    )


@cache
def marched() -> float:
    """Return the processor time of Runge-Kutta on the ring of Fig. 4.19, from rest [s]."""
    begin = time.process_time()
    ss.transient(ring(7e3, 0), 200.0, periods=5000, scheme="rk4", tolerance=1e-6, keep=1)
    return time.process_time() - begin


def balanced(harmonics: int) -> float:
    """Return that of Broyden's method, from the single harmonic [s]."""
    model, repeats = ring(7e3, 0), 3
    begin = time.process_time()
    for _ in range(repeats):
        ss.forced_response(model, [200.0], harmonics, method="broyden")
    return (time.process_time() - begin) / repeats
