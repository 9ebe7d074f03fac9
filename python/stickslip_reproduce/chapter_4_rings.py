"""Chapter IV, section 4.5: rings of 36 SNECMA beams, tuned and mistuned.

Beam i of the dissertation is sector i here, beam 36 is sector 0: so the phases of eq. (4.3) agree.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np

import stickslip as ss
from stickslip_reproduce import errata
from stickslip_reproduce.curves import (
    DAMPER,
    FREQUENCY,
    PERIOD,
    PERIOD_SHARE,
    TIP,
    curve,
    over_period,
)
from stickslip_reproduce.item import reproduces
from stickslip_reproduce.numbers import Axis, Fact, Numbers, Panel, Plot, Series
from stickslip_reproduce.resolution import Resolution

SECTORS = 36
SPAN = (150.0, 260.0)
SUBRESONANCES = (205.0, 222.0)
"""Where those of Fig. 4.21f are [rad/s]."""

COUPLING = 1e5
"""Stiffness between the tips of the tuned ring [N/m]."""

PATTERN = ss.mistuning_pattern(SECTORS, 0.07, "uniform", seed=0)
"""Deviations of the stiffness of the beams: those of the dissertation are not printed."""

KEPT: Mapping[str, int | Literal["auto"]] = {"H = 1": 1, "H = 3": 3, "converged": "auto"}
"""Harmonics of Fig. 4.22: the two of the dissertation, and as many as it takes."""

FACTOR_TOLERANCE = 1e-2
"""Accuracy of the converged factors: far below what the number of harmonics changes."""

OURS = (
    "The random numbers are not printed: these are mistuning_pattern(36, 0.07, 'uniform', seed=0); "
    "only the kind of behaviour can be compared."
)


@reproduces(
    "fig-4.16",
    """All beams of the tuned ring respond alike. The curves come from one sector of a travelling
    wave; the marks from all 36 beams solved together, without the symmetry.""",
)
def figure_4_16(resolution: Resolution) -> Numbers:
    """Tuned ring at the dampers, beams 13 to 24."""
    return _tuned("damper", resolution)


@reproduces(
    "fig-4.17",
    """At the tips all beams of the tuned ring respond alike, too.""",
)
def figure_4_17(resolution: Resolution) -> Numbers:
    """Tuned ring at the tips, beams 13 to 24."""
    return _tuned("tip", resolution)


def _tuned(dof: str, resolution: Resolution) -> Numbers:
    ring = ss.reference.beam_ring(coupling=COUPLING, engine_order=2)
    beams = range(13, 25)
    wave = ss.forced_response(ring, SPAN, harmonics=3, tolerance=resolution.tolerance)
    marks = resolution.marks(*SPAN, 5.0)
    whole = ss.forced_response(
        ring.mistuned(np.zeros(SECTORS)), marks, 3, observe=[f"{beam}.{dof}" for beam in beams]
    )
    converged = ss.forced_response(ring, SPAN, tolerance=resolution.tolerance)
    series = [
        curve(converged, dof, "automatic harmonics", kind="limit", pair=1),
        *(
            curve(wave.sector(beam), dof, "one travelling wave, 3 harmonics", pair=0)
            for beam in beams
        ),
        *(
            curve(whole, f"{beam}.{dof}", "all 36 beams, 3 harmonics", kind="marks", pair=2)
            for beam in beams
        ),
    ]
    amplitudes = whole.blade_amplitudes(dof)
    spread = np.ptp(amplitudes, axis=1) / amplitudes.mean(axis=1)
    facts = (
        Fact("peak, 3 harmonics", wave.peak(dof).amplitude, "m"),
        Fact("peak, converged", converged.peak(dof).amplitude, "m"),
        Fact("largest difference between beams", 100.0 * float(spread.max()), "%"),
    )
    y = {"damper": DAMPER, "tip": TIP}[dof]
    return Numbers(Plot(FREQUENCY, y, (Panel(tuple(series), "beams 13 to 24"),)), facts)


@reproduces(
    "fig-4.18",
    """Adjacent beams move alike with 20 degrees between them, and so do their dampers.""",
)
def figure_4_18(resolution: Resolution) -> Numbers:
    """Time histories of beams 1 to 6 of the tuned ring at 220 rad/s."""
    ring = ss.reference.beam_ring(coupling=COUPLING, engine_order=2)
    wave = ss.forced_response(ring, [220.0], harmonics=7)
    beams = [(number, wave.sector(number)) for number in range(1, 7)]
    moved = tuple(over_period(f"beam {n}", beam.waveform("damper", 0)) for n, beam in beams)
    held = tuple(over_period(f"beam {n}", beam.damper_displacement((0, 0), 0)) for n, beam in beams)
    phases = np.unwrap([float(beam.phase("damper")[0]) for _, beam in beams])
    steps = np.degrees(np.diff(phases))
    facts = (
        Fact("phase between adjacent beams", float(np.abs(steps).max()), "deg", 20.0),
        Fact("amplitude at the damper", float(wave.amplitude("damper")[0]), "m"),
    )
    panels = (Panel(moved, "beam x₁"), Panel(held, "damper x_d"))
    return Numbers(Plot(PERIOD_SHARE, PERIOD, panels), facts)


@reproduces(
    "fig-4.19",
    """Three beams of one mistuned ring at one frequency: (a) one harmonic has the size of the
    motion but not its shape; (b) nine harmonics follow the time integration through several sticks
    and slips per period, beams as well as dampers.""",
    corrected=(errata.PHASES, errata.MISPRINTED_STIFFNESS, errata.BLADE_FREQUENCIES),
    inferred=(OURS, "Newton's method instead of Broyden's: the equations solved are the same."),
)
def figure_4_19(resolution: Resolution) -> Numbers:
    """Time histories of beams 8, 11 and 22 of the mistuned ring at 200 rad/s."""
    ring = ss.reference.beam_ring(coupling=7e3, engine_order=3).mistuned(PATTERN)
    observe = [f"{beam}.damper" for beam in range(SECTORS)]
    true = ss.forced_response(ring, [200.0], tolerance=resolution.tolerance, observe=observe)
    run = ss.transient(ring, 200.0, periods=5000, scheme="rk4", tolerance=1e-6, keep=1)
    panels, facts = [], []
    for letter, harmonics in (("a", 1), ("b", 9)):
        balance = ss.forced_response(ring, [200.0], harmonics, observe=observe)
        panels.append(_beams(f"({letter}) H = {harmonics}", balance, run))
        error = balance.blade_amplitudes("damper") / true.blade_amplitudes("damper") - 1.0
        worst = 100.0 * float(np.abs(error).max())
        facts.append(Fact(f"largest error of any beam, H = {harmonics}", worst, "%"))
    amplitudes = true.blade_amplitudes("damper")[0]
    facts.append(
        Fact("largest over smallest amplitude", float(amplitudes.max() / amplitudes.min()))
    )
    return Numbers(Plot(PERIOD_SHARE, PERIOD, tuple(panels)), tuple(facts))


def _beams(title: str, balance: ss.ForcedResponse, run: ss.Transient) -> Panel:
    series = []
    stiffness = ss.reference.DAMPER_STIFFNESS
    for place, beam in enumerate((8, 11, 22)):
        moved = balance.waveform(f"{beam}.damper", 0)
        held = balance.damper_displacement((beam, 0), 0)
        marks = run.displacement(f"{beam}.damper")[:-1]
        held_marks = run.contact_force((beam, 0))[:-1] / stiffness
        series += [
            over_period(f"x₁, beam {beam}", moved, pair=place),
            over_period(f"x_d, beam {beam}", held, kind="limit", pair=place),
            over_period(f"x₁, beam {beam}, Runge-Kutta", marks, kind="marks", pair=place),
            over_period(f"x_d, beam {beam}, Runge-Kutta", held_marks, kind="dots", pair=place),
        ]
    return Panel(tuple(series), title)


@reproduces(
    "fig-4.20",
    """Weak coupling: the beams respond nearly on their own; as coupling grows some resonate high
    and slipping, others low and sticking.""",
    corrected=(errata.PHASES, errata.BLADE_FREQUENCIES),
    inferred=(OURS,),
)
def figure_4_20(resolution: Resolution) -> Numbers:
    """Beams 1 to 12 of the mistuned ring, k_c = 1000, 3000 and 5000 N/m."""
    return _couplings("abc", (1e3, 3e3, 5e3), resolution)


@reproduces(
    "fig-4.21",
    """Localisation is strong at intermediate coupling and gone at 1e5 N/m, where the beams move
    nearly alike again. The inset enlarges the subresonances of (f).""",
    corrected=(errata.PHASES, errata.BLADE_FREQUENCIES),
    inferred=(OURS,),
)
def figure_4_21(resolution: Resolution) -> Numbers:
    """Beams 1 to 12 of the mistuned ring, k_c = 6000, 12000 and 1e5 N/m."""
    return _couplings("def", (6e3, 1.2e4, 1e5), resolution, enlarged={1e5: SUBRESONANCES})


def _couplings(
    letters: str,
    values: Sequence[float],
    resolution: Resolution,
    *,
    enlarged: Mapping[float, tuple[float, float]] | None = None,
) -> Numbers:
    panels, facts = [], []
    observe = [f"{beam}.damper" for beam in range(SECTORS)]
    for letter, value in zip(letters, values, strict=True):
        ring = ss.reference.beam_ring(coupling=value, engine_order=3).mistuned(PATTERN)
        shown = ss.forced_response(
            ring, SPAN, 3, method="broyden", tolerance=resolution.tolerance, observe=observe
        )
        series = [curve(shown, f"{beam}.damper", f"beam {beam}") for beam in range(1, 13)]
        title = f"({letter}) k_c = {value:.0f} N/m"
        panels.append(Panel(tuple(series), title, enlarged=(enlarged or {}).get(value)))
        peaks = shown.blade_amplitudes("damper").max(axis=0)
        ratio = float(peaks.max() / peaks.min())
        facts.append(Fact(f"highest over lowest peak at {value:g} N/m", ratio))
    return Numbers(Plot(FREQUENCY, DAMPER, tuple(panels)), tuple(facts))


@reproduces(
    "fig-4.22",
    """Mistuning raises the highest peak most at intermediate coupling, and more at the dampers
    than at the tips. The number of harmonics matters: three are no better than one against the
    converged factors.""",
    corrected=(errata.PHASES, errata.BLADE_FREQUENCIES),
    inferred=(OURS,),
)
def figure_4_22(resolution: Resolution) -> Numbers:
    """Magnification factor over the coupling stiffness."""
    couplings = resolution.of(ss.reference.RING_COUPLINGS)
    observe = [f"{beam}.{dof}" for beam in range(SECTORS) for dof in ("damper", "tip")]
    factors: dict[str, list[float]] = {}
    facts = []
    for value in couplings:
        ring = ss.reference.beam_ring(coupling=value, engine_order=3)
        for name, harmonics in KEPT.items():
            tolerance = max(FACTOR_TOLERANCE, resolution.tolerance)
            tuned = ss.forced_response(ring, SPAN, harmonics, tolerance=tolerance)
            mistuned = ss.forced_response(
                ring.mistuned(PATTERN), SPAN, harmonics, tolerance=tolerance, observe=observe
            )
            for dof, place in (("damper", "x₁"), ("tip", "x₂")):
                factor = _highest(mistuned, dof) / tuned.peak(dof).amplitude
                factors.setdefault(f"{place}, {name}", []).append(factor)
                facts.append(Fact(f"{place}, {name}, {value:g} N/m", factor))
    series = tuple(
        Series(label, couplings, values, pair=number)
        for number, (label, values) in enumerate(factors.items())
    )
    x = Axis("coupling stiffness k_c", "N/m", log=True)
    return Numbers(Plot(x, Axis("magnification factor"), (Panel(series),)), tuple(facts))


def _highest(mistuned: ss.ForcedResponse, dof: str) -> float:
    """Return the highest peak of any beam, refined at the beam that has it."""
    highest = int(mistuned.blade_amplitudes(dof).max(axis=0).argmax())
    return mistuned.peak(f"{highest}.{dof}").amplitude
