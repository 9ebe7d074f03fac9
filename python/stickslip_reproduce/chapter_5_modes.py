"""Chapter V, section 5.3: limit cycles of the SNECMA beam, all three modes damped negatively."""

from __future__ import annotations

import numpy as np

import stickslip as ss
from stickslip_reproduce import errata
from stickslip_reproduce.curves import PERIOD_SHARE, over_period
from stickslip_reproduce.cycles import (
    AMPLITUDES,
    FORCES,
    LOWEST,
    MODES,
    NEWTON,
    OMEGA,
    RATIO,
    at,
    held,
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

OPEN_FORCES = (
    "Friction forces at the start are not printed: the starts are tried with f(0) = 0 and with "
    "f(0) = clip(k_d x₁(0), −F_d, F_d), as if the damper had been pulled along from rest."
)

SAME_FORCES = (
    "Friction force at the start: zero; with f(0) = clip(k_d x₁(0), −F_d, F_d) the motion "
    "settles in the same limit cycle, see the numbers."
)

LETTERS = {"damper": "x₁", "tip": "x₂", "mode": "x₃"}


@reproduces(
    "table-5.2",
    """The three starts lead to the modes 1, 2 and 3 at small ratios. With a growing ratio the
    higher modes win, and from 2.5 on only the third is left; at 5, near the last fold of mode 1
    (5.169), all grow without bound. What changes with the friction force at the start is marked:
    case 2 at r = 1 and case 1 at 1.5.""",
    inferred=(OUR_RATIO, OPEN_FORCES, "Integrated exactly, over 3000 periods of mode 1."),
)
def table_5_2(resolution: Resolution) -> Numbers:
    """Three starts and the modes they lead to."""
    beam, negative = ss.reference.flutter_beam()
    ratios = resolution.of(TRIED)
    rows: list[tuple[str | float | None, ...]] = []
    modes: dict[str, list[list[int]]] = {forces: [] for forces in FORCES}
    changed: list[tuple[float, float]] = []
    for ratio in ratios:
        driven = ss.destabilised(beam, negative, ratio)
        states = {forces: [held(driven, one, forces) for one in STARTS] for forces in FORCES}
        ends = {forces: ss.basin_map(driven, starts=states[forces]) for forces in FORCES}
        for case, start in enumerate(STARTS):
            found = {(one.motion[case], int(one.mode[case])) for one in ends.values()}
            for forces, one in ends.items():
                mode = int(one.mode[case])
                omega = float(one.omega[case]) if one.motion[case] == "settled" else None
                began = float(states[forces][case].contact_force[0])
                name = MODES[mode] if mode >= 0 else None
                mark = "changed" if len(found) > 1 else None
                motion = str(one.motion[case])
                rows.append((case + 1, *start.values(), began, ratio, motion, name, omega, mark))
            if len(found) > 1:
                changed.append((ratio, float(ends["pulled"].mode[case] + 1)))
        for forces, one in ends.items():
            modes[forces].append((one.mode + 1).tolist())
    columns = (
        "case",
        "x₁(0) [m]",
        "x₂(0) [m]",
        "x₃(0) [m]",
        "f(0) [N]",
        "r",
        "motion",
        "about",
        "ω [rad/s]",
        "with the force",
    )
    series = [
        Series(f"case {case + 1}", ratios, [row[case] for row in modes["zero"]], "marks")
        for case in range(len(STARTS))
    ]
    if changed:
        places, found_modes = zip(*changed, strict=True)
        label = f"other motion with {FORCES['pulled']}"
        series.append(Series(label, places, found_modes, "marks"))
    driven = ss.destabilised(beam, negative, SHOWN)
    facts = [
        Fact(f"mode of case {case + 1} at r = {SHOWN:g}", float(mode + 1), "", case + 1.0)
        for case, mode in enumerate(ss.basin_map(driven, starts=STARTS).mode)
    ]
    facts.append(Fact("motions that change with the friction force", float(len(changed))))
    y = Axis("mode with the most energy, 0: unbounded")
    plot = Plot(RATIO, y, (Panel(tuple(series), FORCES["zero"]),))
    return Numbers(plot, tuple(facts), Table(columns, tuple(rows)))


@reproduces(
    "fig-5.10",
    """Case 1 settles in mode 1: nearly harmonic at the tip, while higher harmonics are plain in
    x₁ and x₃. The damper slips for a small part of each half period.""",
    corrected=(errata.HARMONICS_OF_MODE_1,),
    inferred=(OUR_RATIO, SAME_FORCES),
)
def figure_5_10(resolution: Resolution) -> Numbers:
    """Time histories of case 1."""
    return _history(0)


@reproduces("fig-5.11", """Case 2 settles in mode 2.""", inferred=(OUR_RATIO, SAME_FORCES))
def figure_5_11(resolution: Resolution) -> Numbers:
    """Time histories of case 2."""
    return _history(1)


@reproduces(
    "fig-5.12",
    """Case 3, of the smallest displacements, settles in mode 3, in which x₃ moves against the
    others.""",
    inferred=(OUR_RATIO, SAME_FORCES),
)
def figure_5_12(resolution: Resolution) -> Numbers:
    """Time histories of case 3."""
    return _history(2)


def _history(case: int) -> Numbers:
    beam, negative = ss.reference.flutter_beam()
    driven = ss.destabilised(beam, negative, SHOWN)
    end, pulled = (ss.classify(driven, held(driven, STARTS[case], one)) for one in FORCES)
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
        label = f"{letter} / {1e6 * size:.3g} µm"
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
    for forces, one in zip(FORCES.values(), (end, pulled), strict=True):
        facts += [
            Fact(f"friction force at the start, {forces}", float(one.start.contact_force[0]), "N"),
            Fact(f"ω, {forces}", one.omega, "rad/s"),
        ]
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
