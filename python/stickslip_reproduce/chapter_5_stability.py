"""Chapter V, section 5.4: stability of the limit cycles of the SNECMA beam."""

from __future__ import annotations

from functools import cache

import numpy as np

import stickslip as ss
from stickslip.results.fields import Float
from stickslip.results.motion_class import Line
from stickslip_reproduce import errata
from stickslip_reproduce.curves import DAMPER
from stickslip_reproduce.cycles import (
    AMPLITUDES,
    FORCES,
    LOWEST,
    MODES,
    NEWTON,
    OMEGA,
    RATIO,
    STARTS,
    at,
    beside,
    held,
    quantity,
    sides,
    smooth,
    stable_share,
    turn,
)
from stickslip_reproduce.item import reproduces
from stickslip_reproduce.numbers import Axis, Fact, Numbers, Panel, Plot, Series
from stickslip_reproduce.resolution import Resolution

TRIED = (0.25, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0)
"""Ratios at which eight starts are tried."""

SHOWN = (LOWEST, 6.5)
"""Range of Figs 5.17 to 5.20."""

WILD = 0.361
"""Ratio of Figs 5.21 to 5.24."""

SETTLED = "settled"
APERIODIC = "aperiodic, row below"
UNBOUNDED = "unbounded, lowest row"
CHANGED = "another motion with f(0) = clip(k_d x₁)"
OUTCOMES = (SETTLED, APERIODIC, UNBOUNDED)

ROWS = {CHANGED: 0.7, APERIODIC: 0.5, UNBOUNDED: 0.35}
"""Heights of the rows of marks that lie on no branch, over the lowest point of any."""

PERIODS = 3
"""Periods of the histories of Figs 5.21 to 5.23."""

HIGHEST = 300.0
"""End of the spectrum [Hz]."""

BEGUN = (
    "The ratios of the marks are ours. The print puts motions that are unbounded or do not settle "
    "at zero; here they have rows of their own below the branches. Starts are those of the print "
    "and signed ones."
)

READINGS = (
    "Friction forces at the start are not printed: marks are of f(0) = 0; what becomes of another "
    "class or mode with f(0) = clip(k_d x₁(0), −F_d, F_d) has a mark of its own."
)

BOTH = (
    "The friction force at the start is not printed: zero, and in the numbers also "
    "clip(k_d x₁(0), −F_d, F_d) = F_d; both motions stay aperiodic about mode 1."
)

FOLLOWED = "Integrated exactly between stick and slip; starts from 5 harmonics."


@reproduces(
    "fig-5.17",
    """Around the sticking orbits of mode 3, starts with the signs of mode 3 return to it at every
    ratio up to 4.5. Unsigned ones, as tried in print, lead elsewhere below 2. At 5 all grow
    without bound.""",
    corrected=(errata.UNSIGNED, errata.FIRST_FOLD),
    inferred=(NEWTON, BEGUN, READINGS, FOLLOWED),
)
def figure_5_17(resolution: Resolution) -> Numbers:
    """Amplitude of DOF 1, sticking branches and starts beside mode 3."""
    return _starts("damper", resolution)


@reproduces(
    "fig-5.18",
    """The same starts seen in DOF 2.""",
    corrected=(errata.UNSIGNED, errata.FIRST_FOLD),
    inferred=(NEWTON, BEGUN, READINGS, FOLLOWED),
)
def figure_5_18(resolution: Resolution) -> Numbers:
    """Amplitude of DOF 2, sticking branches and starts beside mode 3."""
    return _starts("tip", resolution)


@reproduces(
    "fig-5.19",
    """The same starts seen in DOF 3.""",
    corrected=(errata.UNSIGNED, errata.FIRST_FOLD),
    inferred=(NEWTON, BEGUN, READINGS, FOLLOWED),
)
def figure_5_19(resolution: Resolution) -> Numbers:
    """Amplitude of DOF 3, sticking branches and starts beside mode 3."""
    return _starts("mode", resolution)


@reproduces(
    "fig-5.20",
    """The frequencies show which mode the same starts come to.""",
    corrected=(errata.UNSIGNED, errata.FIRST_FOLD),
    inferred=(NEWTON, BEGUN, READINGS, FOLLOWED),
)
def figure_5_20(resolution: Resolution) -> Numbers:
    """Frequency, sticking branches and starts beside mode 3."""
    return _starts("omega", resolution)


def _starts(dof: str, resolution: Resolution) -> Numbers:
    beam, negative = ss.reference.flutter_beam()
    lines, panels, facts = [], [], []
    for mode, name in enumerate(MODES):
        branch = ss.limit_cycles(
            beam, negative, mode=mode, ratio=SHOWN, harmonics=3, stability=False
        )
        stuck = next(sides(branch, dof))
        lines.append(Series(f"{name}, H = 3", stuck.x, stuck.y))
    ratios = resolution.of(TRIED)
    lowest = min(float(line.y.min()) for line in lines)
    for kind in STARTS:
        zero, pulled = (beside(tuple(ratios), kind, forces) for forces in FORCES)
        points: dict[str, list[tuple[float, float]]] = {label: [] for label in OUTCOMES}
        changed = []
        for ratio, ends, others in zip(ratios, zero, pulled, strict=True):
            rows = zip(ends.motion, quantity(ends, dof), ends.mode, strict=True)
            for (motion, last, mode), other, there in zip(
                rows, others.motion, others.mode, strict=True
            ):
                label = _label(motion)
                height = float(last) if label == SETTLED else ROWS[label] * lowest
                points[label].append((ratio, height))
                if (motion, mode) != (other, there):
                    changed.append((ratio, ROWS[CHANGED] * lowest))
            for forces, one in zip(FORCES.values(), (ends, others), strict=True):
                settled = np.array([motion == "settled" for motion in one.motion])
                third = float((settled & (one.mode == 2)).sum())
                what = f"{kind} starts that come to mode 3 at r = {ratio:g}"
                facts.append(Fact(what if one is ends else f"{what}, {forces}", third))
        facts.append(Fact(f"{kind} starts that change with f(0)", float(len(changed))))
        points[CHANGED] = changed
        marks = [_marks(label, found) for label, found in points.items() if found]
        panels.append(Panel((*lines, *marks), f"{kind} starts around mode 3, f(0) = 0"))
    third_mode = ss.limit_cycles(beam, negative, mode=2, method="exact")
    facts.append(Fact("mode 3 sticking stable up to r", third_mode.changes[0].value))
    y = OMEGA if dof == "omega" else AMPLITUDES[dof]
    return Numbers(Plot(RATIO, y, tuple(panels)), tuple(facts))


def _label(motion: str) -> str:
    """Return the row of marks that a motion belongs to."""
    return {"settled": SETTLED, "unbounded": UNBOUNDED}.get(motion, APERIODIC)


def _marks(label: str, points: list[tuple[float, float]]) -> Series:
    return Series(label, [x for x, _ in points], [y for _, y in points], "marks")


@reproduces(
    "fig-5.21",
    """A start 2 % below the slipping branch of mode 3 comes to a motion around the sticking
    orbit of mode 1 that never repeats itself: that orbit is unstable.""",
    inferred=(NEWTON, FOLLOWED, BOTH),
)
def figure_5_21(resolution: Resolution) -> Numbers:
    """Time history of DOF 1 at r = 0.361 beside the limit cycle of mode 1."""
    return _history("damper")


@reproduces(
    "fig-5.22",
    """The tip moves nearly as in the limit cycle of mode 1.""",
    inferred=(NEWTON, FOLLOWED, BOTH),
)
def figure_5_22(resolution: Resolution) -> Numbers:
    """Time history of DOF 2 at r = 0.361 beside the limit cycle of mode 1."""
    return _history("tip")


@reproduces(
    "fig-5.23",
    """DOF 3, which mode 1 hardly moves, shows what else there is: a part in mode 2.""",
    corrected=(errata.HARMONICS_OF_MODE_1,),
    inferred=(NEWTON, FOLLOWED, BOTH),
)
def figure_5_23(resolution: Resolution) -> Numbers:
    """Time history of DOF 3 at r = 0.361 beside the limit cycle of mode 1."""
    return _history("mode")


@cache
def wild_start(forces: str) -> tuple[ss.Model, ss.State, ss.LimitCycles, int]:
    """Return model and start at r = 0.361, and the limit cycles of mode 1 with their place."""
    beam, negative = ss.reference.flutter_beam()
    third = ss.limit_cycles(beam, negative, mode=2, ratio=[WILD], harmonics=5, stability=False)
    place = at(third, WILD, "slipping")
    start = {dof: 0.98 * float(third.amplitude(dof)[place]) for dof in beam.structure.dofs}
    first = ss.limit_cycles(beam, negative, mode=0, ratio=[WILD], harmonics=15)
    driven = third.model_at(place)
    return driven, held(driven, start, forces), first, at(first, WILD, "sticking")


@cache
def _wild(forces: str = "zero") -> tuple[ss.MotionClass, ss.LimitCycles, int]:
    """Return the motion from there, and the limit cycles of mode 1 with their place."""
    driven, start, first, place = wild_start(forces)
    return ss.classify(driven, start, periods=1500), first, place


def _history(dof: str) -> Numbers:
    motion, cycles, place = _wild()
    omega = float(cycles.omega[place])
    count = int(PERIODS * 2.0 * np.pi / omega / motion.step) + 1
    angle = omega * motion.step * np.arange(count)
    orbit = cycles.coefficients(dof)[place]

    def beside(first: int) -> tuple[Float, Float]:
        """Return some periods of the motion, and the orbit, with the tip in phase."""
        followed = motion.tail[first : first + count]
        tip = np.exp(-1j * angle) @ followed[:, motion.dofs.index("tip")]
        behind = np.angle(tip) - np.angle(cycles.coefficients("tip")[place, 1])
        turns = np.outer(angle + behind, np.arange(orbit.size))
        return followed[:, motion.dofs.index(dof)], (np.exp(1j * turns) @ orbit).real

    def difference(first: int) -> float:
        own, orbit = beside(first)
        return float(np.sqrt(np.mean((own - orbit) ** 2) / np.mean(orbit**2)))

    followed, predicted = beside(0)
    # Rounding decides where in its wandering three periods fall: a mean of all of them.
    error = np.mean([difference(k) for k in range(0, len(motion.tail) - count + 1, count)])
    periods = angle / (2.0 * np.pi)
    series = (
        Series("limit cycle of mode 1, 15 harmonics", periods, predicted, "limit"),
        Series("time integration", periods, followed),
    )
    facts: tuple[Fact, ...] = (
        Fact("difference over the limit cycle, mean squares", 100.0 * float(error), "%"),
        Fact("amplitude of the limit cycle", float(cycles.amplitude(dof)[place]), "m"),
        Fact("amplitude of the motion", motion.amplitude(dof), "m"),
        Fact("whether the motion is aperiodic", float(motion.motion == "aperiodic")),
        Fact("mode with the most energy", float((motion.mode or 0) + 1), "", 1.0),
        Fact("largest multiplier of the limit cycle", float(abs(cycles.multipliers[place, 0]))),
    )
    facts += _readings(dof)
    y = Axis({"damper": "x₁", "tip": "x₂", "mode": "x₃"}[dof], "m", DAMPER.drawn, DAMPER.factor)
    x = Axis("time over the period of the limit cycle")
    return Numbers(Plot(x, y, (Panel(series, f"r = {WILD:g}"),)), facts)


def _readings(dof: str) -> tuple[Fact, ...]:
    """Return how the motion starts and what it becomes with both friction forces."""
    facts = []
    for forces, name in FORCES.items():
        motion = _wild(forces)[0]
        facts += [
            Fact(f"friction force at the start, {name}", float(motion.start.contact_force[0]), "N"),
            Fact(f"aperiodic about mode 1, {name}", float(_about_first(motion))),
            Fact(f"amplitude, {name}", motion.amplitude(dof), "m"),
        ]
    return tuple(facts)


def _about_first(motion: ss.MotionClass) -> bool:
    return motion.motion == "aperiodic" and motion.mode == 0


@reproduces(
    "fig-5.24",
    """The strongest line is mode 1 at 36 Hz. At 222 Hz is a part in mode 2, at 179 and 251 Hz are
    the 5th and 7th harmonics of the first.""",
    corrected=(errata.HARMONICS_OF_MODE_1,),
    inferred=(FOLLOWED, BOTH, "Welch's method in Hann windows."),
)
def figure_5_24(resolution: Resolution) -> Numbers:
    """Power spectral density of DOF 3 at r = 0.361."""
    motion, cycles, place = _wild()
    frequency, density = motion.spectrum("mode")
    kept = frequency <= HIGHEST
    lines = motion.lines("mode")
    orbit = np.abs(cycles.coefficients("mode")[place])
    printed = {"mode 1": 35.0, "5th harmonic": 180.0, "mode 2": 225.0, "7th harmonic": 250.0}
    facts = [
        Fact(f"line of {name}", _nearest(lines, value), "Hz", value)
        for name, value in printed.items()
    ]
    facts += [
        Fact(f"{n}th harmonic of x₃ in the limit cycle", 100.0 * float(orbit[n] / orbit[1]), "%")
        for n in (5, 7)
    ]
    facts += _readings("mode")
    other = _wild("pulled")[0].spectrum("mode")
    series = (
        Series(f"x₃, {FORCES['zero']}", frequency[kept], density[kept]),
        Series(f"x₃, {FORCES['pulled']}", other[0][kept], other[1][kept]),
    )
    y = Axis("power spectral density of x₃", "m²/Hz", log=True)
    return Numbers(
        Plot(Axis("frequency", "Hz"), y, (Panel(series, f"r = {WILD:g}"),)), tuple(facts)
    )


def _nearest(lines: list[Line], frequency: float) -> float:
    """Return the frequency of the line nearest to a frequency [Hz]."""
    return min((line.frequency for line in lines), key=lambda found: abs(found - frequency))


@reproduces(
    "fig-5.25",
    """With mode 3 alone damped negatively the beam is like one mass: a sticking branch below, a
    slipping one above, and one r_max.""",
    corrected=(errata.MODAL_COEFFICIENTS, errata.TWO_ORBITS),
    inferred=(NEWTON,),
)
def figure_5_25(resolution: Resolution) -> Numbers:
    """Amplitude of DOF 1 over r, only mode 3 damped negatively."""
    return _one_mode("damper")


@reproduces(
    "fig-5.26",
    """DOF 2 has the same two branches.""",
    corrected=(errata.MODAL_COEFFICIENTS, errata.TWO_ORBITS),
    inferred=(NEWTON,),
)
def figure_5_26(resolution: Resolution) -> Numbers:
    """Amplitude of DOF 2 over r, only mode 3 damped negatively."""
    return _one_mode("tip")


@reproduces(
    "fig-5.27",
    """DOF 3 has the same two branches, with the largest amplitudes.""",
    corrected=(errata.MODAL_COEFFICIENTS, errata.TWO_ORBITS),
    inferred=(NEWTON,),
)
def figure_5_27(resolution: Resolution) -> Numbers:
    """Amplitude of DOF 3 over r, only mode 3 damped negatively."""
    return _one_mode("mode")


@reproduces(
    "fig-5.28",
    """The frequency falls from that of the stuck third mode to that of the slipping one.""",
    corrected=(errata.MODAL_COEFFICIENTS, errata.TWO_ORBITS),
    inferred=(NEWTON,),
)
def figure_5_28(resolution: Resolution) -> Numbers:
    """Frequency over r, only mode 3 damped negatively."""
    return _one_mode("omega")


def _one_mode(dof: str) -> Numbers:
    beam, negative = ss.reference.flutter_beam(mode=2)
    branch = smooth(beam, negative, mode=2, harmonics=9)
    exact = ss.limit_cycles(beam, negative, mode=2, method="exact")
    ordered = ss.limit_cycles(
        *ss.reference.flutter_beam(mode=2, reading="ordered"), mode=2, method="exact"
    )
    facts = (
        Fact("r_max, H = 9", turn(branch).ratio),
        Fact("r_max, exact", turn(exact).ratio),
        Fact("ω there, exact", turn(exact).omega, "rad/s"),
        Fact("sticking branch stable up to r", exact.changes[0].value),
        Fact("stable share of the slipping side", stable_share(exact, "slipping"), "%"),
        Fact("r_max if mode 3 has the coefficient 5.789", turn(ordered).ratio),
    )
    every = Series("exact", exact.ratio, quantity(exact, dof), "limit")
    y = OMEGA if dof == "omega" else AMPLITUDES[dof]
    return Numbers(Plot(RATIO, y, (Panel((every, *sides(branch, dof))),)), facts)
