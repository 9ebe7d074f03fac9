"""Figures of transients: histories, phase plane, Poincare section and spectrum."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

import numpy as np

from stickslip.checks import brief, whole_number
from stickslip.errors import ModelError
from stickslip.model import PointRef
from stickslip.plot.arguments import dofs_of
from stickslip.plot.charts import Frame
from stickslip.plot.style import (
    GREY,
    STUCK,
    LengthUnit,
    OmegaUnit,
    colours,
    finish,
    length_scale,
    new_axes,
    omega_scale,
)
from stickslip.results.transient import Transient

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes

__all__ = [
    "HistoryOptions",
    "PoincareOptions",
    "SpectrumOptions",
    "contact_history",
    "history",
    "phase",
    "poincare",
    "spectrum",
]

# More lines than this would hide what they are to explain.
_MARKED = 30


class HistoryOptions(Frame, total=False):
    """Keywords of `history` and `phase`."""

    last: int | None


class PoincareOptions(Frame, total=False):
    """Keywords of `poincare`."""

    skip: int


class SpectrumOptions(TypedDict, total=False):
    """Keywords of `spectrum`."""

    ax: Axes | None
    last: int | None
    segment: int | None
    window: str
    omega_unit: OmegaUnit


def history(
    result: Transient,
    dof: str | Sequence[str],
    *,
    ax: Axes | None = None,
    last: int | None = None,
    length_unit: LengthUnit = "m",
) -> Axes:
    """Draw displacements over time.

    Parameters
    ----------
    result : Transient
        The motion.
    dof : str or sequence of str
        Observed degrees of freedom.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.
    last : int, optional
        How many of the last periods to draw. Default: all that are kept.
    length_unit : {"m", "mm", "um"}, optional
        Unit of the displacement.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such degree of freedom or unit, or fewer periods are kept.
    """
    dofs = dofs_of(dof)
    result, length = _transient_of(result), length_scale(length_unit)
    part = _last(result, last)
    waves = [result.displacement(one)[part] for one in dofs]
    made, ax = ax is None, new_axes(ax)
    for one, wave, colour in zip(dofs, waves, colours(len(dofs)), strict=True):
        ax.plot(result.time[part], length.factor * wave, color=colour, lw=1.0, label=one)
    _over_time(ax, result, part)
    ax.set_ylabel(f"displacement{f' of {dofs[0]}' if len(dofs) == 1 else ''} [{length.label}]")
    finish(ax, made=made)
    return ax


def contact_history(
    result: Transient,
    contact: PointRef,
    *,
    ax: Axes | None = None,
    last: int | None = None,
) -> Axes:
    """Draw contact forces over time, between the forces at which they slip.

    Parameters
    ----------
    result : Transient
        The motion.
    contact : int, str or (int or str, int)
        The contact, or one of its points.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.
    last : int, optional
        How many of the last periods to draw. Default: all that are kept.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such contact, or fewer periods are kept.
    """
    result = _transient_of(result)
    part = _last(result, last)
    forces = result.contact_force(contact).reshape(result.time.size, -1)[part]
    number, only = result.locate(contact)
    name = result.model.contact_names[number]
    made, ax = ax is None, new_axes(ax)
    for point, colour in enumerate(colours(forces.shape[1])):
        label = name if forces.shape[1] == 1 and only is None else f"{name}[{point + (only or 0)}]"
        ax.plot(result.time[part], forces[:, point], color=colour, lw=1.0, label=label)
    limits = result.model.contacts[number].limits
    limit = limits[only or 0] if forces.shape[1] == 1 else np.inf
    if np.isfinite(limit):
        for side in (-limit, limit):
            ax.axhline(side, color=GREY, lw=0.9, ls=STUCK, zorder=1.5)
    _over_time(ax, result, part)
    ax.set_ylabel(f"contact force of {name} [N]")
    finish(ax, made=made)
    return ax


def phase(
    result: Transient,
    dof: str,
    *,
    ax: Axes | None = None,
    last: int | None = None,
    length_unit: LengthUnit = "m",
) -> Axes:
    """Draw velocity over displacement, and the states after each of the periods drawn.

    Parameters
    ----------
    result : Transient
        The motion.
    dof : str
        An observed degree of freedom.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.
    last : int, optional
        How many of the last periods to draw. Default: all that are kept.
    length_unit : {"m", "mm", "um"}, optional
        Unit of the displacement.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such degree of freedom or unit, or fewer periods are kept.
    """
    result, length = _transient_of(result), length_scale(length_unit)
    part = _last(result, last)
    x, v = (
        length.factor * result.displacement(dof)[part],
        length.factor * result.velocity(dof)[part],
    )
    sections = [length.factor * value for value in result.poincare(dof)]
    drawn = result.kept_periods if last is None else last
    made, ax = ax is None, new_axes(ax)
    ax.plot(x, v, color=colours(1)[0], lw=0.8, label="motion")
    ax.plot(
        sections[0][-drawn - 1 :],
        sections[1][-drawn - 1 :],
        ls="",
        marker="o",
        ms=4,
        mfc="white",
        mec="black",
        label="after each period",
    )
    _phase_axes(ax, dof, length.label)
    finish(ax, made=made)
    return ax


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
    result : Transient
        The motion.
    dof : str
        Any degree of freedom.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.
    skip : int, optional
        How many of the first periods to leave out.
    length_unit : {"m", "mm", "um"}, optional
        Unit of the displacement.

    Returns
    -------
    matplotlib.axes.Axes
        The axes. Points are coloured from the first to the last period; the last has a ring.

    Raises
    ------
    ModelError
        If there is no such degree of freedom or unit, or fewer periods were computed.
    """
    result, length = _transient_of(result), length_scale(length_unit)
    first = whole_number(skip, "skip", largest=result.periods)
    x, v = (length.factor * value[first:] for value in result.poincare(dof))
    made, ax = ax is None, new_axes(ax)
    periods = first + np.arange(x.size)
    cloud = ax.scatter(x, v, c=periods, cmap="viridis", s=12, lw=0.0)
    ax.plot(x[-1], v[-1], ls="", marker="o", ms=9, mfc="none", mec="black", label="last")
    if x.size > 1:
        ax.figure.colorbar(cloud, ax=ax, label="periods since the start")
    _phase_axes(ax, dof, length.label)
    finish(ax, made=made)
    return ax


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
    """Draw the power spectral density of a displacement.

    Parameters
    ----------
    result : Transient
        The motion.
    dof : str
        An observed degree of freedom.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.
    last, segment, window
        As of `Transient.spectrum`.
    omega_unit : {"rad/s", "Hz"}, optional
        Unit of the frequency axis; the density is per Hz in either.

    Returns
    -------
    matplotlib.axes.Axes
        The axes; thin lines stand at the multiples of the excitation frequency if they are few.

    Raises
    ------
    ModelError
        If there is no such degree of freedom, unit or window, or fewer periods are kept.
    """
    result, omega = _transient_of(result), omega_scale(omega_unit)
    found = result.spectrum(dof, last=last, segment=segment, window=window)
    made, ax = ax is None, new_axes(ax)
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
        ax.set_yscale("log")
        ax.set_ylim(1e-16 * top, 4.0 * top)
    ax.set_xlabel(omega.label)
    ax.set_ylabel(f"power spectral density of {dof} [m²/Hz]")
    finish(ax, made=made)
    return ax


def _transient_of(result: object) -> Transient:
    if not isinstance(result, Transient):
        raise ModelError(
            f"result: {brief(result)} is not a Transient; give what transient returned"
        )
    return result


def _last(result: Transient, last: int | None) -> slice:
    """Return the instants of the last periods."""
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
    ax.set_xlabel(f"displacement of {dof} [{unit}]")
    ax.set_ylabel(f"velocity of {dof} [{unit}/s]")
