"""Claims of chapter III: many harmonics, and the solvers."""

from __future__ import annotations

import time
from functools import cache

import numpy as np

import stickslip as ss
from stickslip_reproduce.beam_orbits import EIGHT, NEAR, exact
from stickslip_reproduce.claims import Found, claim, numbers_of, verdict
from stickslip_reproduce.numbers import Axis, Fact, Panel, Plot, Series
from stickslip_reproduce.resolution import Float, Resolution
from stickslip_reproduce.solver_experiment import (
    HARMONICS,
    OMEGA,
    POOR,
    begins,
    largest,
    order,
    runs,
    share,
)
from stickslip_reproduce.solvers import METHODS

DOZENS = 24
FEW = 5
KEPT = (1, 3, 5, 9, 15, 24)

NOISE = 1.25
"""Ratio of two times below which neither is the shorter one."""


@cache
def errors(harmonics: int) -> Float:
    """Return errors of the tip's peak at the eight loads [%]."""
    found = []
    for load in EIGHT:
        true = exact(load)
        kept = ss.forced_response(true.model, true.omega, harmonics)
        found.append(kept.peak("tip").amplitude / true.peak("tip").amplitude - 1.0)
    return 100.0 * np.abs(found)


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
        Axis("start, 0: single harmonic, 1: rest, 2: without damper, 3: ten times too large"),
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
    "twice-the-operations",
    "3.4.1",
    "they require about twice as many operations as LU decompositions",
    """Multiplications of Householder's and of Gauss's elimination of a full matrix of 31 unknowns,
    counted.""",
    rule=lambda n: verdict(1.5 < n["QR over LU"] < 2.5),
)
def operations(resolution: Resolution) -> Found:
    """Multiplications of both decompositions."""
    size = 2 * HARMONICS + 1
    lengths = range(size, 1, -1)
    # A reflection of m numbers applied to m - 1 columns; an elimination below one pivot.
    householder = sum(2 * m * (m - 1) + m for m in lengths)
    gauss = sum((m - 1) ** 2 + (m - 1) for m in lengths)
    return Found((Fact("QR over LU", householder / gauss, "", 2.0),))


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
    "faster-than-newton",
    "3.4.2",
    "the Broyden method turns out to be faster than the NR algorithm",
    """Processor time of Newton's method with the exact tangent over that of Broyden's: over all
    rows of Table 4.1, with one damper, and on the mistuned ring of 36 dampers with 3 harmonics.
    Within a quarter neither is faster.""",
    rule=lambda n: (
        verdict(
            min(n.values()) > NOISE,
            max(n.values()) > NOISE,
        )
        if not all(1.0 / NOISE < value < NOISE for value in n.values())
        else "open"
    ),
    see="table-4.1",
)
def faster_than_newton(resolution: Resolution) -> Found:
    """Time of Newton's over that of Broyden's method."""
    table = numbers_of("table-4.1", resolution).table
    assert table is not None
    taken = {
        method: sum(
            float(one or 0.0)
            for name, one in zip(table.column("method"), table.column("ours [s]"), strict=True)
            if name == method
        )
        for method in ("Newton", "Broyden")
    }
    tuned = ss.reference.beam_ring(coupling=7e3, engine_order=3)
    ring = tuned.mistuned(ss.mistuning_pattern(36, 0.07, "uniform", seed=0))
    whole = []
    for method in ("newton", "broyden"):
        begin = time.process_time()
        ss.forced_response(ring, np.linspace(150.0, 260.0, 111), 3, method=method)
        whole.append(time.process_time() - begin)
    return Found(
        (
            Fact("one damper", taken["Newton"] / taken["Broyden"], "times"),
            Fact("36 dampers", whole[0] / whole[1], "times"),
        )
    )


@claim(
    "more-iterations",
    "3.4.2",
    "The Broyden algorithm needs more iterations to converge",
    """Iterations of both methods in Table 4.1, 15 harmonics.""",
    rule=lambda n: verdict(n["iterations of Broyden over Newton"] > 1.0),
    see="table-4.1",
)
def more_iterations(resolution: Resolution) -> Found:
    """Return the iterations of both methods."""
    table = numbers_of("table-4.1", resolution).table
    assert table is not None
    rows = {row[:2]: row[table.columns.index("iterations")] for row in table.rows}
    newton, broyden = (float(rows[name, HARMONICS] or 0) for name in ("Newton", "Broyden"))
    return Found((Fact("iterations of Broyden over Newton", broyden / newton),))


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
    "never-unloads",
    "3.2",
    "The time-marching procedure is presented in Table 3.1.",
    """Range of the force over 2 F_d in the fourth period of u = 2 (F_d / k_d) cos, by the printed
    update and by f_j = clip(f_(j-1) + k_d Δu, −F_d, F_d); 200 and 2000 instants per period. As
    printed a contact whose force exceeds F_d by one step slips on when the motion turns, and never
    unloads.""",
    rule=lambda n: verdict(min(n["as printed, 200"], n["as printed, 2000"]) > 0.99),
)
def never_unloads(resolution: Resolution) -> Found:
    """Range of the force by Table 3.1 and by the corrected update."""
    facts = []
    for count in (200, 2000):
        moved = 2.0 * np.cos(2.0 * np.pi * np.arange(4 * count + 1) / count)
        printed, right = _as_printed(moved), _returned(moved)
        for name, force in (("as printed", printed), ("corrected", right)):
            facts.append(Fact(f"{name}, {count}", float(np.ptp(force[-count:]) / 2.0)))
    return Found(tuple(facts))


def _as_printed(moved: Float) -> Float:
    """Return the force over F_d by Table 3.1, of a displacement over F_d / k_d."""
    force = np.zeros_like(moved)
    slips = False
    change = np.diff(moved, prepend=moved[0])
    for place in range(1, len(moved)):
        force[place] = force[place - 1] + (0.0 if slips else change[place])
        if not slips:
            slips = abs(force[place]) > 1.0
        elif change[place] * change[place - 1] < 0.0:
            slips = False
            # The table's own test of the sticking state comes before its next update.
            slips = abs(force[place]) > 1.0
    return force


def _returned(moved: Float) -> Float:
    force = np.zeros_like(moved)
    for place in range(1, len(moved)):
        force[place] = np.clip(force[place - 1] + moved[place] - moved[place - 1], -1.0, 1.0)
    return force


@claim(
    "few-harmonics",
    "3.3",
    "Practically, a few harmonics will give a good approximation of the solution",
    """Largest error of the tip's peak at the eight loads with 5 harmonics; good is 5 %.""",
    rule=lambda n: verdict(n["largest error, H = 5"] < 5.0, n["median error, H = 5"] < 5.0),
)
def few_harmonics(resolution: Resolution) -> Found:
    """Errors with five harmonics."""
    found = errors(FEW)
    return Found(
        (
            Fact("largest error, H = 5", float(found.max()), "%"),
            Fact("median error, H = 5", float(np.median(found)), "%"),
        )
    )


@claim(
    "couple-dozens",
    "3.3",
    "in all cases a couple dozens of harmonics will predict virtually the same answer as the "
    "numerical time integration",
    """Largest error of the tip's peak at the eight loads with 24 harmonics, with 15 for comparison,
    and with 24 at 20.313 N with a damper a hundred times as stiff, the nearly rigid one of Figs 4.7
    and 4.8; virtually the same is 1 %.""",
    rule=lambda n: verdict(max(n["H = 24"], n["H = 24, stiff damper"]) < 1.0, n["H = 24"] < 1.0),
)
def couple_dozens(resolution: Resolution) -> Found:
    """Errors with 24 harmonics."""
    plot = Plot(
        Axis("highest harmonic H"),
        Axis("largest error of the tip's peak", "%", log=True),
        (
            Panel(
                (
                    Series(
                        "eight loads",
                        KEPT,
                        [float(errors(kept).max()) for kept in KEPT],
                    ),
                )
            ),
        ),
    )
    stiff = ss.Jenkins(
        "damper",
        stiffness=100.0 * ss.reference.DAMPER_STIFFNESS,
        slip_force=ss.reference.DAMPER_SLIP_FORCE,
    )
    rough = ss.forced_response(
        ss.reference.snecma_beam(20.313).replaced(contacts=[stiff]), NEAR, DOZENS
    )
    near = np.abs(rough.omega / rough.peak("tip").omega - 1.0) < 0.02
    true = ss.exact_response(rough.model, rough.omega[near], observe="tip")
    facts = [Fact(f"H = {kept}", float(errors(kept).max()), "%") for kept in (15, DOZENS)]
    apart = 100.0 * abs(rough.peak("tip").amplitude / true.peak("tip").amplitude - 1.0)
    return Found((*facts, Fact(f"H = {DOZENS}, stiff damper", apart, "%")), plot)


@claim(
    "hybrid-method",
    "3.5",
    "The Broyden method is used iteratively until convergence criteria are met and Eq. (3.16) is "
    "solved",
    """Procedure 1 with 19 harmonics against exact orbits: amplitudes at the damper in the cases of
    Figs 4.1 and 4.2.""",
    rule=lambda n: verdict(max(n.values()) < 1.0),
    see="fig-4.1 fig-4.2",
)
def hybrid_method(resolution: Resolution) -> Found:
    """Differences of 19 harmonics to exact orbits."""
    facts = []
    for name in ("fig-4.1", "fig-4.2"):
        shown = numbers_of(name, resolution)
        kept, true = (
            shown.fact(f"amplitude at the damper, {what}") for what in ("19 harmonics", "exact")
        )
        facts.append(Fact(f"difference, {name}", 100.0 * abs(kept / true - 1.0), "%"))
    return Found(tuple(facts))
