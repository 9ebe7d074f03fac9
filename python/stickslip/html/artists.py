"""What Matplotlib has drawn, as traces of plotly."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from matplotlib import collections, colors, container, image, lines, patches
from matplotlib.artist import Artist
from matplotlib.axes import Axes

from stickslip.html.colours import colour_of, scaled
from stickslip.html.labels import label
from stickslip.results.arrays import Float

__all__ = ["Trace", "UndrawableError", "proxy", "traces"]

Trace: TypeAlias = dict[str, Any]

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
_HOVER = "%{x:.6g}, %{y:.6g}"


class UndrawableError(Exception):
    """An artist has no counterpart; the picture can only be shown as it is."""


@dataclass(frozen=True)
class Place:
    """The names of the axes of plotly on which something is drawn."""

    x: str
    y: str
    fraction: str
    """The vertical axis from 0 to 1 over the same frame."""

    def on(self, y: str | None = None) -> Trace:
        """Return the entries of a trace that say where it is drawn."""
        return {"xaxis": self.x, "yaxis": y or self.y}


def traces(ax: Axes, place: Place) -> Iterator[Trace]:
    """Give everything drawn on axes, from back to front.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        The axes.
    place : Place
        Where it goes.

    Raises
    ------
    UndrawableError
        If something has no counterpart.
    """
    rows = [one for one in ax.containers if isinstance(one, container.BarContainer)]
    bars = {id(bar): one for one in rows for bar in one.patches}
    drawn = [*ax.lines, *ax.collections, *ax.patches, *ax.images]
    for artist in sorted(drawn, key=lambda one: one.get_zorder()):
        if not artist.get_visible():
            continue
        if id(artist) in bars:
            whole = bars[id(artist)]
            if whole.patches[0] is artist:
                yield _bar(whole) | place.on()
            continue
        yield from _trace(artist, ax, place)


def _trace(artist: Artist, ax: Axes, place: Place) -> Iterator[Trace]:
    match artist:
        case lines.Line2D():
            yield from _line(artist, ax, place)
        case collections.LineCollection():
            yield _segments(artist) | place.on()
        case collections.PathCollection():
            yield _cloud(artist) | place.on()
        case collections.QuadMesh():
            yield _mesh(artist) | place.on()
        case collections.PolyCollection():
            yield _areas(artist) | place.on()
        case image.AxesImage():
            yield _image(artist) | place.on()
        case patches.Polygon() | patches.Rectangle():
            yield _polygon(artist) | place.on()
        case _:
            raise UndrawableError(type(artist).__name__)


def proxy(handle: Artist, name: str) -> Trace:
    """Return the entry of a legend that belongs to no artist on the axes."""
    entry: Trace = {"type": "scatter", "x": [None], "y": [None], "name": label(name)}
    entry |= {"showlegend": True, "xaxis": "x", "yaxis": "y"}
    match handle:
        case lines.Line2D() if handle.get_linestyle() not in ("None", "", " "):
            line = {"color": colour_of(handle.get_color()), "dash": _dash(handle)}
            return entry | {"mode": "lines", "line": line}
        case lines.Line2D():
            return entry | {"mode": "markers", "marker": _marker(handle, str(handle.get_marker()))}
        case patches.Patch():
            shade = colour_of(handle.get_facecolor())
            marker = {"symbol": "square", "size": 12, "color": shade, "line": {"color": shade}}
            return entry | {"mode": "markers", "marker": marker}
        case _:
            raise UndrawableError(f"{type(handle).__name__} in a legend")


def _numbers(values: Any) -> Float:
    """Return an array in which what is masked out is not-a-number."""
    return np.asarray(np.ma.filled(np.ma.asarray(values, float), np.nan), dtype=np.float64)


def _name(artist: Artist | container.Container) -> Trace:
    text = str(artist.get_label())
    if not text or text.startswith("_"):
        return {"showlegend": False}
    return {"name": label(text), "showlegend": True}


def _line(line: lines.Line2D, ax: Axes, place: Place) -> Iterator[Trace]:
    x, y = (_numbers(data) for data in line.get_data(orig=False))
    in_x, in_y = line.get_transform().contains_branch_seperately(ax.transData)
    if not x.size:
        return
    if not (in_x or in_y):
        raise UndrawableError("line in the units of the frame")
    if not in_x:
        # a level: from side to side of the frame
        low, high = ax.get_xlim()
        x = low + (high - low) * x
    x, y = _thinned(x, y)
    trace: Trace = {"type": "scatter", "x": x, "y": y, "hovertemplate": _HOVER} | _name(line)
    trace |= place.on(None if in_y else place.fraction)
    modes = []
    colour = colour_of(line.get_color(), line.get_alpha())
    if line.get_linestyle() not in ("None", "", " "):
        modes.append("lines")
        trace["line"] = {
            "color": colour,
            "width": _PIXELS * line.get_linewidth(),
            "dash": _dash(line),
        }
    marker = line.get_marker()
    if marker not in (None, "", " ", "None", "none"):
        modes.append("markers")
        trace["marker"] = _marker(line, str(marker))
    if not modes:
        return
    if not in_x:
        trace["hoverinfo"] = "skip"
        del trace["hovertemplate"]
    yield trace | {"mode": "+".join(modes)}


def _marker(line: lines.Line2D, marker: str) -> Trace:
    if marker not in _MARKERS:
        raise UndrawableError(f"marker {marker}")
    symbol = _MARKERS[marker]
    face, edge = line.get_markerfacecolor(), line.get_markeredgecolor()
    hollow = colors.to_rgba(face)[3] == 0.0
    size = line.get_markersize() * (0.5 if marker == "." else 1.0)
    return {
        "symbol": f"{symbol}-open" if hollow or symbol in _THIN else symbol,
        "size": _PIXELS * size,
        "color": colour_of(edge if hollow or symbol in _THIN else face),
        "line": {"color": colour_of(edge), "width": _PIXELS * line.get_markeredgewidth()},
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


def _segments(collection: collections.LineCollection) -> Trace:
    gap = np.full((1, 2), np.nan)
    parts = [part for one in collection.get_segments() for part in (np.asarray(one, float), gap)]
    points: Float = np.concatenate([*parts, gap])
    return {
        "type": "scatter",
        "mode": "lines",
        "x": points[:, 0],
        "y": points[:, 1],
        "line": {
            "color": colour_of(collection.get_colors()[0]),
            "width": _PIXELS * float(np.atleast_1d(collection.get_linewidth())[0]),
        },
        "hoverinfo": "skip",
    } | _name(collection)


def _cloud(cloud: collections.PathCollection) -> Trace:
    points = _numbers(cloud.get_offsets())
    sizes = np.sqrt(np.asarray(cloud.get_sizes(), float))
    marker: Trace = {"size": _PIXELS * (float(sizes[0]) if sizes.size == 1 else sizes)}
    trace: Trace = {
        "type": "scatter",
        "mode": "markers",
        "x": points[:, 0],
        "y": points[:, 1],
        "marker": marker,
        "hovertemplate": _HOVER,
    } | _name(cloud)
    values = cloud.get_array()
    if values is not None:
        known = _numbers(values)
        shown, scale = scaled(cloud, known)
        marker |= {"color": shown} | scale
        return trace | {"customdata": known, "hovertemplate": _HOVER + ": %{customdata:.6g}"}
    faces, edges = cloud.get_facecolor(), cloud.get_edgecolor()
    hollow = not len(faces)
    shades = edges if hollow else faces
    marker["color"] = (
        [colour_of(one) for one in shades] if len(shades) > 1 else colour_of(shades[0])
    )
    marker["symbol"] = "circle-open" if hollow else "circle"
    return trace


def _mesh(mesh: collections.QuadMesh) -> Trace:
    corners: Float = np.asarray(mesh.get_coordinates(), float)
    values = _numbers(mesh.get_array())
    x, y = corners[0, :, 0], corners[:, 0, 1]
    if not (np.allclose(corners[..., 0], x) and np.allclose(corners[..., 1].T, y)):
        raise UndrawableError("a mesh that is not rectangular")
    if values.ndim != 2:
        values = values.reshape(y.size - 1, x.size - 1)
    return _heat(mesh, x, y, values)


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


def _areas(collection: collections.PolyCollection) -> Trace:
    gap = np.full((1, 2), np.nan)
    parts = [
        part for path in collection.get_paths() for part in (np.asarray(path.vertices, float), gap)
    ]
    return _area(np.concatenate(parts), collection.get_facecolor()[0]) | _name(collection)


def _polygon(patch: patches.Polygon | patches.Rectangle) -> Trace:
    outline = patch.get_path().transformed(patch.get_patch_transform())
    trace = _area(np.asarray(outline.vertices, float), patch.get_facecolor())
    if not patch.get_fill():
        trace |= {"fill": "none"}
    edge = {"color": colour_of(patch.get_edgecolor()), "width": _PIXELS * patch.get_linewidth()}
    return trace | {"line": edge} | _name(patch)


def _area(points: Float, colour: object) -> Trace:
    return {
        "type": "scatter",
        "mode": "lines",
        "x": points[:, 0],
        "y": points[:, 1],
        "fill": "toself",
        "fillcolor": colour_of(colour),
        "line": {"width": 0, "color": colour_of(colour)},
        "hoverinfo": "skip",
    }


def _bar(bars: container.BarContainer) -> Trace:
    across = bars.orientation == "horizontal"
    places, heights, widths, bases = [], [], [], []
    for bar in bars.patches:
        x, y, width, height = bar.get_x(), bar.get_y(), bar.get_width(), bar.get_height()
        if across:
            x, y, width, height = y, x, height, width
        places.append(x + 0.5 * width)
        heights.append(height)
        widths.append(width)
        bases.append(y)
    colours = [colour_of(bar.get_facecolor()) for bar in bars.patches]
    first = bars.patches[0]
    return {
        "type": "bar",
        "orientation": "h" if across else "v",
        "y" if across else "x": np.array(places, float),
        "x" if across else "y": np.array(heights, float),
        "width": np.array(widths, float),
        "base": np.array(bases, float),
        "marker": {
            "color": colours[0] if len(set(colours)) == 1 else colours,
            "line": {
                "color": colour_of(first.get_edgecolor()),
                "width": _PIXELS * first.get_linewidth()
                if colors.to_rgba(first.get_edgecolor())[3]
                else 0,
            },
        },
        "hovertemplate": _HOVER,
    } | _name(first if str(bars.get_label()).startswith("_") else bars)


def _thinned(x: Float, y: Float) -> tuple[Float, Float]:
    """Keep the extremes of every stretch of a long history: a page has no use for more."""
    if x.size <= _MOST or not (np.diff(x) > 0.0).all():
        return x, y
    stretches = np.array_split(np.arange(x.size), _MOST // 2)
    known = np.nan_to_num(y)
    kept = [{s[0] + int(known[s].argmin()), s[0] + int(known[s].argmax())} for s in stretches]
    places = np.unique([place for pair in kept for place in pair] + [0, x.size - 1])
    return x[places], y[places]
