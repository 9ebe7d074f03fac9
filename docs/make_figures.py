"""Makes the figures and measured tables of the documentation: ``python docs/make_figures.py``.

They are kept with the pages, so that building the pages computes nothing.
"""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

import stickslip as ss
from stickslip import plot

ASSETS = Path(__file__).parent / "assets"

REFERENCE_HARMONICS = 121
"""Highest harmonic of the solutions that count as exact."""


def snecma_beam(folder: Path = ASSETS) -> Path:
    """Draw the response curves of the SNECMA beam and its hysteresis loops."""
    model = ss.reference.snecma_beam(force=1.0)
    omega = (60.0, 300.0)
    curves = [
        ss.forced_response(model.scaled(force=load), omega)
        for load in ss.reference.SNECMA_LOADS[1::2]
    ]
    figure = Figure(figsize=(11.0, 4.4), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.5, 1.0))
    plot.curves(curves, "tip", normalise="force", length_unit="um", ax=left)
    shown = curves[2]
    indices = [shown.index(frequency) for frequency in (260.0, 220.0, 200.0)]
    plot.hysteresis(shown, "jenkins", indices, length_unit="um", ax=right)
    right.set_title(f"damper at P = {shown.model.forces[0].amplitude:g} N", fontsize="medium")
    loops, _ = right.get_legend_handles_labels()
    labels = [f"{shown.omega[index]:.0f} rad/s" for index in indices]
    right.legend(loops, labels, loc="center", frameon=False, fontsize="small", handlelength=1.0)
    return _save(figure, folder / "snecma-beam.png")


def error_estimates(folder: Path = ASSETS) -> Path:
    """Tabulate true truncation errors of the beam tip against their estimates.

    Over 401 frequencies and all loads, at the points where the damper slips. The true error is
    the largest difference over a period from the solution with `REFERENCE_HARMONICS`.
    """
    omega = np.linspace(100.0, 300.0, 401)
    model = ss.reference.snecma_beam(force=1.0)
    models = [model.scaled(force=load) for load in ss.reference.SNECMA_LOADS]
    exact = [
        ss.forced_response(one, omega, harmonics=REFERENCE_HARMONICS, observe="tip")
        for one in models
    ]
    lines = [
        "| H | largest true error | estimate ≥ true error | true error / estimate: "
        "median, 99 %, largest |",
        "|---|---|---|---|",
    ]
    for harmonics in (1, 3, 7, 15, 21, 31, "auto"):
        found = [_errors(one, close, harmonics) for one, close in zip(models, exact, strict=True)]
        true, ratio = (np.concatenate(values) for values in zip(*found, strict=True))
        middle, most, largest = np.quantile(ratio, [0.5, 0.99, 1.0])
        lines.append(
            f"| {harmonics} | {true.max():.2g} | {np.mean(ratio <= 1.0):.0%} of points | "
            f"{middle:.1f}, {most:.1f}, {largest:.1f} |"
        )
    file = folder / "error-estimates.md"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def _errors(
    model: ss.Model, exact: ss.ForcedResponse, harmonics: int | Literal["auto"]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return relative true errors, and true errors over their estimates, where they matter."""
    result = ss.forced_response(model, exact.omega, harmonics=harmonics, observe="tip")
    difference = exact.coefficients("tip").copy()
    kept = result.coefficients("tip")
    difference[:, : kept.shape[1]] -= kept
    angles = np.linspace(0.0, 2.0 * np.pi, 1024, endpoint=False)
    turns = np.exp(1j * np.outer(np.arange(difference.shape[1]), angles))
    error = np.abs((difference @ turns).real).max(axis=1)
    relative = error / exact.amplitude("tip")
    # Below this the solutions differ by what the solver leaves, not by truncation.
    counted = (exact.slip_fraction(0)[:, 0] > 0.0) & (relative > 1e-6)
    estimate = np.maximum(result.error_estimate("tip"), np.finfo(np.float64).tiny)
    return relative[counted], (error / estimate)[counted]


def _save(figure: Figure, file: Path) -> Path:
    file.parent.mkdir(exist_ok=True)
    # Without the date and version in the file, an unchanged figure is an unchanged file.
    figure.savefig(file, dpi=110, metadata={"Software": None})
    return file


if __name__ == "__main__":
    print(snecma_beam())
    print(error_estimates())
