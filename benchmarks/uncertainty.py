"""A wedge between two blades, four uncertain parameters: 625 peaks with a surrogate, 10 000 direct.

python benchmarks/uncertainty.py [samples of the surrogate] [direct samples]
"""

from __future__ import annotations

import os

for name in ("OPENBLAS_NUM_THREADS", "RAYON_NUM_THREADS"):
    os.environ.setdefault(name, "1")

import sys
import time

import numpy as np
from scipy import stats

import stickslip as ss

PARAMETERS = {
    "friction": stats.uniform(0.15, 0.25),
    "tangential_stiffness": stats.norm(3e5, 2e4),
    "normal_stiffness": stats.lognorm(0.1, scale=3e5),
    "load": stats.uniform(0.8, 0.4),
}
PEAK = ss.HighestPeak("left.x", omega=(80.0, 240.0))
HARMONICS = 5


def wedge() -> ss.Model:
    left = ss.Structure(10 * np.eye(2), [[1e6, -9e5], [-9e5, 1e6]], 100 * np.eye(2), ["x", "y"])
    right = ss.Structure(10 * np.eye(2), [[4e5, -3e5], [-3e5, 4e5]], 100 * np.eye(2), ["x", "y"])
    damper = ss.WedgeDamper(
        angle=60.0,
        mass=0.1,
        friction=0.2,
        tangential_stiffness=3e5,
        normal_stiffness=3e5,
        load=240.0,
    )
    forces = [ss.Force("left.x", 150.0), ss.Force("right.x", 150.0, phase=np.pi)]
    return damper.between(left, right, left_dofs=["x", "y"], right_dofs=["x", "y"], forces=forces)


def main(few: int, many: int) -> None:
    model = wedge()

    def sampled(samples: int, sampling: str, seed: int) -> ss.Uncertainty:
        start = time.perf_counter()
        study = ss.uncertainty(
            model,
            PARAMETERS,
            PEAK,
            samples=samples,
            sampling=sampling,
            seed=seed,
            harmonics=HARMONICS,
            threads=1,
        )
        seconds = time.perf_counter() - start
        print(f"{samples} samples, {sampling}: {seconds:.1f} s, {study.failed} failed", flush=True)
        return study

    few_study = sampled(few, "sobol", 0)
    expansions = {}
    for number in few_study.numbers:
        start = time.perf_counter()
        expansions[number] = few_study.expansion(number)
        print(f"{number}: {expansions[number]}, {time.perf_counter() - start:.1f} s", flush=True)
    many_study = sampled(many, "random", 1)
    for number, expansion in expansions.items():
        values = many_study.values(number)
        found = np.isfinite(values)
        said = expansion({name: many_study.parameter(name)[found] for name in PARAMETERS})
        left = ((values[found] - said) ** 2).mean() / values[found].var()
        print(f"{number}: error on the direct samples {left:.2g} of the variance")
        for q in (5, 50, 95, 99):
            direct, own = many_study.percentile(number, q), few_study.percentile(number, q)
            surrogate = expansion.percentile(q)
            print(
                f"  {q:2d} %: direct {direct.value:.5g} ({direct.low:.5g} to {direct.high:.5g}), "
                f"surrogate {surrogate.value:.5g} ({surrogate.low:.5g} to {surrogate.high:.5g}), "
                f"{few} samples {own.value:.5g} ({own.low:.5g} to {own.high:.5g})"
            )
        shares = expansion.sobol()
        for name in PARAMETERS:
            one, whole = shares.first[name], shares.total[name]
            print(
                f"  {name}: first {one.value:.3f} ({one.low:.3f} to {one.high:.3f}), "
                f"total {whole.value:.3f} ({whole.low:.3f} to {whole.high:.3f})"
            )


if __name__ == "__main__":
    given = [int(one) for one in sys.argv[1:]]
    main(*given, *(625, 10_000)[len(given) :])
