"""Chapter IV, section 4.3: a turbine blade, here the open one of `stickslip.reference`.

The blade of the dissertation is proprietary, and its figures have no units: amplitudes and
frequencies are over those of the peak with the damper stuck.
"""

from __future__ import annotations

import time
from functools import cache
from math import inf

import numpy as np

import stickslip as ss
from stickslip_reproduce import errata
from stickslip_reproduce.item import reproduces
from stickslip_reproduce.numbers import Axis, Fact, Numbers, Panel, Plot, Series
from stickslip_reproduce.resolution import Resolution

RATIOS = (0.01, 0.1, 0.3, 0.6, 1.0, 2.0, 5.0, 20.0, 100.0)
"""Slip forces over the best one, F_d / F_d0."""

SPAN = (0.95, 1.05)
"""From below the slipping to above the stuck natural frequency, over them."""

HARMONICS = 9

ORBITS = 200
"""Frequencies of exact orbits."""

TIMES = (
    *(0.930, 0.945, 0.955, 0.9605, 0.9625, 0.965, 0.9675, 0.971),
    *(0.975, 0.980, 0.985, 0.990, 1.0, 1.01, 1.025, 1.04),
)
"""Frequencies of the time integration over the stuck one."""

PATIENCE, SETTLED = 20000, 1e-6
"""Periods of a motion at most, and its relative change over one that counts as steady."""

FREQUENCY = Axis("frequency ω / ω of the stuck peak")
PLACES = {"damper": "x₁ at the damper", "tip": "x₂ of the tip"}

OPEN = (
    "The blade of the dissertation is not open: this is stickslip.reference.turbine_blade(), "
    "around its first mode, which moves the tip most; there it was the fifth."
)

RESONANCE = (
    "The stuck open blade has 3 ω₁ / ω₂ = 1.02: its third harmonic meets the second mode. This "
    "internal resonance makes two humps at optimal damping, and one harmonic alone is 53 % high."
)

LEVELS = "The ratios F_d / F_d0 are ours, from 0.01 to 100; F_d0 has the lowest peak of the tip."


def _blade(slip_force: float) -> ss.Model:
    return ss.reference.turbine_blade(slip_force)


def blade_span() -> tuple[float, float]:
    """Return the range of frequencies of the figures [rad/s]."""
    blade = ss.reference.turbine_blade()
    slipping = ss.natural_frequencies(blade, slipping=[0])[0]
    return SPAN[0] * float(slipping), SPAN[1] * float(ss.natural_frequencies(blade)[0])


@reproduces(
    "fig-4.10",
    """Three groups of curves as of the beam: small slip forces slip and resonate low, large ones
    stick and resonate high, and between them friction takes the peak down to a thirtieth.""",
    corrected=(errata.RETURN_MAP,),
    inferred=(OPEN, RESONANCE, LEVELS),
)
def figure_4_10(resolution: Resolution) -> Numbers:
    """Blade at the damper over frequency for several slip forces."""
    return _levels("damper", resolution)


@reproduces(
    "fig-4.11",
    """The same groups at the tip, where the best slip force takes the peak down to a fortieth:
    the blade itself has hardly any damping.""",
    corrected=(errata.RETURN_MAP,),
    inferred=(OPEN, RESONANCE, LEVELS),
)
def figure_4_11(resolution: Resolution) -> Numbers:
    """Tip of the blade over frequency for several slip forces."""
    return _levels("tip", resolution)


def _levels(dof: str, resolution: Resolution) -> Numbers:
    span = blade_span()
    stuck = ss.forced_response(_blade(inf), span).peak(dof)
    best = ss.optimal_damper(ss.reference.turbine_blade(), dof="tip", omega=span, mode=0)
    series, facts = [], [Fact("F_d0", best.slip_force, "N")]
    for ratio in RATIOS:
        shown = ss.forced_response(
            _blade(ratio * best.slip_force),
            span,
            HARMONICS,
            method="broyden",
            tolerance=resolution.tolerance,
        )
        peak = shown.peak(dof)
        series.append(
            Series(
                f"F_d / F_d0 = {ratio:g}",
                shown.omega / stuck.omega,
                shown.amplitude(dof) / stuck.amplitude,
            )
        )
        facts += [
            Fact(f"peak over the stuck one at {ratio:g} F_d0", peak.amplitude / stuck.amplitude),
            Fact(f"its frequency over the stuck one at {ratio:g} F_d0", peak.omega / stuck.omega),
        ]
    y = Axis(f"{PLACES[dof]} over its stuck peak", log=True)
    return Numbers(Plot(FREQUENCY, y, (Panel(tuple(series)),)), tuple(facts))


@reproduces(
    "fig-4.12",
    """At optimal damping nine harmonics, exact orbits and Runge-Kutta lie on each other. With so
    little damping of its own the blade takes thousands of periods to settle.""",
    corrected=(errata.RETURN_MAP,),
    inferred=(OPEN, RESONANCE),
)
def figure_4_12(resolution: Resolution) -> Numbers:
    """Blade at the damper at optimal damping, harmonic balance and time integration."""
    return _optimal("damper", resolution)


@reproduces(
    "fig-4.13",
    """The same agreement at the tip.""",
    corrected=(errata.RETURN_MAP,),
    inferred=(OPEN, RESONANCE),
)
def figure_4_13(resolution: Resolution) -> Numbers:
    """Tip of the blade at optimal damping, harmonic balance and time integration."""
    return _optimal("tip", resolution)


def _optimal(dof: str, resolution: Resolution) -> Numbers:
    span = blade_span()
    stuck = ss.forced_response(_blade(inf), span).peak(dof)
    best = ss.optimal_damper(ss.reference.turbine_blade(), dof="tip", omega=span, mode=0)
    blade = _blade(best.slip_force)
    shown = ss.forced_response(
        blade, span, HARMONICS, method="broyden", tolerance=resolution.tolerance
    )
    exact = ss.exact_response(blade, np.linspace(*span, resolution.count(ORBITS)))
    times = float(ss.natural_frequencies(blade)[0]) * np.array(resolution.of(TIMES))
    runs = settled_blade(best.slip_force, tuple(times.tolist()))
    settled = np.array([run[dof] for run in runs])
    same = ss.exact_response(blade, times).amplitude(dof)
    nine = ss.forced_response(blade, exact.omega, HARMONICS).amplitude(dof)
    every = exact.amplitude(dof)
    series = (
        Series("exact orbits", exact.omega / stuck.omega, every / stuck.amplitude, "limit"),
        Series(
            "9 harmonics (Broyden)",
            shown.omega / stuck.omega,
            shown.amplitude(dof) / stuck.amplitude,
        ),
        Series("Runge-Kutta", times / stuck.omega, settled / stuck.amplitude, "marks"),
    )
    facts = (
        Fact("peak over the stuck one", shown.peak(dof).amplitude / stuck.amplitude),
        Fact(
            "largest difference of 9 harmonics to exact orbits, over the peak",
            100.0 * float(np.abs(nine - every).max() / every.max()),
            "%",
        ),
        Fact(
            "largest difference of Runge-Kutta to exact orbits",
            100.0 * float(np.abs(settled / same - 1.0).max()),
            "%",
        ),
        Fact("periods until the slowest motion is steady", max(run["periods"] for run in runs)),
    )
    y = Axis(f"{PLACES[dof]} over its stuck peak")
    return Numbers(Plot(FREQUENCY, y, (Panel(series, "F_d = F_d0"),)), facts)


@cache
def settled_blade(slip_force: float, omega: tuple[float, ...]) -> tuple[dict[str, float], ...]:
    """Return settled amplitudes from rest, and the periods and seconds of processor time they took.

    They are kept, as two figures and Table 4.1 ask for them.
    """
    rows = []
    for frequency in omega:
        start = time.process_time()
        run = ss.transient(
            _blade(slip_force),
            frequency,
            periods=PATIENCE,
            scheme="rk4",
            tolerance=SETTLED,
            keep=1,
            observe=list(PLACES),
        )
        taken = {"periods": float(run.periods), "seconds": time.process_time() - start}
        rows.append({dof: run.amplitude(dof) for dof in PLACES} | taken)
    return tuple(rows)
