"""A flutter map of 36 nodal diameters, on one thread.

Usage::

    python benchmarks/flutter.py

Sectors of one degree of freedom, and of the three of the SNECMA beam, with a damper to the ground.
The flow destabilises two thirds of the travelling waves. Processor times, with automatic harmonics
and with 5; the error is that of the amplitudes of limit cycles against the whole equations.
"""

from __future__ import annotations

import os
import time

for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS", "RAYON_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np

import stickslip as ss

SECTORS = 36


def disks() -> dict[str, ss.BladedDisk]:
    """Return tuned disks by what their sector is."""
    mass = ss.Structure([[0.1]], [[1.6e5]], ss.Rayleigh(mass=0.5), ["tip"])
    beam = ss.reference.snecma_beam()
    light = ss.Structure(
        beam.structure.mass, beam.structure.stiffness, ss.Rayleigh(mass=0.5), beam.structure.dofs
    )
    ground = ss.Jenkins("tip", stiffness=2e4, slip_force=5.0)
    return {
        "1 DOF": ss.BladedDisk(
            mass, SECTORS, [ss.Coupling("tip", stiffness=4e3)], [ground], engine_order=1
        ),
        "3 DOFs": ss.BladedDisk(
            light,
            SECTORS,
            [ss.Coupling(beam.structure.dofs[1], stiffness=1e4)],
            beam.contacts,
            engine_order=1,
        ),
    }


def main() -> None:
    angle = 2.0 * np.pi * np.arange(SECTORS) / SECTORS
    flow = ss.AerodynamicDamping(ratio=-0.003 + 0.004 * np.sin(angle))
    for name, disk in disks().items():
        for keys in ({}, {"harmonics": 5}):
            start = time.process_time()
            found = ss.flutter_map(disk, flow, **keys)
            spent = time.process_time() - start
            errors = [one.error for one in found.cycles()]
            print(
                f"{name:>7} {keys or 'automatic'}: {spent:6.2f} s, {len(errors)} limit cycles, "
                f"largest error {np.nanmax(errors):.1e}",
                flush=True,
            )


if __name__ == "__main__":
    main()
