"""Chapter IV, section 4.2: forced response of the SNECMA beam with many harmonics."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import stickslip as ss
from stickslip_reproduce import errata
from stickslip_reproduce.curves import (
    DAMPER,
    FREQUENCY,
    PER_FORCE,
    PERIOD,
    PERIOD_SHARE,
    TIP,
    curve,
    over_period,
)
from stickslip_reproduce.item import reproduces
from stickslip_reproduce.numbers import Fact, Numbers, Panel, Plot
from stickslip_reproduce.resolution import Resolution

SPAN = (100.0, 300.0)
FORCE = 20.313
"""Force of the section on damper stiffness [N], the best of the eight at the tip."""

SOFT = (2.4e4, 2.4e5, 2.4e6, 2.4e7)
STIFF = (2.4e7, 2.4e8, 2.4e9, 2.4e10)

NEAR = 0.05
"""How far the exact peak may be from that of 15 harmonics, over its frequency."""

RAISED = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")

STIFFNESSES = "The text names k_d ≤ 2.4e5 N/m and 'large values'; the steps of ten are ours."


@reproduces(
    "fig-4.1",
    """The damper slips for a small part of each half period: it stays a little behind the beam.
    19 harmonics lie on the time integration.""",
    corrected=(errata.RETURN_MAP,),
)
def figure_4_1(resolution: Resolution) -> Numbers:
    """Beam and damper over a period at 20.313 N, 170 rad/s."""
    return _history(20.313, 170.0, printed_slips=2)


@reproduces(
    "fig-4.2",
    """Near optimal damping the damper slips six times in a period, between the six it sticks.
    19 harmonics follow every one of them.""",
    corrected=(errata.RETURN_MAP,),
)
def figure_4_2(resolution: Resolution) -> Numbers:
    """Beam and damper over a period at 25 N, 200 rad/s."""
    return _history(25.0, 200.0)


def _history(force: float, omega: float, printed_slips: float | None = None) -> Numbers:
    model = ss.reference.snecma_beam(force)
    balance = ss.forced_response(model, [omega], harmonics=19, method="broyden")
    run = ss.transient(model, omega, periods=5000, scheme="rk4", tolerance=1e-6, keep=1)
    exact = ss.exact_response(model, [omega])
    stiffness = model.contacts[0].parameters()["stiffness"]
    series = (
        over_period("x₁, 19 harmonics (Broyden)", balance.waveform("damper", 0), pair=0),
        over_period("x_d, 19 harmonics (Broyden)", balance.damper_displacement((0, 0), 0), pair=1),
        over_period("x₁, Runge-Kutta", run.displacement("damper")[:-1], kind="marks", pair=0),
        over_period(
            "x_d, Runge-Kutta", run.contact_force((0, 0))[:-1] / stiffness, kind="marks", pair=1
        ),
    )
    kept, true = (float(one.amplitude("damper")[0]) for one in (balance, exact))
    events = exact.events(0)
    facts = (
        Fact("amplitude at the damper, exact", true, "m"),
        Fact("amplitude at the damper, 19 harmonics", kept, "m"),
        Fact("amplitude of the tip, exact", float(exact.amplitude("tip")[0]), "m"),
        Fact("slips per period", len(events) - events.count("sticks"), "", printed_slips),
    )
    title = f"P = {force:g} N, ω = {omega:g} rad/s"
    return Numbers(Plot(PERIOD_SHARE, PERIOD, (Panel(series, title),)), facts)


@reproduces(
    "fig-4.3",
    """Three groups of curves: large forces slip and resonate near the free beam, small ones stick
    and resonate near the stuck one, and between them friction damps best, at 6.563 N of the eight
    loads.""",
    corrected=(errata.RETURN_MAP, errata.OPTIMUM),
)
def figure_4_3(resolution: Resolution) -> Numbers:
    """Beam at the damper per unit force, 15 harmonics."""
    return _levels("damper", resolution)


@reproduces(
    "fig-4.4",
    """The same three groups at the tip, where 20.313 N is best of the eight loads: where to place
    the optimum depends on where the stress is.""",
    corrected=(errata.RETURN_MAP, errata.OPTIMUM),
)
def figure_4_4(resolution: Resolution) -> Numbers:
    """Tip of the beam per unit force, 15 harmonics."""
    return _levels("tip", resolution)


def _levels(dof: str, resolution: Resolution) -> Numbers:
    beam = ss.reference.snecma_beam(force=1.0)
    series, facts = [], []
    for load in ss.reference.SNECMA_LOADS:
        model = beam.scaled(force=load)
        shown = ss.forced_response(
            model, SPAN, harmonics=15, method="broyden", tolerance=resolution.tolerance
        )
        exact = ss.exact_response(model, shown.omega, observe=dof)
        peak, true = shown.peak(dof).amplitude, exact.peak(dof).amplitude
        series.append(curve(shown, dof, f"P = {load:g} N", per=load))
        facts.append(Fact(f"peak / P at {load:g} N", peak / load, "m/N"))
        facts.append(Fact(f"error of the peak at {load:g} N", 100.0 * (peak / true - 1.0), "%"))
    optimum = ss.optimal_damper(beam, dof=dof, parameter="level", mode=0)
    facts.append(Fact("optimal load, converged", optimum.value, "N"))
    facts.append(Fact("peak / P at the optimal load", optimum.amplitude / optimum.value, "m/N"))
    return Numbers(Plot(FREQUENCY, PER_FORCE[dof], (Panel(tuple(series)),)), tuple(facts))


@reproduces(
    "fig-4.5",
    """A soft damper never builds up its slip force: it leaves the beam as it is, near 159.6 rad/s.
    The stiffer the damper, the more it slips, dissipates and lowers the peak.""",
    corrected=(errata.RETURN_MAP, errata.SLIPPING_FREQUENCY),
    inferred=(STIFFNESSES,),
)
def figure_4_5(resolution: Resolution) -> Numbers:
    """Beam at the damper for soft dampers."""
    return _stiffnesses("damper", SOFT, resolution)


@reproduces(
    "fig-4.6",
    """The tip shows the same trend as the damper's place: a soft damper hardly slips and hardly
    damps.""",
    corrected=(errata.RETURN_MAP, errata.SLIPPING_FREQUENCY),
    inferred=(STIFFNESSES,),
)
def figure_4_6(resolution: Resolution) -> Numbers:
    """Tip of the beam for soft dampers."""
    return _stiffnesses("tip", SOFT, resolution)


@reproduces(
    "fig-4.7",
    """With a growing stiffness the response converges to that with a rigid damper: from 2.4e9 N/m
    on the curves cannot be told apart. 15 harmonics are too few for such stiff dampers: their peaks
    are 2.5 to 3 % above the exact ones, which differ by 0.4 % between 2.4e9 and 2.4e10 N/m.""",
    corrected=(errata.RETURN_MAP,),
    inferred=(STIFFNESSES,),
)
def figure_4_7(resolution: Resolution) -> Numbers:
    """Beam at the damper for stiff dampers."""
    return _stiffnesses("damper", STIFF, resolution)


@reproduces(
    "fig-4.8",
    """The tip converges to the response with a rigid damper as well.""",
    corrected=(errata.RETURN_MAP,),
    inferred=(STIFFNESSES,),
)
def figure_4_8(resolution: Resolution) -> Numbers:
    """Tip of the beam for stiff dampers."""
    return _stiffnesses("tip", STIFF, resolution)


def _stiffnesses(dof: str, values: Sequence[float], resolution: Resolution) -> Numbers:
    beam = ss.reference.snecma_beam(FORCE)
    series, facts = [], []
    for value in values:
        damper = ss.Jenkins("damper", stiffness=value, slip_force=ss.reference.DAMPER_SLIP_FORCE)
        model = beam.replaced(contacts=[damper])
        shown = ss.forced_response(
            model, SPAN, harmonics=15, method="broyden", tolerance=resolution.tolerance
        )
        near = np.abs(shown.omega / shown.peak(dof).omega - 1.0) < NEAR
        peak = ss.exact_response(model, shown.omega[near], observe=dof).peak(dof)
        error = 100.0 * (shown.peak(dof).amplitude / peak.amplitude - 1.0)
        power = str(int(np.log10(value))).translate(RAISED)
        series.append(curve(shown, dof, f"k_d = 2.4·10{power} N/m"))
        facts.append(Fact(f"exact peak at {value:g} N/m", peak.amplitude, "m"))
        facts.append(Fact(f"at, {value:g} N/m", peak.omega, "rad/s"))
        facts.append(Fact(f"error of 15 harmonics at {value:g} N/m", error, "%"))
    y = {"damper": DAMPER, "tip": TIP}[dof]
    return Numbers(Plot(FREQUENCY, y, (Panel(tuple(series), f"P = {FORCE:g} N"),)), tuple(facts))
