"""Uncertain parameters: distributions of a number, shares of parameters, bands of backbones."""

from __future__ import annotations

from typing import Unpack

import numpy as np
from matplotlib.axes import Axes

from stickslip.errors import ModelError
from stickslip.plot import style
from stickslip.plot.figure import figure
from stickslip.plot.options import BandOptions, PercentileOptions, ShareOptions
from stickslip.results.uncertainty import Uncertainty

_BAR = 0.38
"""Width of a bar; two stand side by side."""


@figure
def uncertainty_distribution(
    ax: Axes, /, result: Uncertainty, number: str, **options: Unpack[PercentileOptions]
) -> None:
    """Draw the distribution of a number: its histogram, the share below, and percentiles.

    Parameters
    ----------
    number : str
        One of `Uncertainty.numbers`.
    """
    values = np.sort(result.values(number))
    values = values[np.isfinite(values)]
    if not values.size:
        raise ModelError(f"result: no sample has {number!r}; see reasons")
    counts, edges = np.histogram(values, bins="sturges")
    ax.bar(
        edges[:-1],
        counts / counts.max(initial=1),
        np.diff(edges),
        align="edge",
        color=style.GREY,
        alpha=0.35,
        label="histogram, over its highest bar",
    )
    share = np.arange(1, values.size + 1) / values.size
    ax.step(values, share, where="post", color=style.BLUE, lw=1.4, label="share below")
    unit = result.settings.quantity.numbers[number]
    shown = style.scale_of(float(values[-1]), unit)
    for q in options["percentiles"]:
        found = result.percentile(number, q, options["confidence"])
        ends = np.array([[found.value - found.low], [found.high - found.value]])
        bars = np.where(np.isfinite(ends), ends, 0.0)
        value, low, high = (shown.factor * end for end in (found.value, found.low, found.high))
        label = f"{q:g} %: {value:.4g} {shown.label}".rstrip() + f" ({low:.4g} to {high:.4g})"
        (mark,) = ax.plot([found.value], [q / 100.0], ls="", marker="D", ms=5, label=label)
        ax.errorbar([found.value], [q / 100.0], xerr=bars, color=mark.get_color(), capsize=3)
    ax.set(
        xlabel=f"{style.named(number)} [{unit}]", ylabel="share of the samples", ylim=(0.0, 1.02)
    )
    failed = f", {result.failed} failed" if result.failed else ""
    ax.set_title(f"{values.size} samples{failed}", fontsize="medium")


@figure
def sobol_indices(
    ax: Axes, /, result: Uncertainty, number: str, **options: Unpack[ShareOptions]
) -> None:
    """Draw the Sobol indices of the parameters, with their intervals.

    Parameters
    ----------
    number : str
        One of `Uncertainty.numbers`.
    """
    found = result.sobol(number, options["confidence"])
    names = list(found.first)
    place = np.arange(len(names))
    for shares, side, colour, label in (
        (found.first, -0.5, style.BLUE, "alone"),
        (found.total, 0.5, style.ORANGE, "with others"),
    ):
        value, low, high = np.array([shares[name] for name in names]).T
        # Resampled shares may lie to one side.
        bars = np.maximum([value - low, high - value], 0.0)
        at = place + side * _BAR
        ax.bar(at, value, _BAR, color=colour, label=label)
        ax.errorbar(at, value, yerr=bars, ls="", color="0.2", capsize=3)
    ax.set_xticks(place, [style.named(name.replace("_", "_\n")) for name in names])
    ax.set(ylabel="share of the variance", ylim=(0.0, None))
    ax.set_title(
        f"{style.named(number)}: surrogate misses {found.error:.2g} of the variance",
        fontsize="medium",
    )


@figure
def backbone_band(ax: Axes, /, result: Uncertainty, **options: Unpack[BandOptions]) -> None:
    """Draw between which percentiles backbones lie, frequency or damping over the amplitude."""
    backbone = result.backbone
    amplitude = np.array(backbone.amplitude)
    entry = "damping_ratio" if options["damping"] else "omega"
    low, high = options["band"]
    rows = [result.values(f"{entry}[{at}]") for at in range(amplitude.size)]
    found = np.array(
        [
            np.quantile(one[np.isfinite(one)], [low / 100.0, 0.5, high / 100.0])
            if np.isfinite(one).any()
            else (np.nan,) * 3
            for one in rows
        ]
    )
    scale = 1.0 if options["damping"] else style.OMEGA[options["omega_unit"]].factor
    below, middle, above = scale * found.T
    ax.fill_between(
        amplitude, below, above, color=style.BLUE, alpha=0.25, label=f"{low:g} to {high:g} %"
    )
    ax.plot(amplitude, middle, color=style.BLUE, lw=1.4, marker="o", ms=3, label="median")
    label = "damping ratio" if options["damping"] else style.OMEGA[options["omega_unit"]].label
    ax.set_xscale("log")
    ax.set(xlabel="modal amplitude [m kg$^{1/2}$]", ylabel=label)
