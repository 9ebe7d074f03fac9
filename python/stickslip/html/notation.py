"""Texts and colours of Matplotlib as plotly writes them, also colours that stand for values."""

from __future__ import annotations

import re
from html import escape
from html.entities import html5
from typing import Any

import numpy as np
from matplotlib import colors

from stickslip.plot.style import UNSEEN
from stickslip.results.fields import Float

_STEPS = 32
_MATH = re.compile(r"(?<!\\)\$([^$]+)\$")
_SHIFT = re.compile(r"([_^])(?:\{([^{}]*)\}|(\w))")
_COMMAND = re.compile(r"\\([A-Za-z]+) ?")
_TAGS = {"_": "sub", "^": "sup"}
# Where names in HTML are other ones than in TeX, and for the prefix micro.
_SIGNS = {"cdot": "·", "infty": "∞", "mu": "µ"}


def label(text: str) -> str:
    """Return a text with formulas such as ``$F_d$`` as plotly shows it.

    Names of anything may stand in it: everything that plotly would take for a tag is escaped.
    """
    marked = _MATH.sub(lambda found: _formula(found[1]), escape(text, quote=False))
    # What stands between dollars plotly takes for a formula too.
    return marked.replace("\\$", "&#36;").replace("\n", "<br>").replace(UNSEEN, "")


def plain(text: str) -> str:
    """Return a text without formulas, for attributes that are read aloud."""
    read = _MATH.sub(lambda found: re.sub(r"[\\{}_]", "", found[1]), text)
    return read.replace("\\$", "$").replace(UNSEEN, "")


def _formula(text: str) -> str:
    def shifted(found: re.Match[str]) -> str:
        tag = _TAGS[found[1]]
        return f"<{tag}>{found[2] or found[3]}</{tag}>"

    def sign(found: re.Match[str]) -> str:
        return _SIGNS.get(found[1]) or html5.get(f"{found[1]};", found[1])

    return _SHIFT.sub(shifted, _COMMAND.sub(sign, text))


def colour_of(value: object, alpha: float | None = None) -> str:
    """Return a colour as CSS writes it."""
    red, green, blue, opacity = colors.to_rgba(value)  # type: ignore[arg-type]
    opacity = opacity if alpha is None else alpha
    return f"rgba({255 * red:.0f},{255 * green:.0f},{255 * blue:.0f},{opacity:.3g})"


def scaled(mapped: Any, values: Float) -> tuple[Float, dict[str, Any]]:
    """Return what the colours of a ScalarMappable stand for, as plotly takes it.

    First the values, or where the norm is not linear what it makes of them, from 0 to 1; then the
    scale of colours, its ends and the bar.
    """
    low, high = mapped.get_clim()
    scale = _scale(mapped.cmap)
    entries: dict[str, Any] = {"colorscale": scale, "cmin": low, "cmax": high, "showscale": False}
    straight = type(mapped.norm) is colors.Normalize
    if not straight:
        values = _normed(mapped, values)
        entries |= {"cmin": 0.0, "cmax": 1.0}
    bar = mapped.colorbar
    if bar is None:
        return values, entries
    axis = bar.ax.yaxis if bar.orientation == "vertical" else bar.ax.xaxis
    title = {"text": label(axis.get_label_text()), "side": "right"}
    shown = {"title": title, "thickness": 14, "outlinewidth": 0}
    # steps stand for cases, whose names only the ticks of the picture know
    if not straight or scale[0][1] == scale[1][1]:
        places: list[float] = []
        texts: list[str] = []
        for minor in (False, True):
            formatter = axis.get_minor_formatter() if minor else axis.get_major_formatter()
            ticks = [float(tick) for tick in bar.get_ticks(minor=minor) if low <= tick <= high]
            named = zip(ticks, formatter.format_ticks(ticks), strict=True)
            for tick, text in named:
                if text:
                    places.append(tick)
                    texts.append(label(text))
        ticks_at: Float = np.array(places, float)
        shown["tickvals"] = ticks_at if straight else _normed(mapped, ticks_at)
        shown["ticktext"] = texts
    return values, entries | {"colorbar": shown, "showscale": True}


def _normed(mapped: Any, values: Float) -> Float:
    numbers: Float = np.ma.filled(
        np.ma.asarray(mapped.norm(np.ma.masked_invalid(values)), float), np.nan
    )
    if isinstance(mapped.norm, colors.BoundaryNorm):
        # it counts colours; their middles are what is drawn
        numbers = (numbers + 0.5) / mapped.cmap.N
    return np.asarray(numbers, dtype=np.float64)


def _scale(shades: Any) -> list[tuple[float, str]]:
    """Return a scale: steps where there are few colours, for these stand for cases."""
    if isinstance(shades, colors.ListedColormap) and shades.N <= _STEPS:
        steps = [(index, edge) for index in range(shades.N) for edge in (index, index + 1)]
        return [(edge / shades.N, colour_of(shades(index))) for index, edge in steps]
    return [(float(at), colour_of(shades(float(at)))) for at in np.linspace(0.0, 1.0, 16)]
