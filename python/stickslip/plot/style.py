"""The looks of every figure: axes, colours, marks, units and number formats."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np
from matplotlib import colormaps, pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogFormatterMathtext, LogLocator, NullFormatter

from stickslip.checks import brief
from stickslip.errors import ModelError
from stickslip.results.arrays import Float
from stickslip.results.stability import STATES, States

OmegaUnit: TypeAlias = Literal["rad/s", "Hz"]
LengthUnit: TypeAlias = Literal["m", "mm", "um", "µm"]
Colour: TypeAlias = tuple[float, float, float, float] | str
Looks: TypeAlias = dict[str, Any]
"""Keywords of Matplotlib."""

RESPONSE, LIMIT = "response", "limit"
"""Group names (gid) by which a figure finds its own lines again."""

GREY, BLUE, ORANGE = "0.45", "#31688e", "#d8863b"
STUCK = (0, (6, 2))
FREE = (0, (1, 1.5))

LINES = {"stable": "-", "unstable": "--", "not decided": ":"}
"""Style of the line by state."""

_SIZE = (6.4, 4.2)
_WIDE = (8.2, 4.2)
_FEW = 6
_PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M"}


class Scale(NamedTuple):
    """A factor from SI to the unit that is drawn, and its label."""

    factor: float
    label: str


OMEGA: dict[str, Scale] = {
    "rad/s": Scale(1.0, "angular frequency ω [rad/s]"),
    "Hz": Scale(0.5 / np.pi, "frequency [Hz]"),
}
LENGTH: dict[str, Scale] = {
    "m": Scale(1.0, "m"),
    "mm": Scale(1e3, "mm"),
    "um": Scale(1e6, "µm"),
    "µm": Scale(1e6, "µm"),
}


def new_axes(ax: Axes | None) -> Axes:
    """Return the given axes, or those of a new figure that `plt.show()` will show."""
    if isinstance(ax, Axes):
        return ax
    if ax is not None:
        raise ModelError(f"ax: {brief(ax)} is not a matplotlib Axes; leave it out for a new figure")
    _, made = pyplot.subplots(figsize=_SIZE, layout="constrained")
    return made


def colours(count: int) -> list[tuple[float, float, float, float]]:
    """Return colours in a perceptual sequence, from dark to light, the palest left out."""
    positions = np.linspace(0.05, 0.85, count) if count > 1 else np.array([0.25])
    return [colormaps["viridis"](float(position)) for position in positions]


def mark(marker: str, size: float, edge: Colour, fill: Colour = "white") -> Looks:
    """Return the looks of single points without a line."""
    return {"ls": "", "marker": marker, "ms": size, "mfc": fill, "mec": edge}


def marks(state: str, colour: Colour) -> Looks:
    """Return how single motions of a state are marked: full and hollow circles, and crosses."""
    fill = {"stable": colour, "unstable": "white", "not decided": "none"}[state]
    return mark("x" if state == "not decided" else "o", 4, colour, fill)


def name_states(ax: Axes, states: Iterable[States], *, single: bool = False) -> None:
    """Name the lines, or the marks of single motions, of the states that occur."""
    occurring = {str(state) for some in states for state in some}
    for state in STATES:
        if state in occurring:
            looks = marks(state, GREY) if single else {"color": GREY, "ls": LINES[state]}
            ax.plot([], [], label=state, **looks)


def pieces(states: States) -> list[tuple[slice, str]]:
    """Return the runs of equal states along a line, each joined to the one before it."""
    if not states.size:
        return []
    breaks = [0, *(np.flatnonzero(states[1:] != states[:-1]) + 1).tolist(), states.size]
    return [(slice(max(start - 1, 0), end), str(states[start])) for start, end in pairwise(breaks)]


def slip_limits(ax: Axes, limit: float, *, lw: float = 0.9, ls: Any = STUCK) -> None:
    """Draw the forces at which a contact slips, in either direction."""
    for side in (-limit, limit):
        ax.axhline(side, color=GREY, lw=lw, ls=ls, zorder=1.5)


def linear_limit(*, stuck: bool, of: str = "") -> Looks:
    """Return the looks of a linear response with all contacts stuck, or with none."""
    label, ls = (f"stuck (linear{of})", STUCK) if stuck else (f"free (linear{of})", FREE)
    return {"color": GREY, "lw": 1.1, "ls": ls, "label": label, "zorder": 1.5, "gid": LIMIT}


def unit_circle(ax: Axes) -> None:
    """Draw the circle inside which Floquet multipliers are stable, and name the axes."""
    turn = np.exp(2j * np.pi * np.linspace(0.0, 1.0, 361))
    ax.plot(turn.real, turn.imag, color=GREY, lw=0.9, zorder=1.5)
    ax.set_aspect("equal")
    ax.set(xlabel="real part of the multiplier", ylabel="imaginary part")


def bare(ax: Axes) -> None:
    """Put a grid behind everything, and leave the frame open."""
    ax.grid(visible=True, which="major", color="0.9", lw=0.7)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)


def finish(ax: Axes, *, made: bool) -> None:
    """Put grid, frame and, where there is something to tell apart, a legend on the axes.

    On a figure of ours (`made`) the legend stands outside and hides no curve. On axes of others it
    does so if it is long and their layout makes room for it.
    """
    bare(ax)
    handles, _ = ax.get_legend_handles_labels()
    if len(handles) < 2:
        return
    looks: Looks = {"frameon": False, "fontsize": "small", "handlelength": 2.4}
    outside = looks | {"borderaxespad": 0.0}
    figure = ax.figure
    roomy = made or isinstance(figure.get_layout_engine(), ConstrainedLayoutEngine)
    long = len(handles) > _FEW
    if not made and not (roomy and long):
        ax.legend(**looks | {"frameon": True, "framealpha": 0.85, "edgecolor": "none"})
    elif long or ax.get_title():
        ax.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), **outside)
        if made and isinstance(figure, Figure):
            figure.set_size_inches(_WIDE)
    else:
        place: Looks = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.01)}
        ax.legend(**place, ncols=3, columnspacing=1.4, **outside)


def fit(ax: Axes, *, log: bool) -> None:
    """Scale and frame the responses: antiresonances, and limits on a linear axis, may leave it."""
    responses, everything = _drawn(ax, [RESPONSE]), _drawn(ax, [RESPONSE, LIMIT])
    abscissae = np.concatenate([np.asarray(line.get_xdata(), float) for line in responses])
    if abscissae.min() < abscissae.max():
        ax.set_xlim(abscissae.min(), abscissae.max())
    values, tops = _positive(responses), _positive(everything)
    ax.set_yscale("log" if log and values.size else "linear")
    if not values.size:
        return
    if log:
        ax.set_ylim(0.6 * max(values.min(), 1e-6 * values.max()), 1.6 * tops.max())
        _number_decades(ax)
    else:
        ax.set_ylim(0.0, 1.15 * values.max())


def prefixed(value: float, unit: str) -> str:
    """Return a number with three digits and the SI prefix that suits it."""
    if value == 0.0 or not np.isfinite(value):
        return f"{value:g} {unit}"
    exponent = int(np.clip(3 * np.floor(np.log10(abs(value)) / 3), -9, 6))
    return f"{value / 10.0**exponent:.3g} {_PREFIXES[exponent]}{unit}"


def _number_decades(ax: Axes) -> None:
    """Write plain numbers on a logarithmic axis, and some between the decades if there are few."""
    low, high = ax.get_ylim()
    plain = low > 1e-4 and high < 1e5
    written = FuncFormatter(lambda value, _: f"{value:g}") if plain else LogFormatterMathtext()
    between = plain and np.log10(high / low) < 2.5
    ax.yaxis.set_major_formatter(written)
    ax.yaxis.set_minor_formatter(written if between else NullFormatter())
    if between:
        ax.yaxis.set_minor_locator(LogLocator(subs=(2.0, 5.0)))


def _drawn(ax: Axes, groups: Sequence[str]) -> list[Line2D]:
    return [line for line in ax.lines if line.get_gid() in groups]


def _positive(lines: Sequence[Line2D]) -> Float:
    values: Float = np.concatenate([np.asarray(line.get_ydata(), float) for line in lines])
    return values[np.isfinite(values) & (values > 0.0)]
