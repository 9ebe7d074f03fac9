"""Claims of chapter IV on the beam: the stiffness of the damper."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np

import stickslip as ss
from stickslip_reproduce.beam_orbits import FORCE, NEAR, SLIPPING
from stickslip_reproduce.claims import Found, claim, verdict
from stickslip_reproduce.numbers import Fact
from stickslip_reproduce.resolution import Resolution

STIFFNESSES = tuple(2.4 * 10.0**power for power in range(4, 11))
"""Stiffnesses of the damper in Figs 4.5 to 4.8 [N/m]."""


@cache
def stiffened(stiffness: float) -> ss.ForcedResponse:
    """Return 15 harmonics of the beam at 20.313 N with a damper of some stiffness."""
    damper = ss.Jenkins("damper", stiffness=stiffness, slip_force=ss.reference.DAMPER_SLIP_FORCE)
    model = ss.reference.snecma_beam(FORCE).replaced(contacts=[damper])
    return ss.forced_response(model, NEAR, 15)


@cache
def stiffened_peak(stiffness: float, dof: str) -> tuple[float, float]:
    """Return the exact peak and its frequency, near that of 15 harmonics."""
    shown = stiffened(stiffness)
    near = np.abs(shown.omega / shown.peak(dof).omega - 1.0) < 0.02
    top = ss.exact_response(shown.model, shown.omega[near], observe=dof).peak(dof)
    return top.amplitude, top.omega


@claim(
    "soft-damper",
    "4.2.2",
    "For low values of the damper stiffness, k_d ≤ 2.4 × 10⁵ N/m, the damper is hardly slipping "
    "because the force in the damper cannot build up to the slipping value.",
    """Largest slip fraction from 100 to 300 rad/s, and the largest force of the damper over F_d, at
    20.313 N and k_d = 2.4e5 N/m.""",
    rule=lambda n: verdict(n["slip fraction"] < 0.05, n["slip fraction"] < 0.2),
    see="fig-4.5 fig-4.6",
)
def soft_damper(resolution: Resolution) -> Found:
    """Slip of soft dampers."""
    true = stiffened(2.4e5)
    force = 2.4e5 * true.damper_amplitude((0, 0)).max() / ss.reference.DAMPER_SLIP_FORCE
    return Found(
        (
            Fact("slip fraction", float(true.slip_fraction((0, 0)).max())),
            Fact("largest force over F_d", float(force)),
        )
    )


@claim(
    "frequency-of-the-beam",
    "4.2.2",
    "the frequency of the motion approaches the natural frequency of the cantilevered beam, "
    "ω_beam = 159.39 rad/s",
    """Exact peak with the softest damper, and the natural frequency of the beam without damper: it
    does approach it, but that is 159.59; 159.39 belongs to the single DOF.""",
    rule=lambda n: verdict(
        abs(n["natural frequency"] - 159.39) < 0.01,
        abs(n["peak at 2.4e4 N/m"] / n["natural frequency"] - 1.0) < 0.005,
    ),
    see="fig-4.5 fig-4.6",
)
def frequency_of_the_beam(resolution: Resolution) -> Found:
    """Frequency of the beam with the softest damper."""
    return Found(
        (
            Fact("peak at 2.4e4 N/m", stiffened_peak(2.4e4, "tip")[1], "rad/s"),
            Fact("natural frequency", SLIPPING, "rad/s", 159.39),
        )
    )


@claim(
    "stiffer-is-lower",
    "4.2.2",
    "the overall amplitude of the motion decreases when the damper stiffness increases, all other "
    "parameters remaining constant, and the amplitude versus frequency trend is the same for the "
    "tip displacement, x₂, and the displacement at the damper location, x₁",
    """Largest ratio of exact peaks from one stiffness to the next stiffer one, 2.4e4 to 2.4e10 N/m
    in steps of ten, at both places.""",
    rule=lambda n: verdict(max(n.values()) < 1.0),
    see="fig-4.5 fig-4.6 fig-4.7 fig-4.8",
)
def stiffer_is_lower(resolution: Resolution) -> Found:
    """Ratios of peaks from stiffness to stiffness."""
    facts = []
    for dof in ("damper", "tip"):
        peaks = np.array([stiffened_peak(value, dof)[0] for value in STIFFNESSES])
        facts.append(Fact(f"largest ratio, {dof}", float((peaks[1:] / peaks[:-1]).max())))
    return Found(tuple(facts))


@claim(
    "rigid-damper",
    "4.2.2",
    "as the damper stiffness becomes large, the frequency response of the system converges toward "
    "the response of the beam attached to a rigid damper, that is, a damper with an infinite "
    "stiffness",
    """Change of the exact peak at the damper over the last two decades of stiffness, which falls by
    about ten from decade to decade.""",
    rule=lambda n: verdict(
        n["to 2.4e10 N/m"] < 0.5 and n["to 2.4e10 N/m"] < 0.3 * n["to 2.4e9 N/m"]
    ),
    see="fig-4.7 fig-4.8",
)
def rigid_damper(resolution: Resolution) -> Found:
    """Return the changes of the peak with the last decades of stiffness."""
    peaks = [stiffened_peak(value, "damper")[0] for value in STIFFNESSES[-3:]]
    changes = [100.0 * abs(b / a - 1.0) for a, b in pairwise(peaks)]
    return Found(
        tuple(
            Fact(f"to 2.4e{power} N/m", change, "%")
            for power, change in zip((9, 10), changes, strict=True)
        )
    )


@claim(
    "like-the-bare-beam",
    "4.2.2",
    "With the damper hardly slipping and the damper stiffness small, the response of the system is "
    "very similar to the response of the beam without an attached friction damper",
    """Largest distance of the tip's curves from those of the beam without damper over its peak,
    at k_d = 2.4e4 and 2.4e5 N/m, and the distance of the peaks alone; very similar is 10 %.""",
    rule=lambda n: verdict(max(n.values()) < 10.0, max(n["peaks, 2.4e4"], n["peaks, 2.4e5"]) < 10),
    see="fig-4.5 fig-4.6",
)
def like_the_bare_beam(resolution: Resolution) -> Found:
    """Distance from the beam without damper."""
    facts = []
    for value, name in ((2.4e4, "2.4e4"), (2.4e5, "2.4e5")):
        shown = stiffened(value)
        free = ss.single_harmonic(shown.model.replaced(contacts=[]), shown.omega)
        apart = np.abs(shown.amplitude("tip") - free.amplitude("tip")).max()
        tops = shown.peak("tip").amplitude / free.peak("tip").amplitude - 1.0
        facts += [
            Fact(f"curves, {name}", 100.0 * float(apart) / free.peak("tip").amplitude, "%"),
            Fact(f"peaks, {name}", 100.0 * abs(tops), "%"),
        ]
    return Found(tuple(facts))


@claim(
    "more-slip-more-energy",
    "4.2.2",
    "As the damper becomes stiffer, there is more slipping and thus more friction during each "
    "cycle of the motion and more energy is dissipated.",
    """At the peak of the tip, k_d = 2.4e5, 2.4e6 and 2.4e7 N/m: least growth from one to the next
    of the slip fraction, of the energy lost to friction per cycle, and of its share of all energy
    lost. Both fall from the second to the third, as the amplitude does; only the share grows.""",
    rule=lambda n: verdict(
        min(n["slip fraction"], n["energy"]) > 1.0, min(n["slip fraction"], n["share"]) > 1.0
    ),
    see="fig-4.5 fig-4.6 fig-4.7",
)
def more_slip_more_energy(resolution: Resolution) -> Found:
    """Growth of slip and of the energy lost with stiffness."""
    rows = []
    for value in STIFFNESSES[1:4]:
        shown = stiffened(value)
        top = int(shown.amplitude("tip").argmax())
        friction = float(shown.dissipation((0, 0))[top])
        moved = np.array([shown.coefficients(dof)[top] for dof in shown.model.structure.dofs])
        orders = shown.omega[top] * np.arange(moved.shape[1])
        loss = (moved.conj() * (shown.model.structure.damping @ moved)).sum(axis=0).real
        viscous = np.pi / shown.omega[top] * float((orders**2 * loss).sum())
        rows.append(
            (float(shown.slip_fraction((0, 0))[top]), friction, friction / (friction + viscous))
        )
    growth = [[b / max(a, 1e-12) for a, b in pairwise(one)] for one in zip(*rows, strict=True)]
    return Found(
        tuple(
            Fact(name, float(min(one)), "times")
            for name, one in zip(("slip fraction", "energy", "share"), growth, strict=True)
        )
    )
