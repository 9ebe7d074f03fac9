"""Forced response of the SNECMA beam with one Jenkins damper, solved by pyHarm-os.

The peer side of a benchmark: three degrees of freedom, a friction damper from the first to
ground, a cosine force on the second (the tip), and a sweep at equally spaced frequencies
without continuation. Prints one line of JSON; everything else goes to the standard error.

Run it with the interpreter of the peer's environment (see ``requirements.txt``)::

    python pyharm_beam.py --harmonics 15 --samples 1024 --points 400 --repeat 2

The default settings are the fastest found that solve every frequency and keep it exactly. What
was tried, in processor time of a warm sweep with 15 harmonics, 1024 samples and 400 points on a
2-core machine:

* Predictor, the choice that decides whether the sweep ends. The default tangent fails for good
  at 273.9 rad/s; a constant step then retries that same frequency forever. The previous
  solution passes with 1024 samples (6.3 s) but not with 128. The secant, scaled to the
  frequency step, passes with both: 5.9 s, from 2.7 to 2.4 Newton iterations per point.
* Odd harmonics alone, the motion having half-wave symmetry: 5.9 s to 4.8 s, same solution.
  ``--all-harmonics`` keeps the mean and the even ones too.
* Solver. Newton-Raphson 4.8 s; Moore-Penrose 3.7 s (``--solver MoorePenrose``), but it lets the
  frequency drift, here by 4e-9 rad/s. pyHarm's default, scipy's hybr, takes twice as long as
  Newton-Raphson (12 s against 6.3 s, all harmonics, previous solution), and only passes if told
  to accept every exit status whose residual is below a tolerance.
* Samples per period: 2048 10.7 s, 1024 5.9 s, 512 3.6 s, 256 2.2 s, 128 1.7 s (all harmonics);
  1.1 s with 128 and odd harmonics. The tip peak moves by 2e-4 from 1024 to 128. 64 fail.
* One BLAS thread: with two, the wall time is the same or several times longer, and the
  processor time about doubles or worse. Set below, unless the environment says otherwise.
* Condensation to the damper (NLdofs): 6.3 s to 8.6 s, slower, as it solves for the linear
  degrees of freedom at each evaluation. Allgower's preconditioner and scaled units: no gain.
* Tolerances: the defaults (1e-8 N, 1e-8 m) are kept; 1e-4 N and 1e-6 m save a tenth.
* Jacobian by jax: twice as slow. Bifurcation detection, off here, costs 3 %.
* Numba keeps its compiled code on disk. Without it (``--fresh-cache``) the first sweep takes
  some 20 to 25 s more.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib.metadata
import json
import logging
import os
import sys
import tempfile
import time
import warnings
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read when numpy and scipy load

import numpy as np

MASS = np.array(
    [[6.67959, 1.02115, 0.6343], [1.02115, 1.22168, 0.232108], [0.6343, 0.232108, 0.121809]]
)
STIFFNESS = np.array(
    [[4.43203e6, -3.77514e5, 0.0], [-3.77514e5, 6.9626e4, 0.0], [0.0, 0.0, 1.85323e5]]
)
DAMPING = 2.6e-5 * STIFFNESS + 7.49 * MASS
DAMPER_NODE, TIP_NODE = 0, 1
DAMPER_STIFFNESS = 2.4e7  # N/m
SLIP_FORCE = 246.048  # N
FORCE = 20.313  # N
OMEGA_FIRST, OMEGA_LAST = 20.0, 350.0  # rad/s
WAVEFORM_POINTS = 8192

STARTED = time.perf_counter()


@dataclass(frozen=True)
class Study:
    """What to compute and how."""

    harmonics: int
    samples: int
    points: int
    all_harmonics: bool
    solver: str

    @property
    def orders(self) -> list[int]:
        """The harmonics kept."""
        if self.all_harmonics:
            return list(range(self.harmonics + 1))
        return list(range(1, self.harmonics + 1, 2))

    @property
    def step(self) -> float:
        """Spacing of the frequencies."""
        return (OMEGA_LAST - OMEGA_FIRST) / (self.points - 1)


@dataclass(frozen=True)
class Sweep:
    """A finished sweep and its cost."""

    wall_s: float
    cpu_s: float
    omega: np.ndarray
    tip: np.ndarray
    damper: np.ndarray
    converged: np.ndarray


@dataclass(frozen=True)
class Summary:
    """The line that is printed."""

    tool: str
    version: str
    harmonics: int
    orders: list[int]
    samples: int
    points: int
    solver: str
    blas_threads: str
    jit_compiled: bool
    import_s: float
    first_s: float
    first_cpu_s: float
    warm_s: list[float]
    warm_cpu_s: list[float]
    cold_process_s: float
    tip_peak_m: float
    tip_peak_omega: float
    damper_peak_m: float
    damper_peak_omega: float
    converged_points: int
    grid_error: float


def system_input(study: Study) -> dict[str, Any]:
    """Return the beam, its damper to ground and its load, as pyHarm reads them."""
    matrices = {"M": MASS.copy(), "C": DAMPING.copy(), "K": STIFFNESS.copy()}
    damper = {
        "type": "Jenkins",
        "connect": {"beam": [DAMPER_NODE]},  # one node alone: the other end is the ground
        "dirs": [0],
        "mu": 1.0,
        "N0": SLIP_FORCE,
        "k": DAMPER_STIFFNESS,
    }
    load = {
        "type": "CosinusForcing",
        "connect": {"beam": [TIP_NODE]},
        "dirs": [0],
        "amp": FORCE,
    }
    return {
        "system": {"type": "Base", "nh": study.orders, "nti": study.samples},
        "substructures": {"beam": {"matrix": matrices, "ndofs": 1}},
        "connectors": {"damper": damper, "load": load},
    }


def analysis_input(study: Study) -> dict[str, Any]:
    """Return the sweep at the frequencies of the study, bounded even where a point fails.

    pyHarm retries a point that fails: the number of solutions, failed ones included, ends it.
    """
    return {
        "study": "frf",
        "solver": study.solver,
        "solver_options": {"max_iter": 50},
        "predictor": "secant",
        "predictor_options": {"norm": "om", "bifurcation_detect": False},
        "corrector": "nocontinuation",
        "reductors": [{"type": "noreductor"}],
        "stepsizer": "constant",
        "ds0": study.step,
        "ds_max": study.step,
        "stopper": "solnumber",
        "stopper_options": {"max_solutions": study.points},
        "puls_inf": OMEGA_FIRST,
        "puls_sup": OMEGA_LAST,
        "verbose": False,
    }


def run_sweep(maestro_class: type[Any], study: Study) -> Sweep:
    """Build the model anew and solve it; only the solution is timed."""
    maestro = maestro_class({**system_input(study), "analysis": {"frf": analysis_input(study)}})
    wall, cpu = time.perf_counter(), time.process_time()
    maestro.operate()
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    solutions = maestro.nls["frf"].SolList
    states = np.array([solution.x for solution in solutions])
    return Sweep(
        wall_s=wall,
        cpu_s=cpu,
        omega=states[:, -1],
        tip=amplitudes(maestro, states, TIP_NODE),
        damper=amplitudes(maestro, states, DAMPER_NODE),
        converged=np.array([solution.flag_accepted for solution in solutions]),
    )


def amplitudes(maestro: Any, states: np.ndarray, node: int) -> np.ndarray:
    """Return half the peak-to-peak displacement of a node in each state."""
    unknowns = maestro.system.expl_dofs
    unknowns = unknowns[unknowns["node_num"] == node]
    phase = np.linspace(0.0, 2.0 * np.pi, WAVEFORM_POINTS, endpoint=False)
    basis = np.array(
        [
            np.cos(order * phase) if part == "c" else np.sin(order * phase)
            for order, part in zip(unknowns["harm"], unknowns["cs"], strict=True)
        ]
    )
    half_range: np.ndarray = np.ptp(states[:, unknowns.index] @ basis, axis=1) / 2.0
    return half_range


def largest(amplitude: np.ndarray, sweep: Sweep) -> tuple[float, float]:
    """Return the largest amplitude among the converged points, and its frequency."""
    where = int(np.where(sweep.converged, amplitude, 0.0).argmax())
    return float(amplitude[where]), float(sweep.omega[where])


def process_age() -> float:
    """Return the seconds since the process started, or since this module did if unknown."""
    try:
        with open("/proc/self/stat", encoding="ascii") as stat:
            ticks = int(stat.read().rpartition(")")[2].split()[19])
        return time.clock_gettime(time.CLOCK_BOOTTIME) - ticks / os.sysconf("SC_CLK_TCK")
    except (OSError, AttributeError):
        return time.perf_counter() - STARTED


@contextlib.contextmanager
def peer_surroundings(fresh_cache: bool) -> Iterator[None]:
    """Keep pyHarm's output off the standard output and its files out of the working folder."""
    logging.disable(logging.CRITICAL)
    warnings.simplefilter("ignore")
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(sys.stderr):
        os.environ.setdefault("PYHARM_CONTEXT_FILE", os.path.join(folder, "context.json"))
        if fresh_cache:
            os.environ["NUMBA_CACHE_DIR"] = os.path.join(folder, "numba")
        yield


def benchmark(study: Study, repeat: int) -> Summary:
    """Import pyHarm, then sweep repeatedly in this process."""
    began = time.perf_counter()
    from numba.core import event
    from pyHarm.Maestro import Maestro

    import_s = time.perf_counter() - began
    with event.install_recorder("numba:compile") as compilations:
        first = run_sweep(Maestro, study)
    cold_process_s = process_age()
    warm = [run_sweep(Maestro, study) for _ in range(repeat - 1)]
    tip_peak, tip_omega = largest(first.tip, first)
    damper_peak, damper_omega = largest(first.damper, first)
    grid = OMEGA_FIRST + study.step * np.arange(len(first.omega))
    return Summary(
        tool="pyHarm-os",
        version=importlib.metadata.version("pyHarm-os"),
        harmonics=study.harmonics,
        orders=study.orders,
        samples=study.samples,
        points=study.points,
        solver=study.solver,
        blas_threads=os.environ["OPENBLAS_NUM_THREADS"],
        jit_compiled=bool(compilations.buffer),
        import_s=import_s,
        first_s=first.wall_s,
        first_cpu_s=first.cpu_s,
        warm_s=[sweep.wall_s for sweep in warm],
        warm_cpu_s=[sweep.cpu_s for sweep in warm],
        cold_process_s=cold_process_s,
        tip_peak_m=tip_peak,
        tip_peak_omega=tip_omega,
        damper_peak_m=damper_peak,
        damper_peak_omega=damper_omega,
        converged_points=int(first.converged.sum()),
        grid_error=float(np.abs(first.omega - grid).max()),
    )


def parse_arguments() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description="The beam benchmark, solved by pyHarm-os.")
    parser.add_argument("--harmonics", type=int, default=15, help="highest harmonic")
    parser.add_argument("--samples", type=int, default=1024, help="time samples per period")
    parser.add_argument("--points", type=int, default=400, help="frequencies")
    parser.add_argument("--repeat", type=int, default=2, help="sweeps, the first included")
    parser.add_argument(
        "--all-harmonics", action="store_true", help="keep the mean and the even harmonics too"
    )
    parser.add_argument(
        "--solver", choices=["NewtonRaphson", "MoorePenrose"], default="NewtonRaphson"
    )
    parser.add_argument(
        "--fresh-cache", action="store_true", help="ignore code that numba compiled earlier"
    )
    arguments = parser.parse_args()
    for name, least in (("harmonics", 1), ("samples", 4), ("points", 2), ("repeat", 1)):
        if getattr(arguments, name) < least:
            parser.error(f"--{name} must be at least {least}")
    return arguments


def main() -> None:
    """Run the benchmark and print its summary."""
    arguments = parse_arguments()
    study = Study(
        harmonics=arguments.harmonics,
        samples=arguments.samples,
        points=arguments.points,
        all_harmonics=arguments.all_harmonics,
        solver=arguments.solver,
    )
    with peer_surroundings(arguments.fresh_cache):
        summary = benchmark(study, arguments.repeat)
    print(json.dumps(asdict(summary)))


if __name__ == "__main__":
    main()
