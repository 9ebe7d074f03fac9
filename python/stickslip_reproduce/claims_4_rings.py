"""Claims of chapter IV on the motion of rings of 36 beams."""

from __future__ import annotations

import numpy as np

import stickslip as ss
from stickslip_reproduce.chapter_4_rings import SECTORS, SPAN
from stickslip_reproduce.claims import Found, claim, verdict
from stickslip_reproduce.numbers import Fact
from stickslip_reproduce.resolution import Resolution
from stickslip_reproduce.ring_responses import (
    COUPLINGS,
    SEEDS,
    balanced,
    histories,
    marched,
    response,
    ring,
)


@claim(
    "identical-beams",
    "4.5",
    "As expected, the frequency response is identical for all beams in the tuned case.",
    """All 36 beams solved together: largest difference between their amplitudes at the damper and
    at the tip, over the mean, and to the curve of the one blade of a travelling wave.""",
    rule=lambda n: verdict(max(n.values()) < 1e-6),
    see="fig-4.16 fig-4.17",
)
def identical_beams(resolution: Resolution) -> Found:
    """Differences between the beams of the tuned ring."""
    tuned = ss.reference.beam_ring(coupling=1e5, engine_order=2)
    omega = np.linspace(*SPAN, 45)
    whole = ss.forced_response(tuned.mistuned(np.zeros(SECTORS)), omega, 3)
    wave = ss.forced_response(tuned, omega, 3)
    facts = []
    for dof in ("damper", "tip"):
        found = whole.blade_amplitudes(dof)
        spread = np.ptp(found, axis=1) / found.mean(axis=1)
        apart = np.abs(found / wave.amplitude(dof)[:, None] - 1.0)
        facts += [
            Fact(f"between beams, {dof}", float(spread.max())),
            Fact(f"to one blade, {dof}", float(apart.max())),
        ]
    return Found(tuple(facts))


@claim(
    "twenty-degrees",
    "4.5",
    "there is a 20-degree phase difference in the responses of adjacent beams, as illustrated in "
    "Fig. 4.18. The same phase difference characterizes the displacements of adjacent dampers",
    """Largest distance from 20 degrees of the fundamentals of beams 1 to 6, and of their
    dampers, at 220 rad/s with 7 harmonics.""",
    rule=lambda n: verdict(max(n.values()) < 0.1),
    see="fig-4.18",
)
def twenty_degrees(resolution: Resolution) -> Found:
    """Phases between adjacent beams and dampers."""
    wave = ss.forced_response(ss.reference.beam_ring(coupling=1e5, engine_order=2), [220.0], 7)
    facts = []
    for name in ("beams", "dampers"):
        phases = []
        for number in range(1, 7):
            one = wave.sector(number)
            values = (
                one.waveform("damper", 0) if name == "beams" else one.damper_displacement((0, 0), 0)
            )
            turn = np.exp(-2j * np.pi * np.arange(values.size) / values.size)
            phases.append(np.angle(turn @ values))
        steps = np.degrees(np.abs(np.diff(np.unwrap(phases))))
        facts.append(Fact(name, float(np.abs(steps - 20.0).max()), "deg"))
    return Found(tuple(facts))


@claim(
    "seven-percent",
    "4.5",
    "the beam frequencies are generated from a uniform random distribution with 7% standard "
    "deviation",
    """Standard deviation of the first stuck frequency over the 36 beams, by the text's own formula
    E_i = (1 + S r_i) E_0 with S = 7 %, seed 0.""",
    rule=lambda n: verdict(abs(n["of the frequencies"] - 7.0) < 0.7),
)
def seven_percent(resolution: Resolution) -> Found:
    """Deviation of the frequencies of the beams."""
    pattern = ss.mistuning_pattern(SECTORS, 0.07, "uniform", seed=0)
    nominal = ss.reference.snecma_structure()
    first = []
    for deviation in pattern:
        beam = ss.Structure(nominal.mass, (1.0 + deviation) * nominal.stiffness, None, nominal.dofs)
        first.append(ss.natural_frequencies(ss.Model(beam, ss.reference.snecma_beam().contacts))[0])
    spread = np.std(first) / np.mean(first)
    return Found(
        (
            Fact("of the frequencies", 100.0 * float(spread), "%", 7.0),
            Fact("of the stiffness", 100.0 * float(np.std(pattern)), "%"),
        )
    )


@claim(
    "fair-approximation",
    "4.5",
    "The one-harmonic calculation, shown in Fig. 4.19a, provides a fair approximation of the "
    "amplitude of the response, but does poorly at describing the complex dynamic response of the "
    "system.",
    """Errors of the 36 amplitudes at the dampers at 200 rad/s with one harmonic, seed 0: the median
    and the largest. Fair is 10 %.""",
    rule=lambda n: verdict(n["largest error"] < 10.0, n["median error"] < 10.0),
    see="fig-4.19",
)
def fair(resolution: Resolution) -> Found:
    """Errors of one harmonic by beam."""
    return Found(_errors(0))


@claim(
    "nine-harmonics",
    "4.5",
    "results obtained with the hybrid frequency/time method with 9 harmonics, depicted in Fig. "
    "4.19b, describe accurately the truly stick/slip motions or the mostly slipping motions, with "
    "several stick/slip phases per cycle",
    """The same errors with 9 harmonics; accurate is 2 %.""",
    rule=lambda n: verdict(n["largest error"] < 2.0, n["median error"] < 2.0),
    see="fig-4.19",
)
def nine(resolution: Resolution) -> Found:
    """Errors of nine harmonics by beam."""
    return Found(_errors(1))


def _errors(which: int) -> tuple[Fact, ...]:
    found = histories()
    true = found[2].blade_amplitudes("damper")[0]
    errors = 100.0 * np.abs(found[which].blade_amplitudes("damper")[0] / true - 1.0)
    return (
        Fact("largest error", float(errors.max()), "%"),
        Fact("median error", float(np.median(errors)), "%"),
    )


@claim(
    "one-harmonic-is-section-2-4",
    "4.5",
    "the results predicted by the one-harmonic calculation are identical to the ones predicted by "
    "the improved single-harmonic approximation presented in Section 2.4",
    """Largest difference of both amplitudes over the 36 beams at 200 rad/s, with the phases that
    eq. (2.40) lacks in print.""",
    rule=lambda n: verdict(n["largest difference"] < 1e-6),
    see="fig-4.19",
)
def one_harmonic(resolution: Resolution) -> Found:
    """One harmonic by both methods."""
    observe = [f"{beam}.damper" for beam in range(SECTORS)]
    single = ss.single_harmonic(ring(7e3, 0), [200.0], observe=observe)
    apart = single.blade_amplitudes("damper") / histories()[0].blade_amplitudes("damper") - 1.0
    return Found((Fact("largest difference", float(np.abs(apart).max())),))


@claim(
    "unknowns",
    "4.5",
    "2052 equations are solved by the hybrid frequency/time Broyden method, of which 684 are "
    "non-linear",
    """N (2 N_h + 1) and N_d (2 N_h + 1) of the ring with 9 harmonics.""",
    rule=lambda n: verdict(n["equations"] == 2052 and n["non-linear"] == 684),
)
def unknowns(resolution: Resolution) -> Found:
    """Return the number of equations."""
    whole = ring(7e3, 0)
    one = ss.reference.snecma_beam()
    parts = 2 * 9 + 1
    return Found(
        (
            Fact("equations", len(one.structure) * whole.sectors * parts, "", 2052.0),
            Fact("non-linear", len(one.contacts) * whole.sectors * parts, "", 684.0),
        )
    )


@claim(
    "no-convergence-problems",
    "4.5",
    "No convergence problems were ever encountered",
    """Points that Broyden's method leaves unsolved: mistuned rings at seven couplings with 3
    harmonics and eight patterns each, and the frequencies that these curves ask for.""",
    rule=lambda n: verdict(n["unsolved"] == 0, n["unsolved"] < 0.01 * n["points"]),
    see="fig-4.20 fig-4.21",
)
def no_problems(resolution: Resolution) -> Found:
    """Points that Broyden's method does not solve."""
    every = [response(coupling, seed) for coupling in COUPLINGS for seed in SEEDS]
    solved = [one.converged for one in every]
    return Found(
        (
            Fact("unsolved", int(sum((~one).sum() for one in solved))),
            Fact("points", int(sum(one.size for one in solved))),
        )
    )


@claim(
    "orders-faster",
    "4.5",
    "the Broyden method is still several orders of magnitude faster than the numerical time "
    "integration",
    """Processor time of Runge-Kutta, 1000 steps per period from rest until a period changes the
    state by less than 1e-6, over that of Broyden's method with 9 harmonics: ring of Fig. 4.19, one
    frequency. Several orders are at least 100.""",
    rule=lambda n: verdict(n["Runge-Kutta takes"] > 100.0, n["Runge-Kutta takes"] > 3.0),
)
def orders_faster(resolution: Resolution) -> Found:
    """Time of Runge-Kutta over Broyden on the ring."""
    return Found((Fact("Runge-Kutta takes", marched() / balanced(9), "times"),))


@claim(
    "several-phases-per-cycle",
    "4.5",
    "the truly stick/slip motions or the mostly slipping motions, with several stick/slip phases "
    "per cycle",
    """Slips per period of the 36 dampers of Fig. 4.19, converged: the most, and how many dampers
    slip more than twice.""",
    rule=lambda n: verdict(n["dampers with more than two"] > 18, n["most slips per period"] > 2),
    see="fig-4.19",
)
def several_phases(resolution: Resolution) -> Found:
    """Return the slips per period of the dampers."""
    slips = []
    limit = ss.reference.DAMPER_SLIP_FORCE
    for beam in range(SECTORS):
        force = np.asarray(histories()[2].contact_force((beam, 0), 0))
        on = np.abs(force) > (1.0 - 1e-9) * limit
        slips.append(int((on & ~np.roll(on, 1)).sum()))
    return Found(
        (
            Fact("most slips per period", max(slips)),
            Fact("dampers with more than two", sum(count > 2 for count in slips)),
        )
    )
