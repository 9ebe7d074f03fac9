"""What Matplotlib has drawn, as traces of plotly."""

from __future__ import annotations

from collections.abc import Iterator
from functools import singledispatch
from typing import Any, TypeAlias

import numpy as np
from matplotlib import collections, colors, container, image, lines, patches
from matplotlib.artist import Artist
from matplotlib.axes import Axes

from stickslip.html.notation import colour_of, label, scaled
from stickslip.results.fields import Float

Trace: TypeAlias = dict[str, Any]

_FRACTION = "y3"
"""The vertical axis from 0 to 1 over the frame, `yaxis3` of a layout."""

_PIXELS = 4.0 / 3.0
"""Per point: 96 in an inch instead of 72."""
_MOST = 20_000
_MARKERS = {
    "o": "circle",
    ".": "circle",
    "x": "x-thin",
    "+": "cross-thin",
    "*": "star",
    "s": "square",
    "D": "diamond",
    "d": "diamond-tall",
    "^": "triangle-up",
    "v": "triangle-down",
    "<": "triangle-left",
    ">": "triangle-right",
    "|": "line-ns",
    "_": "line-ew",
}
_THIN = ("x-thin", "cross-thin", "line-ns", "line-ew")
_NOTHING = ("None", "none", "", " ")
_HOVER = "%{x:.6g}, %{y:.6g}"
_GAP = np.full((1, 2), np.nan)


class UndrawableError(Exception):
    """An artist has no counterpart; the picture can only be shown as it is."""


def traces(ax: Axes, y: str) -> Iterator[Trace]:
    """Give everything drawn on axes, from back to front, for plotly's vertical axis `y`.

    `UndrawableError` says that something has no counterpart.
    """
    rows = [one for one in ax.containers if isinstance(one, container.BarContainer)]
    bars = {id(bar): one for one in rows for bar in one.patches}
    # Of values with bars to their sides the container has the name.
    owners = {
        id(_bearer(one)): one
        for one in ax.containers
        if isinstance(one, container.ErrorbarContainer)
    }
    drawn = [*ax.lines, *ax.collections, *ax.patches, *ax.images]
    for artist in sorted(drawn, key=lambda one: one.get_zorder()):
        whole = bars.get(id(artist))
        if not artist.get_visible() or (whole and whole.patches[0] is not artist):
            continue
        trace = _bar(whole) if whole else _trace(artist)
        if trace:
            named = _name(owners[id(artist)]) if id(artist) in owners else {}
            yield {"xaxis": "x", "yaxis": y} | trace | named


def _bearer(bars: container.ErrorbarContainer) -> Artist:
    """Return what bears the name of bars: their values, or the first bars if none are drawn."""
    line, _, sides = bars.lines
    if line and not {line.get_linestyle(), str(line.get_marker())} <= set(_NOTHING):
        return line
    return sides[0]


def proxy(handle: Artist, name: str) -> Trace:
    """Return the entry of a legend that belongs to no artist on the axes."""
    match handle:
        case lines.Line2D() if handle.get_linestyle() not in _NOTHING:
            line = {"color": colour_of(handle.get_color()), "dash": _dash(handle)}
            looks: Trace = {"mode": "lines", "line": line}
        case lines.Line2D():
            looks = {"mode": "markers", "marker": _marker(handle)}
        case patches.Patch():
            shade = colour_of(handle.get_facecolor())
            square = {"symbol": "square", "size": 12, "color": shade, "line": {"color": shade}}
            looks = {"mode": "markers", "marker": square}
        case _:
            raise UndrawableError(f"{type(handle).__name__} in a legend")
    place = {"x": [None], "y": [None], "xaxis": "x", "yaxis": "y"}
    return {"type": "scatter", "name": label(name), "showlegend": True} | place | looks


@singledispatch
def _trace(artist: Artist) -> Trace:
    """Return the trace of an artist; an empty one if nothing of it is seen."""
    raise UndrawableError(type(artist).__name__)


@_trace.register
def _line(line: lines.Line2D) -> Trace:
    ax = line.axes
    x, y = (_numbers(data) for data in line.get_data(orig=False))
    styled, marked = line.get_linestyle() not in _NOTHING, str(line.get_marker()) not in _NOTHING
    if ax is None or not x.size or not (styled or marked):
        return {}
    in_x, in_y = line.get_transform().contains_branch_seperately(ax.transData)
    if not (in_x or in_y):
        raise UndrawableError("line in the units of the frame")
    looks: Trace = {"hovertemplate": _HOVER}
    if not in_x:
        # a level: from side to side of the frame
        low, high = ax.get_xlim()
        x, looks = low + (high - low) * x, {"hoverinfo": "skip"}
    if not in_y:
        looks["yaxis"] = _FRACTION
    if styled:
        colour = colour_of(line.get_color(), line.get_alpha())
        width = _PIXELS * line.get_linewidth()
        looks["line"] = {"color": colour, "width": width, "dash": _dash(line)}
    if marked:
        looks["marker"] = _marker(line)
    mode = "+".join(["lines"] * styled + ["markers"] * marked)
    return _scatter(line, *_thinned(x, y), mode=mode, **looks)


@_trace.register
def _segments(collection: collections.LineCollection) -> Trace:
    parts = [part for one in collection.get_segments() for part in (np.asarray(one, float), _GAP)]
    points: Float = np.concatenate([*parts, _GAP])
    width = _PIXELS * float(np.atleast_1d(collection.get_linewidth())[0])
    line = {"color": colour_of(collection.get_colors()[0]), "width": width}
    return _scatter(collection, *points.T, mode="lines", line=line, hoverinfo="skip")


@_trace.register
def _cloud(cloud: collections.PathCollection) -> Trace:
    points = _numbers(cloud.get_offsets())
    sizes = np.sqrt(np.asarray(cloud.get_sizes(), float))
    marker: Trace = {"size": _PIXELS * (float(sizes[0]) if sizes.size == 1 else sizes)}
    values = cloud.get_array()
    if values is not None:
        known = _numbers(values)
        marker["color"], scale = scaled(cloud, known)
        hover: Trace = {"customdata": known, "hovertemplate": _HOVER + ": %{customdata:.6g}"}
        return _scatter(cloud, *points.T, mode="markers", marker=marker | scale, **hover)
    faces, edges = cloud.get_facecolor(), cloud.get_edgecolor()
    shades = [colour_of(one) for one in (faces if len(faces) else edges)]
    marker["color"] = shades if len(shades) > 1 else shades[0]
    marker["symbol"] = "circle" if len(faces) else "circle-open"
    return _scatter(cloud, *points.T, mode="markers", marker=marker, hovertemplate=_HOVER)


@_trace.register
def _mesh(mesh: collections.QuadMesh) -> Trace:
    corners: Float = np.asarray(mesh.get_coordinates(), float)
    x, y = corners[0, :, 0], corners[:, 0, 1]
    if not (np.allclose(corners[..., 0], x) and np.allclose(corners[..., 1].T, y)):
        raise UndrawableError("a mesh that is not rectangular")
    return _heat(mesh, x, y, _numbers(mesh.get_array()).reshape(y.size - 1, x.size - 1))


@_trace.register
def _image(shown: image.AxesImage) -> Trace:
    values = _numbers(shown.get_array())
    if values.ndim != 2:
        raise UndrawableError("an image of true colours")
    left, right, bottom, top = shown.get_extent()
    if shown.origin == "upper":
        bottom, top = top, bottom
    rows, columns = values.shape
    x, y = np.linspace(left, right, columns + 1), np.linspace(bottom, top, rows + 1)
    return _heat(shown, x, y, values)


@_trace.register
def _areas(collection: collections.PolyCollection) -> Trace:
    outlines = [np.asarray(path.vertices, float) for path in collection.get_paths()]
    points = np.concatenate([part for one in outlines for part in (one, _GAP)])
    return _area(collection, points, collection.get_facecolor()[0])


@_trace.register(patches.Polygon)
@_trace.register(patches.Rectangle)
def _polygon(patch: patches.Polygon | patches.Rectangle) -> Trace:
    outline = patch.get_path().transformed(patch.get_patch_transform())
    trace = _area(patch, np.asarray(outline.vertices, float), patch.get_facecolor())
    if not patch.get_fill():
        trace["fill"] = "none"
    edge = {"color": colour_of(patch.get_edgecolor()), "width": _PIXELS * patch.get_linewidth()}
    return trace | {"line": edge}


def _bar(bars: container.BarContainer) -> Trace:
    along, across = ("y", "x") if bars.orientation == "horizontal" else ("x", "y")
    first = bars.patches[0]
    edge = colors.to_rgba(first.get_edgecolor())
    shades = [colour_of(bar.get_facecolor()) for bar in bars.patches]
    boxes = [(bar.get_xy(), (bar.get_width(), bar.get_height())) for bar in bars.patches]
    start, size = np.moveaxis(np.array(boxes, float), 0, -1)
    if along == "y":
        start, size = start[::-1], size[::-1]
    return {
        "type": "bar",
        "orientation": "h" if along == "y" else "v",
        along: start[0] + 0.5 * size[0],
        across: size[1],
        "width": size[0],
        "base": start[1],
        "marker": {
            "color": shades[0] if len(set(shades)) == 1 else shades,
            "line": {
                "color": colour_of(edge),
                "width": _PIXELS * first.get_linewidth() if edge[3] else 0,
            },
        },
        "hovertemplate": _HOVER,
    } | _name(first if str(bars.get_label()).startswith("_") else bars)


def _scatter(artist: Artist, x: Float, y: Float, **looks: Any) -> Trace:
    return {"type": "scatter", "x": x, "y": y} | _name(artist) | looks


def _area(artist: Artist, points: Float, colour: object) -> Trace:
    shade = colour_of(colour)
    line = {"width": 0, "color": shade}
    fill: Trace = {"fill": "toself", "fillcolor": shade, "line": line, "hoverinfo": "skip"}
    return _scatter(artist, *points.T, mode="lines", **fill)


def _heat(mapped: Any, x: Float, y: Float, values: Float) -> Trace:
    shown, scale = scaled(mapped, values)
    return {
        "type": "heatmap",
        "x": x,
        "y": y,
        "z": shown,
        "zmin": scale.pop("cmin"),
        "zmax": scale.pop("cmax"),
        "customdata": values,
        "hovertemplate": "%{x:.5g}, %{y:.5g}: %{customdata:.5g}<extra></extra>",
        "showlegend": False,
    } | scale


def _name(artist: Artist | container.Container) -> Trace:
    text = str(artist.get_label())
    if not text or text.startswith("_"):
        return {"showlegend": False}
    return {"name": label(text), "showlegend": True}


def _marker(line: lines.Line2D) -> Trace:
    marker = str(line.get_marker())
    if marker not in _MARKERS:
        raise UndrawableError(f"marker {marker}")
    symbol, face = _MARKERS[marker], line.get_markerfacecolor()
    edge = colour_of(line.get_markeredgecolor())
    hollow = colors.to_rgba(face)[3] == 0.0 or symbol in _THIN
    return {
        "symbol": f"{symbol}-open" if hollow else symbol,
        "size": _PIXELS * line.get_markersize() * (0.5 if marker == "." else 1.0),
        "color": edge if hollow else colour_of(face),
        "line": {"color": edge, "width": _PIXELS * line.get_markeredgewidth()},
    }


def _dash(line: lines.Line2D) -> str:
    # Matplotlib tells "--" for every pattern of its own; the pattern itself has no public name
    _, pattern = line._unscaled_dash_pattern  # type: ignore[attr-defined]
    if not pattern:
        return "solid"
    if line.get_linestyle() in (":", "-."):
        return {":": "dot", "-.": "dashdot"}[str(line.get_linestyle())]
    unit = _PIXELS * line.get_linewidth()
    return ",".join(f"{max(unit * length, 1.0):.3g}px" for length in pattern)


def _numbers(values: Any) -> Float:
    """Return an array in which what is masked out is not-a-number."""
    return np.asarray(np.ma.filled(np.ma.asarray(values, float), np.nan), dtype=np.float64)


def _thinned(x: Float, y: Float) -> tuple[Float, Float]:
    """Keep the extremes of every stretch of a long history: a page has no use for more."""
    if x.size <= _MOST or not (np.diff(x) > 0.0).all():
        return x, y
    stretches = np.array_split(np.arange(x.size), _MOST // 2)
    known = np.nan_to_num(y)
    kept = [{s[0] + int(known[s].argmin()), s[0] + int(known[s].argmax())} for s in stretches]
    places = np.unique([place for pair in kept for place in pair] + [0, x.size - 1])
    return x[places], y[places]
