"""The study of section 4.3 of the dissertation, on the open blade.

    python examples/turbine-blade/study.py

finds the best slip force F_d0, computes responses of damper and tip around the mode with the
largest tip motion for F_d from 0.01 to 100 F_d0 (Figs 4.10, 4.11), compares the best one with exact
orbits (Figs 4.12, 4.13), and writes turbine-blade.png and turbine-blade.json.
"""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
from matplotlib import pyplot

import stickslip as ss

RATIOS = (0.01, 0.1, 0.3, 0.6, 1.0, 2.0, 5.0, 20.0, 100.0)  # F_d / F_d0
SPAN = (0.95, 1.05)  # from below the free to above the stuck natural frequency
HARMONICS = 9  # of Figs 4.10 to 4.13
TOLERANCE = 1e-3


def with_slip_force(model: ss.Model, slip_force: float) -> ss.Model:
    """Return the blade with another damper."""
    (damper,) = model.contacts
    return ss.Model(model.structure, [replace(damper, slip_force=slip_force)], model.forces)


def largest_tip_mode(model: ss.Model) -> int:
    """Return the mode, from 0, that moves the tip most while the damper sticks."""
    stuck = with_slip_force(model, np.inf)
    omegas = ss.natural_frequencies(stuck)[:10]
    peaks = ss.forced_response(stuck, omega=omegas, harmonics=1).amplitude("tip")
    return int(np.argmax(peaks))


def study() -> dict[str, object]:
    """Compute, draw, and return the numbers."""
    model = ss.reference.turbine_blade()
    mode = largest_tip_mode(model)
    low = ss.natural_frequencies(model, slipping=[0])[mode]
    high = ss.natural_frequencies(model)[mode]
    span = (SPAN[0] * low, SPAN[1] * high)
    best = ss.optimal_damper(model, dof="tip", omega=span, mode=mode)
    stuck = ss.forced_response(with_slip_force(model, np.inf), omega=span)
    scale = {dof: stuck.peak(dof) for dof in ("damper", "tip")}

    curves = {
        ratio: ss.forced_response(
            with_slip_force(model, ratio * best.slip_force), omega=span, harmonics=HARMONICS
        )
        for ratio in RATIOS
    }
    best_model = with_slip_force(model, best.slip_force)
    orbits = ss.exact_response(best_model, omega=np.linspace(*span, 100))
    same = ss.forced_response(best_model, omega=orbits.omega, tolerance=TOLERANCE)
    nine = ss.forced_response(best_model, omega=orbits.omega, harmonics=HARMONICS)
    differences = {
        name: {dof: difference(curve, orbits, dof) for dof in scale}
        for name, curve in (("auto", same), (str(HARMONICS), nine))
    }
    draw(curves, orbits, nine, scale)
    numbers: dict[str, object] = {
        "mode": mode + 1,
        "free_hz": low / (2.0 * np.pi),
        "stuck_hz": high / (2.0 * np.pi),
        "slip_force_n": best.slip_force,
        "stuck_peak_m": {dof: peak.amplitude for dof, peak in scale.items()},
        "normalised_peaks": {
            str(ratio): {
                dof: [
                    curve.peak(dof).amplitude / scale[dof].amplitude,
                    curve.peak(dof).omega / scale[dof].omega,
                ]
                for dof in scale
            }
            for ratio, curve in curves.items()
        },
        "peak_reduction_at_optimum": scale["tip"].amplitude / curves[1.0].peak("tip").amplitude,
        "converged": all(bool(curve.converged.all()) for curve in curves.values()),
        "harmonics_at_optimum": int(same.arrays.displacement.shape[1] - 1),
        "difference_to_exact_orbits": differences,
    }
    return numbers


def difference(curve: ss.ForcedResponse, orbits: ss.ExactResponse, dof: str) -> float:
    """Return the largest difference of amplitudes over the largest amplitude."""
    exact = orbits.amplitude(dof)
    return float(np.nanmax(np.abs(curve.amplitude(dof) - exact)) / np.nanmax(exact))


def draw(
    curves: dict[float, ss.ForcedResponse],
    orbits: ss.ExactResponse,
    nine: ss.ForcedResponse,
    scale: dict[str, object],
) -> None:
    """Draw Figs 4.10 to 4.13."""
    figure, axes = pyplot.subplots(2, 2, figsize=(11, 8), layout="constrained")
    colours = pyplot.get_cmap("viridis")(np.linspace(0.0, 0.92, len(curves)))
    for column, (dof, peak) in enumerate(scale.items()):
        for colour, (ratio, curve) in zip(colours, curves.items(), strict=True):
            x, y = curve.omega / peak.omega, curve.amplitude(dof) / peak.amplitude
            axes[0, column].semilogy(x, y, color=colour, label=f"{ratio:g}")
        axes[0, column].set_title(f"{dof}, F_d / F_d0 from 0.01 to 100")
        x, y = orbits.omega / peak.omega, orbits.amplitude(dof) / peak.amplitude
        axes[1, column].plot(x, y, "k-", lw=1.0, label="exact orbits")
        y = nine.amplitude(dof) / peak.amplitude
        axes[1, column].plot(x, y, "o", ms=3, mfc="none", label=f"{HARMONICS} harmonics")
        axes[1, column].set_title(f"{dof}, F_d = F_d0")
        axes[1, column].legend()
        for axis in axes[:, column]:
            axis.set_xlabel("frequency / stuck natural frequency")
            axis.set_ylabel("amplitude / stuck peak")
            axis.grid(alpha=0.3)
    axes[0, 1].legend(title="F_d / F_d0", fontsize="small")
    figure.savefig("turbine-blade.png", dpi=110)
    pyplot.close(figure)


if __name__ == "__main__":
    numbers = study()
    with open("turbine-blade.json", "w") as stream:
        json.dump(numbers, stream, indent=1)
    print(f"mode {numbers['mode']}, F_d0 = {numbers['slip_force_n']:.4g} N")
    print(f"peak at the tip {numbers['peak_reduction_at_optimum']:.1f} times lower than stuck")
