"""Chapter V, section 5.2: limit cycles of one mass with negative viscous damping."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

import stickslip as ss
from stickslip_reproduce import errata
from stickslip_reproduce.cycles import (
    AMPLITUDES,
    NEWTON,
    OMEGA,
    RATIO,
    at,
    quantity,
    sides,
    smooth,
    stable_share,
    turn,
)
from stickslip_reproduce.item import reproduces
from stickslip_reproduce.numbers import Axis, Fact, Numbers, Panel, Plot, Series
from stickslip_reproduce.resolution import Resolution

UNIT = {"mass": "m", "omega": "rad/s"}
Y = {"mass": AMPLITUDES["mass"], "omega": OMEGA}
STIFFNESSES = (4e6, 2.4e10)
"""From where no limit cycle exists to where the damper is as good as rigid [N/m]."""

KIND: Mapping[int, Literal["line", "limit"]] = {31: "limit", 21: "limit", 1: "line", 3: "line"}
"""How curves of so many harmonics are drawn: the many behind the few."""

MARKED = (0.1, 5.0, 0.2)
"""Ratios at which motions in time are followed: from, to, in steps of."""

TIME = (
    "The ratios and starts of the time integration are not printed: ours are 0.1 to 5 from 2 % "
    "below and 2 % above the slipping limit cycle, with its friction force F_d, by the exact flow."
)


@reproduces(
    "fig-5.1",
    """Two limit cycles for every r up to r_max: the lower one sticks most of the time and is
    stable, the upper one slips and is unstable. They meet at r_max, beyond which friction cannot
    take what is fed in. The marks are the closed formulas.""",
    corrected=(errata.SINGLE_HARMONIC, errata.SINGLE_CYCLE),
)
def figure_5_1(resolution: Resolution) -> Numbers:
    """Amplitude of the mass over r, one harmonic."""
    return _one_harmonic("mass", resolution)


@reproduces(
    "fig-5.2",
    """The frequency stays between that of the free and that of the stuck mass, 159.40 and
    225.42 rad/s, and falls along the branch from sticking to slipping.""",
    corrected=(errata.SINGLE_HARMONIC, errata.SINGLE_CYCLE),
)
def figure_5_2(resolution: Resolution) -> Numbers:
    """Frequency of the mass over r, one harmonic."""
    return _one_harmonic("omega", resolution)


def _one_harmonic(dof: str, resolution: Resolution) -> Numbers:
    model, negative = ss.reference.flutter_mass()
    branch = smooth(model, negative, harmonics=1)
    damper = model.contacts[0].parameters()
    marks, formula = [], []
    for ratio in resolution.marks(0.2, 5.0, 0.3):
        cycles = ss.single_harmonic_cycles(
            mass=model.structure.mass[0, 0],
            damping=ratio * negative[0, 0],
            stiffness=model.structure.stiffness[0, 0],
            contact_stiffness=damper["stiffness"],
            slip_force=damper["slip_force"],
        )
        marks += [ratio] * len(cycles)
        formula += [cycle.omega if dof == "omega" else cycle.amplitude for cycle in cycles]
    series = (*sides(branch, dof), Series("closed formulas", marks, formula, "marks"))
    ends = quantity(branch, dof)[[0, -1]]
    printed = (225.42, 159.40) if dof == "omega" else (None, None)
    facts = (
        *_limits(branch),
        Fact("at r = 0.01, sticking", float(ends[0]), UNIT[dof], printed[0]),
        Fact("at r = 0.01, slipping", float(ends[1]), UNIT[dof], printed[1]),
    )
    return Numbers(Plot(RATIO, Y[dof], (Panel(series),)), facts)


def _limits(branch: ss.LimitCycles) -> tuple[Fact, ...]:
    """Return where a branch turns, and where the exact one does."""
    exact = ss.limit_cycles(branch.model, branch.negative_damping, method="exact")
    return (
        Fact("r_max", turn(branch).ratio),
        Fact("r_max, exact", turn(exact).ratio),
        Fact("ω there, exact", turn(exact).omega, "rad/s"),
        Fact("stable share of the sticking side, exact", stable_share(exact, "sticking"), "%"),
        Fact("stable share of the slipping side, exact", stable_share(exact, "slipping"), "%"),
    )


@reproduces(
    "fig-5.3",
    """One harmonic and 31 lie on each other: the free motion of one mass has hardly any other.
    r_max differs by 0.1 %.""",
    corrected=(errata.SINGLE_HARMONIC,),
    inferred=(NEWTON,),
)
def figure_5_3(resolution: Resolution) -> Numbers:
    """Amplitude of the mass over r, 1 and 31 harmonics."""
    model, negative = ss.reference.flutter_mass()
    series, facts = [], []
    for harmonics in (31, 1):
        branch = smooth(model, negative, harmonics=harmonics)
        values = branch.amplitude("mass")
        series.append(Series(f"H = {harmonics}", branch.ratio, values, KIND[harmonics]))
        facts.append(Fact(f"r_max, H = {harmonics}", turn(branch).ratio))
    return Numbers(Plot(RATIO, AMPLITUDES["mass"], (Panel(tuple(series)),)), tuple(facts))


@reproduces(
    "fig-5.4",
    """Motions that start 2 % below the slipping branch all come to the sticking one; those that
    start 2 % above it grow without bound.""",
    inferred=(NEWTON, TIME),
)
def figure_5_4(resolution: Resolution) -> Numbers:
    """Amplitude of the mass over r, 5 harmonics and time integration."""
    return _integrated("mass", resolution)


@reproduces(
    "fig-5.5",
    """The sticking branch alone: time integration lies on 5 harmonics.""",
    inferred=(NEWTON, TIME),
)
def figure_5_5(resolution: Resolution) -> Numbers:
    """Amplitude of the mass on the sticking side, 5 harmonics and time integration."""
    return _integrated("mass", resolution, whole=False)


@reproduces(
    "fig-5.6",
    """The frequencies of the motions in time are those of the sticking branch, too.""",
    inferred=(NEWTON, TIME),
)
def figure_5_6(resolution: Resolution) -> Numbers:
    """Frequency of the mass over r, 5 harmonics and time integration."""
    return _integrated("omega", resolution)


@reproduces(
    "fig-5.7",
    """The frequency of the sticking branch alone: time integration lies on 5 harmonics.""",
    inferred=(NEWTON, TIME),
)
def figure_5_7(resolution: Resolution) -> Numbers:
    """Frequency of the mass on the sticking side, 5 harmonics and time integration."""
    return _integrated("omega", resolution, whole=False)


def _integrated(dof: str, resolution: Resolution, *, whole: bool = True) -> Numbers:
    model, negative = ss.reference.flutter_mass()
    branch = smooth(model, negative, harmonics=5)
    ratios = resolution.marks(*MARKED)
    exact = ss.limit_cycles(model, negative, ratio=ratios, method="exact")
    reached, bounded, grown, error = [], 0, 0, 0.0
    for ratio in ratios:
        slips, sticks = (at(exact, ratio, side) for side in ("slipping", "sticking"))
        orbit = exact.amplitude("mass")[slips]
        # At its largest displacement the damper of the orbit is at its slip limit.
        held = [ss.reference.DAMPER_SLIP_FORCE]
        driven = exact.model_at(slips)
        below, above = (
            ss.State(driven, {"mass": factor * orbit}, contact_force=held)
            for factor in (0.98, 1.02)
        )
        motions = ss.basin_map(driven, starts=[below, above])
        reached.append(float(quantity(motions, dof)[0]))
        bounded += motions.motion[0] == "settled"
        grown += motions.motion[1] == "unbounded"
        error = max(error, abs(reached[-1] / quantity(exact, dof)[sticks] - 1.0))
    stuck, slipped = sides(branch, dof)
    shown = (stuck, slipped) if whole else (stuck,)
    series = (*shown, Series("time integration", ratios, reached, "marks"))
    facts = (
        Fact("settled starts 2 % below the slipping branch", 100.0 * bounded / ratios.size, "%"),
        Fact("unbounded starts 2 % above it", 100.0 * grown / ratios.size, "%"),
        Fact("largest difference to the exact sticking orbit", 100.0 * error, "%"),
        *_at_ratios(dof),
    )
    y = Y[dof] if whole or dof == "omega" else Axis("amplitude of the mass", "m", "µm", 1e6)
    return Numbers(Plot(RATIO, y, (Panel(series),)), facts)


def _at_ratios(dof: str) -> tuple[Fact, ...]:
    """Return exact values on both sides at a small, a medium and a large ratio."""
    exact = ss.limit_cycles(*ss.reference.flutter_mass(), ratio=[0.1, 1, 5], method="exact")
    rows = zip(exact.ratio, exact.branch, quantity(exact, dof), strict=True)
    return tuple(Fact(f"exact, r = {r:g}, {side}", float(v), UNIT[dof]) for r, side, v in rows)


@reproduces(
    "fig-5.8",
    """Below ν = 0.167 the damper is too soft to slip enough and there is no limit cycle. A stiff
    damper leaves one whose amplitude no longer depends on ν, that of a rigid damper; the other
    one goes to zero.""",
    corrected=(errata.RIGID,),
    inferred=(NEWTON, "The ratio r is not printed: r = 1."),
)
def figure_5_8(resolution: Resolution) -> Numbers:
    """Amplitude of the mass over the stiffness of the damper, r = 1."""
    return _stiffnesses("mass")


@reproduces(
    "fig-5.9",
    """With the stiffness the frequency of the slipping cycle falls to that of the free mass,
    159.40 rad/s; that of the sticking one grows with the stiffness it sticks to.""",
    corrected=(errata.RIGID,),
    inferred=(NEWTON, "The ratio r is not printed: r = 1."),
)
def figure_5_9(resolution: Resolution) -> Numbers:
    """Frequency of the mass over the stiffness of the damper, r = 1."""
    return _stiffnesses("omega")


def _stiffnesses(dof: str) -> Numbers:
    model, negative = ss.reference.flutter_mass()
    nominal = ss.reference.DAMPER_STIFFNESS
    series = []
    for harmonics in (21, 3):
        branch = ss.limit_cycles(
            model, negative, stiffness=STIFFNESSES, harmonics=harmonics, stability=False
        )
        values = quantity(branch, dof)
        series.append(Series(f"H = {harmonics}", branch.values / nominal, values, KIND[harmonics]))
    rigid, rough = (
        ss.rigid_limit_cycle(
            mass=model.structure.mass[0, 0],
            damping=negative[0, 0],
            stiffness=model.structure.stiffness[0, 0],
            slip_force=ss.reference.DAMPER_SLIP_FORCE,
            single_harmonic=single,
        )
        for single in (False, True)
    )
    ends = [1.0, STIFFNESSES[1] / nominal]
    limit = rigid.omega if dof == "omega" else rigid.amplitude
    series.append(Series("rigid damper", ends, [limit] * 2))
    exact = ss.limit_cycles(
        model, negative, stiffness=[10 * nominal, 1000 * nominal], method="exact"
    )
    whole = ss.limit_cycles(model, negative, stiffness=STIFFNESSES, method="exact")
    printed = {"mass": (2.65e-4, None), "omega": (159.5, None)}[dof][0]
    facts = (
        Fact("smallest ν, exact", turn(whole).value / nominal),
        *(
            Fact(f"exact, ν = {value / nominal:g}, {side}", float(found), UNIT[dof])
            for value, side, found in zip(
                exact.values, exact.branch, quantity(exact, dof), strict=True
            )
        ),
        Fact("rigid damper, exact", limit, UNIT[dof], printed),
        Fact(
            "rigid damper, one harmonic",
            rough.omega if dof == "omega" else rough.amplitude,
            UNIT[dof],
            printed,
        ),
    )
    x = Axis("ratio ν of damper stiffness", log=True)
    y = Axis(Y[dof].quantity, "rad/s", log=True) if dof == "omega" else Y[dof]
    return Numbers(Plot(x, y, (Panel(tuple(series)),)), facts)
