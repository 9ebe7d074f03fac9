"""The figure of a stability map."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stickslip.checks import brief
from stickslip.errors import ModelError
from stickslip.plot.states import marks
from stickslip.plot.style import GREY, finish, new_axes
from stickslip.results.limit_cycles import StabilityMap

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["stability_map"]

_SYMBOLS = {"slip_force": "slip force $F_d$", "stiffness": "contact stiffness $k_d$"}


def stability_map(result: StabilityMap, *, ax: Axes | None = None) -> Axes:
    """Draw where friction bounds negative damping, and where the bounded motion is stable.

    Crosses stand at values of which the stability is not decided.

    Parameters
    ----------
    result : StabilityMap
        The map.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ModelError
        If the result is no map, or has no value to draw.
    """
    if not isinstance(result, StabilityMap):
        raise ModelError(f"result: {brief(result)} is no StabilityMap")
    known = np.isfinite(result.limit)
    if not known.any():
        raise ModelError("result: no branch turns, so that there is nothing to draw")
    made, ax = ax is None, new_axes(ax)
    x, limit, stable = (a[known] for a in (result.values, result.limit, result.stable_limit))
    # Not-a-number leaves a gap in both areas: nothing is decided there.
    ax.fill_between(x, 0.0, stable, color="#31688e", alpha=0.25, lw=0.0, label="stable limit cycle")
    ax.fill_between(x, stable, limit, color="#d8863b", alpha=0.25, lw=0.0, label="unstable one")
    undecided = np.isnan(stable)
    if undecided.any():
        ax.plot(
            x[undecided], 0.5 * limit[undecided], label="not decided", **marks("not decided", GREY)
        )
    ax.plot(x, limit, color="0.2", lw=1.5, label="no limit cycle above")
    variation = result.settings.variation
    symbol = _SYMBOLS[variation.parameter]
    if variation.common == "factor":
        ax.set_xlabel(f"factor on the {variation.parameter.replace('_', ' ')}")
    else:
        ax.set_xlabel(f"{symbol} [{variation.unit}]")
    ax.set_xscale("log")
    ax.set_ylim(bottom=0.0)
    ax.set_ylabel("negative damping ratio r")
    finish(ax, made=made)
    return ax
