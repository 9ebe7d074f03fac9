"""Makes the figures and measured tables of the documentation: ``python docs/make_figures.py``.

They are kept with the pages, so that building the pages computes nothing.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from disk_figures import (
    amplification,
    bladed_disks,
    flutter_waves,
    mistuning,
    ring_histories,
    wedge_dampers,
)
from error_figures import bounds, certificate, error_estimates, harmonics_errors
from matplotlib.figure import Figure
from saved import ASSETS, save
from scipy import stats

import stickslip as ss
from stickslip import plot


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
    return save(figure, folder / "snecma-beam.png")


def structural_damper(folder: Path = ASSETS) -> Path:
    """Draw the forces at the four contacts of the beam pair."""
    orbit = ss.exact_response(ss.reference.damped_pair(550.0), [550.0])
    figure = plot.contact_forces(orbit, "structural", 0)[0].figure
    assert isinstance(figure, Figure)
    return save(figure, folder / "structural-damper.png")


def structural_curve(folder: Path = ASSETS) -> Path:
    """Draw the peak of the beam pair against a factor on all slip limits of its damper."""
    model = ss.reference.damped_pair(60.0)
    factors = np.unique(
        [*np.geomspace(0.02, 0.2, 12), *np.geomspace(0.2, 0.3, 15), *np.geomspace(0.3, 10, 20)]
    )
    curve = ss.damper_curve(model, slip_force=factors, common="factor", dof="1.tip")
    figure = Figure(figsize=(7.5, 4.4), layout="constrained")
    plot.damper(curve, ax=figure.subplots())
    return save(figure, folder / "structural-curve.png")


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
    return save(figure, folder / "exact-orbits.png")


def transient(folder: Path = ASSETS) -> Path:
    """Draw a run from rest: history, phase plane and spectrum."""
    run = ss.transient(ss.reference.snecma_beam(25.0), 200.0, periods=40, samples=256)
    figure = Figure(figsize=(13.0, 4.0), layout="constrained")
    history, phase, spectrum = figure.subplots(1, 3, width_ratios=(1.2, 1.0, 1.1))
    plot.history(run, "tip", length_unit="mm", ax=history)
    plot.phase(run, "damper", last=5, ax=phase)
    plot.spectrum(run, "damper", last=10, ax=spectrum)
    return save(figure, folder / "transient.png")


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
    return save(figure, folder / "starts.png")


def flutter(folder: Path = ASSETS) -> Path:
    """Draw limit cycles of the beam under negative damping, and multipliers of its third mode."""
    beam, negative = ss.reference.flutter_beam()
    branches = [ss.limit_cycles(beam, negative, mode=mode, method="exact") for mode in range(3)]
    figure = Figure(figsize=(11.0, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.4, 1.0))
    plot.limit_cycles(branches, "tip", length_unit="mm", ax=left)
    left.legend(frameon=False, fontsize="small")
    plot.cycle_multipliers(branches[2], ax=right)
    return save(figure, folder / "flutter.png")


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
    return save(figure, folder / "campbell.png")


def sweep(folder: Path = ASSETS) -> Path:
    """Draw the response curves of the beam over the slip force."""
    swept = ss.sweep(
        ss.reference.snecma_beam(),
        lambda model: ss.forced_response(model, (120.0, 280.0), observe="tip"),
        slip_force=["30 N", "100 N", "246 N", "362 N", "1 kN", "3 kN"],
    )
    figure = Figure(figsize=(8.0, 4.4), layout="constrained")
    swept.plot("tip", ax=figure.subplots())
    return save(figure, folder / "sweep.png")


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
    return save(figure, folder / "nonlinear-modes.png")


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
    return save(figure, folder / "several-solutions.png")


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
    return save(figure, folder / "uncertainty.png")


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
