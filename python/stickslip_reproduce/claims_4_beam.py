"""Claims of chapter IV on the beam."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np

import stickslip as ss
from stickslip_reproduce.beam_orbits import EIGHT, NEAR, exact, optimum
from stickslip_reproduce.claims import Found, claim, numbers_of, verdict
from stickslip_reproduce.numbers import Fact
from stickslip_reproduce.resolution import Resolution

FORCE = 20.313
SLIPPING, STUCK = (
    float(one[0])
    for one in (
        ss.natural_frequencies(ss.reference.snecma_beam(), slipping=[0]),
        ss.natural_frequencies(ss.reference.snecma_beam()),
    )
)
STIFFNESSES = tuple(2.4 * 10.0**power for power in range(4, 11))
"""Stiffnesses of the damper in Figs 4.5 to 4.8 [N/m]."""


@cache
def peak_state(load: float, dof: str) -> tuple[float, float]:
    """Return frequency and slip fraction at the exact peak of a place."""
    true = exact(load)
    top = true.peak(dof)
    at = int(np.abs(true.omega - top.omega).argmin())
    return top.omega, float(true.slip_fraction((0, 0))[at])


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
    "match-almost-perfectly",
    "4.2.1",
    "the hybrid frequency/time method is able to match almost perfectly the results predicted by "
    "time integration",
    """Difference of 19 harmonics to exact orbits, amplitude at the damper at 20.313 N, 170 rad/s;
    almost perfectly is 0.5 %.""",
    rule=lambda n: verdict(n["difference"] < 0.5, n["difference"] < 2.0),
    see="fig-4.1",
)
def match(resolution: Resolution) -> Found:
    """Difference of 19 harmonics."""
    shown = numbers_of("fig-4.1", resolution)
    kept, true = (
        shown.fact(f"amplitude at the damper, {what}") for what in ("19 harmonics", "exact")
    )
    return Found((Fact("difference", 100.0 * abs(kept / true - 1.0), "%"),))


@claim(
    "phase-shift",
    "4.2.1",
    "the occurrence of slipping introduces a small phase shift between the damper displacement and "
    "the displacement at the damper location",
    """Phase by which the fundamental of the damper's displacement is behind that of the beam, at
    20.313 N and 170 rad/s.""",
    rule=lambda n: verdict(0.1 < abs(n["phase"]) < 20.0, 0.0 < abs(n["phase"]) < 45.0),
    see="fig-4.1",
)
def phase_shift(resolution: Resolution) -> Found:
    """Phase between damper and beam."""
    one = ss.exact_response(ss.reference.snecma_beam(FORCE), [170.0])
    moved, held = one.waveform("damper", 0), one.damper_displacement((0, 0), 0)
    angles = (
        np.angle(np.exp(-2j * np.pi * np.arange(values.size) / values.size) @ values)
        for values in (moved, held)
    )
    ahead, behind = angles
    apart = (behind - ahead + np.pi) % (2.0 * np.pi) - np.pi
    return Found((Fact("phase", float(np.degrees(apart)), "deg"),))


@claim(
    "several-slips",
    "4.2.1",
    "there are in this case more than two slipping phases during one period of the motion",
    """Slips per period of the exact orbit at 25 N and 200 rad/s.""",
    rule=lambda n: verdict(n["slips per period"] > 2),
    see="fig-4.2",
)
def several_slips(resolution: Resolution) -> Found:
    """Slips per period."""
    shown = numbers_of("fig-4.2", resolution)
    return Found((Fact("slips per period", shown.fact("slips per period")),))


@claim(
    "slipping-group",
    "4.2.1",
    "cases where the damper is slipping most of the time. This is the case for high force "
    "amplitudes, namely for P = 31.475N and P = 38.438N. As the force amplitude increases, the "
    "resonance frequency of these response curves tends to the so-called slipping resonance "
    "frequency",
    """Smallest slip fraction at the exact peaks of both loads, and the frequency of the peak over
    the slipping one, at these and at ten times the larger load.""",
    rule=lambda n: verdict(
        n["slip fraction"] > 0.5
        and n["at 31.475 N"] > n["at 38.438 N"] > n["at 384.38 N"]
        and n["at 384.38 N"] < 1.001
    ),
    see="fig-4.3",
)
def slipping_group(resolution: Resolution) -> Found:
    """Slip fraction and frequency of the peaks at large loads."""
    shares = [peak_state(load, "damper")[1] for load in EIGHT[-2:]]
    facts = [Fact("slip fraction", min(shares))]
    for load in (*EIGHT[-2:], 10.0 * EIGHT[-1]):
        facts.append(Fact(f"at {load:g} N", peak_state(load, "damper")[0] / SLIPPING))
    return Found(tuple(facts))


@claim(
    "sticking-group",
    "4.2.1",
    "cases where the damper is sticking during most of the motion. This is the case for low levels "
    "of force amplitude, from P = 0.938N to P = 6.563N. As the force amplitude decreases, the "
    "resonance frequency of these response curves tends to the so-called sticking resonance "
    "frequency",
    """Largest slip fraction at the exact peaks of the three loads, and the frequency of the peak
    over the stuck one.""",
    rule=lambda n: verdict(
        n["slip fraction"] < 0.5
        and n["at 6.563 N"] < n["at 2.188 N"] <= n["at 0.938 N"]
        and abs(n["at 0.938 N"] - 1.0) < 0.001
    ),
    see="fig-4.3",
)
def sticking_group(resolution: Resolution) -> Found:
    """Slip fraction and frequency of the peaks at small loads."""
    facts = [Fact("slip fraction", max(peak_state(load, "damper")[1] for load in EIGHT[:3]))]
    facts += [Fact(f"at {load:g} N", peak_state(load, "damper")[0] / STUCK) for load in EIGHT[:3]]
    return Found(tuple(facts))


@claim(
    "optimal-group",
    "4.2.1",
    "intermediate levels of force amplitude, from P = 6.563N to P = 16.563N, and it can be seen "
    "that they also correspond to the optimal friction damper effect",
    """The best loads over all, with converged peaks: that of the damper's place, which Fig. 4.3
    shows, and that of the tip.""",
    rule=lambda n: verdict(all(6.563 <= load <= 16.563 for load in n.values())),
    see="fig-4.3 fig-4.4",
)
def optimal_group(resolution: Resolution) -> Found:
    """Best loads."""
    return Found(
        tuple(
            Fact(f"best load, {dof}", float(optimum(dof).value), "N") for dof in ("damper", "tip")
        )
    )


@claim(
    "two-optima",
    "4.2.1",
    "For the beam tip response, P = 20.313N for optimal damping, while P = 6.563N for minimum peak "
    "response at the damper location.",
    """The best of the eight loads by exact peaks, and the best over all loads: true among the
    eight.""",
    rule=lambda n: verdict(
        abs(n["best load, tip"] / 20.313 - 1.0) < 0.1
        and abs(n["best load, damper"] / 6.563 - 1.0) < 0.1,
        n["best of eight, tip"] == 20.313 and n["best of eight, damper"] == 6.563,
    ),
    see="fig-4.3 fig-4.4",
)
def two_optima(resolution: Resolution) -> Found:
    """Best of the eight loads and over all."""
    facts = []
    for dof, printed in (("tip", 20.313), ("damper", 6.563)):
        among = min(EIGHT, key=lambda load: exact(load).peak(dof).amplitude / load)
        facts += [
            Fact(f"best of eight, {dof}", among, "N", printed),
            Fact(f"best load, {dof}", float(optimum(dof).value), "N", printed),
        ]
    return Found(tuple(facts))


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
