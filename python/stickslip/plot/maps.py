"""Peaks over two parameters."""

from __future__ import annotations

from typing import Unpack

import numpy as np
from matplotlib.axes import Axes

from stickslip.plot import style
from stickslip.plot.figure import figure
from stickslip.plot.options import Frame
from stickslip.results.design_map import DesignMap


@figure
def design_map(ax: Axes, /, result: DesignMap, **options: Unpack[Frame]) -> None:
    """Draw the peak over both parameters, the least one marked."""
    scale = style.LENGTH[options["length_unit"]]
    if options["length_unit"] == "auto":
        scale = style.prefix_of(float(np.nanmax(result.amplitude, initial=0.0)), "m")
    first, second = result.values
    shade = ax.pcolormesh(
        first, second, scale.factor * result.amplitude.T, shading="nearest", cmap="viridis"
    )
    ax.figure.colorbar(shade, ax=ax, label=f"peak of {result.dof} [{scale.label}]")
    if np.isfinite(result.amplitude).any():
        best = result.optimum
        ax.plot(*best.values(), "*", color=style.ORANGE, ms=12, mec="white", label="least peak")
    ax.set(xlabel=result.names[0], ylabel=result.names[1])
