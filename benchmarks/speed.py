"""Speed of the 400-point beam sweep, as ratios measured in one run.

Usage::

    python benchmarks/speed.py            # against plain dense linear algebra
    python benchmarks/speed.py --peers    # against pyHarm-os too, in an environment of its own

The study is the SNECMA beam of Guillen (1999), eq. (2.32), at 20.313 N over 20 to 350 rad/s. Times
depend on the machine and on what else it does; the ratios are what to read.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

# One thread each: the sweep runs on one, and small matrices are slower on more.
for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np
import scipy.fft
import scipy.linalg

import stickslip as ss

HERE = Path(__file__).parent
POINTS = 400
COLD_SCRIPT = """
import numpy as np, stickslip as ss
model = ss.reference.snecma_beam(20.313)
frf = ss.forced_response(model, np.linspace(20, 350, 400), harmonics=15)
print(frf.amplitude("tip").max())
"""


def best(work: Callable[[], object], repeats: int = 15) -> float:
    """Shortest wall time of several runs in s: the one least disturbed by other processes."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def sweep(model: ss.Model, harmonics: int) -> ss.ForcedResponse:
    return ss.forced_response(model, np.linspace(20.0, 350.0, POINTS), harmonics=harmonics)


def dense_algebra() -> Callable[[], None]:
    """One dense 31 x 31 factorise-and-solve and one FFT of 512 samples per frequency."""
    generator = np.random.default_rng(0)
    matrices = generator.normal(size=(POINTS, 31, 31))
    rights = generator.normal(size=(POINTS, 31))
    samples = generator.normal(size=(POINTS, 512))

    def work() -> None:
        for matrix, right, series in zip(matrices, rights, samples, strict=True):
            scipy.linalg.lu_solve(scipy.linalg.lu_factor(matrix), right)
            scipy.fft.fft(series)

    return work


def cold_process() -> float:
    """Median wall time of a new Python process that imports, builds and sweeps, in s."""
    times = []
    for _ in range(5):
        start = time.perf_counter()
        subprocess.run([sys.executable, "-c", COLD_SCRIPT], check=True, capture_output=True)
        times.append(time.perf_counter() - start)
    return median(times)


def install_peer(folder: Path) -> Path:
    """Install pyHarm-os into an environment of its own if needed; return its interpreter."""
    python = folder / "bin" / "python"
    if not python.exists():
        print(f"installing pyHarm-os into {folder} ...", flush=True)
        subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
        requirements = HERE / "peers" / "requirements.txt"
        install = [str(python), "-m", "pip", "install", "--quiet", "-r", str(requirements)]
        subprocess.run(install, check=True)
    return python


def peer(folder: Path, samples: int) -> dict[str, object]:
    """Run the same study with pyHarm-os."""
    command = [
        str(install_peer(folder)),
        str(HERE / "peers" / "pyharm_beam.py"),
        "--harmonics",
        "15",
    ]
    command += ["--samples", str(samples), "--points", str(POINTS), "--repeat", "3"]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return dict(json.loads(done.stdout.strip().splitlines()[-1]))


def own_table() -> float:
    """Print the times of the sweep by harmonics; return the one for H = 15 in s."""
    print("\n|  H | sweep [ms] | point [us] | tip peak [mm] | iterations | factorisations |")
    print("|---|---|---|---|---|---|")
    taken = {}
    # Built once, as the peer's model is: warm sweeps are compared.
    model = ss.reference.snecma_beam(20.313)
    for harmonics in (1, 3, 9, 15, 21, 35):
        taken[harmonics] = best(lambda h=harmonics: sweep(model, h))  # type: ignore[misc]
        frf = sweep(model, harmonics)
        print(
            f"| {harmonics} | {1e3 * taken[harmonics]:.1f} | {1e6 * taken[harmonics] / POINTS:.1f} "
            f"| {1e3 * frf.amplitude('tip').max():.6f} | {frf.counters['iterations']} "
            f"| {frf.counters['factorisations']} |"
        )
    return taken[15]


def peer_table(folder: Path, own: float, cold: float) -> None:
    """Print what pyHarm-os takes for the same sweep, and the ratios."""
    print("\n| pyHarm-os, H = 15 | warm [s] | ratio | cold process [s] | ratio | tip peak [mm] |")
    print("|---|---|---|---|---|---|")
    for samples in (1024, 128):
        result = peer(folder, samples)
        warm = min(np.atleast_1d(np.asarray(result["warm_s"], dtype=float)))
        cold_peer = float(str(result["cold_process_s"]))
        print(
            f"| {samples} samples | {warm:.2f} | {warm / own:.0f} | {cold_peer:.1f} "
            f"| {cold_peer / cold:.0f} | {1e3 * float(str(result['tip_peak_m'])):.6f} |",
            flush=True,
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--peers", action="store_true", help="run pyHarm-os as well")
    default = HERE.parent / ".peers"
    parser.add_argument("--environment", type=Path, default=default, help="where pyHarm-os lives")
    options = parser.parse_args()
    own = own_table()
    dense, cold = best(dense_algebra()), cold_process()
    print(f"\n400 dense 31 x 31 solves and FFTs of 512: {1e3 * dense:.1f} ms;", end=" ")
    print(f"sweep with H = 15 takes {own / dense:.2f} times that")
    print(f"cold process, H = 15: {cold:.2f} s")
    if options.peers:
        peer_table(options.environment, own, cold)


if __name__ == "__main__":
    main()
