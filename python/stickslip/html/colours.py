"""Colours of Matplotlib as plotly writes them, also those that stand for values."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib import colors

from stickslip.html.labels import label
from stickslip.results.arrays import Float

__all__ = ["colour_of", "scaled"]

_STEPS = 32


def colour_of(value: object, alpha: float | None = None) -> str:
    """Return a colour as CSS writes it."""
    red, green, blue, opacity = colors.to_rgba(value)  # type: ignore[arg-type]
    opacity = opacity if alpha is None else alpha
    return f"rgba({255 * red:.0f},{255 * green:.0f},{255 * blue:.0f},{opacity:.3g})"


def scaled(mapped: Any, values: Float) -> tuple[Float, dict[str, Any]]:
    """Return what colours stand for, as plotly takes it.

    Parameters
    ----------
    mapped : matplotlib.cm.ScalarMappable
        With a map of colours, a norm and perhaps a bar.
    values : ndarray of float64
        The values.

    Returns
    -------
    numbers : ndarray of float64
        The values, or where the norm is not linear what it makes of them, from 0 to 1.
    entries : dict
        The scale, its ends and the bar.
    """
    low, high = mapped.get_clim()
    entries: dict[str, Any] = {"colorscale": _scale(mapped.cmap), "cmin": low, "cmax": high}
    straight = type(mapped.norm) is colors.Normalize
    if not straight:
        values = _normed(mapped, values)
        entries |= {"cmin": 0.0, "cmax": 1.0}
    bar = mapped.colorbar
    if bar is None:
        return values, entries | {"showscale": False}
    axis = bar.ax.yaxis if bar.orientation == "vertical" else bar.ax.xaxis
    entries["colorbar"] = {
        "title": {"text": label(axis.get_label_text()), "side": "right"},
        "thickness": 14,
        "outlinewidth": 0,
    }
    ticks = np.array([tick for tick in bar.get_ticks() if low <= tick <= high], float)
    # steps stand for cases, whose names only the ticks of the picture know
    if not straight or entries["colorscale"][0][1] == entries["colorscale"][1][1]:
        entries["colorbar"] |= {
            "tickvals": ticks if straight else _normed(mapped, ticks),
            "ticktext": [label(text) for text in axis.get_major_formatter().format_ticks(ticks)],
        }
    return values, entries | {"showscale": True}


def _normed(mapped: Any, values: Float) -> Float:
    numbers: Float = np.ma.filled(
        np.ma.asarray(mapped.norm(np.ma.masked_invalid(values)), float), np.nan
    )
    if isinstance(mapped.norm, colors.BoundaryNorm):
        # it counts colours; their middles are what is drawn
        numbers = (numbers + 0.5) / mapped.cmap.N
    return np.asarray(numbers, dtype=np.float64)


def _scale(shades: Any) -> list[list[Any]]:
    """Return a scale: steps where there are few colours, for these stand for cases."""
    if isinstance(shades, colors.ListedColormap) and shades.N <= _STEPS:
        count = shades.N
        return [
            [edge / count, colour_of(shades(index))]
            for index in range(count)
            for edge in (index, index + 1)
        ]
    return [[float(at), colour_of(shades(float(at)))] for at in np.linspace(0.0, 1.0, 16)]
