"""Mistuning studies: the distribution of amplification factors, and what moves it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike

from stickslip.checks import choice, real_number
from stickslip.errors import ModelError
from stickslip.plot.arguments import of_kind
from stickslip.plot.documentation import figure
from stickslip.plot.style import BLUE, GREY, STUCK, Colour, Looks, colours, framed
from stickslip.results.arrays import Float
from stickslip.results.mistuning import MistuningStudy
from stickslip.results.weibull import FEWEST, empirical_percentile

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["amplification", "distribution"]

_TICKS = (0.1, 1, 10, 25, 50, 75, 90, 95, 99, 99.5, 99.9, 99.99)
"""Percentages that the axis of probabilities names."""


@figure
def distribution(
    result: MistuningStudy,
    dof: str,
    *,
    deviation: float | None = None,
    coupling: float | None = None,
    ax: Axes | None = None,
    percentile: float | None = 99.9,
    confidence: float = 0.95,
) -> Axes:
    """Draw the distribution of amplification factors and its Weibull fit.

    The axis of probabilities is that of extreme values, -ln(-ln F): a straight line has no upper
    limit, a Weibull distribution of maxima bends upwards to its limit.

    Parameters
    ----------
    dof, deviation, coupling
        See `MistuningStudy.factors`.
    percentile : float, optional
        Percentile of the fit that is marked with its interval; None marks none.

    Returns
    -------
    matplotlib.axes.Axes
        The axes. With too few or equal factors the fit is left out, and the title says so.
    """
    result = of_kind(MistuningStudy, result)
    chosen = {"deviation": deviation, "coupling": coupling}
    factors = np.sort(result.factors(dof, **chosen))
    if not factors.size:
        raise ModelError(f"result: no amplification factor of {dof!r} was found; see status")
    with framed(ax) as ax:
        ranks = (np.arange(1, factors.size + 1) - 0.44) / (factors.size + 0.12)
        title = f"{factors.size} disks"
        ax.plot(factors, _height(ranks), ls="", marker=".", ms=4, color=BLUE, label="disks")
        try:
            fit = result.weibull(dof, **chosen, confidence=confidence)
        except ModelError as error:
            title += f": no fit, {str(error).removeprefix('weibull: ').split(';')[0]}"
        else:
            top = max(ranks[-1], 0.0 if percentile is None else percentile / 100.0)
            drawn = 1.0 / (1.0 + np.exp(-np.linspace(np.log(ranks[0]), -np.log(1.0 - top), 200)))
            drawn = drawn[(drawn > 0.5 * ranks[0]) & (drawn <= top)]
            ax.plot(fit.quantile(drawn), _height(drawn), color="0.2", lw=1.3, label="Weibull")
            if percentile is not None:
                _mark(ax, fit.percentile(percentile), percentile, confidence)
        ax.set_yticks(_height(np.array(_TICKS) / 100.0), [f"{tick:g} %" for tick in _TICKS])
        low, high = _height([0.7 * ranks[0], 1.0 - 0.5 * (1.0 - ranks[-1])])
        if percentile is not None:
            high = max(high, float(_height(0.5 + percentile / 200.0)))
        ax.set(ylim=(low, high), xlabel=f"amplification factor of {dof}")
        ax.set_ylabel("share of disks that do not exceed it")
        ax.set_title(title, fontsize="medium")
    return ax


@figure
def amplification(
    result: MistuningStudy,
    dof: str,
    against: Literal["deviation", "coupling"] = "deviation",
    *,
    ax: Axes | None = None,
    percentile: float = 99.0,
    confidence: float = 0.95,
) -> Axes:
    """Draw amplification factors against the deviation or the stiffness of the couplings.

    Their mean, and a percentile of the factors themselves with its interval as far as there are
    enough of them for one; a single pattern is drawn by itself, as Guillen (1999), Fig. 4.22.

    Parameters
    ----------
    dof : str
        Degree of freedom of a sector.
    against : {"deviation", "coupling"}, optional
        What stands below; every value of the other one has a line of its own.
    """
    result = of_kind(MistuningStudy, result)
    choice(against, "against", ("deviation", "coupling"))
    factors = result.amplification(dof)
    below, others = result.deviation, result.coupling_stiffness
    label, named = "standard deviation of the sectors' stiffness", ", {:g} N/m"
    if against == "coupling":
        factors, below, others = factors.swapaxes(0, 1), others, below
        label, named = "stiffness of the couplings [N/m]", ", S = {:g}"
        if np.isnan(below).any():
            raise ModelError("against: the couplings have no common stiffness; give one to vary")
    order = np.argsort(below)
    q = real_number(percentile, "percentile")
    with framed(ax) as ax:
        for number, (other, colour) in enumerate(zip(others, colours(others.size), strict=True)):
            rows = [one[np.isfinite(one)] for one in factors[order, number]]
            name = "" if others.size < 2 else named.format(other)
            _trend(ax, below[order], rows, name, colour, q, confidence)
        if against == "coupling" and (below > 0.0).all() and below.size > 1:
            ax.set_xscale("log")
        ax.axhline(1.0, color=GREY, lw=1.0, ls=STUCK, label="tuned")
        ax.set(xlabel=label, ylabel=f"amplification factor of {dof}")
    return ax


def _trend(
    ax: Axes,
    below: Float,
    rows: list[Float],
    name: str,
    colour: Colour,
    q: float,
    confidence: float,
) -> None:
    several = max(row.size for row in rows) > 1
    mean = [row.mean() if row.size else np.nan for row in rows]
    label = "mean" if several else "one pattern"
    ax.plot(below, mean, marker="o", ms=4, lw=1.4, color=colour, label=f"{label}{name}")
    if not several:
        return
    ends = [
        empirical_percentile(row, q, confidence) if row.size >= FEWEST else (np.nan,) * 3
        for row in rows
    ]
    value, low, high = np.array(ends, dtype=np.float64).T
    if np.isfinite(value).any():
        looks: Looks = {"marker": "^", "ms": 4, "lw": 1.2, "ls": "--"}
        ax.plot(below, value, **looks, color=colour, label=f"{q:g} %{name}")
        ax.errorbar(
            below, value, yerr=_bars(value, low, high), ls="", color=colour, lw=1.0, capsize=2.5
        )


def _mark(ax: Axes, found: tuple[float, float, float], q: float, confidence: float) -> None:
    value, low, high = found
    label = f"{q:g} %: {value:.4g} ({low:.4g} to {high:.4g}, {confidence:.0%})"
    looks: Looks = {"fmt": "D", "ms": 5, "mfc": "white", "color": "0.2", "capsize": 3}
    bars = _bars(*(np.array([one]) for one in found))
    ax.errorbar([value], _height([q / 100.0]), xerr=bars, **looks, label=label)


def _bars(value: Float, low: Float, high: Float) -> Float:
    """Return the lengths of bars to either side; an open end is drawn to the point itself."""
    bars = np.array([value - low, high - value])
    return np.where(np.isfinite(bars), bars, np.where(np.isfinite(value), 0.0, np.nan))


def _height(probability: ArrayLike) -> Float:
    return np.asarray(-np.log(-np.log(np.asarray(probability))), dtype=np.float64)
