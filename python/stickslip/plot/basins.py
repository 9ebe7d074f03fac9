"""What becomes of free motions: basin maps, and spectra with their lines."""

from __future__ import annotations

from typing import Unpack

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, to_hex
from matplotlib.patches import Patch

from stickslip.errors import ModelError
from stickslip.plot import style
from stickslip.plot.figure import figure
from stickslip.plot.options import Frame, LineOptions
from stickslip.plot.style import Looks
from stickslip.results.basin_map import BasinMap, Outcome
from stickslip.results.fate_arrays import Motion
from stickslip.results.fields import Float
from stickslip.results.motion_class import MotionClass

_COLOURS = {
    Motion.DECAYING: "#e8e8e8",
    Motion.UNBOUNDED: "#7f2704",
    Motion.UNDECIDED: "white",
}
# Modes are told apart by hue, aperiodic motions about them by a lighter shade of it.
_SHADES = (Motion.SETTLED, Motion.APERIODIC)
_HUES = 10
_CLOSE = 0.07


@figure
def basins(ax: Axes, /, result: BasinMap, **options: Unpack[Frame]) -> None:
    """Draw what the starts of a map lead to, over its two axes."""
    if len(result.settings.axes) != 2:
        raise ModelError(
            "basins: the map is of a list of starts, without axes; give basin_map axes to draw"
        )
    length = style.LENGTH[options["length_unit"]]
    outcomes = result.outcomes
    colours = [_colour(outcome) for outcome in outcomes]
    (up, rows), (right, columns) = result.settings.axes
    ax.pcolormesh(
        _edges(length.factor * np.array(columns)),
        _edges(length.factor * np.array(rows)),
        result.codes[np.ix_(np.argsort(rows), np.argsort(columns))],
        cmap=ListedColormap(colours),
        vmin=-0.5,
        vmax=len(outcomes) - 0.5,
        rasterized=True,
    )
    ax.set_xlabel(f"{_named(right)} [{length.label}]")
    ax.set_ylabel(f"{_named(up)} [{length.label}]")
    patches = [
        Patch(facecolor=colour, edgecolor="0.6", lw=0.5, label=f"{outcome} ({count})")
        for (outcome, count), colour in zip(outcomes.items(), colours, strict=True)
    ]
    place: Looks = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.01), "borderaxespad": 0.0}
    ax.legend(handles=patches, **place, ncols=2, frameon=False, fontsize="small")


@figure
def lines(ax: Axes, /, result: MotionClass, dof: str, **options: Unpack[LineOptions]) -> None:
    """Draw the spectrum of a motion that neither decays nor grows for ever, its lines marked."""
    omega = style.omega_scale(options["omega_unit"], result)
    frequency, density = result.spectrum(dof)
    found = result.lines(dof, options["most"])
    scale = 2.0 * np.pi * omega.factor
    shown = density > 0.0
    ax.semilogy(
        scale * frequency[shown], density[shown], lw=0.9, color=style.BLUE, label=style.named(dof)
    )
    if found:
        where = np.array([line.frequency for line in found])
        height = np.interp(where, frequency, density)
        ax.plot(scale * where, height, **style.mark("v", 4, "crimson"), label="lines")
        _number(ax, scale * where, height)
        ax.set(xlim=(0.0, 1.5 * scale * where.max()))
        ax.set(ylim=(1e-9 * density.max(), 10.0 * density.max()))
    ax.set(xlabel=omega.label, ylabel="power spectral density [m²/Hz]")


def _number(ax: Axes, where: Float, height: Float) -> None:
    """Write frequencies over lines; of close ones, which would cover each other, the strongest."""
    looks: Looks = {"ha": "center", "fontsize": "x-small", "color": "crimson"}
    written: list[float] = []
    for at, top in zip(where, height, strict=True):
        if not any(abs(at - other) < _CLOSE * where.max() for other in written):
            written.append(at)
            ax.annotate(f"{at:.4g}", (at, top), (0.0, 5.0), textcoords="offset points", **looks)


def _colour(outcome: Outcome) -> str:
    if outcome.mode is None or outcome.motion not in _SHADES:
        return _COLOURS[outcome.motion]
    shade = _SHADES.index(outcome.motion)
    return to_hex(colormaps["tab20"](2 * (outcome.mode % _HUES) + shade))


def _edges(centres: Float) -> Float:
    """Return the borders half-way between values, in ascending order."""
    values = np.sort(centres)
    if values.size == 1:
        half = 0.5 * abs(values[0]) or 0.5
        return np.array([values[0] - half, values[0] + half])
    between = 0.5 * (values[1:] + values[:-1])
    ends = 2.0 * values[0] - between[0], 2.0 * values[-1] - between[-1]
    return np.concatenate([ends[:1], between, ends[1:]])


def _named(axis: str | int) -> str:
    return f"start of mode {axis}" if isinstance(axis, int) else f"start of {style.named(axis)}"
