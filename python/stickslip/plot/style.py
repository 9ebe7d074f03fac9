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
from matplotlib.ticker import (
    Formatter,
    FuncFormatter,
    LogFormatterMathtext,
    LogLocator,
    MaxNLocator,
    NullFormatter,
    NullLocator,
)

from stickslip.checks import brief
from stickslip.disk.bladed_disk import rotor_order
from stickslip.errors import ModelError
from stickslip.results.fields import Bool, Float
from stickslip.results.stability import STATES, States

OmegaUnit: TypeAlias = Literal["rad/s", "Hz", "rpm"]
LengthUnit: TypeAlias = Literal["auto", "m", "mm", "um", "µm"]
Colour: TypeAlias = tuple[float, float, float, float] | str
Looks: TypeAlias = dict[str, Any]
"""Keywords of Matplotlib."""

RESPONSE, LIMIT = "response", "limit"
"""Group names (gid) by which a figure finds its own lines again."""

UNSEEN = "\u200b"
"""A space without a width, before names that begin with an underscore."""

GREY, BLUE, ORANGE = "0.45", "#31688e", "#d8863b"
STUCK = (0, (6, 2))
FREE = (0, (1, 1.5))

LINES = {"stable": "-", "unstable": "--", "not decided": ":"}
"""Style of the line by state."""

_SIZE = (6.4, 4.2)
_WIDE = (8.2, 4.2)
_FEW = 6
_FEW_DECADES = 2.5
_STEPS = 5
_PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
_LENGTHS = ("m", "m/N", "m/s")
_PREFIXED = (*_LENGTHS, "N", "N/m", "J", "W")
"""Units of axes that get a prefix."""


class Scale(NamedTuple):
    """A factor from SI to the unit that is drawn, and its label."""

    factor: float
    label: str
    order: float = 0
    """Engine order of the forces, if it is a rotor speed that is drawn."""


_ROTOR, _ABOVE = "rotor speed", "above"
"""What an axis shows, and the name (gid) of the one above, where no legend can stand."""

OMEGA: dict[str, Scale] = {
    "rad/s": Scale(1.0, "angular frequency ω [rad/s]"),
    "Hz": Scale(0.5 / np.pi, "frequency [Hz]"),
    "rpm": Scale(30.0 / np.pi, "frequency [rpm]"),
}


def omega_scale(unit: OmegaUnit, results: Any) -> Scale:
    """Return the unit of the frequencies of one or several results.

    Of a disk rpm are those of the rotor: the frequency over the engine order.
    """
    models = [one.model for one in (results if isinstance(results, Iterable) else [results])]
    orders = {rotor_order(model) for model in models}
    order = orders.pop() if len(orders) == 1 else 0
    if unit != "rpm" or not order:
        return OMEGA[unit]
    return rotor_speed(order)


def rotor_speed(order: float | None, unit: OmegaUnit = "rpm") -> Scale:
    """Return the scale of frequencies of an engine order drawn over the speed of the rotor.

    None are several orders.
    """
    factor = OMEGA[unit].factor
    if order is None:
        return Scale(factor, f"{_ROTOR} [{unit}]")
    return Scale(factor / order, f"{_ROTOR} at engine order {order:g} [{unit}]", order)


def omega_scales(unit: OmegaUnit, results: Sequence[Any]) -> tuple[Scale, list[Scale]]:
    """Return the scale of the axis of several results, and that of each.

    Of disks under several engine orders the rotor speed of each is its frequency over its order.
    """
    each = [omega_scale(unit, one) for one in results]
    orders = {one.order for one in each}
    if len(orders) == 1:
        return each[0], each
    if 0 in orders:
        return OMEGA[unit], [OMEGA[unit]] * len(each)
    return rotor_speed(None), each


def label_omega(ax: Axes, omega: Scale) -> None:
    """Write what the axis of frequencies shows; over rotor speeds stand the frequencies."""
    ax.set_xlabel(omega.label)
    if omega.order:
        per_hertz = omega.factor / OMEGA["Hz"].factor

        def hertz(x: Any) -> Any:
            return x / per_hertz

        above = ax.secondary_xaxis("top", functions=(hertz, lambda x: per_hertz * np.asarray(x)))
        above.set(xlabel="frequency [Hz]", gid=_ABOVE)


LENGTH: dict[str, Scale] = {
    "auto": Scale(1.0, "m"),
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


def named(text: str) -> str:
    """Return a name of the user as Matplotlib is to write it.

    It takes what stands between dollars for a formula, and hides what begins with an underscore
    from legends.
    """
    text = text.replace("$", r"\$")
    return f"{UNSEEN}{text}" if text.startswith("_") else text


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


def pieces(states: States, begins: Bool | None = None) -> list[tuple[slice, str]]:
    """Return the runs of equal states along a line, each joined to the one before it.

    But for those at which another line `begins`.
    """
    if not states.size:
        return []
    apart = np.zeros(states.size, np.bool_) if begins is None else begins
    changes = (states[1:] != states[:-1]) | apart[1:]
    breaks = [0, *(np.flatnonzero(changes) + 1).tolist(), states.size]
    return [
        (slice(start if apart[start] else max(start - 1, 0), end), str(states[start]))
        for start, end in pairwise(breaks)
    ]


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


def finish(ax: Axes, *, made: bool, lengths: bool = True) -> None:
    """Put prefixes, grid, frame and, where there is something to tell apart, a legend on the axes.

    Lengths get a prefix unless their unit was named.

    On a figure of ours (`made`) the legend stands outside and hides no curve. On axes of others it
    does so if it is long and their layout makes room for it.
    """
    bare(ax)
    prefix_axes(ax, lengths=lengths)
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
    elif long or ax.get_title() or any(one.get_gid() == _ABOVE for one in ax.child_axes):
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


def prefixed(value: float, unit: str, digits: int = 3) -> str:
    """Return a number with three digits and the SI prefix that suits it."""
    if value == 0.0 or not np.isfinite(value):
        return f"{value:g} {unit}"
    exponent = _exponent(value)
    return f"{value / 10.0**exponent:.{digits}g} {_PREFIXES[exponent]}{unit}"


def written(value: float, unit: str) -> str:
    """Return a number with four digits and its unit, with a prefix where units take one."""
    if unit in _PREFIXED:
        return prefixed(value, unit, 4)
    return f"{value:.4g} {unit}".rstrip()


def unit_of(label: str) -> str:
    """Return the unit at the end of the label of an axis, "" if there is none."""
    _, between, unit = label.rpartition(" [")
    return unit.rstrip("]") if between else ""


def _exponent(value: float) -> int:
    return int(np.clip(3 * np.floor(np.log10(abs(value)) / 3), -9, 9))


def prefix_of(value: float, unit: str) -> Scale:
    """Return the factor and the unit with the SI prefix that suit a largest value."""
    exponent = _exponent(value) if value and np.isfinite(value) else 0
    return Scale(10.0**-exponent, f"{_PREFIXES[exponent]}{unit}")


def scale_of(value: float, unit: str) -> Scale:
    """Return the factor and the unit that suit a largest value, with a prefix if it takes one."""
    return prefix_of(value, unit) if unit in _PREFIXED else Scale(1.0, unit)


class Prefixed(Formatter):
    """Writes the numbers of an axis in its unit with a prefix; what is drawn stays in SI."""

    def __init__(self, factor: float, *, powers: bool = False) -> None:
        self.factor = factor
        self._powers = LogFormatterMathtext() if powers else None

    def __call__(self, x: float, pos: int | None = None) -> str:
        """Return a number as it is written."""
        value = self.factor * x
        return f"{value:.6g}" if self._powers is None else self._powers(value, pos)

    def set_axis(self, axis: Any) -> None:
        """Take the axis."""
        super().set_axis(axis)
        if self._powers is not None:
            self._powers.create_dummy_axis()


def prefix_axes(ax: Axes, *, lengths: bool) -> None:
    """Write forces, stiffnesses and, if asked, lengths with the prefix that suits the data."""
    axes = ((ax.xaxis, ax.get_xlim()), (ax.yaxis, ax.get_ylim()))
    labels = [axis.get_label_text() for axis, _ in axes]
    units = [unit_of(label) for label in labels]
    for (axis, ends), label, unit in zip(axes, labels, units, strict=True):
        if unit not in _PREFIXED or (unit in _LENGTHS and not lengths):
            continue
        # Both axes of one plane have one unit.
        reach = [
            end for (_, both), one in zip(axes, units, strict=True) if one == unit for end in both
        ]
        reached = (1.0 - 1e-9) * max(map(abs, reach))
        if axis is ax.xaxis and axis.get_scale() == "log":
            # A parameter is varied by factors about its middle.
            reached = float(np.sqrt(np.prod(ends)))
        scale = prefix_of(reached, unit)
        if scale.factor == 1.0:
            continue
        low, high = sorted(scale.factor * end for end in ends)
        powers = axis.get_scale() == "log" and not (low > 1e-4 and high < 1e5)
        axis.set_label_text(f"{label.removesuffix(f'[{unit}]')}[{scale.label}]")
        axis.set_major_formatter(Prefixed(scale.factor, powers=powers))
        if axis.get_scale() == "log":
            few = not powers and np.log10(high / low) < _FEW_DECADES
            axis.set_minor_formatter(Prefixed(scale.factor) if few else NullFormatter())
            if few:
                _number_between(axis, low, high)


def number_bar(ax: Axes) -> None:
    """Write plain numbers beside a logarithmic bar of colours."""
    written = FuncFormatter(lambda value, _: f"{value:g}")
    ax.yaxis.set_major_formatter(written)
    ax.yaxis.set_minor_locator(LogLocator(subs=(2.0, 5.0)))
    ax.yaxis.set_minor_formatter(written)


def _number_decades(ax: Axes) -> None:
    """Write plain numbers on a logarithmic axis, and some between the decades if there are few."""
    low, high = ax.get_ylim()
    plain = (low > 1e-4 and high < 1e5) or high < 10.0 * low
    written = FuncFormatter(lambda value, _: f"{value:g}") if plain else LogFormatterMathtext()
    between = plain and np.log10(high / low) < _FEW_DECADES
    ax.yaxis.set_major_formatter(written)
    ax.yaxis.set_minor_formatter(written if between else NullFormatter())
    if between:
        _number_between(ax.yaxis, low, high)


def _number_between(axis: Any, low: float, high: float) -> None:
    """Put numbers between the decades; within one, where these may be none, at equal steps."""
    if high < 10.0 * low:
        axis.set_major_locator(MaxNLocator(_STEPS))
        axis.set_minor_locator(NullLocator())
    else:
        axis.set_minor_locator(LogLocator(subs=(2.0, 5.0)))


def _drawn(ax: Axes, groups: Sequence[str]) -> list[Line2D]:
    return [line for line in ax.lines if line.get_gid() in groups]


def _positive(lines: Sequence[Line2D]) -> Float:
    values: Float = np.concatenate([np.asarray(line.get_ydata(), float) for line in lines])
    return values[np.isfinite(values) & (values > 0.0)]
