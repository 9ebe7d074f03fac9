"""Figures of the natural frequencies of bladed disks, and of their excitation by the rotor."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np

from stickslip.checks import brief, members, real_number, whole_number
from stickslip.disk import BladedDisk, NodalDiameters
from stickslip.errors import ModelError
from stickslip.plot.style import FREE, STUCK, OmegaUnit, finish, new_axes, omega_scale
from stickslip.results.arrays import Float

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["DiameterOptions", "SafeOptions", "nodal_diameters", "safe"]

_STUCK_COLOUR = "#31688e"
_SLIPPING_COLOUR = "#d8863b"


class DiameterOptions(TypedDict, total=False):
    """Keywords of `nodal_diameters`."""

    ax: Axes | None
    omega_unit: OmegaUnit
    slipping: bool


class SafeOptions(DiameterOptions, total=False):
    """Keywords of `safe`."""

    orders: int | Sequence[int] | None


def nodal_diameters(
    table: NodalDiameters | BladedDisk,
    *,
    ax: Axes | None = None,
    omega_unit: OmegaUnit = "Hz",
    slipping: bool = True,
) -> Axes:
    """Draw the natural frequencies of a disk over its nodal diameters.

    Parameters
    ----------
    table : NodalDiameters or BladedDisk
        What `BladedDisk.nodal_diameters` returned, or the disk.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.
    omega_unit : {"rad/s", "Hz"}, optional
        Unit of the frequency axis.
    slipping : bool, optional
        Draw those with slipping contacts too.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ModelError
        If `table` is neither, or there is no such unit.
    """
    made = ax is None
    drawn, _ = _draw_diameters(table, ax, omega_unit, slipping=slipping)
    finish(drawn, made=made)
    return drawn


def safe(
    table: NodalDiameters | BladedDisk,
    speed: float,
    *,
    orders: int | Sequence[int] | None = None,
    ax: Axes | None = None,
    omega_unit: OmegaUnit = "Hz",
    slipping: bool = True,
) -> Axes:
    """Draw the SAFE diagram of a disk, folded at half the sectors (ZZENF).

    Engine order E excites nodal diameter d = E modulo n, folded to n - d above n/2, with the
    frequency E times the speed: the line of excitation runs to and fro between 0 and n/2. Where it
    meets a natural frequency at an order, the disk is in resonance.

    Parameters
    ----------
    table : NodalDiameters or BladedDisk
        What `BladedDisk.nodal_diameters` returned, or the disk.
    speed : float
        Angular speed of the rotor [rad/s].
    orders : int or sequence of int, optional
        Engine orders to mark, or up to which. Default: the engine order of the disk and the
        harmonics of it that its forces have; the line reaches up to the highest frequency drawn.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.
    omega_unit : {"rad/s", "Hz"}, optional
        Unit of the frequency axis.
    slipping : bool, optional
        Draw the frequencies with slipping contacts too.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ModelError
        If `table` is neither, the speed is not positive, or there is no such unit.
    """
    rate = real_number(speed, "speed")
    if rate <= 0.0:
        raise ModelError(f"speed: {rate:g} is not above zero; give the speed of the rotor in rad/s")
    made = ax is None
    drawn, data = _draw_diameters(table, ax, omega_unit, slipping=slipping)
    disk, omega = data.disk, omega_scale(omega_unit)
    top = 1.05 * max(data.stuck.max(), data.slipping.max() if slipping else 0.0)
    marked = _orders(orders, disk)
    reach = max(int(np.ceil(top / rate)), *marked, 1)
    # The corners of the line lie at whole orders only where n is even.
    line = np.unique(np.append(np.arange(reach + 1.0), np.arange(0.0, reach, disk.sectors / 2)))
    drawn.plot(
        _folded(line, disk.sectors),
        omega.factor * rate * line,
        color="crimson",
        lw=0.9,
        label=f"excitation at {rate:.5g} rad/s",
    )
    chosen = np.array(marked, dtype=np.float64)
    drawn.plot(
        _folded(chosen, disk.sectors),
        omega.factor * rate * chosen,
        ls="",
        marker="D",
        ms=5,
        mfc="white",
        mec="crimson",
        label="engine orders",
    )
    for order, where in zip(marked, _folded(chosen, disk.sectors), strict=True):
        drawn.annotate(
            f"{order}",
            (float(where), omega.factor * rate * order),
            (4.0, 4.0),
            textcoords="offset points",
            color="crimson",
            fontsize="small",
        )
    drawn.set_ylim(0.0, omega.factor * top)
    finish(drawn, made=made)
    return drawn


def _draw_diameters(
    table: NodalDiameters | BladedDisk, ax: Axes | None, omega_unit: OmegaUnit, *, slipping: bool
) -> tuple[Axes, NodalDiameters]:
    from matplotlib.ticker import MaxNLocator

    if isinstance(table, BladedDisk):
        table = table.nodal_diameters()
    if not isinstance(table, NodalDiameters):
        raise ModelError(
            f"table: {brief(table)} is no BladedDisk; give one, or its nodal_diameters()"
        )
    omega, drawn = omega_scale(omega_unit), new_axes(ax)
    looks: dict[str, Any] = {"lw": 0.9, "marker": "o", "ms": 3.5}
    stuck = drawn.plot(
        table.diameters, omega.factor * table.stuck, color=_STUCK_COLOUR, ls=STUCK, **looks
    )
    stuck[0].set_label("stuck" if table.disk.contacts else "natural frequencies")
    if slipping and table.disk.contacts:
        free = drawn.plot(
            table.diameters,
            omega.factor * table.slipping,
            color=_SLIPPING_COLOUR,
            ls=FREE,
            mfc="white",
            **looks,
        )
        free[0].set_label("slipping")
    drawn.xaxis.set_major_locator(MaxNLocator(integer=True))
    drawn.set_xlabel("nodal diameter")
    drawn.set_ylabel(omega.label.replace("angular frequency ω", "natural frequency"))
    drawn.set_xlim(-0.3, float(table.diameters[-1]) + 0.3)
    drawn.set_ylim(bottom=0.0)
    return drawn, table


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
    given = members(orders, "orders", "orders=[1, 2]")
    return [whole_number(order, "orders") for order in given]
