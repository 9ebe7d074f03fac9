"""Mistuning studies: the distribution of amplification factors, and what moves it."""

from __future__ import annotations

from typing import Literal, Unpack

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from stickslip.checks import real_number
from stickslip.errors import ModelError
from stickslip.plot import style
from stickslip.plot.figure import figure
from stickslip.plot.options import DistributionOptions, TrendOptions
from stickslip.plot.style import Colour, Looks
from stickslip.results.fields import Float, Int
from stickslip.results.mistuning import MistuningStudy
from stickslip.results.status import Status
from stickslip.results.weibull import FEWEST, empirical_percentile

_TICKS = (0.1, 1, 10, 25, 50, 75, 90, 95, 99, 99.5, 99.9, 99.99)
"""Percentages that the axis of probabilities names."""


@figure
def distribution(
    ax: Axes, /, result: MistuningStudy, dof: str, **options: Unpack[DistributionOptions]
) -> None:
    """Draw the distribution of amplification factors and its Weibull fit.

    The axis of probabilities is that of extreme values, -ln(-ln F): a straight line has no upper
    limit, a Weibull distribution of maxima bends upwards to its limit.

    Parameters
    ----------
    dof, deviation, coupling
        See `MistuningStudy.factors`.

    Returns
    -------
    matplotlib.axes.Axes
        The axes. With too few or equal factors the fit is left out, and the title says so.
    """
    percentile, confidence = options["percentile"], options["confidence"]
    chosen = {"deviation": options["deviation"], "coupling": options["coupling"]}
    factors = np.sort(result.factors(dof, **chosen))
    if not factors.size:
        raise ModelError(f"result: no amplification factor of {dof!r} was found; see status")
    ranks = (np.arange(1, factors.size + 1) - 0.44) / (factors.size + 0.12)
    title = f"{factors.size} disks"
    ax.plot(factors, _height(ranks), ls="", marker=".", ms=4, color=style.BLUE, label="disks")
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
    ax.set(ylim=(low, high), xlabel=f"amplification factor of {style.named(dof)}")
    ax.set_ylabel("share of disks that do not exceed it")
    ax.set_title(title, fontsize="medium")


@figure
def amplification(
    ax: Axes,
    /,
    result: MistuningStudy,
    dof: str,
    against: Literal["deviation", "coupling"] = "deviation",
    **options: Unpack[TrendOptions],
) -> None:
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
    factors = result.amplification(dof)
    sought = result.arrays.status[..., result.dofs.index(dof)] != Status.NOT_COMPUTED.code
    missing = (sought & ~np.isfinite(factors)).sum(axis=-1)
    below, others = result.deviation, result.coupling_stiffness
    label, named = "standard deviation of the sectors' stiffness", ", {:g} N/m"
    if against == "coupling":
        factors, missing = factors.swapaxes(0, 1), missing.T
        below, others = others, below
        label, named = "stiffness of the couplings [N/m]", ", S = {:g}"
        if np.isnan(below).any():
            raise ModelError("against: the couplings have no common stiffness; give one to vary")
    order = np.argsort(below)
    q = real_number(options["percentile"], "percentile")
    for number, (other, colour) in enumerate(zip(others, style.colours(others.size), strict=True)):
        rows = [one[np.isfinite(one)] for one in factors[order, number]]
        name = "" if others.size < 2 else named.format(other)
        parts = rows, missing[order, number]
        _trend(ax, below[order], *parts, name, colour, q, options["confidence"])
    if against == "coupling" and (below > 0.0).all() and below.size > 1:
        ax.set_xscale("log")
    ax.axhline(1.0, color=style.GREY, lw=1.0, ls=style.STUCK, label="tuned")
    ax.set(xlabel=label, ylabel=f"amplification factor of {style.named(dof)}")


def _trend(
    ax: Axes,
    below: Float,
    rows: list[Float],
    missing: Int,
    name: str,
    colour: Colour,
    q: float,
    trust: float,
) -> None:
    """Draw the mean and a percentile of rows of factors, of which some are missing."""
    several = max(row.size for row in rows) > 1
    mean = [row.mean() if row.size else np.nan for row in rows]
    label = "mean" if several else "one pattern"
    ax.plot(below, mean, marker="o", ms=4, lw=1.4, color=colour, label=f"{label}{name}")
    if not several:
        return
    ends = [
        empirical_percentile(row, q, trust, int(lost)) if row.size >= FEWEST else (np.nan,) * 3
        for row, lost in zip(rows, missing, strict=True)
    ]
    value, low, high = np.array(ends, dtype=np.float64).T
    if np.isfinite(value).any():
        looks: Looks = {"marker": "^", "ms": 4, "lw": 1.2, "ls": "--"}
        ax.plot(below, value, **looks, color=colour, label=f"{q:g} %{name}")
        bars = _bars(value, low, high)
        ax.errorbar(below, value, yerr=bars, ls="", color=colour, lw=1.0, capsize=2.5)


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
