"""Makes the figures and measured tables of the documentation: ``python docs/make_figures.py``.

They are kept with the pages, so that building the pages computes nothing.
"""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy import stats

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


def structural_damper(folder: Path = ASSETS) -> Path:
    """Draw the forces at the four contacts of the beam pair."""
    orbit = ss.exact_response(ss.reference.damped_pair(550.0), [550.0])
    figure = plot.contact_forces(orbit, "structural", 0)[0].figure
    assert isinstance(figure, Figure)
    return _save(figure, folder / "structural-damper.png")


def structural_curve(folder: Path = ASSETS) -> Path:
    """Draw the peak of the beam pair against a factor on all slip limits of its damper."""
    model = ss.reference.damped_pair(60.0)
    factors = np.unique(
        [*np.geomspace(0.02, 0.2, 12), *np.geomspace(0.2, 0.3, 15), *np.geomspace(0.3, 10, 20)]
    )
    curve = ss.damper_curve(model, slip_force=factors, common="factor", dof="1.tip")
    figure = Figure(figsize=(7.5, 4.4), layout="constrained")
    plot.damper(curve, length_unit="um", ax=figure.subplots())
    return _save(figure, folder / "structural-curve.png")


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
    return _save(figure, folder / "harmonics-errors.png"), table


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


def exact_orbits(folder: Path = ASSETS) -> Path:
    """Draw the loop, the events and the multipliers of exact orbits at 25 N."""
    exact = ss.exact_response(ss.reference.snecma_beam(25.0), np.linspace(120.0, 260.0, 281))
    index = exact.index(200.0)
    figure = Figure(figsize=(13.0, 4.0), layout="constrained")
    loop, strip, plane = figure.subplots(1, 3, width_ratios=(1.0, 1.2, 1.1))
    plot.hysteresis(exact, "jenkins", index, length_unit="um", ax=loop)
    loop.set_title("damper at ω = 200 rad/s", fontsize="medium")
    plot.events(exact, index, ax=strip)
    plot.multipliers(exact, ax=plane)
    return _save(figure, folder / "exact-orbits.png")


def transient(folder: Path = ASSETS) -> Path:
    """Draw a run from rest: history, phase plane and spectrum."""
    run = ss.transient(ss.reference.snecma_beam(25.0), 200.0, periods=40, samples=256)
    figure = Figure(figsize=(13.0, 4.0), layout="constrained")
    history, phase, spectrum = figure.subplots(1, 3, width_ratios=(1.2, 1.0, 1.1))
    plot.history(run, "tip", length_unit="mm", ax=history)
    plot.phase(run, "damper", last=5, ax=phase)
    plot.spectrum(run, "damper", last=10, ax=spectrum)
    return _save(figure, folder / "transient.png")


def starts(folder: Path = ASSETS) -> Path:
    """Draw what the amplitudes of two modes at the start lead to."""
    model = ss.reference.snecma_beam()
    own = model.structure
    bare = ss.Model(ss.Structure(own.mass, own.stiffness, None, own.dofs), model.contacts)
    driven = ss.destabilised(bare, ss.Rayleigh(mass=-7.49, stiffness=-2.6e-5), 0.15)
    axes = {2: np.linspace(0.0, 4e-4, 31), 0: np.linspace(0.0, 2.4e-3, 31)}
    figure = Figure(figsize=(7.5, 4.6), layout="constrained")
    ax = figure.add_subplot()
    ss.basin_map(driven, axes, periods=1000).plot(length_unit="mm", ax=ax)
    return _save(figure, folder / "starts.png")


def certificate(folder: Path = ASSETS) -> Path:
    """Draw a coarse curve with its error band and exact orbits."""
    curve = ss.forced_response(ss.reference.snecma_beam(25.0), np.linspace(140, 230, 181), 3)
    figure = Figure(figsize=(7.5, 4.4), layout="constrained")
    ax = figure.add_subplot()
    plot.curves(
        ss.certify(curve, range(0, 181, 8)), "tip", length_unit="mm", log=False, peaks=False, ax=ax
    )
    ax.legend(loc="lower right", ncols=3, frameon=False, fontsize="small")
    return _save(figure, folder / "certificate.png")


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
    return _save(figure, folder / "bladed-disks.png")


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
    return _save(figure, folder / "ring-histories.png")


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
    return _save(figure, folder / "mistuning.png")


def flutter(folder: Path = ASSETS) -> Path:
    """Draw limit cycles of the beam under negative damping, and multipliers of its third mode."""
    beam, negative = ss.reference.flutter_beam()
    branches = [ss.limit_cycles(beam, negative, mode=mode, method="exact") for mode in range(3)]
    figure = Figure(figsize=(11.0, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.4, 1.0))
    plot.limit_cycles(branches, "tip", length_unit="mm", ax=left)
    left.legend(frameon=False, fontsize="small")
    plot.cycle_multipliers(branches[2], ax=right)
    return _save(figure, folder / "flutter.png")


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
    left.legend(frameon=False, fontsize="small", loc="lower right")
    waves.plot(ax=middle)
    found.plot("tip", length_unit="um", ax=right)
    return _save(figure, folder / "flutter-waves.png")


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
    return _save(figure, folder / "wedge-dampers.png")


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
    return _save(figure, folder / "bounds.png")


def campbell(folder: Path = ASSETS) -> Path:
    """Draw natural frequencies of a blisk that stiffens as it turns, and a SAFE diagram of it."""
    blisk = ss.reference.laxalde_blisk()
    turning = ss.spinning(blisk.structure, 2.0 * blisk.structure.mass)

    def spun(speed: float) -> ss.BladedDisk:
        return ss.BladedDisk(
            turning(speed), blisk.sectors, blisk.couplings, forces=blisk.forces, engine_order=4
        )

    diagram = ss.campbell(spun, speed=np.linspace(100.0, 420.0, 33), orders=[2, 4, 6])
    figure = Figure(figsize=(7.5, 4.4), layout="constrained")
    plot.campbell(diagram, omega_unit="Hz", ax=figure.subplots())
    return _save(figure, folder / "campbell.png")


def sweep(folder: Path = ASSETS) -> Path:
    """Draw the response curves of the beam over the slip force."""
    swept = ss.sweep(
        ss.reference.snecma_beam(),
        lambda model: ss.forced_response(model, (120.0, 280.0), observe="tip"),
        slip_force=["30 N", "100 N", "246 N", "362 N", "1 kN", "3 kN"],
    )
    figure = Figure(figsize=(8.0, 4.4), layout="constrained")
    swept.plot("tip", ax=figure.subplots())
    return _save(figure, folder / "sweep.png")


def nonlinear_modes(folder: Path = ASSETS) -> Path:
    """Draw frequency, shapes and damping of a nonlinear mode."""
    structure = ss.Structure(
        np.diag([1.0, 0.5]), [[3e4, -1e4], [-1e4, 2.5e4]], ss.ModalDamping(0.003), ["x", "y"]
    )
    model = ss.Model(structure, contacts=[ss.Jenkins("x", stiffness=4e3, slip_force=1.0)])
    modes = ss.nonlinear_modes(model, mode=0, amplitude=(3e-5, 1e-2))
    figure = Figure(figsize=(11.0, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    plot.backbone(modes, damping=False, ax=left)
    plot.mode_damping(modes, ax=right)
    return _save(figure, folder / "nonlinear-modes.png")


def several_solutions(folder: Path = ASSETS) -> Path:
    """Draw curves that fold: with a spring that stiffens, and with a stop."""
    mass = ss.Structure(mass=[[1.0]], stiffness=[[1.0]], damping=[[0.1]], dofs=["x"])
    spring, stop = ss.Cubic("x", stiffness=1.0), ss.Stop("x", stiffness=20.0, gap=1.0)
    figure = Figure(figsize=(11.0, 4.2), layout="constrained")
    cases = ((spring, 1.0, (0.3, 4.0)), (stop, 0.3, (0.5, 2.5)))
    for ax, (law, force, omega) in zip(figure.subplots(1, 2), cases, strict=True):
        model = ss.Model(mass, contacts=[law], forces=[ss.Force("x", amplitude=force)])
        frf = ss.forced_response(model, omega)
        plot.curves(
            frf,
            "x",
            length_unit="m",
            log=False,
            stuck=False,
            free=False,
            peaks=False,
            error_band=False,
            ax=ax,
        )
        ax.set_title(type(law).__name__, fontsize="medium")
    return _save(figure, folder / "several-solutions.png")


def uncertainty(folder: Path = ASSETS) -> Path:
    """Draw the distribution of a peak over uncertain parameters, and their shares in it."""
    left = ss.Structure(10 * np.eye(2), [[1e6, -9e5], [-9e5, 1e6]], 100 * np.eye(2), ["x", "y"])
    right = ss.Structure(10 * np.eye(2), [[4e5, -3e5], [-3e5, 4e5]], 100 * np.eye(2), ["x", "y"])
    face = {"friction": 0.2, "tangential_stiffness": 3e5, "normal_stiffness": 3e5, "load": 240.0}
    wedge = ss.WedgeDamper(angle=60.0, mass=0.1, **face)
    forces = [ss.Force("left.x", 150.0), ss.Force("right.x", 150.0, phase=np.pi)]
    study = ss.uncertainty(
        wedge.between(left, right, left_dofs=["x", "y"], right_dofs=["x", "y"], forces=forces),
        {
            "friction": stats.uniform(0.15, 0.25),
            "tangential_stiffness": stats.norm(3e5, 2e4),
            "normal_stiffness": stats.lognorm(0.1, scale=3e5),
            "load": stats.uniform(0.8, 0.4),
        },
        ss.HighestPeak("left.x", omega=(80, 240)),
        samples=128,
        harmonics=3,
    )
    figure = Figure(figsize=(12.0, 4.2), layout="constrained")
    first, second = figure.subplots(1, 2)
    plot.uncertainty_distribution(study, "amplitude", ax=first)
    plot.sobol_indices(study, "amplitude", ax=second)
    return _save(figure, folder / "uncertainty.png")


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
    print(campbell())
    print(sweep())
    print(nonlinear_modes())
    print(several_solutions())
    print(uncertainty())
    print(snecma_beam())
    print(structural_damper())
    print(structural_curve())
    print(error_estimates())
    print(*harmonics_errors())
    print(exact_orbits())
    print(transient())
    print(starts())
    print(certificate())
    print(bladed_disks())
    print(ring_histories())
    print(amplification())
    print(mistuning())
    print(flutter())
    print(flutter_waves())
    print(wedge_dampers())
    print(bounds())
