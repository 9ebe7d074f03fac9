"""The figures of bladed disks."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from saved import ASSETS, save

import stickslip as ss
from stickslip import plot


def bladed_disks(folder: Path = ASSETS) -> Path:
    """Draw a mistuned ring blade by blade, some of its curves, and the SAFE diagram of a blisk."""
    ring = ss.reference.beam_ring(coupling=7e3, engine_order=3)
    omega = np.linspace(160.0, 240.0, 161)
    observe = [f"{blade}.damper" for blade in range(36)]
    pattern = ss.mistuning_pattern(36, 0.07, "uniform", seed=0)
    mistuned = ss.forced_response(ring.mistuned(pattern), omega, 9, observe=observe)
    tuned = ss.forced_response(ring, omega, 9)
    figure = Figure(figsize=(14.0, 4.2), layout="constrained")
    bars, curves, safe = figure.subplots(1, 3)
    plot.blade_bars(mistuned, "damper", tuned=tuned, length_unit="um", ax=bars)
    shown = [1, 7, 12, 13, 20, 26]
    plot.blade_curves(mistuned, "damper", shown, tuned=tuned, length_unit="um", ax=curves)
    bars.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, frameon=False)
    bars.set_title("")
    plot.safe(ss.reference.laxalde_blisk(), 500.0, orders=[2, 4, 8, 18, 22], ax=safe)
    above = {"loc": "lower left", "bbox_to_anchor": (-0.1, 1.0), "columnspacing": 1.0}
    safe.legend(ncols=3, fontsize="small", frameon=False, **above)
    return save(figure, folder / "bladed-disks.png")


def ring_histories(folder: Path = ASSETS) -> Path:
    """Draw one period of three blades of the mistuned ring by harmonic balance and in time."""
    ring = ss.reference.beam_ring(coupling=7e3, engine_order=3)
    disk = ring.mistuned(ss.mistuning_pattern(36, 0.07, "uniform", seed=0))
    blades = (8, 11, 22)
    observe = [f"{blade}.damper" for blade in blades]
    run = ss.transient(disk, 200.0, 60, tolerance=1e-6, observe=observe, keep=1, samples=512)
    phase = (run.time - run.time[0]) / run.period
    figure = Figure(figsize=(13.0, 4.0), layout="constrained")
    axes = figure.subplots(1, 3, sharey=True)
    for ax, harmonics in zip(axes, (1, 9, 25), strict=True):
        # Come to from where all blades stick, which takes fewer iterations than from scratch.
        omega = np.linspace(170.0, 200.0, 13)
        frf = ss.forced_response(disk, omega, harmonics, observe=observe)
        for blade, name in zip(blades, observe, strict=True):
            series = frf.coefficients(name)[-1]
            turns = np.exp(1j * run.omega * np.outer(run.time, np.arange(series.size)))
            line = ax.plot(phase, 1e6 * (turns @ series).real, label=f"blade {blade}")[0]
            exact = 1e6 * run.displacement(name)
            ax.plot(phase[::16], exact[::16], "o", ms=3.5, mfc="none", color=line.get_color())
        ax.set_title(f"H = {harmonics}", fontsize="medium")
        ax.set_xlabel("time / period")
        ax.grid(alpha=0.3)
    axes[0].set_ylabel("displacement at the damper [µm]")
    axes[0].legend(frameon=False)
    return save(figure, folder / "ring-histories.png")


def amplification(folder: Path = ASSETS) -> Path:
    """Tabulate the amplification factors of the mistuned ring over the coupling stiffness."""
    kept, dofs = (1, 3, 25), ("damper", "tip")
    pattern = ss.mistuning_pattern(36, 0.07, "uniform", seed=0)
    omega = np.linspace(150.0, 260.0, 111)
    observe = [f"{blade}.{dof}" for blade in range(36) for dof in dofs]
    heads = [f"{dof}, H = {harmonics}" for dof in dofs for harmonics in kept]
    lines = [f"| coupling [N/m] | {' | '.join(heads)} |", "|---" * 7 + "|"]
    for coupling in ss.reference.RING_COUPLINGS:
        ring = ss.reference.beam_ring(coupling=coupling, engine_order=3)
        pairs = [
            (
                ss.forced_response(ring.mistuned(pattern), omega, harmonics, observe=observe),
                ss.forced_response(ring, omega, harmonics),
            )
            for harmonics in kept
        ]
        factors = [one.amplification(tuned, dof).factor for dof in dofs for one, tuned in pairs]
        lines.append(f"| {coupling:g} | {' | '.join(f'{value:.3f}' for value in factors)} |")
    file = folder / "amplification.md"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def mistuning(folder: Path = ASSETS) -> Path:
    """Draw the amplification factors of many rings: their distribution, and what moves it."""
    ring = ss.reference.beam_ring(coupling=7e3, engine_order=3)
    many = ss.mistuning_study(
        ring,
        0.07,
        patterns=1000,
        distribution="uniform",
        seed=1,
        omega=(140.0, 290.0),
        harmonics=3,
        dofs="damper",
    )
    moved = ss.mistuning_study(
        ring,
        [0.01, 0.02, 0.04, 0.07],
        coupling_stiffness=[3e3, 1.2e4],
        patterns=120,
        seed=1,
        omega=(140.0, 280.0),
        harmonics=3,
        dofs="damper",
    )
    figure = Figure(figsize=(11.0, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    plot.distribution(many, "damper", ax=left)
    plot.amplification(moved, "damper", "deviation", ax=right)
    return save(figure, folder / "mistuning.png")


def flutter_waves(folder: Path = ASSETS) -> Path:
    """Draw the sign of nodal diameters, the damping of a flow, and limit cycles in it."""
    blade = ss.Structure([[0.1]], [[1.6e5]], ss.Rayleigh(mass=0.5), ["tip"])
    coupling = ss.Coupling("tip", stiffness=4e3)
    contact = ss.Jenkins("tip", "next.tip", stiffness=2e4, slip_force=5.0)
    disk = ss.BladedDisk(blade, 24, [coupling], [contact], engine_order=1)
    places = np.arange(24)
    flow = ss.AerodynamicDamping(ratio=0.001 - 0.006 * np.sin(2.0 * np.pi * places / 24))
    waves, found = ss.aerodynamic_waves(disk, flow), ss.flutter_map(disk, flow, harmonics=5)
    figure = Figure(figsize=(13.0, 4.2), layout="constrained")
    left, middle, right = figure.subplots(1, 3)
    sectors = np.arange(disk.sectors)
    for share, colour in ((0.0, "0.7"), (1.0 / 12.0, "#31688e")):
        height = np.cos(2.0 * np.pi * (share + 2.0 * sectors / disk.sectors))
        left.plot(sectors, height, "o-", color=colour, ms=3.5, label=f"t = {share:.2g} T")
    left.annotate(
        "", (7.0, 1.15), (11.0, 1.15), arrowprops={"arrowstyle": "->", "color": "crimson"}
    )
    left.set(xlabel="sector", ylabel="displacement", title="nodal diameter +2", ylim=(-1.1, 1.35))
    left.legend(frameon=False, fontsize="small", loc="upper right", ncols=2)
    waves.plot(ax=middle)
    found.plot("tip", ax=right)
    return save(figure, folder / "flutter-waves.png")


def wedge_dampers(folder: Path = ASSETS) -> Path:
    """Draw ready dampers, and the normal forces that statics allow a wedge."""
    face = {"friction": 0.3, "tangential_stiffness": 3e5, "normal_stiffness": 3e5, "load": 240.0}
    split = ss.SplitDamper(angle=30.0, mass=0.06, **face)
    wedge = ss.WedgeDamper(angle=40.0, mass=0.1, **face)
    figure = Figure(figsize=(11.0, 3.9), layout="constrained")
    first, second, third = figure.subplots(1, 3)
    wedge.plot(ax=first)
    split.plot(ax=second)
    a, frictions = np.deg2rad(40.0), np.linspace(0.0, 1.6, 161)
    least = 120.0 / (np.cos(a) + frictions * np.sin(a))
    limit = 1.0 / np.tan(a)
    free = frictions < 0.97 * limit
    greatest = 120.0 / (np.cos(a) - frictions[free] * np.sin(a))
    third.fill_between(frictions[free], least[free], greatest, color="0.88", label="allowed")
    third.plot(frictions, least, label="about to move in")
    third.plot(frictions[free], greatest, label="about to come out")
    third.axvline(limit, color="0.45", ls=":", label="µ = cot a: locks")
    third.set(xlabel="friction", ylabel="normal force [N]", ylim=(0.0, 1200.0))
    third.legend(frameon=False, fontsize="small")
    return save(figure, folder / "wedge-dampers.png")
