"""Claims of chapter III on operations and on the time that they take."""

from __future__ import annotations

import time

import numpy as np

import stickslip as ss
from stickslip_reproduce.claims import Found, claim, numbers_of, verdict
from stickslip_reproduce.numbers import Fact
from stickslip_reproduce.resolution import Resolution
from stickslip_reproduce.solver_experiment import HARMONICS, experiment

NOISE = 1.25
"""Ratio of two times below which neither is the shorter one."""


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
    "relations-of-the-secant",
    "3.4.2",
    "Equation (3.30) provides N_d relations, which are not sufficient to determine the N_d × N_d "
    "components of the new approximate Jacobian",
    """Relations and components for one damper and 15 harmonics, counted. There are N_d (2 N_h + 1)
    relations for the square of as many components: not sufficient all the same.""",
    rule=lambda n: verdict(n["relations"] == 1, n["relations"] < n["components"]),
)
def relations(resolution: Resolution) -> Found:
    """Return the number of relations of the secant condition."""
    size = experiment().vector(experiment().force).shape[1]
    return Found((Fact("relations", size, "", 1.0), Fact("components", size * size, "", 1.0)))


@claim(
    "update-of-qr",
    "3.4.2",
    "the QR decomposition of A_(n+1) can be updated from the QR decomposition of A_n in O(N²) "
    "operations",
    """Multiplications by Givens rotations, and of a new decomposition, counted: their growth from
    62 to 124 unknowns, four and eight times for squares and cubes.""",
    rule=lambda n: verdict(n["growth, updated"] < 4.2 and n["growth, anew"] > 7.5),
)
def update_of_qr(resolution: Resolution) -> Found:
    """Growth of the number of multiplications."""

    def updated(size: int) -> int:
        # Two sweeps of rotations, each of two rows of R from its place on and two columns of Q.
        return 2 * sum(4 * (size - place) + 4 * size for place in range(size - 1))

    def anew(size: int) -> int:
        return sum(2 * m * (m - 1) + m for m in range(size, 1, -1))

    return Found(
        (
            Fact("growth, updated", updated(124) / updated(62), "times", 4.0),
            Fact("growth, anew", anew(124) / anew(62), "times"),
        )
    )


@claim(
    "faster-iteration",
    "3.4.2",
    "because of the improved updates of Q and R, the Broyden iteration is faster than the Newton "
    "step",
    """Time of an iteration of Newton's method with the exact tangent over that of one of Broyden's,
    over all rows of Table 4.1, with one damper. Within a quarter neither is faster.""",
    rule=lambda n: verdict(
        n["Newton over Broyden"] > NOISE, n["Newton over Broyden"] * NOISE > 1.0
    ),
    see="table-4.1",
)
def faster_iteration(resolution: Resolution) -> Found:
    """Time of an iteration of both methods."""
    table = numbers_of("table-4.1", resolution).table
    assert table is not None
    taken: dict[str, float] = {}
    steps: dict[str, float] = {}
    columns = ("method", "ours [s]", "iterations")
    for name, seconds, count in zip(*(table.column(one) for one in columns), strict=True):
        if name in ("Newton", "Broyden"):
            taken[str(name)] = taken.get(str(name), 0.0) + float(seconds or 0.0)
            steps[str(name)] = steps.get(str(name), 0.0) + float(count or 0.0)
    each = {name: taken[name] / steps[name] for name in taken}
    return Found((Fact("Newton over Broyden", each["Newton"] / each["Broyden"], "times"),))
