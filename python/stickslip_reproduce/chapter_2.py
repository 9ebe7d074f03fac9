"""Chapter II: the improved single-harmonic approximation, for one mass and for the SNECMA beam."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import stickslip as ss
from stickslip_reproduce import errata
from stickslip_reproduce.curves import (
    FREQUENCY,
    PER_FORCE,
    PERIOD,
    PERIOD_SHARE,
    TIP,
    curve,
    maxima,
    over_period,
    settled,
)
from stickslip_reproduce.item import reproduces
from stickslip_reproduce.numbers import Axis, Cell, Fact, Numbers, Panel, Plot, Series, Table
from stickslip_reproduce.resolution import Resolution

SPAN = (20.0, 350.0)
NEAR_RESONANCE = (100.0, 300.0)
LEVELS = (0.1, 0.25, 0.5, 0.75, 1.0, 2.0)

PRINTED = {
    "tip": {
        "time integration": (0.37, 0.68, 0.72, 1.22, 1.45, 1.82, 2.98, 5.99),
        "single harmonic": (0.37, 0.71, 0.87, 1.18, 1.36, 1.73, 2.82, 5.22),
        "error": (0.0, 4.1, 17.2, 3.2, 6.5, 4.9, 5.6, 14.7),
    },
    "damper": {
        "time integration": (0.57, 1.12, 2.12, 6.22, 8.74, 13.03, 24.80, 50.68),
        "single harmonic": (0.57, 1.11, 2.25, 6.22, 8.52, 12.77, 24.12, 47.72),
        "error": (0.0, 0.9, 6.1, 0.0, 2.6, 2.0, 2.8, 6.2),
    },
}
"""Table 2.3 as printed: tip in mm, damper in 1e-5 m, errors in %."""


@reproduces(
    "fig-2.3",
    """The damper's displacement z has corners where it sticks and slips. Its first harmonic alone
    (Griffin) rounds them off; the friction law followed through the period of a harmonic motion
    gives them back, and lies on the time integration.""",
    corrected=(errata.SINGLE_HARMONIC,),
)
def figure_2_3(resolution: Resolution) -> Numbers:
    """Damper displacement of the single DOF over a period, P = 0.5 F_d, 225 rad/s."""
    model = ss.reference.single_dof(force_ratio=0.5)
    improved = ss.single_harmonic(model, [225.0]).damper_displacement((0, 0), 0)
    angles = np.linspace(0.0, 2.0 * np.pi, improved.size, endpoint=False)
    fundamental = 2.0 * np.mean(improved * np.exp(-1j * angles))
    standard = (fundamental * np.exp(1j * angles)).real
    run = ss.transient(model, 225.0, periods=5000, scheme="rk4", tolerance=1e-6, keep=1)
    stiffness = model.contacts[0].parameters()["stiffness"]
    integrated = run.contact_force((0, 0))[:-1] / stiffness
    every = improved.size // integrated.size
    slip = integrated.max()
    series = (
        over_period("Runge-Kutta", integrated, kind="marks", pair=2),
        over_period("first harmonic of z (Griffin)", standard, pair=1),
        over_period("improved single harmonic", improved, pair=0),
    )
    facts = (
        Fact("largest difference of Griffin's z", _apart(standard[::every], integrated, slip), "%"),
        Fact("largest difference of improved z", _apart(improved[::every], integrated, slip), "%"),
    )
    return Numbers(Plot(PERIOD_SHARE, PERIOD, (Panel(series),)), facts)


def _apart(one: np.ndarray, other: np.ndarray, whole: float) -> float:
    return float(100.0 * np.abs(one - other).max() / whole)


@reproduces(
    "fig-2.4",
    """A damper that mostly sticks: one harmonic gives the resonance of the mass, and the plateau
    F_d / k_d of the damper where it slips. Runge-Kutta from rest and exact orbits agree.""",
    corrected=(errata.SINGLE_HARMONIC,),
)
def figure_2_4(resolution: Resolution) -> Numbers:
    """Mass and damper of the single DOF over frequency, P = 0.5 F_d."""
    return _single_dof(0.5, resolution)


@reproduces(
    "fig-2.5",
    """A damper that mostly slips: below 70 rad/s the exact curve has subresonances, where an odd
    multiple of the excitation meets the resonance. One harmonic has none of them, but the right
    peak.""",
    corrected=(errata.SINGLE_HARMONIC,),
    inferred=("The amplitude axis is logarithmic here, so that the subresonances are seen.",),
)
def figure_2_5(resolution: Resolution) -> Numbers:
    """Mass and damper of the single DOF over frequency, P = 2 F_d."""
    return _single_dof(2.0, resolution, log=True)


def _single_dof(ratio: float, resolution: Resolution, *, log: bool = False) -> Numbers:
    model = ss.reference.single_dof(force_ratio=ratio)
    exact = ss.exact_response(model, SPAN, tolerance=resolution.tolerance)
    single = ss.single_harmonic(model, exact.omega)
    marks = resolution.marks(*SPAN, 5.0)
    mass, damper = settled(model, marks, "mass")
    orbits = curve(exact, "mass", "mass, exact orbits", kind="limit", pair=0)
    series = (
        orbits,
        Series("damper, exact orbits", exact.omega, exact.damper_amplitude((0, 0)), "limit", 1),
        curve(single, "mass", "mass, single harmonic", pair=0),
        Series("damper, single harmonic", single.omega, single.damper_amplitude((0, 0)), pair=1),
        Series("mass, Runge-Kutta", marks, mass, "marks", 0),
        Series("damper, Runge-Kutta", marks, damper, "marks", 1),
    )
    peak, rough = exact.peak("mass"), single.peak("mass")
    facts = [
        Fact("peak of the mass", peak.amplitude, "m"),
        Fact("at", peak.omega, "rad/s"),
        Fact("peak of the mass, single harmonic", rough.amplitude, "m"),
        Fact("at, single harmonic", rough.omega, "rad/s"),
    ]
    low = [top for top, _ in maxima(orbits) if top < 80.0]
    facts += [Fact(f"subresonance {n}", top, "rad/s") for n, top in enumerate(low[::-1], start=1)]
    y = Axis("amplitude", "m", "µm", 1e6, log=log)
    return Numbers(Plot(FREQUENCY, y, (Panel(series, f"P = {ratio:g} F_d"),)), tuple(facts))


@reproduces(
    "fig-2.6",
    """Per unit force the peak is lowest between P = 0.5 F_d and F_d; smaller forces let the damper
    stick, larger ones let it slip away. The resonance moves from the stuck to the free one.""",
    corrected=(errata.SINGLE_HARMONIC,),
    inferred=("Of the levels the text names 0.5, 1 and 2; the others are ours.",),
)
def figure_2_6(resolution: Resolution) -> Numbers:
    """Mass of the single DOF per unit force, single harmonic."""
    model = ss.reference.single_dof(force_ratio=1.0)
    series, facts = [], []
    for level in LEVELS:
        shown = ss.forced_response(
            model.scaled(force=level), NEAR_RESONANCE, 1, tolerance=resolution.tolerance
        )
        force = shown.model.forces[0].amplitude
        series.append(curve(shown, "mass", f"P = {level:g} F_d", per=force))
        facts.append(
            Fact(f"peak / P at {level:g} F_d", shown.peak("mass").amplitude / force, "m/N")
        )
    optimum = ss.optimal_damper(model, dof="mass", parameter="level", omega=NEAR_RESONANCE)
    facts.append(Fact("optimal P / F_d, converged", optimum.value))
    y = Axis("amplitude per force x / P", "m/N", "µm/N", 1e6)
    return Numbers(Plot(FREQUENCY, y, (Panel(tuple(series)),)), tuple(facts))


@reproduces(
    "fig-2.8",
    """At the damper one harmonic has nearly the right peak, but none of the humps between 220 and
    270 rad/s that the higher harmonics make. The damper rests at F_d / k_d where it slips.""",
    corrected=(errata.SINGLE_HARMONIC,),
)
def figure_2_8(resolution: Resolution) -> Numbers:
    """Displacement at the damper and of the damper, beam at 16.563 N."""
    model = ss.reference.snecma_beam(force=16.563)
    exact = ss.exact_response(model, SPAN, tolerance=resolution.tolerance)
    single = ss.single_harmonic(model, exact.omega)
    marks = resolution.marks(*SPAN, 5.0)
    beam, damper = settled(model, marks, "damper")
    series = (
        curve(exact, "damper", "beam, exact orbits", kind="limit", pair=0),
        Series("damper, exact orbits", exact.omega, exact.damper_amplitude((0, 0)), "limit", 1),
        curve(single, "damper", "beam, single harmonic", pair=0),
        Series("damper, single harmonic", single.omega, single.damper_amplitude((0, 0)), pair=1),
        Series("beam, Runge-Kutta", marks, beam, "marks", 0),
        Series("damper, Runge-Kutta", marks, damper, "marks", 1),
    )
    facts = (
        Fact("peak at the damper", exact.peak("damper").amplitude, "m", 6.22e-5),
        Fact("single harmonic", single.peak("damper").amplitude, "m", 6.22e-5),
    )
    y = Axis("amplitude at the damper", "m", "µm", 1e6)
    return Numbers(Plot(FREQUENCY, y, (Panel(series, "P = 16.563 N"),)), facts)


@reproduces(
    "fig-2.9",
    """At the tip the single harmonic is less exact than at the damper: the harmonics that friction
    excites grow along the beam. Its peak is 3 % low, and lies at another frequency.""",
    corrected=(errata.SINGLE_HARMONIC,),
)
def figure_2_9(resolution: Resolution) -> Numbers:
    """Tip of the beam at 16.563 N."""
    model = ss.reference.snecma_beam(force=16.563)
    exact = ss.exact_response(model, SPAN, tolerance=resolution.tolerance)
    single = ss.single_harmonic(model, exact.omega)
    marks = resolution.marks(*SPAN, 5.0)
    series = (
        curve(exact, "tip", "exact orbits", kind="limit", pair=0),
        curve(single, "tip", "single harmonic", pair=0),
        Series("Runge-Kutta", marks, settled(model, marks, "tip")[0], "marks", 1),
    )
    peak, rough = exact.peak("tip"), single.peak("tip")
    facts = (
        Fact("peak of the tip", peak.amplitude, "m", 1.22e-3),
        Fact("at", peak.omega, "rad/s"),
        Fact("single harmonic", rough.amplitude, "m", 1.18e-3),
        Fact("at, single harmonic", rough.omega, "rad/s"),
    )
    return Numbers(Plot(FREQUENCY, TIP, (Panel(series, "P = 16.563 N"),)), facts)


@reproduces(
    "table-2.3",
    """Exact orbits confirm the printed time integration to 0.7 %, but for the damper at 16.563 N,
    where it is 1 % low. One harmonic errs by up to 21 % at the tip and 6 % at the damper, and by
    less than 7 % wherever friction damps best.""",
    corrected=(errata.SINGLE_HARMONIC, errata.ERROR_ROW),
    inferred=("Runge-Kutta runs at the frequency of the exact peak, until it is steady.",),
)
def table_2_3(resolution: Resolution) -> Numbers:
    """Peaks of the beam at eight loads."""
    beam = ss.reference.snecma_beam(force=1.0)
    rows: list[tuple[Cell, ...]] = []
    for place, load in enumerate(ss.reference.SNECMA_LOADS):
        model = beam.scaled(force=load)
        exact = ss.exact_response(model, NEAR_RESONANCE, tolerance=resolution.tolerance)
        single = ss.single_harmonic(model, exact.omega)
        for dof, scale in (("tip", 1e-3), ("damper", 1e-5)):
            true, rough = exact.peak(dof), single.peak(dof).amplitude
            ours = {
                "time integration": float(settled(model, [true.omega], dof)[0][0]),
                "single harmonic": rough,
            }
            for method, value in ours.items():
                printed = PRINTED[dof][method][place] * scale
                apart = 100.0 * (value / printed - 1.0)
                error = 100.0 * (value / true.amplitude - 1.0)
                rows.append((load, dof, method, "m", printed, value, true.amplitude, apart, error))
            error = 100.0 * abs(rough / true.amplitude - 1.0)
            printed = PRINTED[dof]["error"][place]
            rows.append((load, dof, "error", "%", printed, error, error, error - printed, None))
    columns = (
        "load [N]",
        "place",
        "what",
        "unit",
        "printed",
        "ours",
        "exact",
        "ours to printed [%]",
        "ours to exact [%]",
    )
    table = Table(columns, tuple(rows))
    return Numbers(_peaks_over_load(rows), _largest_errors(table), table)


def _largest_errors(table: Table) -> tuple[Fact, ...]:
    printed = {"tip": 17.2, "damper": 6.2}
    return tuple(
        Fact(
            f"largest error of one harmonic, {dof}",
            max(float(row[5] or 0.0) for row in table.rows if row[1:3] == (dof, "error")),
            "%",
            printed[dof],
        )
        for dof in ("tip", "damper")
    )


def _peaks_over_load(rows: Sequence[tuple[Cell, ...]]) -> Plot:
    """Draw every peak over the exact one."""
    panels = []
    for dof, title in (("tip", "tip"), ("damper", "at the damper")):
        series = []
        for pair, method in enumerate(("time integration", "single harmonic")):
            found = [row for row in rows if row[1:3] == (dof, method)]
            load, printed, ours, true = (
                np.array([row[place] for row in found], dtype=np.float64) for place in (0, 4, 5, 6)
            )
            series.append(Series(method, load, ours / true, pair=pair))
            series.append(Series(f"{method}, printed", load, printed / true, "marks", pair))
        panels.append(Panel(tuple(series), title))
    return Plot(Axis("load P", "N", log=True), Axis("peak over exact peak"), tuple(panels))


@reproduces(
    "fig-2.10",
    """Per unit force the peak at the damper is lowest at 6.563 N of the eight loads: there friction
    damps best. Small loads resonate near the stuck frequency, large ones near the free one.""",
    corrected=(errata.SINGLE_HARMONIC, errata.OPTIMUM, errata.MISPRINTED_LEVEL),
)
def figure_2_10(resolution: Resolution) -> Numbers:
    """Beam at the damper per unit force, single harmonic."""
    return _levels("damper", resolution)


@reproduces(
    "fig-2.11",
    """At the tip other loads are best than at the damper: from 16.563 to 25 N in print, with a
    lower optimum between 6.563 and 16.563 N.""",
    corrected=(errata.SINGLE_HARMONIC, errata.OPTIMUM),
)
def figure_2_11(resolution: Resolution) -> Numbers:
    """Tip of the beam per unit force, single harmonic."""
    return _levels("tip", resolution)


def _levels(dof: str, resolution: Resolution) -> Numbers:
    beam = ss.reference.snecma_beam(force=1.0)
    series, facts = [], []
    for load in ss.reference.SNECMA_LOADS:
        shown = ss.forced_response(
            beam.scaled(force=load), NEAR_RESONANCE, 1, tolerance=resolution.tolerance
        )
        series.append(curve(shown, dof, f"P = {load:g} N", per=load))
        facts.append(Fact(f"peak / P at {load:g} N", shown.peak(dof).amplitude / load, "m/N"))
    optimum = ss.optimal_damper(beam, dof=dof, parameter="level", mode=0)
    facts.append(Fact("optimal load, converged", optimum.value, "N"))
    return Numbers(Plot(FREQUENCY, PER_FORCE[dof], (Panel(tuple(series)),)), tuple(facts))
