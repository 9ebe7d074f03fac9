"""Chapter V, section 5.3: limit cycles of the SNECMA beam, all three modes damped negatively."""

from __future__ import annotations

import numpy as np

import stickslip as ss
from stickslip_reproduce import errata
from stickslip_reproduce.curves import PERIOD_SHARE, over_period
from stickslip_reproduce.cycles import (
    AMPLITUDES,
    LOWEST,
    MODES,
    NEWTON,
    OMEGA,
    RATIO,
    at,
    quantity,
    turn,
)
from stickslip_reproduce.item import reproduces
from stickslip_reproduce.numbers import Axis, Fact, Numbers, Panel, Plot, Series, Table
from stickslip_reproduce.resolution import Resolution

STARTS = (
    {"damper": 1e-5, "tip": 1e-3, "mode": 1e-5},
    {"damper": 1e-5, "tip": 1e-5, "mode": 3e-4},
    {"damper": 1e-6, "tip": 1e-6, "mode": 1e-5},
)
"""Displacements of Table 5.2 [m]."""

SHOWN = 0.15
"""Ratio of the time histories."""

TRIED = (0.1, 0.15, 0.2, 0.3, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0)
"""Ratios at which the starts of Table 5.2 are tried."""

END = 4.9
"""Ratio at which mode 1 ends in print."""

OUR_RATIO = "The ratio r of Figs 5.10-5.12 is not printed: r = 0.15, at which all three settle."

LETTERS = {"damper": "x₁", "tip": "x₂", "mode": "x₃"}


@reproduces(
    "table-5.2",
    """The three starts lead to the modes 1, 2 and 3 at small ratios. With a growing ratio the
    higher modes win, and from 2.5 on only the third is left; where mode 1 has no limit cycle any
    more (5), all grow without bound.""",
    inferred=(OUR_RATIO, "Integrated exactly between stick and slip, over 3000 periods of mode 1."),
)
def table_5_2(resolution: Resolution) -> Numbers:
    """Three starts and the modes they lead to."""
    beam, negative = ss.reference.flutter_beam()
    ratios = resolution.of(TRIED)
    rows: list[tuple[str | float | None, ...]] = []
    modes = []
    for ratio in ratios:
        ends = ss.basin_map(ss.destabilised(beam, negative, ratio), starts=STARTS)
        modes.append(ends.mode + 1)
        for case, start in enumerate(STARTS):
            settled = ends.motion[case] == "settled"
            name = MODES[ends.mode[case]] if ends.mode[case] >= 0 else None
            omega = float(ends.omega[case]) if settled else None
            rows.append((case + 1, *start.values(), ratio, str(ends.motion[case]), name, omega))
    columns = ("case", "x₁(0) [m]", "x₂(0) [m]", "x₃(0) [m]", "r", "motion", "about", "ω [rad/s]")
    series = tuple(
        Series(f"case {case + 1}", ratios, [row[case] for row in modes], "marks")
        for case in range(len(STARTS))
    )
    shown = ss.basin_map(ss.destabilised(beam, negative, SHOWN), starts=STARTS)
    facts = tuple(
        Fact(f"mode of case {case + 1} at r = {SHOWN:g}", float(mode + 1), "", case + 1.0)
        for case, mode in enumerate(shown.mode)
    )
    y = Axis("mode with the most energy, 0: unbounded")
    return Numbers(Plot(RATIO, y, (Panel(series),)), facts, Table(columns, tuple(rows)))


@reproduces(
    "fig-5.10",
    """Case 1 settles in mode 1: nearly harmonic at the tip, while higher harmonics are plain in
    x₁ and x₃. The damper slips for a small part of each half period.""",
    corrected=(errata.HARMONICS_OF_MODE_1,),
    inferred=(OUR_RATIO,),
)
def figure_5_10(resolution: Resolution) -> Numbers:
    """Time histories of case 1."""
    return _history(0)


@reproduces("fig-5.11", """Case 2 settles in mode 2.""", inferred=(OUR_RATIO,))
def figure_5_11(resolution: Resolution) -> Numbers:
    """Time histories of case 2."""
    return _history(1)


@reproduces(
    "fig-5.12",
    """Case 3, of the smallest displacements, settles in mode 3, in which x₃ moves against the
    others.""",
    inferred=(OUR_RATIO,),
)
def figure_5_12(resolution: Resolution) -> Numbers:
    """Time histories of case 3."""
    return _history(2)


def _history(case: int) -> Numbers:
    beam, negative = ss.reference.flutter_beam()
    driven = ss.destabilised(beam, negative, SHOWN)
    end = ss.classify(driven, STARTS[case])
    run = ss.transient(driven, end.omega, periods=1, start=end.final, samples=256)
    # The period begins where the damper's place is farthest out.
    first = int(run.displacement("damper")[:-1].argmax())
    motions = {letter: run.displacement(dof)[:-1] for dof, letter in LETTERS.items()}
    spring = run.contact_force(0)[:-1] / beam.contacts[0].parameters()["stiffness"]
    motions["x_d"] = spring
    series, facts = [], [Fact("ω", end.omega, "rad/s")]
    cycle = ss.limit_cycles(beam, negative, mode=case, ratio=[SHOWN], method="exact")
    place = at(cycle, SHOWN, "sticking")
    facts.append(Fact("ω of the exact limit cycle", float(cycle.omega[place]), "rad/s"))
    for letter, motion in motions.items():
        size = run.amplitude({"x₂": "tip", "x₃": "mode"}.get(letter, "damper"))
        label = f"{letter} / {size:.3g} m"
        series.append(over_period(label, np.roll(motion, -first) / size))
        if letter != "x_d":
            facts.append(Fact(f"amplitude {letter}", size, "m"))
    facts += [
        Fact(
            f"amplitude {letter} of the exact limit cycle", float(cycle.amplitude(dof)[place]), "m"
        )
        for dof, letter in LETTERS.items()
    ]
    facts.append(Fact("mode", float((end.mode or 0) + 1), "", case + 1.0))
    y = Axis("displacement over amplitude")
    title = f"case {case + 1}, r = {SHOWN:g}, ω = {end.omega:.2f} rad/s"
    return Numbers(Plot(PERIOD_SHARE, y, (Panel(tuple(series), title),)), tuple(facts))


@reproduces(
    "fig-5.13",
    """Every mode has its two branches and its own r_max, 5.17, 14.5 and 6.36. Three harmonics lie
    on the exact orbits but for mode 1, whose 7th harmonic is near mode 2.""",
    corrected=(errata.FIRST_FOLD,),
    inferred=(NEWTON,),
)
def figure_5_13(resolution: Resolution) -> Numbers:
    """Amplitude of DOF 1 over r in the three modes."""
    return _modes("damper")


@reproduces(
    "fig-5.14",
    """The tip moves most in mode 1; the general aspect is that of DOF 1.""",
    corrected=(errata.FIRST_FOLD,),
    inferred=(NEWTON,),
)
def figure_5_14(resolution: Resolution) -> Numbers:
    """Amplitude of DOF 2 over r in the three modes."""
    return _modes("tip")


@reproduces(
    "fig-5.15",
    """DOF 3 hardly moves in mode 1: there the higher harmonics count most, and three of them are
    too few.""",
    corrected=(errata.FIRST_FOLD, errata.HARMONICS_OF_MODE_1),
    inferred=(NEWTON,),
)
def figure_5_15(resolution: Resolution) -> Numbers:
    """Amplitude of DOF 3 over r in the three modes."""
    return _modes("mode")


@reproduces(
    "fig-5.16",
    """The frequency of every mode falls from that of the stuck beam to that of the slipping
    one.""",
    corrected=(errata.FIRST_FOLD, errata.ROW_OF_MASS),
    inferred=(NEWTON,),
)
def figure_5_16(resolution: Resolution) -> Numbers:
    """Frequency over r in the three modes."""
    return _modes("omega")


def _modes(dof: str) -> Numbers:
    beam, negative = ss.reference.flutter_beam()
    series, facts = [], []
    for mode, name in enumerate(MODES):
        exact = ss.limit_cycles(beam, negative, mode=mode, method="exact", stability=False)
        three = ss.limit_cycles(beam, negative, mode=mode, harmonics=3, stability=False)
        series += [
            Series(f"{name}, exact", exact.ratio, quantity(exact, dof), "limit", pair=mode),
            Series(f"{name}, H = 3", three.ratio, quantity(three, dof), pair=mode),
        ]
        one = ss.limit_cycles(beam, negative, mode=mode, ratio=[1.0], method="exact")
        value = float(quantity(one, dof)[at(one, 1.0, "sticking")])
        unit = "rad/s" if dof == "omega" else "m"
        facts += [
            Fact(f"r_max of {name}, H = 3", turn(three).ratio),
            Fact(f"r_max of {name}, exact", turn(exact).ratio),
            Fact(f"{name}, r = 1, sticking, exact", value, unit),
        ]
        if mode == 0:
            fold = min(exact.folds, key=lambda fold: abs(fold.value - END))
            facts.append(Fact("fold of mode 1 at its printed end, exact", fold.value, "", END))
    y = Axis(OMEGA.quantity, "rad/s", log=True) if dof == "omega" else AMPLITUDES[dof]
    return Numbers(Plot(RATIO, y, (Panel(tuple(series)),)), tuple(facts))


@reproduces(
    "table-5.3",
    """Where the negative damping goes to zero, the limit cycles have the natural frequencies of
    the stuck and of the slipping beam.""",
    corrected=(errata.ROW_OF_MASS,),
)
def table_5_3(resolution: Resolution) -> Numbers:
    """Stuck and slipping natural frequencies, and the limit cycles at r = 0.01."""
    beam, negative = ss.reference.flutter_beam()
    printed = {"sticking": (225.42, 1404.38, 3273.79), "slipping": (159.40, 901.76, 2167.54)}
    natural = {
        "sticking": ss.natural_frequencies(beam),
        "slipping": ss.natural_frequencies(beam, slipping=[0]),
    }
    cycles = [
        ss.limit_cycles(beam, negative, mode=mode, ratio=[LOWEST], method="exact")
        for mode in range(3)
    ]
    series, facts = [], []
    rows: list[tuple[str | float | None, ...]] = []
    numbers = np.arange(1.0, 4.0)
    for pair, side in enumerate(natural):
        found = [float(cycle.omega[at(cycle, LOWEST, side)]) for cycle in cycles]
        series += [
            Series(f"{side}, natural", numbers, natural[side], "marks", pair),
            Series(f"{side}, limit cycle", numbers, found, "dots", pair),
        ]
        for mode, name in enumerate(MODES):
            value = float(natural[side][mode])
            facts.append(Fact(f"{side}, {name}", value, "rad/s", printed[side][mode]))
            rows.append((mode + 1, side, value, printed[side][mode], found[mode]))
    columns = (
        "mode",
        "damper",
        "ours [rad/s]",
        "printed [rad/s]",
        f"limit cycle at r = {LOWEST:g} [rad/s]",
    )
    x = Axis("number of the mode")
    return Numbers(
        Plot(x, OMEGA, (Panel(tuple(series)),)), tuple(facts), Table(columns, tuple(rows))
    )
