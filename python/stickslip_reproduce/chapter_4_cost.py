"""Chapter IV, section 4.4: what each method takes for one response curve of the beam."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import Literal, NamedTuple

import numpy as np

import stickslip as ss
from stickslip_reproduce import errata
from stickslip_reproduce.chapter_4_blade import TIMES, blade_span, settled_blade
from stickslip_reproduce.curves import PATIENCE, SETTLED
from stickslip_reproduce.item import reproduces
from stickslip_reproduce.numbers import Axis, Cell, Fact, Numbers, Panel, Plot, Series, Table
from stickslip_reproduce.resolution import Float, Resolution

__all__ = ["FREQUENCIES", "PRINTED", "RUNGE_KUTTA", "Timing", "timings"]

FORCE = 20.313
SPAN = (20.0, 350.0)
FREQUENCIES = 400
"""Number of frequencies in the dissertation."""

PRINTED = {1: 1.87, 3: 4.43, 5: 5.83, 7: 5.04, 9: 7.89, 11: 12.96, 13: 8.02, 15: 18.15, 21: 22.05}
"""Printed seconds of Broyden's method by harmonics kept."""

PRINTED_INTEGRATION = 3807.6
"""Printed seconds of time integration."""

PRINTED_BLADE = {
    1: 9.74,
    3: 16.69,
    5: 25.38,
    7: 95.01,
    9: 94.72,
    11: 405.84,
    13: 419.05,
    15: 416.25,
    21: 407.64,
}
"""Printed seconds of Broyden's method for the 18-DOF blade."""

PRINTED_BLADE_INTEGRATION = 167685.6

RUNGE_KUTTA = "Runge-Kutta"

Method = Literal["broyden", "newton"]
METHODS: tuple[Method, ...] = ("broyden", "newton")


class Timing(NamedTuple):
    """What one method took for all frequencies."""

    method: str
    """Name."""
    harmonics: int | None
    """Highest harmonic kept; None where there is no such number."""
    seconds: float
    """Processor time [s], which a busy machine does not lengthen."""
    iterations: int | None
    """Iterations of the solver."""
    periods: float | None
    """Mean number of periods integrated until the motion was steady."""
    peak: float
    """Highest amplitude of the tip [m]."""


def timings(
    omega: Float, harmonics: Sequence[int] = tuple(PRINTED), repeats: int = 3
) -> list[Timing]:
    """Measure every method on the beam at 20.313 N, one after the other.

    Integration runs from rest until a period changes the state by less than 1e-6, Runge-Kutta with
    compiled steps.

    Parameters
    ----------
    omega : ndarray of float64, shape (n,)
        Frequencies [rad/s].
    harmonics : sequence of int, optional
        Highest harmonics of harmonic balance.
    repeats : int, optional
        Of so many runs of harmonic balance and of exact orbits the shortest counts.

    Returns
    -------
    list of Timing
        Broyden and Newton by harmonics, exact orbits, exact flow, Runge-Kutta.
    """
    model = ss.reference.snecma_beam(FORCE)
    rows = _balances(model, omega, harmonics, repeats)
    rows.append(_orbits(model, omega, repeats))
    rows.append(_integration(model, omega, "exact", "exact flow from rest"))
    rows.append(_integration(model, omega, "rk4", RUNGE_KUTTA))
    return rows


def _balances(
    model: ss.Model, omega: Float, harmonics: Sequence[int], repeats: int
) -> list[Timing]:
    return [
        _balance(model, omega, kept, method, repeats) for kept in harmonics for method in METHODS
    ]


def blade_timings(omega_count: int, times: Sequence[float]) -> list[Timing]:
    """Measure harmonic balance, exact orbits and Runge-Kutta on the open blade at optimal damping.

    Runge-Kutta is measured at the frequencies of Figs 4.12 and 4.13, given over the stuck one, and
    its seconds are those of as many frequencies as the others have.
    """
    span = blade_span()
    blade = ss.reference.turbine_blade()
    best = ss.optimal_damper(blade, dof="tip", omega=span, mode=0)
    damped = ss.reference.turbine_blade(best.slip_force)
    omega = np.linspace(*span, omega_count)
    stuck = float(ss.natural_frequencies(blade)[0])
    runs = settled_blade(best.slip_force, tuple((stuck * np.array(times)).tolist()))
    seconds, periods, tip = (
        np.array([run[key] for run in runs]) for key in ("seconds", "periods", "tip")
    )
    return [
        *_balances(damped, omega, tuple(PRINTED_BLADE), 1),
        _orbits(damped, omega, 1),
        Timing(
            RUNGE_KUTTA,
            None,
            omega_count * float(seconds.mean()),
            None,
            float(periods.mean()),
            float(tip.max()),
        ),
    ]


def _balance(model: ss.Model, omega: Float, kept: int, method: Method, repeats: int) -> Timing:
    taken = []
    for _ in range(repeats):
        start = time.process_time()
        frf = ss.forced_response(model, omega, kept, method=method)
        taken.append(time.process_time() - start)
    peak = float(frf.amplitude("tip").max())
    return Timing(method.capitalize(), kept, min(taken), frf.counters["iterations"], None, peak)


def _orbits(model: ss.Model, omega: Float, repeats: int) -> Timing:
    taken = []
    for _ in range(repeats):
        start = time.process_time()
        exact = ss.exact_response(model, omega, observe="tip")
        taken.append(time.process_time() - start)
    return Timing("exact orbits", None, min(taken), None, None, float(exact.amplitude("tip").max()))


def _integration(
    model: ss.Model, omega: Float, scheme: Literal["exact", "rk4"], name: str
) -> Timing:
    start = time.process_time()
    runs = [
        ss.transient(
            model,
            float(frequency),
            periods=PATIENCE,
            tolerance=SETTLED,
            scheme=scheme,
            keep=1,
            observe="tip",
        )
        for frequency in omega
    ]
    taken = time.process_time() - start
    periods = float(np.mean([run.periods for run in runs]))
    return Timing(name, None, taken, None, periods, max(run.amplitude("tip") for run in runs))


@reproduces(
    "table-4.1",
    """Runge-Kutta takes 100 to 600 times as long as harmonic balance for the beam, although both
    are compiled here; in print 170 to 2000 times. The open blade, with less damping, takes
    thousands of periods to settle, and the factors are larger. Newton's method with the exact
    tangent needs fewer iterations than Broyden's.""",
    corrected=(errata.RETURN_MAP, errata.BROYDEN, errata.SEVERAL_HUNDREDS),
    inferred=(
        "Read ratios of one run: the printed seconds are those of an HP C240 workstation.",
        "The blade is the open one of Figs 4.10-4.13, not that of the print; Runge-Kutta is "
        "measured at the frequencies of Fig. 4.12 and counted for all.",
    ),
)
def table_4_1(resolution: Resolution) -> Numbers:
    """Time of each method for 400 frequencies, beam at 20.313 N and blade at optimal damping."""
    count = resolution.count(FREQUENCIES)
    measured = timings(np.linspace(*SPAN, count))
    blade = {(row.method, row.harmonics): row for row in blade_timings(count, resolution.of(TIMES))}
    slowest = next(row for row in measured if row.method == RUNGE_KUTTA)
    true = next(row for row in measured if row.method == "exact orbits").peak
    rows = [
        (
            *_beam_cells(row, slowest, true),
            *_blade_cells(blade.get((row.method, row.harmonics)), blade[RUNGE_KUTTA, None]),
        )
        for row in measured
    ]
    columns = (
        "method",
        "H",
        "printed [s]",
        "ours [s]",
        "printed: Runge-Kutta takes [times]",
        "ours: Runge-Kutta takes [times]",
        "iterations",
        "periods",
        "error of the tip peak to exact [%]",
        "blade, printed [s]",
        "blade, ours [s]",
        "blade, printed: Runge-Kutta takes [times]",
        "blade, ours: Runge-Kutta takes [times]",
        "blade, periods",
    )
    facts = (
        *_facts(measured, PRINTED_INTEGRATION / PRINTED[15]),
        *_facts([*blade.values()], PRINTED_BLADE_INTEGRATION / PRINTED_BLADE[15], "blade, "),
    )
    return Numbers(_plot(measured, blade), facts, Table(columns, tuple(rows)))


def _beam_cells(row: Timing, slowest: Timing, true: float) -> tuple[Cell, ...]:
    printed = PRINTED[row.harmonics or 0] if row.method == "Broyden" else None
    if row is slowest:
        printed = PRINTED_INTEGRATION
    return (
        row.method,
        row.harmonics,
        printed,
        row.seconds,
        PRINTED_INTEGRATION / printed if printed else None,
        slowest.seconds / row.seconds,
        row.iterations,
        row.periods,
        100.0 * (row.peak / true - 1.0),
    )


def _blade_cells(row: Timing | None, slowest: Timing) -> tuple[Cell, ...]:
    if row is None:
        return (None,) * 5
    printed = PRINTED_BLADE[row.harmonics or 0] if row.method == "Broyden" else None
    if row is slowest:
        printed = PRINTED_BLADE_INTEGRATION
    return (
        printed,
        row.seconds,
        PRINTED_BLADE_INTEGRATION / printed if printed else None,
        slowest.seconds / row.seconds,
        row.periods,
    )


def _facts(measured: Sequence[Timing], printed: float, of: str = "") -> tuple[Fact, ...]:
    seconds = {(row.method, row.harmonics): row.seconds for row in measured}
    slowest = next(row for row in measured if row.method == RUNGE_KUTTA)
    ratios = {key: slowest.seconds / one for key, one in seconds.items()}
    return (
        Fact(f"{of}Runge-Kutta over Broyden, H = 15", ratios["Broyden", 15], "times", printed),
        Fact(f"{of}Runge-Kutta over Newton, H = 15", ratios["Newton", 15], "times"),
        Fact(f"{of}Runge-Kutta over exact orbits", ratios["exact orbits", None], "times"),
        Fact(f"{of}periods of Runge-Kutta until steady, on average", slowest.periods or np.nan),
    )


def _plot(measured: Sequence[Timing], blade: Mapping[tuple[str, int | None], Timing]) -> Plot:
    beam = {(row.method, row.harmonics): row for row in measured}
    panels = []
    for title, system, printed, whole in (
        ("beam, 3 degrees of freedom", beam, PRINTED, PRINTED_INTEGRATION),
        ("blade, 18 degrees of freedom", blade, PRINTED_BLADE, PRINTED_BLADE_INTEGRATION),
    ):
        kept = np.array(list(printed), dtype=np.float64)
        longest = system[RUNGE_KUTTA, None].seconds
        series = [
            Series("printed, Broyden", kept, [whole / one for one in printed.values()], "marks", 0)
        ]
        for pair, method in enumerate(("Broyden", "Newton")):
            times = [longest / system[method, int(one)].seconds for one in kept]
            series.append(Series(method, kept, times, pair=pair))
        for pair, method in enumerate(("exact orbits", "exact flow from rest"), start=2):
            if (method, None) in system:
                ratio = longest / system[method, None].seconds
                series.append(Series(method, kept[[0, -1]], [ratio] * 2, pair=pair))
        panels.append(Panel(tuple(series), title))
    y = Axis("Runge-Kutta takes", "times as long", log=True)
    return Plot(Axis("harmonics kept H"), y, tuple(panels))
