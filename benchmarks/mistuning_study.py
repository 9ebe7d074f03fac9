"""Speed of mistuning studies, as ratios measured in one run.

Usage::

    python benchmarks/mistuning_study.py              # 1000 patterns of 36 beams
    python benchmarks/mistuning_study.py --patterns 200

The disks are rings of SNECMA beams at 20.313 N, Guillen (1999), section 4.5: couplings of 7000 N/m,
engine order 3, deviation 5 %, three harmonics, highest blade between 150 and 260 rad/s.
"""

from __future__ import annotations

import argparse
import os
import time

for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np

import stickslip as ss

SPAN = (150.0, 260.0)


def measured(patterns: int, sectors: int = 36, threads: int = 1) -> tuple[float, ss.MistuningStudy]:
    """Return processor time of all threads [s], less disturbed than wall time, and the study."""
    ring = ss.reference.beam_ring(sectors, 7e3, 3)
    start = time.process_time()
    study = ss.mistuning_study(
        ring,
        0.05,
        omega=SPAN,
        patterns=patterns,
        seed=1,
        harmonics=3,
        dofs="damper",
        threads=threads,
    )
    return time.process_time() - start, study


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--patterns", type=int, default=1000, help="of the largest study")
    count = parser.parse_args().patterns
    processors = os.cpu_count() or 1
    measured(4)
    start = time.perf_counter()
    spent, study = measured(count, threads=processors)
    wall = time.perf_counter() - start
    points = study.counters["points"] / count
    print(f"{count} patterns of 36 beams, {processors} threads: {wall:.1f} s ({spent:.1f} s busy)")
    print(f"  {1e3 * spent / count:.1f} ms of a processor and {points:.1f} solutions per pattern")

    print("\npatterns: time per pattern, over that of the first row")
    sizes = [count // 16, count // 4, count]
    times = [measured(sizes[0])[0], measured(sizes[1])[0], spent]
    for size, seconds in zip(sizes, times, strict=True):
        print(f"  {size:5d} {seconds / size / (times[0] / sizes[0]):6.2f}", flush=True)

    print("\nblades: time per pattern over 12 blades, exponent since the row before")
    few, before = max(count // 25, 4), None
    for sectors in (12, 36, 108):
        seconds = measured(few, sectors)[0]
        if before is None:
            print(f"  {sectors:5d} {1.0:6.2f}")
            reference = seconds
        else:
            exponent = np.log(seconds / before[1]) / np.log(sectors / before[0])
            print(f"  {sectors:5d} {seconds / reference:6.2f}   {exponent:.2f}")
        before = (sectors, seconds)

    ring = ss.reference.beam_ring(36, 7e3, 3)
    grid = np.arange(*SPAN, 0.05)
    observe = [f"{blade}.damper" for blade in range(36)]
    start = time.process_time()
    frf = ss.forced_response(ring.mistuned(0.05 * study.patterns[0]), grid, 3, observe=observe)
    frf.blade_amplitudes("damper")
    sweep = time.process_time() - start
    ratio = sweep / (spent / count)
    print(f"\na sweep in steps of 0.05 rad/s takes {ratio:.0f} times as long as one pattern")


if __name__ == "__main__":
    main()
