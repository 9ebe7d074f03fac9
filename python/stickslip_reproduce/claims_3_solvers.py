"""Claims of chapter III on the solvers."""

from __future__ import annotations

import numpy as np

import stickslip as ss
from stickslip_reproduce.beam_orbits import EIGHT
from stickslip_reproduce.claims import Found, claim, verdict
from stickslip_reproduce.numbers import Axis, Fact, Panel, Plot, Series
from stickslip_reproduce.resolution import Resolution
from stickslip_reproduce.solver_experiment import (
    HARMONICS,
    OMEGA,
    POOR,
    begins,
    largest,
    order,
    order_of_chord,
    runs,
    share,
    solved,
)
from stickslip_reproduce.solvers import CONVERGED, METHODS

BEGUN = ("single\nharmonic", "rest", "without\ndamper", "ten times\ntoo large")
"""Starts as on the axis."""


@claim(
    "no-scaling",
    "3.4.1",
    "The QR decompositions of the Jacobian do not require the scaling of the dependent variables "
    "and are numerically stable without pivoting",
    """Largest backward error of any linear solution in the experiment of section 3.4, with a QR
    decomposition at every step and with one that is updated.""",
    rule=lambda n: verdict(max(n.values()) < 1e-14),
)
def no_scaling(resolution: Resolution) -> Found:
    """Backward errors of QR decompositions."""
    return Found(
        tuple(
            Fact(method, largest(method, resolution))
            for method in ("Newton, QR", "Broyden, QR updated")
        )
    )


@claim(
    "lu-unstable",
    "3.4.1",
    "Even with partial pivoting, the numerical stability problems of the LU method persist.",
    """Every case by LU and by QR decomposition, from a good and three poor starts: runs that
    converge, and the largest backward error of any linear solution. The method converges or not
    whatever the decomposition is. Only an LU decomposition that is updated with its old pivots
    loses digits, four of sixteen, and no solution with them.""",
    rule=lambda n: verdict(
        n["backward error, LU with pivots"] > 1e-10
        or n["runs by LU with pivots"] < 0.9 * n["runs by QR"],
        n["runs by updated LU"] < 0.9 * n["runs by updated QR"],
    ),
)
def lu_unstable(resolution: Resolution) -> Found:
    """Newton and Broyden by LU and by QR."""
    every = runs(resolution)
    lost = {
        method: sum(row.converged for row in every if row.method == method) for method in METHODS
    }
    panel = [
        Series(
            method,
            np.arange(len(begins(resolution))),
            [100.0 * row.converged / row.runs for row in every if row.method == method],
            "marks",
        )
        for method in METHODS
    ]
    plot = Plot(
        Axis("start", names=BEGUN),
        Axis("runs that converge", "%"),
        (Panel(tuple(panel)),),
    )
    return Found(
        (
            Fact("runs by LU with pivots", lost["Newton, LU"]),
            Fact("runs by QR", lost["Newton, QR"]),
            Fact("runs by updated LU", lost["Broyden, LU updated"]),
            Fact("runs by updated QR", lost["Broyden, QR updated"]),
            Fact("backward error, LU with pivots", largest("Newton, LU", resolution)),
            Fact("backward error, QR", largest("Newton, QR", resolution)),
            Fact("backward error, updated LU", largest("Broyden, LU updated", resolution)),
            Fact("backward error, updated QR", largest("Broyden, QR updated", resolution)),
        ),
        plot,
    )


@claim(
    "quadratic",
    "3.4.2",
    "The Newton procedure, as presented in Eq. (3.23), is locally quadratically convergent",
    """Started 0.1 % from the solutions: the median over the cases of the order q at the last steps,
    |F_(n+1)| ~ |F_n|^q. The force is smooth but for the harmonics left out, so that the order shows
    only close by.""",
    rule=lambda n: verdict(n["order of Newton"] > 1.8, n["order of Newton"] > 1.2),
)
def quadratic(resolution: Resolution) -> Found:
    """Order of Newton's method near the solution."""
    return Found((Fact("order of Newton", order("Newton, QR", resolution)),))


@claim(
    "superlinear",
    "3.4.2",
    "The Broyden update, Eq. (3.33), leads to superlinear convergence of the Broyden method.",
    """From the single harmonic: median of |F_(n+1)| / |F_n| over the last three steps of a run,
    and over the three in its middle. With superlinear convergence the quotients fall.""",
    rule=lambda n: verdict(
        n["last quotient"] < 0.5 * n["quotient in the middle"], n["last quotient"] < 0.5
    ),
)
def superlinear(resolution: Resolution) -> Found:
    """Quotients of residuals of Broyden's method."""
    (row,) = (
        one
        for one in runs(resolution)
        if (one.method, one.start) == ("Broyden, QR updated", "single harmonic")
    )
    last, middle = [], []
    for history in row.histories:
        if history[-1] > 1e-9 or len(history) < 10:
            continue
        half = len(history) // 2
        last.append((history[-1] / history[-4]) ** (1 / 3))
        middle.append((history[half + 1] / history[half - 2]) ** (1 / 3))
    return Found(
        (
            Fact("last quotient", float(np.median(last))),
            Fact("quotient in the middle", float(np.median(middle))),
        )
    )


@claim(
    "printed-norm",
    "3.4.2",
    "The solution of Eq. (3.31) can be found analytically, and is given by: (3.33)",
    """Runs that converge from the single harmonic with the norm in the denominator as printed, and
    with its square, which the secant condition (3.30) asks for.""",
    rule=lambda n: verdict(n["as printed"] >= n["squared"]),
)
def printed_norm(resolution: Resolution) -> Found:
    """Broyden's update with both norms."""
    found = {
        row.method: row.converged for row in runs(resolution) if row.start == "single harmonic"
    }
    return Found(
        (
            Fact("as printed", found["Broyden, QR, norm as printed"]),
            Fact("squared", found["Broyden, QR updated"]),
            Fact("runs", len(EIGHT) * len(OMEGA)),
        )
    )


@claim(
    "better-stability",
    "3.4.2",
    "the Broyden method seems to have better stability than NR schemes",
    """Runs that converge from a good and three poor starts, by the plain methods of section 3.4,
    without any safeguard. Newton's method with one, as in this package, converges in all.""",
    rule=lambda n: verdict(
        n["Broyden"] > n["Newton"] and n["Newton here"] < n["Broyden"], n["Broyden"] > n["Newton"]
    ),
)
def better_stability(resolution: Resolution) -> Found:
    """Return the runs of Newton's and Broyden's method that converge."""
    every = runs(resolution)
    solved = [
        ss.forced_response(ss.reference.snecma_beam(load), list(OMEGA), HARMONICS).converged
        for load in EIGHT
    ]
    return Found(
        (
            Fact("Broyden", share(every, "Broyden, QR updated"), "%"),
            Fact("Newton", share(every, "Newton, QR"), "%"),
            Fact("Newton here", 100.0 * float(np.mean(solved)), "%"),
        )
    )


@claim(
    "poor-guess",
    "3.4.2",
    "the convergence of the method is nearly always guaranteed, even with a poor initial guess",
    """Broyden's method of section 3.4 from the single harmonic, and from three poor starts: rest,
    the beam without damper, ten times the single harmonic; nearly always is 95 %.""",
    rule=lambda n: verdict(n["poor starts"] >= 95.0, n["poor starts"] >= 80.0),
)
def poor_guess(resolution: Resolution) -> Found:
    """Return the runs of Broyden's method from poor starts."""
    every = runs(resolution)
    good = [row for row in every if row.start not in POOR]
    poor = [row for row in every if row.start in POOR]
    return Found(
        (
            Fact("single harmonic", share(good, "Broyden, QR updated"), "%"),
            Fact("poor starts", share(poor, "Broyden, QR updated"), "%"),
        )
    )


@claim(
    "newton-in-stick-slip",
    "3.4",
    "significant convergence problems and long computation times were encountered, especially in "
    "stick-slip regions",
    """Runs of the plain Newton method with QR, from the single harmonic, that converge: cases whose
    damper slips between a twentieth and half of the period, and the others. With a
    safeguard, as in this package, all converge.""",
    rule=lambda n: verdict(
        n["stick-slip"] < 80.0 and n["stick-slip"] < n["others"],
        min(n["stick-slip"], n["others"]) < 80.0,
    ),
)
def newton_in_stick_slip(resolution: Resolution) -> Found:
    """Return the runs of Newton's method by the state of the damper."""
    _, slips = solved()
    mixed = (slips > 0.05) & (slips < 0.5)
    (row,) = (
        one
        for one in runs(resolution)
        if (one.method, one.start) == ("Newton, QR", "single harmonic")
    )
    done = np.array([history[-1] <= CONVERGED for history in row.histories])
    return Found(
        (
            Fact("stick-slip", 100.0 * float(done[mixed].mean()), "%"),
            Fact("others", 100.0 * float(done[~mixed].mean()), "%"),
            Fact("cases with stick-slip", int(mixed.sum())),
        )
    )


@claim(
    "different-orders",
    "3.4.1",
    "This is probably due to the fact that the amplitudes of the harmonic components of the modes "
    "retained to describe the dynamics of the structure are of very different orders of magnitude.",
    """Decades between the largest and the smallest harmonic of the solutions, the median over the
    cases that slip, and the runs that LU decomposition with pivots loses against QR. The decades
    are there, the loss is not.""",
    rule=lambda n: verdict(n["decades"] > 2.0 and n["runs lost by LU"] > 0),
)
def different_orders(resolution: Resolution) -> Found:
    """Sizes of harmonics, and what LU loses by them."""
    vector = solved()[0][solved()[1] > 0.0]
    odd = np.hypot(vector[:, 1::4], vector[:, 2::4])
    decades = np.log10(odd.max(axis=1) / odd.min(axis=1))
    kept = {
        method: sum(row.converged for row in runs(resolution) if row.method == method)
        for method in ("Newton, LU", "Newton, QR")
    }
    return Found(
        (
            Fact("decades", float(np.median(decades))),
            Fact("runs lost by LU", kept["Newton, QR"] - kept["Newton, LU"]),
        )
    )


@claim(
    "newton-chord",
    "3.4.2",
    "The iterative Newton-Chord method has only locally linear convergence.",
    """Started 0.1 % from the solutions with the Jacobian of the start throughout: the median over
    the cases of the order q at the last steps, |F_(n+1)| ~ |F_n|^q.""",
    rule=lambda n: verdict(0.8 < n["order of Newton-Chord"] < 1.2),
)
def newton_chord(resolution: Resolution) -> Found:
    """Order of the Newton-Chord method near the solution."""
    return Found((Fact("order of Newton-Chord", order_of_chord()),))
