"""Bladed disks over their nodal diameters: natural frequencies, excitation, aerodynamic damping."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Unpack

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.ticker import MaxNLocator

from stickslip.checks import brief, members, real_array, whole_number
from stickslip.disk import BladedDisk, NodalDiameters
from stickslip.disk.waves import AerodynamicWaves
from stickslip.errors import ModelError
from stickslip.plot import style
from stickslip.plot.figure import figure
from stickslip.plot.options import DiameterOptions, Drawing, Frame, LimitOptions, SafeOptions
from stickslip.plot.style import Looks, Scale
from stickslip.results.fields import Float
from stickslip.results.flutter_map import FlutterMap
from stickslip.results.stability import STATES
from stickslip.units import physical_number

_MARGIN = 1.05
_NEAR = 1.25
"""Share above the highest marked excitation up to which modes are near it."""


@figure
def nodal_diameters(
    ax: Axes, /, table: NodalDiameters | BladedDisk, **options: Unpack[DiameterOptions]
) -> None:
    """Draw the natural frequencies of a disk over its nodal diameters."""
    omega = style.OMEGA[options["omega_unit"]]
    _draw_diameters(ax, _table_of(table), omega, slipping=options["slipping"])


@figure
def safe(
    ax: Axes, /, table: NodalDiameters | BladedDisk, speed: float, **options: Unpack[SafeOptions]
) -> None:
    """Draw the SAFE diagram of a disk, folded at half the sectors (ZZENF).

    Engine order E excites nodal diameter d = E modulo n, folded to n - d above n/2, with the
    frequency E times the speed: the line of excitation runs to and fro between 0 and n/2. Where it
    meets a natural frequency at an order, the disk is in resonance.

    Parameters
    ----------
    speed : float
        Angular speed of the rotor [rad/s].
    """
    rate = physical_number(speed, "rad/s", "speed")
    if rate <= 0.0:
        raise ModelError(f"speed: {rate:g} is not above zero; give the speed of the rotor in rad/s")
    table, omega = _table_of(table), style.OMEGA[options["omega_unit"]]
    n, factor = table.disk.sectors, omega.factor
    marked = _orders(options["orders"], table.disk)
    top = _top(table, rate * max(*marked, 1), options["modes"])
    _draw_diameters(ax, table, omega, slipping=options["slipping"], top=top)
    reach = max(int(np.ceil(top / rate)), *marked, 1)
    # The corners of the line lie at whole orders only where n is even.
    line = np.unique(np.append(np.arange(reach + 1.0), np.arange(0.0, reach, n / 2)))
    label = f"excitation at {rate * style.OMEGA['rpm'].factor:.5g} rpm"
    ax.plot(_folded(line, n), factor * rate * line, color="crimson", lw=0.9, label=label)
    chosen = np.array(marked, dtype=np.float64)
    x, y = _folded(chosen, n), factor * rate * chosen
    ax.plot(x, y, **style.mark("D", 5, "crimson"), label="engine orders")
    looks: Looks = {"textcoords": "offset points", "color": "crimson", "fontsize": "small"}
    for order, place in zip(marked, zip(x.tolist(), y.tolist(), strict=True), strict=True):
        ax.annotate(f"{order}", place, (4.0, 4.0), **looks)
    ax.set_ylim(0.0, factor * top)


@figure
def aerodynamic(ax: Axes, /, waves: AerodynamicWaves, **options: Unpack[Drawing]) -> None:
    """Draw the damping ratio of the travelling waves over their nodal diameter: the S-curve.

    Parameters
    ----------
    waves : AerodynamicWaves
        What `aerodynamic_waves` returned.

    Returns
    -------
    matplotlib.axes.Axes
        The axes. Waves above n/2 are drawn at d - n: they run backwards.
    """
    n = waves.disk.sectors
    signed = np.where(waves.diameters > n / 2, waves.diameters - n, waves.diameters)
    order = np.argsort(signed)
    x = signed[order]
    looks: Looks = {"ms": 3.5, "lw": 1.0}
    ax.axhline(0.0, color=style.GREY, lw=0.8)
    ax.plot(x, 100.0 * waves.aerodynamic_ratio[order], marker="o", label="flow", **looks)
    if not np.array_equal(waves.ratio, waves.aerodynamic_ratio):
        ax.plot(x, 100.0 * waves.ratio[order], marker="s", label="flow and disk", **looks)
    least = int(waves.ratio.argmin())
    looks = style.mark("o", 8, "crimson", "none") | {"label": f"least stable: {signed[least]}"}
    ax.plot(signed[least], 100.0 * waves.ratio[least], **looks)
    _over_diameters(ax, "damping ratio [%]")


@figure
def flutter_map(ax: Axes, /, result: FlutterMap, dof: str, **options: Unpack[Frame]) -> None:
    """Draw the amplitudes of limit cycles over the nodal diameter of their wave.

    Stable ones, on a line, are full circles, unstable ones hollow, those whose stability is not
    decided crosses. Triangles at the top are waves that grow from rest without bound.
    """
    length = style.LENGTH[options["length_unit"]]
    arrays, column = result.arrays, result._column(dof)
    x = result.diameters[arrays.cycle_wave]
    y = length.factor * arrays.cycle_displacement[:, column]
    states = np.array([one.stability for one in result.cycles()], dtype=np.str_)
    order = np.argsort(result.diameters)
    line = length.factor * result.amplitude(dof)[order]
    ax.plot(result.diameters[order], line, color=style.BLUE, lw=1.0)
    for state in STATES:
        mask = states == state
        if mask.any():
            ax.plot(x[mask], y[mask], **style.marks(state, style.BLUE), label=state)
    growing = [d for d in result.diameters.tolist() if result.fate(d) == "grows"]
    if growing:
        looks = style.mark("^", 6, style.ORANGE, style.ORANGE)
        frame = ax.get_xaxis_transform()
        ax.plot(growing, [0.97] * len(growing), transform=frame, **looks, label="grows")
    if x.size:
        ax.set_yscale("log")
    else:
        ax.set_yticks([])
    first, last = result.diameters[order[[0, -1]]]
    ax.set_xlim(first - 0.5, last + 0.5)
    if not (x.size or growing):
        ax.text(0.5, 0.5, "all waves decay", transform=ax.transAxes, ha="center", va="center")
    _over_diameters(ax, f"amplitude of {style.named(dof)} [{length.label}]")


@figure
def aerodynamic_limits(
    ax: Axes, /, result: FlutterMap, dof: str, **options: Unpack[LimitOptions]
) -> None:
    """Draw amplitudes of stable limit cycles over nodal diameter and aerodynamic damping ratio.

    The line is the largest negative damping that friction holds; what is grey below it has no
    stable limit cycle. Circles are the waves in the flow as it was given.
    """
    length = style.LENGTH[options["length_unit"]]
    order = np.argsort(result.diameters)
    x, held = result.diameters[order], result.held_ratio[order]
    if not (np.isfinite(held).any() and np.nanmin(held) < 0.0):
        raise ModelError("result: friction holds no negative damping, so that nothing is drawn")
    given = options["aerodynamic_ratio"]
    lowest = 1.1 * float(np.nanmin(held))
    ratios = np.linspace(lowest, 0.0, 120)
    if given is not None:
        ratios = np.sort(real_array(given, "aerodynamic_ratio", "a list").ravel())
    if not ratios.size:
        raise ModelError("aerodynamic_ratio: empty; give at least one, or leave it out")
    size = result.limit_amplitude(dof, ratios)[order, :, 0]
    if options["length_unit"] == "auto":
        length = style.prefix_of(float(np.nanmax(size, initial=0.0)), "m")
    size = length.factor * size
    ax.set_facecolor("0.93")
    colour = LogNorm() if np.isfinite(size).any() else None
    shade = ax.pcolormesh(
        x, 100.0 * ratios, size.T, shading="nearest", cmap="viridis", norm=colour, rasterized=True
    )
    bar = ax.figure.colorbar(
        shade, ax=ax, label=f"amplitude of {style.named(dof)} [{length.label}]"
    )
    if colour is not None:
        style.number_bar(bar.ax)
    ax.plot(x, 100.0 * held, color="crimson", lw=1.2, label="friction holds above")
    flow = 100.0 * result.arrays.rest_aerodynamic_ratio[order]
    shown = flow >= 100.0 * ratios[0]
    ax.plot(x[shown], flow[shown], **style.mark("o", 4, "k"), label="flow")
    _over_diameters(ax, "aerodynamic damping ratio [%]")


def _table_of(table: object) -> NodalDiameters:
    if isinstance(table, BladedDisk):
        return table.nodal_diameters()
    if not isinstance(table, NodalDiameters):
        raise ModelError(
            f"table: {brief(table)} is no BladedDisk; give one, or its nodal_diameters()"
        )
    return table


def _top(table: NodalDiameters, excited: float, modes: int | None) -> float:
    """Return the highest frequency to draw: of some modes, or of those near the excitation."""
    if modes is not None:
        count = whole_number(modes, "modes", smallest=1, largest=table.stuck.shape[1])
        return _MARGIN * max(float(table.stuck[:, :count].max()), excited)
    # The first family that lies wholly above shows how far away the next resonance is.
    above = table.stuck.min(axis=0) > _NEAR * excited
    first = int(np.argmax(above)) if above.any() else table.stuck.shape[1] - 1
    return _MARGIN * max(float(table.stuck[:, : max(first, 1)].max()), excited)


def _draw_diameters(
    ax: Axes, table: NodalDiameters, omega: Scale, *, slipping: bool, top: float = np.inf
) -> None:
    x = table.diameters
    seen = table.stuck.min(axis=0) <= top
    table = replace(table, stuck=table.stuck[:, seen], slipping=table.slipping[:, seen])
    looks: Looks = {"lw": 0.9, "marker": "o", "ms": 3.5}
    label = "stuck" if table.disk.contacts else "natural frequencies"
    ax.plot(x, omega.factor * table.stuck, color=style.BLUE, ls=style.STUCK, **looks)[0].set_label(
        label
    )
    if slipping and table.disk.contacts:
        looks |= {"color": style.ORANGE, "ls": style.FREE, "mfc": "white"}
        ax.plot(x, omega.factor * table.slipping, **looks)[0].set_label("slipping")
    _over_diameters(ax, omega.label.replace("angular frequency ω", "natural frequency"))
    ax.set_xlim(-0.3, float(x[-1]) + 0.3)
    ax.set_ylim(bottom=0.0)


def _over_diameters(ax: Axes, label: str) -> None:
    ax.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    ax.set(xlabel="nodal diameter", ylabel=label)


def _folded(orders: Float, sectors: int) -> Float:
    """Nodal diameters that engine orders excite, waves of both senses alike."""
    rest = np.mod(orders, sectors)
    return np.asarray(np.minimum(rest, sectors - rest), dtype=np.float64)


def _orders(orders: int | Sequence[int] | None, disk: BladedDisk) -> list[int]:
    if orders is None:
        harmonics = sorted({force.harmonic for force in disk.forces if force.harmonic} | {1})
        return [disk.order_of(harmonic) for harmonic in harmonics]
    if isinstance(orders, int):
        return list(range(1, whole_number(orders, "orders", smallest=1) + 1))
    return [whole_number(order, "orders") for order in members(orders, "orders", "orders=[1, 2]")]
