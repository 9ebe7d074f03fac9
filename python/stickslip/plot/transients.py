"""Transients: histories, phase plane, Poincare section and spectrum."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from stickslip.checks import whole_number
from stickslip.model import PointRef
from stickslip.plot.arguments import dofs_of, of_kind
from stickslip.plot.documentation import figure
from stickslip.plot.style import (
    LengthUnit,
    OmegaUnit,
    colours,
    framed,
    length_scale,
    mark,
    omega_scale,
    slip_limits,
)
from stickslip.results.transient import Transient

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["contact_history", "history", "phase", "poincare", "spectrum"]

# More lines than this would hide what they are to explain.
_MARKED = 30


@figure
def history(
    result: Transient,
    dof: str | Sequence[str],
    *,
    ax: Axes | None = None,
    last: int | None = None,
    length_unit: LengthUnit = "m",
) -> Axes:
    """Draw displacements over time."""
    dofs, length = dofs_of(dof), length_scale(length_unit)
    part = _last(result, last)
    waves = [result.displacement(one)[part] for one in dofs]
    with framed(ax) as ax:
        for one, wave, colour in zip(dofs, waves, colours(len(dofs)), strict=True):
            ax.plot(result.time[part], length.factor * wave, color=colour, lw=1.0, label=one)
        _over_time(ax, result, part)
        ax.set_ylabel(f"displacement{f' of {dofs[0]}' if len(dofs) == 1 else ''} [{length.label}]")
    return ax


@figure
def contact_history(
    result: Transient, contact: PointRef, *, ax: Axes | None = None, last: int | None = None
) -> Axes:
    """Draw contact forces over time, between the forces at which they slip.

    Parameters
    ----------
    contact : int, str or (int or str, int)
        The contact, or one of its points.
    """
    part = _last(result, last)
    forces = result.contact_force(contact).reshape(result.time.size, -1)[part]
    number, only = result.locate(contact)
    name, single = result.model.contact_names[number], forces.shape[1] == 1
    with framed(ax) as ax:
        for point, colour in enumerate(colours(forces.shape[1])):
            label = name if single and only is None else f"{name}[{point + (only or 0)}]"
            ax.plot(result.time[part], forces[:, point], color=colour, lw=1.0, label=label)
        limit = result.model.contacts[number].limits[only or 0]
        if single and np.isfinite(limit):
            slip_limits(ax, limit)
        _over_time(ax, result, part)
        ax.set_ylabel(f"contact force of {name} [N]")
    return ax


@figure
def phase(
    result: Transient,
    dof: str,
    *,
    ax: Axes | None = None,
    last: int | None = None,
    length_unit: LengthUnit = "m",
) -> Axes:
    """Draw velocity over displacement, and the states after each of the periods drawn."""
    length, part = length_scale(length_unit), _last(result, last)
    x, v = result.displacement(dof)[part], result.velocity(dof)[part]
    drawn = result.kept_periods if last is None else last
    after = (length.factor * value[-drawn - 1 :] for value in result.poincare(dof))
    with framed(ax) as ax:
        motion = length.factor * x, length.factor * v
        ax.plot(*motion, color=colours(1)[0], lw=0.8, label="motion")
        ax.plot(*after, **mark("o", 4, "black"), label="after each period")
        _phase_axes(ax, dof, length.label)
    return ax


@figure
def poincare(
    result: Transient,
    dof: str,
    *,
    ax: Axes | None = None,
    skip: int = 0,
    length_unit: LengthUnit = "m",
) -> Axes:
    """Draw the Poincare section: velocity over displacement after each period.

    Parameters
    ----------
    dof : str
        Any degree of freedom.
    skip : int, optional
        How many of the first periods to leave out.

    Returns
    -------
    matplotlib.axes.Axes
        The axes. Points are coloured from the first to the last period; the last has a ring.
    """
    result, length = of_kind(Transient, result), length_scale(length_unit)
    first = whole_number(skip, "skip", largest=result.periods)
    x, v = (length.factor * value[first:] for value in result.poincare(dof))
    with framed(ax) as ax:
        periods = first + np.arange(x.size)
        cloud = ax.scatter(x, v, c=periods, cmap="viridis", s=12, lw=0.0)
        ax.plot(x[-1], v[-1], **mark("o", 9, "black", "none"), label="last")
        if x.size > 1:
            ax.figure.colorbar(cloud, ax=ax, label="periods since the start")
        _phase_axes(ax, dof, length.label)
    return ax


@figure
def spectrum(
    result: Transient,
    dof: str,
    *,
    ax: Axes | None = None,
    last: int | None = None,
    segment: int | None = None,
    window: str = "boxcar",
    omega_unit: OmegaUnit = "Hz",
) -> Axes:
    """Draw the power spectral density of a displacement, per Hz over either frequency.

    Parameters
    ----------
    last, segment, window
        As of `Transient.spectrum`.

    Returns
    -------
    matplotlib.axes.Axes
        The axes; thin lines stand at the multiples of the excitation frequency if they are few.
    """
    result, omega = of_kind(Transient, result), omega_scale(omega_unit)
    found = result.spectrum(dof, last=last, segment=segment, window=window)
    with framed(ax) as ax:
        axis = omega.factor * 2.0 * np.pi * found.frequency
        density = np.where(found.density > 0.0, found.density, np.nan)
        top = np.nanmax(density[1:], initial=0.0)
        seen = axis[1:][np.nan_to_num(density[1:]) > 1e-14 * top]
        end = seen[-1] if seen.size else axis[-1]
        fundamental = omega.factor * result.omega
        orders = int(end / fundamental) + 1
        for order in range(1, orders + 1 if orders <= _MARKED else 0):
            ax.axvline(order * fundamental, color="0.88", lw=0.7, zorder=0.5)
        ax.plot(axis, density, color=colours(1)[0], lw=1.1)
        ax.set_xlim(0.0, end + fundamental)
        if top > 0.0:
            ax.set(yscale="log", ylim=(1e-16 * top, 4.0 * top))
        ax.set(xlabel=omega.label, ylabel=f"power spectral density of {dof} [m²/Hz]")
    return ax


def _last(result: Transient, last: int | None) -> slice:
    """Return the instants of the last periods."""
    result = of_kind(Transient, result)
    if last is None:
        return slice(None)
    count = whole_number(last, "last", smallest=1, largest=max(result.kept_periods, 1))
    return slice(-min(count * result.settings.samples + 1, result.time.size), None)


def _over_time(ax: Axes, result: Transient, part: slice) -> None:
    time = result.time[part]
    if time.size > 1:
        ax.set_xlim(time[0], time[-1])
    ax.set_xlabel("time [s]")
    ax.set_title(f"ω = {result.omega:.5g} rad/s, {result.status}", fontsize="medium")


def _phase_axes(ax: Axes, dof: str, unit: str) -> None:
    ax.set(xlabel=f"displacement of {dof} [{unit}]", ylabel=f"velocity of {dof} [{unit}/s]")
