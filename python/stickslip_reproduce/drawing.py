"""Drawing of reproductions: legible in print without colours, too."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip_reproduce.numbers import Axis, Plot, Series

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw"]

DASHES = (
    "solid",
    (0, (6, 2)),
    (0, (1, 1.3)),
    (0, (6, 2, 1, 2)),
    (0, (3, 1.2)),
    (0, (8, 2, 1, 2, 1, 2)),
)
MARKERS = "os^Dv*Xp"
FEW_COLOURS = ("#1f3b73", "#c8571b", "#2f8f6b", "#7a4fa3")
"""Of different brightness, too; more curves take a sequence from dark to light."""

_TICKED = 7
"""From so many curves on dashes repeat, and each carries sparse marks as well."""
_DENSE = 80
_SPARSE = 32
"""Rows of more marks than the first number are drawn with about as many as the second."""
_SYMBOL = re.compile(r"\b([A-Za-z])_([A-Za-z]\d?)\b")


def _colours(count: int) -> list[tuple[float, float, float, float]]:
    """Return colours in a perceptual sequence, from dark to light, the palest left out."""
    from matplotlib import colormaps

    return [colormaps["viridis"](0.05 + 0.8 * i / max(count - 1, 1)) for i in range(count)]


def draw(plot: Plot) -> Figure:
    """Draw panels beside each other, with one legend for all of them.

    Parameters
    ----------
    plot : Plot
        What to draw.

    Returns
    -------
    matplotlib.figure.Figure
        A figure that no window shows.
    """
    from matplotlib.figure import Figure

    looks = _looks(plot)
    count = len(plot.panels)
    outside = len(looks) > 6 or count > 1
    width = (4.6 if count > 1 else 6.2) * count + (2.2 if outside else 0.4)
    figure = Figure(figsize=(width, 4.4), layout="constrained")
    rows = figure.subplots(1, count, squeeze=False, sharey=count > 1)
    for ax, panel in zip(rows[0], plot.panels, strict=True):
        for series in panel.series:
            ax.plot(
                plot.x.factor * series.x,
                plot.y.factor * series.y,
                label=_typeset(series.label),
                **looks[series.label] | _thinned(series),
            )
        ax.set_title(_typeset(panel.title), fontsize="medium")
        _frame(ax, plot)
    _from_zero(rows[0], plot)
    rows[0][0].set_ylabel(_typeset(plot.y.label))
    handles: dict[str, Any] = {}
    for ax in rows[0]:
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
            handles.setdefault(label, handle)
    if len(handles) > 1:
        style: dict[str, Any] = {"frameon": False, "fontsize": "small", "handlelength": 3.2}
        if outside:
            figure.legend(handles.values(), handles, loc="outside right upper", **style)
        else:
            rows[0][0].legend(handles.values(), handles, **style | {"frameon": True})
    return figure


def _typeset(text: str) -> str:
    """Write F_d with a subscript."""
    return _SYMBOL.sub(r"$\1_{\2}$", text)


def _thinned(series: Series) -> dict[str, int]:
    many = series.kind == "marks" and series.x.size > _DENSE
    return {"markevery": series.x.size // _SPARSE} if many else {}


def _frame(ax: Axes, plot: Plot) -> None:
    from matplotlib.ticker import MaxNLocator

    ax.set_xlabel(_typeset(plot.x.label))
    _scale(ax, plot.x, "x")
    _scale(ax, plot.y, "y")
    marked = any(line.get_linestyle() == "None" for line in ax.lines)
    ax.margins(x=0.02 if marked or plot.x.log else 0.0)
    places = np.concatenate([np.asarray(line.get_xdata(), float) for line in ax.lines])
    if not plot.x.log and places.max() < 100.0 and not np.any(places % 1.0):
        ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    ax.grid(visible=True, color="0.9", lw=0.7)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)


def _from_zero(row: Iterable[Axes], plot: Plot) -> None:
    """Let amplitudes start at zero, unless that would press them together."""
    values = [series.y for panel in plot.panels for series in panel.series]
    low, high = (plot.y.factor * float(end(np.concatenate(values))) for end in (np.min, np.max))
    if not plot.y.log and 0.0 <= low < 0.5 * high:
        for ax in row:
            ax.set_ylim(0.0, 1.05 * high)


def _scale(ax: Axes, axis: Axis, which: str) -> None:
    if not axis.log:
        return
    from matplotlib.ticker import FuncFormatter, LogLocator

    getattr(ax, f"set_{which}scale")("log")
    ruler = getattr(ax, f"{which}axis")
    low, high = ruler.get_data_interval()
    if low <= 0.0 or high / low > 1e4 or low < 1e-3 or high > 1e6:
        return
    written = FuncFormatter(lambda value, _: f"{value:g}")
    ruler.set_major_formatter(written)
    if high / low < 300.0:
        ruler.set_minor_locator(LogLocator(subs=(2.0, 5.0)))
        ruler.set_minor_formatter(written)


def _looks(plot: Plot) -> dict[str, dict[str, Any]]:
    """Return how every label is drawn: one colour per pair, dashes and markers apart."""
    every: dict[str, Series] = {}
    for panel in plot.panels:
        for series in panel.series:
            every.setdefault(series.label, series)
    pairs = list(dict.fromkeys(_pair(series) for series in every.values()))
    few = len(pairs) <= len(FEW_COLOURS)
    palette = dict(zip(pairs, FEW_COLOURS if few else _colours(len(pairs)), strict=not few))
    return {
        label: _look(series, palette[_pair(series)], pairs.index(_pair(series)), len(pairs))
        for label, series in every.items()
    }


def _pair(series: Series) -> object:
    return series.label if series.pair is None else series.pair


def _look(series: Series, colour: object, place: int, count: int) -> dict[str, Any]:
    if series.kind == "marks":
        return {
            "color": colour,
            "ls": "",
            "marker": MARKERS[place % len(MARKERS)],
            "ms": 4.5,
            "mfc": "none",
            "mew": 1.0,
            "zorder": 3.0,
            # Whole at the edge, too, where amplitudes start at zero.
            "clip_on": False,
        }
    if series.kind == "limit":
        return {"color": colour, "lw": 3.2, "alpha": 0.35, "solid_capstyle": "butt"}
    look: dict[str, Any] = {"color": colour, "lw": 1.5, "ls": DASHES[place % len(DASHES)]}
    if count > len(DASHES) or count >= _TICKED:
        marker = MARKERS[place % len(MARKERS)]
        # Each starts elsewhere, so that marks of equal curves do not hide each other.
        start = 0.02 + 0.13 * place / count
        look |= {"marker": marker, "ms": 4.0, "mfc": "white", "markevery": (start, 0.15)}
    return look
