"""Figures of what becomes of free motions: basin maps, and spectra with their lines."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

import numpy as np

from stickslip.checks import brief
from stickslip.errors import ModelError
from stickslip.plot.style import (
    LengthUnit,
    OmegaUnit,
    finish,
    length_scale,
    new_axes,
    omega_scale,
)
from stickslip.results.basin_map import BasinMap, Outcome
from stickslip.results.fate_arrays import Motion
from stickslip.results.motion_class import MotionClass

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from stickslip.results.arrays import Float

__all__ = ["BasinOptions", "LineOptions", "basins", "lines"]

_COLOURS = {
    Motion.DECAYING: "#e8e8e8",
    Motion.UNBOUNDED: "#7f2704",
    Motion.UNDECIDED: "white",
}
# Modes are told apart by hue, aperiodic motions about them by a lighter shade of it.
_SHADES = (Motion.SETTLED, Motion.APERIODIC)
_HUES = 10
_CLOSE = 0.07


class BasinOptions(TypedDict, total=False):
    """Keywords of `basins`."""

    ax: Axes | None
    length_unit: LengthUnit


class LineOptions(TypedDict, total=False):
    """Keywords of `lines`."""

    ax: Axes | None
    omega_unit: OmegaUnit
    most: int


def basins(result: BasinMap, *, ax: Axes | None = None, length_unit: LengthUnit = "m") -> Axes:
    """Draw what the starts of a map lead to, over its two axes.

    Parameters
    ----------
    result : BasinMap
        A map over two axes.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.
    length_unit : {"m", "mm", "um"}, optional
        Unit of the axes.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ModelError
        If it is no map over two axes, or there is no such unit.
    """
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    if not isinstance(result, BasinMap):
        raise ModelError(f"result: {brief(result)} is no BasinMap; give what basin_map returned")
    if len(result.settings.axes) != 2:
        raise ModelError(
            "basins: the map is of a list of starts, without axes; give basin_map axes to draw"
        )
    length = length_scale(length_unit)
    made, ax = ax is None, new_axes(ax)
    (up, rows), (right, columns) = result.settings.axes
    outcomes = list(result.outcomes)
    colours = [_colour(outcome) for outcome in outcomes]
    ax.pcolormesh(
        _edges(length.factor * np.array(columns)),
        _edges(length.factor * np.array(rows)),
        _ordered(result.codes, rows, columns),
        cmap=ListedColormap(colours),
        vmin=-0.5,
        vmax=len(outcomes) - 0.5,
        rasterized=True,
    )
    ax.set_xlabel(f"{_named(right)} [{length.label}]")
    ax.set_ylabel(f"{_named(up)} [{length.label}]")
    patches = [
        Patch(facecolor=colour, edgecolor="0.6", lw=0.5, label=f"{outcome} ({count})")
        for (outcome, count), colour in zip(result.outcomes.items(), colours, strict=True)
    ]
    finish(ax, made=made)
    ax.grid(visible=False)
    ax.legend(
        handles=patches,
        loc="lower left",
        bbox_to_anchor=(0.0, 1.01),
        borderaxespad=0.0,
        ncols=2,
        frameon=False,
        fontsize="small",
    )
    return ax


def lines(
    result: MotionClass,
    dof: str,
    *,
    ax: Axes | None = None,
    omega_unit: OmegaUnit = "Hz",
    most: int = 8,
) -> Axes:
    """Draw the spectrum of a motion, its lines marked.

    Parameters
    ----------
    result : MotionClass
        A motion that neither decays nor grows for ever.
    dof : str
        An observed degree of freedom.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.
    omega_unit : {"Hz", "rad/s"}, optional
        Unit of the frequency axis.
    most : int, optional
        How many lines to mark at most.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ModelError
        If it is no such motion, degree of freedom or unit.
    """
    if not isinstance(result, MotionClass):
        raise ModelError(f"result: {brief(result)} is no MotionClass; give what classify returned")
    omega = omega_scale(omega_unit)
    frequency, density = result.spectrum(dof)
    found = result.lines(dof, most)
    made, ax = ax is None, new_axes(ax)
    scale = 2.0 * np.pi * omega.factor
    shown = density > 0.0
    ax.semilogy(scale * frequency[shown], density[shown], lw=0.9, color="#31688e", label=dof)
    if found:
        where = np.array([line.frequency for line in found])
        height = np.interp(where, frequency, density)
        ax.plot(
            scale * where,
            height,
            ls="",
            marker="v",
            ms=4,
            mfc="white",
            mec="crimson",
            label="lines",
        )
        told: list[float] = []
        for line, top in zip(found, height, strict=True):
            at = scale * line.frequency
            # Numbers of close lines would cover each other: the strongest keeps its own.
            if any(abs(at - other) < _CLOSE * scale * where.max() for other in told):
                continue
            told.append(at)
            ax.annotate(
                f"{at:.4g}",
                (at, top),
                (0.0, 5.0),
                textcoords="offset points",
                ha="center",
                fontsize="x-small",
                color="crimson",
            )
        ax.set_xlim(0.0, 1.5 * scale * where.max())
        ax.set_ylim(1e-9 * density.max(), 10.0 * density.max())
    ax.set_xlabel(omega.label)
    ax.set_ylabel("power spectral density [m²/Hz]")
    finish(ax, made=made)
    return ax


def _colour(outcome: Outcome) -> str:
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    if outcome.mode is None or outcome.motion not in _SHADES:
        return _COLOURS[outcome.motion]
    shade = _SHADES.index(outcome.motion)
    return to_hex(colormaps["tab20"](2 * (outcome.mode % _HUES) + shade))


def _ordered(
    codes: NDArray[np.int64], rows: tuple[float, ...], columns: tuple[float, ...]
) -> NDArray[np.int64]:
    return codes[np.ix_(np.argsort(rows), np.argsort(columns))]


def _edges(centres: Float) -> Float:
    """Return the borders half-way between values, in ascending order."""
    values = np.sort(centres)
    if values.size == 1:
        half = 0.5 * abs(values[0]) or 0.5
        return np.array([values[0] - half, values[0] + half])
    between = 0.5 * (values[1:] + values[:-1])
    return np.concatenate(
        [[2.0 * values[0] - between[0]], between, [2.0 * values[-1] - between[-1]]]
    )


def _named(axis: str | int) -> str:
    return f"start of mode {axis}" if isinstance(axis, int) else f"start of {axis}"
