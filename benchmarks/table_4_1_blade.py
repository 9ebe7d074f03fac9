"""Guillen (1999), Table 4.1 anew, the column of the blade, on the open turbine blade.

Usage::

    python benchmarks/table_4_1_blade.py [--settle]

400 frequencies around the first mode, the damper at its best slip force: harmonic balance by
Broyden's and by Newton's method, exact periodic orbits, and time integration from rest. Integration
needs thousands of periods at this damping. It is measured at three frequencies and extrapolated to
400: Runge-Kutta by its time per period, times the periods that the exact flow takes until a period
changes the state by less than 1e-6. `--settle` runs Runge-Kutta itself to that end at the middle
one. Times depend on what else the machine does; the ratios of one run are what to read.
"""

from __future__ import annotations

import os
import sys
import time

# One thread each: everything compared here runs on one.
for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np

import stickslip as ss

MODEL = ss.reference.turbine_blade()
FREE, STUCK = (ss.natural_frequencies(MODEL, slipping=which)[0] for which in ([0], []))
OMEGA = np.linspace(0.95 * FREE, 1.05 * STUCK, 400)
SETTLED, STEPS, TIMED, LIMIT = 1e-6, 1000, 50, 20000
HARMONICS = (1, 3, 5, 7, 9, 11, 13, 15, 21)
PRINTED = {1: 9.74, 3: 16.69, 5: 25.38, 7: 95.01, 9: 94.72, 11: 405.84, 13: 419.05, 15: 416.25}
PRINTED |= {21: 407.64}
PRINTED_INTEGRATION = 167685.6


def balance(harmonics: int, method: str) -> tuple[float, ss.ForcedResponse]:
    """Shortest of three runs in CPU seconds, and the result."""
    taken = []
    for _ in range(3):
        start = time.process_time()
        frf = ss.forced_response(MODEL, OMEGA, harmonics, method=method, observe=["tip"])
        taken.append(time.process_time() - start)
    return min(taken), frf


def motion(
    omega: float, scheme: str, periods: int, tolerance: float | None
) -> tuple[float, ss.Transient]:
    """CPU seconds of an integration from rest, and its result."""
    start = time.process_time()
    made = ss.transient(
        MODEL,
        omega,
        periods=periods,
        tolerance=tolerance,
        scheme=scheme,
        steps=STEPS,
        samples=64,
        keep=1,
        observe=["tip"],
    )
    return time.process_time() - start, made


def main(settle: bool) -> None:
    start = time.process_time()
    exact = ss.exact_response(MODEL, OMEGA, observe=["tip"])
    orbit_time = time.process_time() - start
    true = exact.amplitude("tip")
    at = int(np.nanargmax(true))
    print(f"exact orbits: {int(exact.converged.sum())} of {OMEGA.size} solved")

    counts, flows, errors = [], [], []
    places = (at - 60, at, at + 60)
    for place in places:
        taken, flow = motion(OMEGA[place], "exact", LIMIT, SETTLED)
        counts.append(flow.periods)
        flows.append(taken)
        errors.append(flow.amplitude("tip") / true[place] - 1.0)
        print(
            f"exact flow at {OMEGA[place]:.2f} rad/s: {flow.periods} periods, {taken:.1f} s, tip "
            f"{errors[-1]:+.1e} of the exact orbit",
            flush=True,
        )
    taken, _ = motion(OMEGA[at], "rk4", TIMED, None)
    per_period = taken / TIMED
    rk4_time = per_period * float(np.mean(counts)) * OMEGA.size
    flow_time = float(np.mean(flows)) * OMEGA.size
    print(f"RK4: {1e3 * per_period:.2f} ms per period of {STEPS} steps, measured over {TIMED}")
    if settle:
        taken, rk4 = motion(OMEGA[at], "rk4", LIMIT, SETTLED)
        error = rk4.amplitude("tip") / true[at] - 1.0
        print(
            f"RK4 at {OMEGA[at]:.2f} rad/s: {rk4.periods} periods, {taken:.1f} s, tip {error:+.1e}"
        )

    print("\n| method | CPU time [s] | time integration takes | printed ratio | peak tip error |")
    print("|---|---|---|---|---|")
    for harmonics in HARMONICS:
        for method in ("broyden", "newton"):
            taken, frf = balance(harmonics, method)
            error = np.nanmax(frf.amplitude("tip")) / np.nanmax(true) - 1.0
            ratio = f"{PRINTED_INTEGRATION / PRINTED[harmonics]:.0f}" if method == "broyden" else ""
            solved = "" if frf.converged.all() else f", {int((~frf.converged).sum())} not solved"
            print(
                f"| {method}, H = {harmonics}{solved} | {taken:.3f} | {rk4_time / taken:.0f} times "
                f"| {ratio} | {error:+.1e} |"
            )
    print(f"| exact orbits | {orbit_time:.2f} | {rk4_time / orbit_time:.0f} times | | 0 |")
    print(
        f"| exact flow, extrapolated from {len(places)} frequencies | {flow_time:.0f} | "
        f"{rk4_time / flow_time:.1f} times | | {max(errors, key=abs):+.1e} |"
    )
    print(f"| RK4, extrapolated: {np.mean(counts):.0f} periods a point | {rk4_time:.0f} | 1 | | |")


if __name__ == "__main__":
    main("--settle" in sys.argv[1:])
