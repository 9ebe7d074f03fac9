"""Claims of chapter IV on rings of 36 beams."""

from __future__ import annotations

import time
from functools import cache

import numpy as np

import stickslip as ss
from stickslip_reproduce.chapter_4_rings import SECTORS, SPAN
from stickslip_reproduce.claims import Found, claim, numbers_of, verdict
from stickslip_reproduce.curves import DAMPER, FREQUENCY, curve, maxima
from stickslip_reproduce.numbers import Axis, Fact, Panel, Plot, Series
from stickslip_reproduce.resolution import Float, Resolution

SEEDS = range(8)
COUPLINGS = ss.reference.RING_COUPLINGS
TOLERANCE = 2e-2
"""Accuracy of the curves: far below what any verdict depends on."""

INSET = (205.0, 225.0)
"""Range of the subresonances of Fig. 4.21f [rad/s]."""


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


@cache
def histories() -> tuple[ss.ForcedResponse, ...]:
    """Return the ring of Fig. 4.19 with 1 and 9 harmonics and converged."""
    observe = [f"{beam}.damper" for beam in range(SECTORS)]
    model = ring(7e3, 0)
    return tuple(
        ss.forced_response(model, [200.0], kept, observe=observe, tolerance=1e-3)
        for kept in (1, 9, "auto")
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
    model = ring(7e3, 0)
    begin = time.process_time()
    ss.transient(model, 200.0, periods=5000, scheme="rk4", tolerance=1e-6, keep=1)
    middle = time.process_time()
    for _ in range(3):
        ss.forced_response(model, [200.0], 9, method="broyden")
    taken = (time.process_time() - middle) / 3.0
    return Found((Fact("Runge-Kutta takes", (middle - begin) / taken, "times"),))


@claim(
    "similar-at-the-ends",
    "4.5",
    "for low and high values of the coupling, the beams respond in a similar way",
    """Highest over lowest peak of the 36 beams, mean of eight patterns, at the lowest and the
    highest coupling, and the largest of those between.""",
    rule=lambda n: verdict(
        max(n["1000 N/m"], n["100000 N/m"]) < 1.5 < n["largest between"],
        max(n["1000 N/m"], n["100000 N/m"]) < n["largest between"],
    ),
    see="fig-4.20 fig-4.21",
)
def similar(resolution: Resolution) -> Found:
    """Ratio of highest to lowest peak by coupling."""
    means = [
        float(np.mean([_ratio(peaks(coupling, seed)) for seed in SEEDS])) for coupling in COUPLINGS
    ]
    plot = Plot(
        Axis("coupling stiffness k_c", "N/m", log=True),
        Axis("highest over lowest peak of 36 beams"),
        (
            Panel(
                tuple(
                    Series(
                        f"seed {seed}",
                        COUPLINGS,
                        [_ratio(peaks(coupling, seed)) for coupling in COUPLINGS],
                    )
                    for seed in SEEDS
                )
            ),
        ),
    )
    facts = (
        Fact("1000 N/m", means[0]),
        Fact("100000 N/m", means[-1]),
        Fact("largest between", max(means[1:-1])),
    )
    return Found(facts, plot)


def _ratio(values: Float) -> float:
    return float(values.max() / values.min())


@claim(
    "two-kinds-of-resonance",
    "4.5",
    "some beams exhibit a slipping-type resonance, and others exhibit a sticking-type resonance, "
    "with large differences in the peak resonant amplitudes of the various beams",
    """Frequencies of the lowest and the highest of the 36 beams' own peaks, k_c = 6000 N/m, seed 0,
    and the slip fractions of the dampers there. The frequencies differ by as much as those of the
    slipping and the stuck beam would at one stiffness, 1.41, where they differ by more than
    1.2.""",
    rule=lambda n: verdict(
        n["highest over lowest frequency"] > 1.2 and n["smallest slip fraction"] < 0.2,
        n["highest over lowest frequency"] > 1.05,
    ),
    see="fig-4.21",
)
def two_kinds(resolution: Resolution) -> Found:
    """Frequencies and slip fractions of the beams at their peaks."""
    found = response(6e3, 0)
    tops = found.blade_amplitudes("damper").argmax(axis=0)
    shares = [float(found.slip_fraction((beam, 0))[tops[beam]]) for beam in range(SECTORS)]
    omega = found.omega[tops]
    return Found(
        (
            Fact("highest over lowest frequency", float(omega.max() / omega.min())),
            Fact("largest slip fraction", max(shares)),
            Fact("smallest slip fraction", min(shares)),
        )
    )


@claim(
    "few-slipping-blades",
    "4.1",
    "localized responses, which are characterized by mostly sticking motion at most blades and "
    "mostly slipping motion at a few blades",
    """Share of the 36 beams whose damper slips more than half of the period at the frequency of the
    highest peak, k_c = 6000 and 7000 N/m, eight patterns: mean. A few is a third at most.""",
    rule=lambda n: verdict(0.0 < n["slip more than half"] <= 33.0, n["slip more than half"] < 50.0),
)
def few_slipping(resolution: Resolution) -> Found:
    """Share of the blades that mostly slip."""
    shares = []
    for coupling in (6e3, 7e3):
        for seed in SEEDS:
            found = response(coupling, seed)
            at = int(found.blade_amplitudes("damper").max(axis=1).argmax())
            slips = [float(found.slip_fraction((beam, 0))[at]) for beam in range(SECTORS)]
            shares.append(np.mean(np.array(slips) > 0.5))
    return Found((Fact("slip more than half", 100.0 * float(np.mean(shares)), "%"),))


@claim(
    "factor-five",
    "4.5",
    "Although the system is only 7%-mistuned, there is up to a factor five between the peak "
    "response amplitudes of the beams",
    """Highest over lowest peak of the 36 beams, the largest over all couplings, for eight patterns:
    the least and the most of them. The print's random numbers are not known.""",
    rule=lambda n: verdict(n["least"] <= 5.0 <= n["most"], n["most"] > 3.0),
    see="fig-4.21",
)
def factor_five(resolution: Resolution) -> Found:
    """Largest ratio of peaks by pattern."""
    largest = [max(_ratio(peaks(coupling, seed)) for coupling in COUPLINGS) for seed in SEEDS]
    return Found((Fact("least", min(largest), "", 5.0), Fact("most", max(largest), "", 5.0)))


@claim(
    "beams-13-to-36",
    "4.5",
    "Beams 13 through 36 are not shown, but would reveal similar behavior.",
    """Mean peak of beams 13 to 36 over that of beams 1 to 12, the largest distance from 1 over the
    six couplings of Figs 4.20 and 4.21, seed 0.""",
    rule=lambda n: verdict(n["distance from 1"] < 0.3),
    see="fig-4.20 fig-4.21",
)
def others(resolution: Resolution) -> Found:
    """Mean peaks of the beams that are not shown."""
    # Beam 36 is sector 0.
    worst = 0.0
    for coupling in (1e3, 3e3, 5e3, 6e3, 1.2e4, 1e5):
        every = np.roll(peaks(coupling, 0), -1)
        worst = max(worst, abs(float(every[12:].mean() / every[:12].mean()) - 1.0))
    return Found((Fact("distance from 1", worst),))


@claim(
    "ring-subresonances",
    "4.5",
    "The multi-harmonic method is also able to capture subresonances, as seen in Fig. 4.21f.",
    """Maxima from 205 to 225 rad/s of beams 1 to 12 at k_c = 1e5 N/m, seed 0: the most of any beam
    with 3 harmonics and with one. One harmonic has them, too: they are resonances of the ring, not
    of a higher harmonic.""",
    rule=lambda n: verdict(
        n["3 harmonics"] > 0 and n["1 harmonic"] < n["3 harmonics"], n["3 harmonics"] > 0
    ),
    see="fig-4.21",
)
def ring_subresonances(resolution: Resolution) -> Found:
    """Subresonances of Fig. 4.21f, enlarged."""
    omega = np.linspace(*INSET, 161)
    observe = [f"{beam}.damper" for beam in range(1, 13)]
    facts, panels = [], []
    for kept, name in ((3, "3 harmonics"), (1, "1 harmonic")):
        shown = ss.forced_response(ring(1e5, 0), omega, kept, observe=observe)
        series = tuple(curve(shown, dof, f"beam {dof.split('.')[0]}") for dof in observe)
        facts.append(Fact(name, max(len(maxima(one)) for one in series)))
        panels.append(Panel(series, f"k_c = 1e5 N/m, {name}"))
    return Found(tuple(facts), Plot(FREQUENCY, DAMPER, tuple(panels)))


@claim(
    "stronger-at-the-dampers",
    "4.5",
    "the localization is stronger at the damper locations than at the tip of the beams, where the "
    "coupling stiffnesses are attached",
    """Patterns of eight in which the largest magnification factor over the couplings is higher at
    x₁ than at x₂, and the couplings and patterns in which it is.""",
    rule=lambda n: verdict(n["patterns"] == len(SEEDS), n["patterns"] > 0.5 * len(SEEDS)),
    see="fig-4.22",
)
def stronger(resolution: Resolution) -> Found:
    """Magnification factors at the dampers and at the tips."""
    both = {dof: np.array([factors(seed, dof) for seed in SEEDS]) for dof in ("damper", "tip")}
    more = both["damper"] > both["tip"]
    wins = both["damper"].max(axis=1) > both["tip"].max(axis=1)
    series = [
        Series(
            f"{place}, {end} of eight patterns",
            COUPLINGS,
            getattr(both[dof], end)(axis=0),
            pair=pair,
            kind="line" if end == "max" else "limit",
        )
        for pair, (dof, place) in enumerate((("damper", "x₁"), ("tip", "x₂")))
        for end in ("max", "min")
    ]
    plot = Plot(
        Axis("coupling stiffness k_c", "N/m", log=True),
        Axis("magnification factor, 3 harmonics"),
        (Panel(tuple(series)),),
    )
    facts = (
        Fact("patterns", int(wins.sum())),
        Fact("couplings and patterns", 100.0 * float(more.mean()), "%"),
    )
    return Found(facts, plot)


@claim(
    "intermediate-coupling",
    "4.5",
    "the localization factor is stronger for intermediate values of the coupling stiffness",
    """Couplings at which the factor at x₁ is highest, over eight patterns: the least, the median
    and the most.""",
    rule=lambda n: verdict(
        COUPLINGS[0] < n["least"] and n["most"] < COUPLINGS[-1],
        COUPLINGS[0] < n["median"] < COUPLINGS[-1],
    ),
    see="fig-4.22",
)
def intermediate(resolution: Resolution) -> Found:
    """Couplings of the highest factors."""
    best = [COUPLINGS[int(np.argmax(factors(seed, "damper")))] for seed in SEEDS]
    return Found(
        (
            Fact("least", min(best), "N/m"),
            Fact("median", float(np.median(best)), "N/m"),
            Fact("most", max(best), "N/m"),
        )
    )


@claim(
    "harmonics-and-localization",
    "4.5",
    "the number of harmonics has a significant influence on the degree of localization",
    """Largest relative difference of the magnification factors at x₁ of one and of three harmonics
    from the converged ones, over the couplings of Fig. 4.22; significant is 5 %.""",
    rule=lambda n: verdict(max(n.values()) > 5.0),
    see="fig-4.22",
)
def harmonics(resolution: Resolution) -> Found:
    """Differences of the magnification factors by harmonics."""
    shown = numbers_of("fig-4.22", resolution)
    found: dict[str, Float] = {
        one.label: one.y for one in shown.plot.panels[0].series if one.label.startswith("x₁")
    }
    true = found.pop("x₁, converged")
    return Found(
        tuple(
            Fact(label.split(", ")[1], 100.0 * float(np.abs(values / true - 1.0).max()), "%")
            for label, values in found.items()
        )
    )
