"""Guillen (1999), Table 4.1 anew: what each method takes for the response of the SNECMA beam.

Usage::

    python benchmarks/table_4_1.py

400 frequencies from 20 to 350 rad/s at 20.313 N. Harmonic balance by Broyden's and by Newton's
method, exact periodic orbits, and time integration from rest until a period changes the state by
less than 1e-6: classical Runge-Kutta with compiled steps, and the exact flow. It is the code of
``stickslip reproduce table-4.1``, on one thread. Times depend on the machine and on what else it
does; the ratios of one run are what to read.
"""

from __future__ import annotations

import os

# One thread each: everything compared here runs on one.
for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

from stickslip_reproduce import FULL, items
from stickslip_reproduce.index import number


def main() -> None:
    table = items()["table-4.1"].compute(FULL).table
    assert table is not None
    print(f"| {' | '.join(table.columns)} |")
    print("|---" * len(table.columns) + "|")
    for row in table.rows:
        print(f"| {' | '.join(map(number, row))} |")


if __name__ == "__main__":
    main()
