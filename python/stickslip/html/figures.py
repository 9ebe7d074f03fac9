"""Interactive figures from the panels that make pictures: one drawing serves both."""

from __future__ import annotations

import base64
import io
import json
from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, log10

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import (
    FixedFormatter,
    FixedLocator,
    FuncFormatter,
    MaxNLocator,
    ScalarFormatter,
)
from matplotlib.transforms import Transform

from stickslip.html.artists import Trace, UndrawableError, proxy, traces
from stickslip.html.notation import label, plain
from stickslip.plot.style import RESPONSE, Prefixed, fit
from stickslip.results.fields import Float
from stickslip.views.picture import Panel

_SIZE = (7.4, 4.2)
_HEIGHT, _LEGEND_ROW, _LEGEND_WIDTH = 400, 22, 800
_BUTTONS = 20
_FONT = "system-ui, -apple-system, 'Segoe UI', 'Liberation Sans', Arial, sans-serif"
_FEW_DECADES = 2.5
_TICKS, _STEPS = 8, 5
"""The most of a logarithmic axis, and for which plotly takes some more within a decade."""
_TITLE, _LETTER = 14, 0.55
"""Size of the title of an axis, and the mean width of a letter over it."""
_FRAME = 280
"""Height of the frame that is left beside titles, in pixels."""
_INTEGERS = 12
"""Whole numbers along an axis that are all labelled."""
_PAGE: Trace = {
    "template": {},
    "font": {"family": _FONT, "size": 13, "color": "#1f2933"},
    "paper_bgcolor": "#ffffff",
    "plot_bgcolor": "#ffffff",
    "hovermode": "closest",
    # bars stand where they are drawn
    "barmode": "overlay",
    "yaxis3": {"overlaying": "y", "range": [0, 1], "visible": False, "fixedrange": True},
    "legend": {
        "orientation": "h",
        "x": 0.0,
        "xanchor": "left",
        "yref": "container",
        "y": 0.0,
        "yanchor": "bottom",
        "font": {"size": 12},
    },
}
_AXIS: Trace = {
    "automargin": True,
    "gridcolor": "#e3e6ea",
    "linecolor": "#8a94a0",
    "showline": True,
    "ticks": "outside",
    "tickcolor": "#8a94a0",
    "zeroline": False,
    "hoverformat": ".6g",
    "exponentformat": "power",
}
_MENU: Trace = {
    "type": "buttons",
    "bgcolor": "#f3f5f7",
    "bordercolor": "#b8c0c8",
    "font": {"size": 12},
    "pad": {"t": 0, "r": 0},
    "x": 0.0,
    "xanchor": "left",
    "y": 1.02,
    "yanchor": "bottom",
    "direction": "right",
}


@dataclass(frozen=True)
class Drawn:
    """A figure of a page."""

    caption: str
    """What it shows, in a line."""
    description: str
    """The same with the names of its curves, to be read aloud."""
    data: str
    """What plotly draws, as JSON; empty if the picture is a still one."""
    still: str
    """A picture as data URI, where there is no interactive one."""
    height: int
    """In pixels."""


def drawn(panel: Panel) -> Drawn:
    """Return a figure of what a panel draws on Matplotlib axes.

    It is interactive, or a still picture where the panel draws what plotly has no counterpart of.

    Raises
    ------
    ModelError
        If the panel refuses what it is to draw.
    """
    figure = Figure(figsize=_SIZE, layout="constrained")
    ax = figure.add_subplot()
    panel(ax=ax)
    caption, description = _words(ax)
    try:
        data, layout = _plotly(figure, ax)
    except UndrawableError:
        return Drawn(caption, description, "", _still(figure), _HEIGHT)
    return Drawn(caption, description, _json(data, layout), "", layout["height"])


def _plotly(figure: Figure, ax: Axes) -> tuple[list[Trace], Trace]:
    mapped = (one for own in figure.axes for one in (*own.collections, *own.images))
    bars = [one.colorbar.ax for one in mapped if one.colorbar is not None]
    beside = [one for one in figure.axes if one is not ax and one not in bars]
    if len(beside) > 1 or not all(one.bbox.bounds == ax.bbox.bounds for one in beside):
        raise UndrawableError("several frames")
    # What is drawn is in SI; the page has no formatter that could write it with a prefix.
    factors = {letter: _factor(ax, letter) for letter in "xy"}
    data = list(traces(ax, "y"))
    layout = _layout(ax)
    for one in beside:
        data += traces(one, "y2")
        side = {"overlaying": "y", "side": "right", "showgrid": False, "tickmode": "auto"}
        layout["yaxis2"] = _axis(one, "y") | side
    layout["annotations"] = [_annotation(text, ax) for text in ax.texts if text.get_text()]
    names = [trace["name"] for trace in data if trace["showlegend"]]
    legend = ax.get_legend()
    if legend is not None:
        for handle, text in zip(legend.legend_handles, legend.get_texts(), strict=True):
            name = text.get_text()
            if handle is not None and label(name) not in names:
                data.append(proxy(handle, name))
                names.append(label(name))
    _group(data)
    layout["showlegend"] = legend is not None or len(names) > 1
    if layout["showlegend"]:
        rows = ceil(sum(7 * len(name) + 60 for name in names) / _LEGEND_WIDTH)
        layout["height"] += _LEGEND_ROW * rows
        layout["margin"]["b"] += _LEGEND_ROW * rows
    layout["updatemenus"] = _scales(ax, data)
    if layout["updatemenus"]:
        # buttons stand between title and frame, below those of plotly
        layout["margin"]["t"] += _BUTTONS
        layout["height"] += _BUTTONS
    for letter, factor in factors.items():
        _rescale(data, layout, letter, factor)
    return data, layout


def _factor(ax: Axes, letter: str) -> float:
    formatter = getattr(ax, f"{letter}axis").get_major_formatter()
    return formatter.factor if isinstance(formatter, Prefixed) else 1.0


def _rescale(data: Sequence[Trace], layout: Trace, letter: str, factor: float) -> None:
    """Multiply what is drawn along an axis."""
    if factor == 1.0:
        return

    def scaled(ends: Sequence[float], kind: str) -> list[float]:
        return [end + log10(factor) if kind == "log" else factor * end for end in ends]

    for trace in data:
        if trace[f"{letter}axis"] != letter:
            continue
        upright = trace["type"] == "bar" and (trace["orientation"] == "v") == (letter == "y")
        along = trace["type"] == "bar" and not upright
        for key in (letter, *(["base"] * upright), *(["width"] * along)):
            trace[key] = [None if one is None else factor * one for one in trace[key]]
    axis = layout[f"{letter}axis"]
    axis["range"] = scaled(axis["range"], axis["type"])
    for note in layout["annotations"]:
        if note[f"{letter}ref"] == letter:
            (note[letter],) = scaled([note[letter]], axis["type"])
    for menu in layout["updatemenus"] if letter == "y" else ():
        for button in menu["buttons"]:
            (shown,) = button["args"]
            shown["yaxis.range"] = scaled(shown["yaxis.range"], shown["yaxis.type"])


def _layout(ax: Axes) -> Trace:
    title = {"text": label(ax.get_title()), "x": 0.0, "xref": "paper", "y": 0.97}
    layout = _PAGE | {
        "height": _HEIGHT,
        "margin": {"l": 74, "r": 24, "t": 48, "b": 56},
        "title": title | {"font": {"size": 14}},
        "xaxis": _axis(ax, "x"),
        "yaxis": _axis(ax, "y"),
    }
    if ax.get_aspect() == 1.0:
        layout["yaxis"] |= {"scaleanchor": "x", "scaleratio": 1.0}
        layout["height"] += 80
    return layout


def _axis(ax: Axes, letter: str) -> Trace:
    axis = getattr(ax, f"{letter}axis")
    scale = axis.get_scale()
    if scale not in ("linear", "log"):
        raise UndrawableError(f"{scale} axis")
    low, high = ax.get_xlim() if letter == "x" else ax.get_ylim()
    text = label(axis.get_label_text())
    entry = _AXIS | {"title": {"text": text}} | _span(low, high, scale)
    if letter == "y":
        room = _FRAME / (_LETTER * max(len(plain(axis.get_label_text())), 1))
        entry["title"] = {"text": text, "font": {"size": round(min(_TITLE, room), 1)}}
    if scale == "linear":
        entry["minexponent"] = 3
    locator, formatter = axis.get_major_locator(), axis.get_major_formatter()
    if isinstance(locator, MaxNLocator) and isinstance(formatter, ScalarFormatter):
        whole = [tick for tick in locator() if low <= tick <= high]
        if whole and not np.mod(whole, 1.0).any() and high - low < _INTEGERS:
            entry |= {"tickmode": "linear", "tick0": 0, "dtick": 1}
    if isinstance(locator, FixedLocator) and isinstance(formatter, FixedFormatter | FuncFormatter):
        places = [float(one) for one in locator()]
        entry["tickvals"] = places
        entry["ticktext"] = [label(one) for one in formatter.format_ticks(places)]
    return entry


def _span(low: float, high: float, scale: str) -> Trace:
    """Return what of an axis is seen.

    Ticks are left to plotly, which finds others where a reader enlarges something. Of few decades
    whole numbers are written: it writes 2 for 20 and for 0.2 alike where it writes powers of ten.
    """
    if scale == "linear":
        shown: Trace = {"type": scale, "range": [float(low), float(high)]}
        return shown | {"nticks": 0, "tickformat": ""}
    ends = log10(low), log10(high)
    decades = abs(ends[1] - ends[0])
    few = decades < _FEW_DECADES
    # Plotly takes equal steps within a decade, and 1, 2 and 5 from 0.3 to 0.7 decades per tick.
    most = _STEPS if decades < 1.0 else ceil(decades / 0.7) if few else int(decades / 0.75)
    written = {"nticks": min(most, _TICKS), "tickformat": ".6~g" if few else ""}
    return {"type": scale, "range": [*ends]} | written


def _scales(ax: Axes, data: Sequence[Trace]) -> list[Trace]:
    """Return the buttons for a logarithmic and a linear axis, where both make sense."""
    now = ax.get_yscale()
    parts = [trace for trace in data if trace["yaxis"] == "y"]
    if not parts or any(trace["type"] != "scatter" for trace in parts) or ax.get_aspect() == 1.0:
        return []
    heights: Float = np.concatenate([np.asarray(trace["y"], float) for trace in parts])
    heights = heights[np.isfinite(heights)]
    if not heights.size or heights.min() <= 0.0:
        return []
    spans = {now: ax.get_ylim()}
    other = "linear" if now == "log" else "log"
    if any(line.get_gid() == RESPONSE for line in ax.lines):
        fit(ax, log=other == "log")
        spans[other] = ax.get_ylim()
    else:
        low, high = float(heights.min()), float(heights.max())
        spans[other] = (0.6 * low, 1.6 * high) if other == "log" else (0.0, 1.05 * high)
    buttons = []
    for name in ("log", "linear"):
        shown = _span(*spans[name], name)
        given = {f"yaxis.{key}": value for key, value in shown.items()}
        buttons.append({"label": f"{name} scale", "method": "relayout", "args": [given]})
    return [_MENU | {"buttons": buttons, "active": int(now == "linear")}]


def _group(data: Sequence[Trace]) -> None:
    """Let what has no name of its own come and go with what looks like it and has one."""
    named = [trace for trace in data if trace["showlegend"]]
    owners = {key: trace for trace in reversed(named) for key in _looks(trace)}
    for number, trace in enumerate(data):
        owner = next((owners[key] for key in _looks(trace) if key in owners), None)
        if trace["showlegend"] or owner is None:
            continue
        trace["legendgroup"] = owner.setdefault("legendgroup", f"group{number}")
        trace["name"] = owner["name"]


def _looks(trace: Trace) -> list[tuple[str, str]]:
    """Return colour and dashes of a trace, then its colour only, both without opacity."""
    if trace["type"] != "scatter":
        return []
    if "lines" in trace["mode"]:
        colour, dash = trace["line"]["color"], str(trace["line"].get("dash", ""))
    else:
        marker = trace["marker"]
        colour, dash = marker.get("line", {}).get("color") or marker["color"], ""
    shade = str(colour).rpartition(",")[0]
    return [(shade, dash), (shade, "")] if dash else [(shade, "")]


def _annotation(text: Text, ax: Axes) -> Trace:
    place = getattr(text, "xy", text.get_position())
    transform = getattr(text, "xycoords", None) or text.get_transform()
    if transform == "data":
        transform = ax.transData
    if not isinstance(transform, Transform):
        raise UndrawableError(f"text in {transform}")
    in_data = transform.contains_branch_seperately(ax.transData)
    height = text.get_verticalalignment()
    entry: Trace = {
        "text": label(text.get_text()),
        "showarrow": False,
        "xanchor": text.get_horizontalalignment(),
        "yanchor": {"baseline": "bottom", "center": "middle"}.get(height, height),
        "font": {"size": 12, "color": "#5a6570"},
    }
    for letter, value, known in zip("xy", place, in_data, strict=True):
        scale = ax.get_xscale() if letter == "x" else ax.get_yscale()
        entry[f"{letter}ref"] = letter if known else f"{letter} domain"
        entry[letter] = log10(value) if known and scale == "log" else float(value)
    return entry


def _words(ax: Axes) -> tuple[str, str]:
    title, x, y = (plain(text) for text in (ax.get_title(), ax.get_xlabel(), ax.get_ylabel()))
    what = f"{y} over {x}" if x and y else x or y
    caption = f"{title}: {what}" if title and what else title or what
    mapped = (one.colorbar for one in (*ax.collections, *ax.images))
    shades = [plain(bar.ax.get_ylabel()) for bar in mapped if bar is not None]
    if any(shades):
        caption += f"; colours: {', '.join(filter(None, shades))}"
    _, names = ax.get_legend_handles_labels()
    curves = f". Drawn: {'; '.join(map(plain, names))}" if names else ""
    return caption, caption + curves


def _json(data: Sequence[Trace], layout: Trace) -> str:
    from plotly.graph_objects import Figure as Interactive

    # plotly checks every entry, and packs the numbers
    figure = json.loads(Interactive(data=list(data), layout=layout).to_json())
    text = json.dumps({"data": figure["data"], "layout": figure["layout"]})
    # nothing in it may end the element of the page it stands in
    for sign in "<>&":
        text = text.replace(sign, f"\\u{ord(sign):04x}")
    return text


def _still(figure: Figure) -> str:
    picture = io.BytesIO()
    figure.savefig(picture, format="png", dpi=150)
    return "data:image/png;base64," + base64.b64encode(picture.getvalue()).decode()
