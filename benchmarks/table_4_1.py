"""Guillen (1999), Table 4.1 anew: what each method takes for the response of the SNECMA beam.

Usage::

    python benchmarks/table_4_1.py

400 frequencies from 20 to 350 rad/s at 20.313 N. Harmonic balance by Broyden's and by Newton's
method, exact periodic orbits, and time integration from rest until a period changes the state by
less than 1e-6: classical Runge-Kutta with 1000 compiled steps per period, and the exact flow. Times
depend on the machine and on what else it does; the ratios of one run are what to read.
"""

from __future__ import annotations

import os
import time

# One thread each: everything compared here runs on one.
for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np

import stickslip as ss

OMEGA = np.linspace(20.0, 350.0, 400)
FORCE = 20.313
SETTLED = 1e-6
STEPS = 1000
PRINTED = {1: 1.87, 3: 4.43, 9: 7.89, 15: 18.15, 21: 22.05}
PRINTED_INTEGRATION = 3807.6


def balance(model: ss.Model, harmonics: int, method: str) -> tuple[float, ss.ForcedResponse]:
    """Shortest of several runs in s, and the result."""
    taken = []
    for _ in range(5):
        start = time.perf_counter()
        frf = ss.forced_response(model, OMEGA, harmonics, method=method)
        taken.append(time.perf_counter() - start)
    return min(taken), frf


def integration(model: ss.Model, scheme: str) -> tuple[float, float, float]:
    """Time in s, mean number of periods, and the highest settled amplitude of the tip."""
    periods, amplitudes = [], []
    start = time.perf_counter()
    for omega in OMEGA:
        motion = ss.transient(
            model,
            omega,
            periods=5000,
            tolerance=SETTLED,
            scheme=scheme,
            steps=STEPS,
            samples=2,
            keep=1,
            observe=["tip"],
        )
        periods.append(motion.periods)
        amplitudes.append(motion.amplitude("tip"))
    return time.perf_counter() - start, float(np.mean(periods)), max(amplitudes)


def main() -> None:
    model = ss.reference.snecma_beam(FORCE)
    start = time.perf_counter()
    exact = ss.exact_response(model, OMEGA, observe=["tip"])
    orbit_time = time.perf_counter() - start
    true = exact.amplitude("tip")
    rk4_time, rk4_periods, rk4_peak = integration(model, "rk4")
    flow_time, flow_periods, flow_peak = integration(model, "exact")
    print("| method | time [ms] | RK4 takes | printed ratio | iterations | peak tip error |")
    print("|---|---|---|---|---|---|")
    for harmonics, printed in PRINTED.items():
        for method in ("broyden", "newton"):
            taken, frf = balance(model, harmonics, method)
            error = frf.amplitude("tip").max() / true.max() - 1.0
            ratio = f"{PRINTED_INTEGRATION / printed:.0f}" if method == "broyden" else ""
            print(
                f"| {method}, H = {harmonics} | {1e3 * taken:.1f} | {rk4_time / taken:.0f} times "
                f"| {ratio} | {frf.counters['iterations']} | {error:+.1e} |"
            )
    print(f"| exact orbits | {1e3 * orbit_time:.1f} | {rk4_time / orbit_time:.0f} times | | | 0 |")
    rows = (
        (f"exact flow, {flow_periods:.0f} periods", flow_time, flow_peak),
        (f"RK4, {rk4_periods:.0f} periods of {STEPS} steps", rk4_time, rk4_peak),
    )
    for name, taken, peak in rows:
        error = peak / true.max() - 1.0
        print(f"| {name} | {1e3 * taken:.0f} | {rk4_time / taken:.1f} times | | | {error:+.1e} |")


if __name__ == "__main__":
    main()
