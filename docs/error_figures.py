"""The figures and tables of errors: of few harmonics, and of their estimates."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from saved import ASSETS, save

import stickslip as ss
from stickslip import plot

REFERENCE_HARMONICS = 121
"""Highest harmonic of the solutions that count as exact."""


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


def harmonics_errors(folder: Path = ASSETS) -> tuple[Path, Path]:
    """Draw and tabulate the error of the refined tip peak over the harmonics kept.

    The truth is the peak of exact orbits.
    """
    omega = np.linspace(140.0, 240.0, 201)
    kept = np.arange(1, 42, 2)
    loads = ss.reference.SNECMA_LOADS[1:]
    signed = {load: _peak_errors(ss.reference.snecma_beam(load), omega, kept) for load in loads}
    figure = Figure(figsize=(11.0, 4.4), layout="constrained")
    left, right = figure.subplots(1, 2)
    for load, colour in zip(loads[::2], ("#440154", "#31688e", "#35b779", "#d8863b"), strict=True):
        errors, full = signed[load]
        left.semilogy(kept, np.abs(errors), marker="o", ms=3, color=colour, label=f"{load:g} N")
        left.axvline(full, color=colour, lw=0.9, ls=":")
    left.set_xlabel("harmonics kept H")
    left.set_ylabel("relative error of the peak of the tip")
    left.legend(frameon=False, title="dotted: H ω passes 3274 rad/s", fontsize="small")
    left.grid(color="0.9", lw=0.7)
    _draw_truncated(right)
    shown = (1, 3, 7, 15, 21, 31)
    lines = [
        f"| load [N] | {' | '.join(f'H = {one}' for one in shown)} | H = 3274/ω |",
        "|---|" + "---|" * (len(shown) + 1),
    ]
    for load, (errors, full) in signed.items():
        cells = " | ".join(f"{100 * errors[(one - 1) // 2]:+.2g} %" for one in shown)
        lines.append(f"| {load:g} | {cells} | {full:.0f} |")
    table = folder / "harmonics-errors.md"
    table.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return save(figure, folder / "harmonics-errors.png"), table


def _peak_errors(
    model: ss.Model, omega: NDArray[np.float64], kept: NDArray[np.int64]
) -> tuple[NDArray[np.float64], float]:
    """Return relative errors of the tip peak, and the harmonic at the highest stuck frequency."""
    exact = ss.exact_response(model, omega, observe="tip").peak("tip")
    peaks = [
        ss.forced_response(model, omega, int(one), observe="tip").peak("tip").amplitude
        for one in kept
    ]
    full = ss.natural_frequencies(model)[-1] / exact.omega
    return np.array(peaks) / exact.amplitude - 1.0, float(full)


def _draw_truncated(ax: Axes) -> None:
    """Draw the tip at 25 N with few harmonics, and exact orbits."""
    model = ss.reference.snecma_beam(25.0)
    omega = np.linspace(150.0, 220.0, 281)
    looks = {1: ("#31688e", "--"), 3: ("#d8863b", "-"), 15: ("#35b779", "-")}
    for harmonics, (colour, style) in looks.items():
        curve = ss.forced_response(model, omega, harmonics, observe="tip")
        ax.plot(
            omega, 1e3 * curve.amplitude("tip"), color=colour, ls=style, label=f"H = {harmonics}"
        )
    exact = ss.exact_response(model, omega[::8], observe="tip")
    ax.plot(
        exact.omega,
        1e3 * exact.amplitude("tip"),
        ls="",
        marker="D",
        ms=3.5,
        mfc="white",
        mec="black",
        label="exact orbits",
    )
    ax.set_xlabel("angular frequency ω [rad/s]")
    ax.set_ylabel("half peak-to-peak of tip [mm]")
    ax.set_title("25 N", fontsize="medium")
    ax.legend(frameon=False, fontsize="small")
    ax.grid(color="0.9", lw=0.7)


def certificate(folder: Path = ASSETS) -> Path:
    """Draw a coarse curve with its error band and exact orbits."""
    curve = ss.forced_response(ss.reference.snecma_beam(25.0), np.linspace(140, 230, 181), 3)
    figure = Figure(figsize=(7.5, 4.4), layout="constrained")
    ax = figure.add_subplot()
    plot.curves(
        ss.certify(curve, range(0, 181, 8)), "tip", length_unit="mm", log=False, peaks=False, ax=ax
    )
    ax.legend(loc="lower right", ncols=3, frameon=False, fontsize="small")
    return save(figure, folder / "certificate.png")


def bounds(folder: Path = ASSETS) -> Path:
    """Draw what residual tractions make of the response of two blades with a wedge."""
    damper = ss.WedgeDamper(
        angle=40.0,
        mass=0.1,
        friction=0.6,
        tangential_stiffness=3e5,
        normal_stiffness=3e5,
        load=240.0,
    )
    left, right = (
        ss.Structure(10.0 * np.eye(2), stiffness, 100.0 * np.eye(2), ["x", "y"])
        for stiffness in ([[1e6, -9e5], [-9e5, 1e6]], [[4e5, -3e5], [-3e5, 4e5]])
    )
    model = damper.between(
        left,
        right,
        left_dofs=["x", "y"],
        right_dofs=["x", "y"],
        forces=[ss.Force("left.x", 200.0), ss.Force("right.x", 200.0, phase=np.pi)],
    )
    omega = np.linspace(285.0, 312.0, 28)
    frf = ss.forced_response(model, omega, 15, residual="bounds", observe=["left.x"])
    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    ax = figure.subplots()
    left_out = {"stuck": False, "free": False, "peaks": False, "error_band": False}
    plot.curves(frf, "left.x", length_unit="mm", ax=ax, **left_out)
    return save(figure, folder / "bounds.png")


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
