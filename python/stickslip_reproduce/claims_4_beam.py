"""Claims of chapter IV on the beam."""

from __future__ import annotations

from functools import cache

import numpy as np

import stickslip as ss
from stickslip_reproduce.beam_orbits import EIGHT, FORCE, SLIPPING, STUCK, exact, optimum
from stickslip_reproduce.claims import Found, claim, numbers_of, verdict
from stickslip_reproduce.numbers import Fact
from stickslip_reproduce.resolution import Resolution


@cache
def peak_state(load: float, dof: str) -> tuple[float, float]:
    """Return frequency and slip fraction at the exact peak of a place."""
    true = exact(load)
    top = true.peak(dof)
    at = int(np.abs(true.omega - top.omega).argmin())
    return top.omega, float(true.slip_fraction((0, 0))[at])


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
    return Found((_difference("fig-4.1", resolution),))


def _difference(figure: str, resolution: Resolution) -> Fact:
    shown = numbers_of(figure, resolution)
    kept, true = (
        shown.fact(f"amplitude at the damper, {what}") for what in ("19 harmonics", "exact")
    )
    return Fact("difference", 100.0 * abs(kept / true - 1.0), "%")


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
    "almost-the-same-amplitude",
    "4.2.1",
    "the damper displacement and the displacement at the damper location have almost the same "
    "amplitude, with the damper slipping only during a small portion of each period",
    """Exact orbit at 20.313 N and 170 rad/s: amplitude of the damper over that of the beam, and
    the share of the period that it slips. Almost is 10 %, small a quarter.""",
    rule=lambda n: verdict(n["amplitudes"] > 0.9 and 0.0 < n["slip fraction"] < 0.25),
    see="fig-4.1",
)
def almost_the_same(resolution: Resolution) -> Found:
    """Amplitudes of damper and beam."""
    one = ss.exact_response(ss.reference.snecma_beam(FORCE), [170.0])
    ratio = one.damper_amplitude((0, 0))[0] / one.amplitude("damper")[0]
    return Found(
        (
            Fact("amplitudes", float(ratio)),
            Fact("slip fraction", float(one.slip_fraction((0, 0))[0])),
        )
    )


@claim(
    "near-optimal-case",
    "4.2.1",
    "Figure 4.2 presents a case of near optimal damping.",
    """Exact peak per load at 25 N over the lowest of any load, at the tip and at the damper; near
    is 10 %.""",
    rule=lambda n: verdict(max(n.values()) < 10.0, min(n.values()) < 10.0),
    see="fig-4.2",
)
def near_optimal_case(resolution: Resolution) -> Found:
    """Peaks per load at 25 N above the lowest."""
    facts = []
    for dof in ("tip", "damper"):
        best = optimum(dof)
        lowest = best.amplitude / best.value
        above = exact(25.0).peak(dof).amplitude / 25.0 / lowest - 1.0
        facts.append(Fact(dof, 100.0 * float(above), "% above the lowest"))
    return Found(tuple(facts))


@claim(
    "almost-identical",
    "4.2.1",
    "when 19 harmonics are accounted for, the results are almost identical to the ones predicted "
    "by time integration",
    """Difference of 19 harmonics to exact orbits, amplitude at the damper at 25 N, 200 rad/s;
    almost identical is 0.5 %.""",
    rule=lambda n: verdict(n["difference"] < 0.5, n["difference"] < 2.0),
    see="fig-4.2",
)
def almost_identical(resolution: Resolution) -> Found:
    """Difference of 19 harmonics at 25 N."""
    return Found((_difference("fig-4.2", resolution),))


@claim(
    "slip-and-stick",
    "4.2.1",
    "the third group of curves corresponds to cases where the damper undergoes both significant "
    "slipping and sticking phases during each period of the motion",
    """Smallest and largest slip fraction at the exact peaks of 6.563 and 16.563 N, at the damper;
    significant is a quarter each.""",
    rule=lambda n: verdict(
        n["least"] > 0.25 and n["most"] < 0.75, n["least"] > 0.0 and n["most"] < 1.0
    ),
    see="fig-4.3",
)
def slip_and_stick(resolution: Resolution) -> Found:
    """Slip fractions of the third group."""
    shares = [peak_state(load, "damper")[1] for load in EIGHT if 6.5 < load < 17.0]
    return Found((Fact("least", min(shares)), Fact("most", max(shares))))


@claim(
    "three-groups-at-the-tip",
    "4.2.1",
    "As in Fig. 4.3, there are three groups of curves which correspond to the cases described "
    "above.",
    """Slip fractions at the exact peaks of the tip at the eight loads: loads that slip less than a
    third, more than two thirds, and between.""",
    rule=lambda n: verdict(min(n.values()) > 0),
    see="fig-4.4",
)
def three_groups_at_the_tip(resolution: Resolution) -> Found:
    """Return the number of loads in each group, at the tip."""
    shares = [peak_state(load, "tip")[1] for load in EIGHT]
    return Found(
        (
            Fact("sticking", sum(one < 1 / 3 for one in shares)),
            Fact("between", sum(1 / 3 <= one <= 2 / 3 for one in shares)),
            Fact("slipping", sum(one > 2 / 3 for one in shares)),
        )
    )
