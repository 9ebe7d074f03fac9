"""Drawing of reproductions: legible in print without colours, too."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip_reproduce.numbers import Axis, Panel, Plot, Series

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
_FEW = 12
"""Curves of so many points at most have a mark at each."""
_COUNTED = 12
"""So many whole numbers at most are all written on an axis."""
_ROW = 3
"""Panels beside each other."""
_INSET = (0.09, 0.4, 0.5, 0.52)
"""Place of an inset in its axes: left, lower, width, height, as shares."""
_SYMBOL = re.compile(r"\b([A-Za-z])_([A-Za-z]\d?)\b")


def _colours(count: int) -> list[tuple[float, float, float, float]]:
    """Return colours in a perceptual sequence, from dark to light, the palest left out."""
    from matplotlib import colormaps

    return [colormaps["viridis"](0.05 + 0.8 * i / max(count - 1, 1)) for i in range(count)]


def draw(plot: Plot) -> Figure:
    """Draw panels in rows of three, with one legend beside all of them.

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
    columns = min(len(plot.panels), _ROW)
    lines = -(-len(plot.panels) // _ROW)
    beside = len(looks) > 1
    width = (4.6 if columns > 1 else 6.2) * columns + (2.2 if beside else 0.4)
    figure = Figure(figsize=(width, 4.4 if lines == 1 else 3.6 * lines), layout="constrained")
    own = any(panel.y for panel in plot.panels)
    grid = figure.subplots(lines, columns, squeeze=False, sharey=columns > 1 and not own).flat
    drawn = dict(zip(plot.panels, grid, strict=True))
    for place, (panel, ax) in enumerate(drawn.items()):
        y = panel.y or plot.y
        _lines(ax, panel, plot, looks)
        ax.set_title(_typeset(panel.title), fontsize="medium")
        _frame(ax, plot.x, y)
        if place % _ROW == 0:
            ax.set_ylabel(_typeset(y.label))
    _from_zero(drawn, plot)
    for panel, ax in drawn.items():
        if panel.enlarged:
            _inset(ax, panel, plot, looks)
    handles: dict[str, Any] = {}
    for ax in drawn.values():
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
            handles.setdefault(label, handle)
    if beside:
        figure.legend(
            handles.values(),
            handles,
            loc="outside right upper",
            frameon=False,
            fontsize="small",
            handlelength=3.2,
        )
    return figure


def _lines(
    ax: Axes, panel: Panel, plot: Plot, looks: Mapping[str, dict[str, Any]], **changed: Any
) -> None:
    y = panel.y or plot.y
    for series in panel.series:
        look = looks[series.label] | _thinned(series) | changed
        ax.plot(plot.x.factor * series.x, y.factor * series.y, label=_typeset(series.label), **look)


def _inset(ax: Axes, panel: Panel, plot: Plot, looks: Mapping[str, dict[str, Any]]) -> None:
    """Enlarge a range in the upper left corner, where a resonance curve leaves room."""
    assert panel.enlarged is not None
    low, high = panel.enlarged
    inset = ax.inset_axes(_INSET)
    _lines(inset, panel, plot, looks, markevery=1.0)
    inside = [series.y[(series.x >= low) & (series.x <= high)] for series in panel.series]
    y = panel.y or plot.y
    least, most = (y.factor * end(np.concatenate(inside)) for end in (np.min, np.max))
    inset.set_xlim(plot.x.factor * low, plot.x.factor * high)
    inset.set_ylim(least - 0.05 * (most - least), most + 0.05 * (most - least))
    inset.tick_params(labelsize="x-small")
    inset.locator_params(nbins=5)
    inset.grid(True, lw=0.4, alpha=0.4)
    ax.indicate_inset_zoom(inset, edgecolor="0.4")


def _typeset(text: str) -> str:
    """Write F_d with a subscript."""
    return _SYMBOL.sub(r"$\1_{\2}$", text)


def _thinned(series: Series) -> dict[str, Any]:
    if series.kind in ("marks", "dots") and series.x.size > _DENSE:
        return {"markevery": series.x.size // _SPARSE}
    # Where few points are joined by lines, they are shown.
    return {"marker": ".", "ms": 6.0} if series.kind == "line" and series.x.size <= _FEW else {}


def _frame(ax: Axes, x: Axis, y: Axis) -> None:
    ax.set_xlabel(_typeset(x.label))
    _scale(ax, x, "x")
    _scale(ax, y, "y")
    marked = any(line.get_marker() != "None" for line in ax.lines)
    ax.margins(x=0.02 if marked or x.log else 0.0)
    ax.grid(visible=True, color="0.9", lw=0.7)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)


def _from_zero(drawn: Mapping[Panel, Axes], plot: Plot) -> None:
    """Let amplitudes start at zero, unless that would press them together."""
    for axis in {panel.y or plot.y for panel in drawn}:
        row = [panel for panel in drawn if (panel.y or plot.y) == axis]
        values = np.concatenate([series.y for panel in row for series in panel.series])
        low, high = (axis.factor * float(end(values)) for end in (np.min, np.max))
        if not axis.log and not axis.names and 0.0 <= low < 0.5 * high:
            for panel in row:
                drawn[panel].set_ylim(0.0, 1.05 * high)


def _scale(ax: Axes, axis: Axis, which: str) -> None:
    from matplotlib.ticker import FuncFormatter, LogLocator

    ruler = getattr(ax, f"{which}axis")
    if axis.names:
        ruler.set_ticks(range(len(axis.names)), axis.names)
        return
    if not axis.log:
        values = np.concatenate([getattr(line, f"get_{which}data")() for line in ax.lines])
        places = np.unique(values)
        if places.size <= _COUNTED and not np.any(places % 1.0):
            ruler.set_ticks(places)
        return
    getattr(ax, f"set_{which}scale")("log")
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
    if series.kind == "dots":
        return {"color": colour, "ls": "", "marker": ".", "ms": 4.0, "zorder": 3.0}
    if series.kind == "limit":
        return {"color": colour, "lw": 3.2, "alpha": 0.35, "solid_capstyle": "butt"}
    look: dict[str, Any] = {"color": colour, "lw": 1.5, "ls": DASHES[place % len(DASHES)]}
    if count > len(DASHES) or count >= _TICKED:
        marker = MARKERS[place % len(MARKERS)]
        # Each starts elsewhere, so that marks of equal curves do not hide each other.
        start = 0.02 + 0.13 * place / count
        look |= {"marker": marker, "ms": 4.0, "mfc": "white", "markevery": (start, 0.15)}
    return look
