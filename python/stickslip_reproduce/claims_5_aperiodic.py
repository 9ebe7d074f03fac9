"""Claims of chapter V on the motion at r = 0.361 that never repeats itself."""

from __future__ import annotations

import numpy as np

import stickslip as ss
from stickslip_reproduce.chapter_5_stability import wild_start
from stickslip_reproduce.claims import Found, claim, numbers_of, verdict
from stickslip_reproduce.numbers import Fact
from stickslip_reproduce.resolution import Resolution


@claim(
    "almost-mode-1",
    "5.4.1",
    "The agreement between time integration and hybrid frequency/time method is almost perfect for "
    "the second DOF, and is good for the first and third DOF.",
    """Difference of the aperiodic motion at r = 0.361 to the limit cycle of mode 1 over three
    periods, mean squares, in the mean of its tail. Almost perfect is 2 %, good 20 %.""",
    rule=lambda n: verdict(
        n["x₂"] < 2.0 and max(n["x₁"], n["x₃"]) < 20.0, n["x₂"] < 5.0 and n["x₁"] < 20.0
    ),
    see="fig-5.21 fig-5.22 fig-5.23",
)
def almost_mode_1(resolution: Resolution) -> Found:
    """Differences of the aperiodic motion to mode 1."""
    names = {"x₁": "fig-5.21", "x₂": "fig-5.22", "x₃": "fig-5.23"}
    what = "difference over the limit cycle, mean squares"
    return Found(
        tuple(
            Fact(letter, numbers_of(name, resolution).fact(what), "%")
            for letter, name in names.items()
        )
    )


@claim(
    "around-35-hz",
    "5.4.1",
    "the harmonic content of the signal is almost exclusively localized around 35 Hz",
    """Share of the power of x₃ from 30 to 41 Hz, at r = 0.361. Almost exclusively is 95 %.""",
    rule=lambda n: verdict(n["share of the power"] > 95.0, n["share of the power"] > 80.0),
    see="fig-5.24",
)
def around_35_hz(resolution: Resolution) -> Found:
    """Share of the power around 35 Hz."""
    (line,) = numbers_of("fig-5.24", resolution).plot.panels[0].series[:1]
    near = (line.x > 30.0) & (line.x < 41.0)
    return Found(
        (Fact("share of the power", 100.0 * float(line.y[near].sum() / line.y.sum()), "%"),)
    )


@claim(
    "three-small-lines",
    "5.4.1",
    "There is a small amplitude component around 225 Hz, which corresponds to the sticking "
    "frequency of the second mode [...] two other small components around 180 Hz and 250 Hz, which "
    "correspond, respectively, to the fifth harmonic and the seventh harmonic",
    """Lines nearest to these frequencies; they are to be within 2 %.""",
    rule=lambda n: verdict(
        abs(n["mode 2"] / 225.0 - 1.0) < 0.02
        and abs(n["5th harmonic"] / 180.0 - 1.0) < 0.02
        and abs(n["7th harmonic"] / 250.0 - 1.0) < 0.02
    ),
    see="fig-5.24",
)
def three_lines(resolution: Resolution) -> Found:
    """Lines of the aperiodic motion."""
    shown = numbers_of("fig-5.24", resolution)
    return Found(
        tuple(
            Fact(name, shown.fact(f"line of {name}"), "Hz", printed)
            for name, printed in (
                ("5th harmonic", 180.0),
                ("mode 2", 225.0),
                ("7th harmonic", 250.0),
            )
        )
    )


@claim(
    "no-such-components",
    "5.4.1",
    "the power spectral density analysis of the solution predicted by the hybrid frequency/time "
    "method revealed no such components",
    """5th and 7th harmonics of x₃ in the limit cycle of mode 1 at r = 0.361, 15 harmonics, over the
    fundamental.""",
    rule=lambda n: verdict(max(n.values()) < 0.1),
    see="fig-5.24",
)
def no_such(resolution: Resolution) -> Found:
    """Higher harmonics of the limit cycle of mode 1."""
    shown = numbers_of("fig-5.24", resolution)
    return Found(
        tuple(
            Fact(f"{n}th harmonic", shown.fact(f"{n}th harmonic of x₃ in the limit cycle"), "%")
            for n in (5, 7)
        )
    )


@claim(
    "no-improvement",
    "5.4.1",
    "no improvement was observed. The time integration results were checked after several thousand "
    "cycles, but the discrepancies were of the same order of magnitude as after several hundreds "
    "of cycles.",
    """Amplitude of x₃ over that of the limit cycle of mode 1 at r = 0.361, after 300 and after
    4000 periods of an integration that is exact between stick and slip, and the largest multiplier
    of that limit cycle: it is unstable, so that no step and no patience leads to it.""",
    rule=lambda n: verdict(
        n["multiplier"] > 1.0
        and abs(n["after 4000 periods"] - 1.0) < 10.0 * abs(n["after 300 periods"] - 1.0)
        and abs(n["after 4000 periods"] - 1.0) > 0.1 * abs(n["after 300 periods"] - 1.0)
    ),
    see="fig-5.23",
)
def no_improvement(resolution: Resolution) -> Found:
    """Return the distance of the aperiodic motion after a short and a long time."""
    driven, start, cycles, place = wild_start("zero")
    size = cycles.amplitude("mode")[place]
    facts = []
    for periods in (300, 4000):
        motion = ss.classify(driven, start, periods=periods)
        facts.append(Fact(f"after {periods} periods", float(motion.amplitude("mode") / size)))
    largest = float(np.abs(cycles.multipliers[place]).max())
    return Found((*facts, Fact("multiplier", largest)))
