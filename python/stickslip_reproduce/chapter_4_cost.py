"""Chapter IV, section 4.4: what each method takes for one response curve of the beam."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np

import stickslip as ss
from stickslip_reproduce import errata
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
    rows = [
        _balance(model, omega, kept, method, repeats) for kept in harmonics for method in METHODS
    ]
    rows.append(_orbits(model, omega, repeats))
    rows.append(_integration(model, omega, "exact", "exact flow from rest"))
    rows.append(_integration(model, omega, "rk4", RUNGE_KUTTA))
    return rows


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
    """Runge-Kutta takes hundreds of times as long as harmonic balance, as in print, although both
    are compiled here. Newton's method with the exact tangent needs fewer iterations than Broyden's.
    Exact orbits have no error and stay far below the time of any integration.""",
    corrected=(errata.RETURN_MAP, errata.BROYDEN),
    inferred=(
        "Read ratios of one run: the printed seconds are those of an HP C240 workstation.",
        "The column of the 18-DOF blade is left out: its data are proprietary.",
    ),
)
def table_4_1(resolution: Resolution) -> Numbers:
    """Time of each method for 400 frequencies from 20 to 350 rad/s at 20.313 N."""
    measured = timings(np.linspace(*SPAN, resolution.count(FREQUENCIES)))
    slowest = next(row for row in measured if row.method == RUNGE_KUTTA)
    true = next(row for row in measured if row.method == "exact orbits").peak
    rows: list[tuple[Cell, ...]] = []
    for row in measured:
        printed = PRINTED[row.harmonics or 0] if row.method == "Broyden" else None
        if row is slowest:
            printed = PRINTED_INTEGRATION
        rows.append(
            (
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
        )
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
    )
    return Numbers(_plot(measured, slowest), _facts(measured, slowest), Table(columns, tuple(rows)))


def _facts(measured: Sequence[Timing], slowest: Timing) -> tuple[Fact, ...]:
    ratios = {(row.method, row.harmonics): slowest.seconds / row.seconds for row in measured}
    return (
        Fact(
            "Runge-Kutta over Broyden, H = 15",
            ratios["Broyden", 15],
            "times",
            PRINTED_INTEGRATION / PRINTED[15],
        ),
        Fact("Runge-Kutta over Newton, H = 15", ratios["Newton", 15], "times"),
        Fact("Runge-Kutta over exact orbits", ratios["exact orbits", None], "times"),
        Fact("periods of Runge-Kutta until steady, on average", slowest.periods or np.nan),
    )


def _plot(measured: Sequence[Timing], slowest: Timing) -> Plot:
    kept = np.array(list(PRINTED), dtype=np.float64)
    by_method = {
        method: [slowest.seconds / row.seconds for row in measured if row.method == method]
        for method in ("Broyden", "Newton", "exact orbits", "exact flow from rest")
    }
    printed = [PRINTED_INTEGRATION / value for value in PRINTED.values()]
    series = (
        Series("printed, Broyden", kept, printed, "marks", 0),
        Series("Broyden", kept, by_method["Broyden"], pair=0),
        Series("Newton", kept, by_method["Newton"], pair=1),
        *(
            Series(name, kept[[0, -1]], by_method[name] * 2, pair=pair)
            for pair, name in enumerate(("exact orbits", "exact flow from rest"), start=2)
        ),
    )
    y = Axis("Runge-Kutta takes", "times as long", log=True)
    return Plot(Axis("harmonics kept H"), y, (Panel(series),))
