"""Stresses at the peak: from 18 component modes back to the finite elements.

    python examples/turbine-blade/stress.py

computes the response at the peak of the tip with the best damper, recovers the displacements of
all nodes, and writes turbine-blade.vtu for ParaView: displacement amplitude and the range of the
von Mises stress over a period. `--coarse` takes a coarse mesh.
"""

from __future__ import annotations

import sys

import numpy as np
from blade import Blade
from reduce import COARSE, DAMPER_STIFFNESS, DAMPING, Model

import stickslip as ss


def main(coarse: bool = False) -> dict[str, object]:
    """Reduce, solve, recover, write."""
    fe = Model.of(Blade(**COARSE) if coarse else Blade())
    structure = fe.reduction.structure(DAMPING)
    damper = ss.Jenkins(
        "damper", stiffness=DAMPER_STIFFNESS, slip_force=ss.reference.BLADE_SLIP_FORCE
    )
    model = ss.Model(structure, [damper], fe.reduction.forces(fe.load))
    low, high = (ss.natural_frequencies(model, slipping=which)[0] for which in ([0], []))
    curve = ss.forced_response(model, omega=(0.98 * low, 1.02 * high), harmonics=35)
    peak = curve.peak("tip")
    (point,) = ss.forced_response(
        model, omega=[peak.omega], harmonics=35, observe=structure.dofs
    ).arrays.displacement  # (H+1, n), the modal coordinates too
    motion = np.array([fe.everywhere(moved) for moved in fe.reduction.recover(point)])
    amplitude, stress_range = motion_fields(fe.solid, motion)
    node = int(stress_range.argmax())
    fields = {
        "displacement amplitude [m]": amplitude,
        "von Mises range [Pa]": stress_range,
    }
    fe.solid.write_vtu("turbine-blade.vtu", fields)
    return {
        "omega": peak.omega,
        "tip_m": peak.amplitude,
        "node": node + 1,
        "place_m": fe.solid.nodes[node].tolist(),
        "von_mises_range_pa": float(stress_range[node]),
    }


def motion_fields(solid: ss.Solid, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return amplitude, shape (n, 3), and von Mises range, shape (n,), of harmonics of motion."""
    phases = np.exp(2j * np.pi * np.outer(np.arange(64) / 64.0, np.arange(len(motion))))
    history = np.real(phases @ motion)
    amplitude = 0.5 * np.ptp(history, axis=0).reshape(-1, 3)
    return amplitude, ss.fe.von_mises_range(np.array([solid.stress(part) for part in motion]))


if __name__ == "__main__":
    found = main("--coarse" in sys.argv[1:])
    print(
        f"peak of the tip {found['tip_m']:.4g} m at {found['omega']:.6g} rad/s; highest von Mises "
        f"range {found['von_mises_range_pa']:.4g} Pa at node {found['node']}"
    )
