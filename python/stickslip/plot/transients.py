"""Transients: histories, phase plane, Poincare section and spectrum."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Unpack

import numpy as np
from matplotlib.axes import Axes

from stickslip.checks import whole_number
from stickslip.model import PointRef
from stickslip.plot import style
from stickslip.plot.arguments import dofs_of, frequency
from stickslip.plot.figure import figure
from stickslip.plot.options import (
    ContactHistoryOptions,
    HistoryOptions,
    PhaseOptions,
    PoincareOptions,
    SpectrumOptions,
)
from stickslip.plot.style import OmegaUnit
from stickslip.results.transient import Transient

# More lines than this would hide what they are to explain.
_MARKED = 30


@figure
def history(
    ax: Axes, /, result: Transient, dof: str | Sequence[str], **options: Unpack[HistoryOptions]
) -> None:
    """Draw displacements over time."""
    dofs, length = dofs_of(dof), style.LENGTH[options["length_unit"]]
    part = _last(result, options["last"])
    waves = [result.displacement(one)[part] for one in dofs]
    for one, wave, colour in zip(dofs, waves, style.colours(len(dofs)), strict=True):
        ax.plot(
            result.time[part], length.factor * wave, color=colour, lw=1.0, label=style.named(one)
        )
    _over_time(ax, result, part, options["omega_unit"])
    ax.set_ylabel(
        f"displacement{f' of {style.named(dofs[0])}' if len(dofs) == 1 else ''} [{length.label}]"
    )


@figure
def contact_history(
    ax: Axes, /, result: Transient, contact: PointRef, **options: Unpack[ContactHistoryOptions]
) -> None:
    """Draw contact forces over time, between the forces at which they slip."""
    part = _last(result, options["last"])
    forces = result.contact_force(contact).reshape(result.time.size, -1)[part]
    number, only = result.locate(contact)
    name, single = style.named(result.model.contact_names[number]), forces.shape[1] == 1
    for point, colour in enumerate(style.colours(forces.shape[1])):
        label = name if single and only is None else f"{name}[{point + (only or 0)}]"
        ax.plot(result.time[part], forces[:, point], color=colour, lw=1.0, label=label)
    limit = result.model.contacts[number].limits[only or 0]
    if single and np.isfinite(limit):
        style.slip_limits(ax, limit)
    _over_time(ax, result, part, options["omega_unit"])
    ax.set_ylabel(f"contact force of {name} [N]")


@figure
def phase(ax: Axes, /, result: Transient, dof: str, **options: Unpack[PhaseOptions]) -> None:
    """Draw velocity over displacement, and the states after each of the periods drawn."""
    length, part = style.LENGTH[options["length_unit"]], _last(result, options["last"])
    x, v = result.displacement(dof)[part], result.velocity(dof)[part]
    drawn = result.kept_periods if options["last"] is None else options["last"]
    after = (length.factor * value[-drawn - 1 :] for value in result.poincare(dof))
    motion = length.factor * x, length.factor * v
    ax.plot(*motion, color=style.colours(1)[0], lw=0.8, label="motion")
    ax.plot(*after, **style.mark("o", 4, "black"), label="after each period")
    _phase_axes(ax, dof, length.label)


@figure
def poincare(ax: Axes, /, result: Transient, dof: str, **options: Unpack[PoincareOptions]) -> None:
    """Draw the Poincare section: velocity over displacement after each period.

    Parameters
    ----------
    dof : str
        Any degree of freedom.

    Returns
    -------
    matplotlib.axes.Axes
        The axes. Points are coloured from the first to the last period; the last has a ring.
    """
    length = style.LENGTH[options["length_unit"]]
    first = whole_number(options["skip"], "skip", largest=result.periods)
    x, v = (length.factor * value[first:] for value in result.poincare(dof))
    periods = first + np.arange(x.size)
    cloud = ax.scatter(x, v, c=periods, cmap="viridis", s=12, lw=0.0)
    ax.plot(x[-1], v[-1], **style.mark("o", 9, "black", "none"), label="last")
    if x.size > 1:
        ax.figure.colorbar(cloud, ax=ax, label="periods since the start")
    _phase_axes(ax, dof, length.label)


@figure
def spectrum(ax: Axes, /, result: Transient, dof: str, **options: Unpack[SpectrumOptions]) -> None:
    """Draw the power spectral density of a displacement, per Hz over either frequency.

    Returns
    -------
    matplotlib.axes.Axes
        The axes; thin lines stand at the multiples of the excitation frequency if they are few.
    """
    omega = style.omega_scale(options["omega_unit"], result)
    found = result.spectrum(
        dof, last=options["last"], segment=options["segment"], window=options["window"]
    )
    axis = omega.factor * 2.0 * np.pi * found.frequency
    density = np.where(found.density > 0.0, found.density, np.nan)
    top = np.nanmax(density[1:], initial=0.0)
    seen = axis[1:][np.nan_to_num(density[1:]) > 1e-14 * top]
    end = seen[-1] if seen.size else axis[-1]
    fundamental = omega.factor * result.omega
    orders = int(end / fundamental) + 1
    for order in range(1, orders + 1 if orders <= _MARKED else 0):
        ax.axvline(order * fundamental, color="0.88", lw=0.7, zorder=0.5)
    ax.plot(axis, density, color=style.colours(1)[0], lw=1.1)
    ax.set_xlim(0.0, end + fundamental)
    if top > 0.0:
        ax.set(yscale="log", ylim=(1e-16 * top, 4.0 * top))
    ax.set(xlabel=omega.label, ylabel=f"power spectral density of {style.named(dof)} [m²/Hz]")


def _last(result: Transient, last: int | None) -> slice:
    """Return the instants of the last periods."""
    if last is None:
        return slice(None)
    count = whole_number(last, "last", smallest=1, largest=max(result.kept_periods, 1))
    return slice(-min(count * result.settings.samples + 1, result.time.size), None)


def _over_time(ax: Axes, result: Transient, part: slice, unit: OmegaUnit) -> None:
    time = result.time[part]
    if time.size > 1:
        ax.set_xlim(time[0], time[-1])
    ax.set_xlabel("time [s]")
    ax.set_title(f"{frequency(result, result.omega, unit)}, {result.status}", fontsize="medium")


def _phase_axes(ax: Axes, dof: str, unit: str) -> None:
    ax.set(
        xlabel=f"displacement of {style.named(dof)} [{unit}]",
        ylabel=f"velocity of {style.named(dof)} [{unit}/s]",
    )
