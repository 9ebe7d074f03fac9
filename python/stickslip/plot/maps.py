"""Peaks over two parameters."""

from __future__ import annotations

from typing import Unpack

import numpy as np
from matplotlib.axes import Axes

from stickslip.plot import style
from stickslip.plot.figure import figure
from stickslip.plot.options import Frame
from stickslip.results.design_map import DesignMap

_DECADES = 30.0
"""Values that go so far, over the least, were chosen by factors."""


@figure
def design_map(ax: Axes, /, result: DesignMap, **options: Unpack[Frame]) -> None:
    """Draw the peak over both parameters, the least one marked; a curve where only one varies."""
    scale = style.LENGTH[options["length_unit"]]
    if options["length_unit"] == "auto":
        scale = style.prefix_of(float(np.nanmax(result.amplitude, initial=0.0)), "m")
    label = f"peak of {style.named(result.dof)} [{scale.label}]"
    if 1 in result.amplitude.shape:
        _curve(ax, result, scale.factor, label)
        return
    first, second = result.values
    shade = ax.pcolormesh(
        first, second, scale.factor * result.amplitude.T, shading="nearest", cmap="viridis"
    )
    ax.figure.colorbar(shade, ax=ax, label=label)
    if np.isfinite(result.amplitude).any():
        best = result.optimum
        ax.plot(*best.values(), "*", color=style.ORANGE, ms=12, mec="white", label="least peak")
    ax.set(xlabel=result.names[0], ylabel=result.names[1])


def _curve(ax: Axes, result: DesignMap, factor: float, label: str) -> None:
    """Draw the peak over the only parameter that varies."""
    varied = int(result.amplitude.shape[0] == 1)
    values, heights = result.values[varied], factor * result.amplitude.ravel()
    name, other = result.names[varied], 1 - varied
    order = np.argsort(values)
    (colour,) = style.colours(1)
    ax.plot(values[order], heights[order], "o-", ms=3.0, color=colour, label=label)
    if np.isfinite(heights).any():
        best = int(np.nanargmin(heights))
        looks: style.Looks = {"color": style.ORANGE, "ms": 12, "mec": "white", "ls": "none"}
        ax.plot(values[best], heights[best], "*", **looks, label=f"least, {values[best]:.4g}")
    if values.min() > 0.0 and values.max() >= _DECADES * values.min():
        ax.set_xscale("log")
    ax.set(xlabel=name, ylabel=label)
    ax.set_title(f"{result.names[other]} = {result.values[other][0]:.4g}", fontsize="medium")
