"""Claims of chapter IV on mistuned rings: localisation and subresonances."""

from __future__ import annotations

import numpy as np

import stickslip as ss
from stickslip_reproduce.chapter_4_rings import SECTORS
from stickslip_reproduce.claims import Found, claim, numbers_of, verdict
from stickslip_reproduce.curves import DAMPER, FREQUENCY, curve, maxima
from stickslip_reproduce.numbers import Axis, Fact, Panel, Plot, Series
from stickslip_reproduce.resolution import Float, Resolution
from stickslip_reproduce.ring_responses import COUPLINGS, SEEDS, factors, peaks, response, ring

INSET = (205.0, 225.0)
"""Range of the subresonances of Fig. 4.21f [rad/s]."""


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
