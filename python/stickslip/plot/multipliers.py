"""Floquet multipliers in the complex plane, of exact orbits and of limit cycles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Unpack

import numpy as np
from matplotlib.axes import Axes

from stickslip.errors import ModelError
from stickslip.plot import style
from stickslip.plot.arguments import at, solved_points
from stickslip.plot.figure import figure
from stickslip.plot.options import Drawing, MultiplierOptions
from stickslip.plot.style import Looks
from stickslip.results.exact_response import ExactResponse
from stickslip.results.limit_cycles import LimitCycles

# Widest part of the plane of multipliers that is drawn: large ones say no more than unstable.
_WIDEST = 3.0


@figure
def multipliers(ax: Axes, /, result: ExactResponse, **options: Unpack[MultiplierOptions]) -> None:
    """Draw Floquet multipliers in the complex plane, with the unit circle.

    Returns
    -------
    matplotlib.axes.Axes
        The axes. Neutral multipliers, of contacts that never slip, are hollow.
    """
    omega = style.omega_scale(options["omega_unit"], result)
    index: Sequence[int] | int | None = options["index"]
    if index is None:
        index = np.flatnonzero(result.arrays.solved).tolist()
        if not index:
            raise ModelError("result: no point is solved, so that there are no multipliers")
    chosen = solved_points(result, index)
    values = result.multipliers[chosen]
    neutral = np.arange(values.shape[1]) < result.neutral[chosen][:, None]
    shade = np.broadcast_to(omega.factor * result.omega[chosen][:, None], values.shape)
    style.unit_circle(ax)
    moving, kept = values[~neutral], values[neutral]
    looks: Looks = {"cmap": "viridis", "s": 14, "lw": 0.0, "zorder": 2.5}
    cloud = ax.scatter(moving.real, moving.imag, c=shade[~neutral], **looks)
    if kept.size:
        hollow: Looks = {"ls": "", "marker": "o", "mfc": "none", "mec": style.GREY}
        ax.plot(kept.real, kept.imag, **hollow, label="neutral: a contact never slips")
        ax.legend(frameon=False, fontsize="small", loc="lower left", bbox_to_anchor=(0.0, 1.0))
    if len(chosen) > 1:
        ax.figure.colorbar(cloud, ax=ax, label=omega.label)
    else:
        ax.set_title(at(result, chosen[0], options["omega_unit"]), fontsize="medium")


@figure
def cycle_multipliers(ax: Axes, /, result: LimitCycles, **options: Unpack[Drawing]) -> None:
    """Draw the Floquet multipliers along a branch in the complex plane, with the unit circle.

    Returns
    -------
    matplotlib.axes.Axes
        The axes, cut where multipliers are larger than 3. Circles belong to the sticking side,
        crosses to the slipping side; colours tell the frequency.
    """
    known = result.arrays.known
    if not known.any():
        raise ModelError("result: no multipliers are known; compute with stability=True")
    style.unit_circle(ax)
    omega = result.omega[known]
    looks: Looks = {"vmin": omega.min(), "vmax": omega.max(), "cmap": "viridis", "s": 12}
    for side, marker, width in (("sticking", "o", 0.0), ("slipping", "x", 0.8)):
        chosen = known & (result.branch == side)
        if not chosen.any():
            continue
        values = result.multipliers[chosen]
        counted = np.arange(values.shape[1]) >= result.neutral[chosen][:, None]
        shade = np.broadcast_to(result.omega[chosen][:, None], values.shape)[counted]
        shown = values[counted]
        looks |= {"lw": width, "marker": marker, "zorder": 2.5}
        cloud = ax.scatter(shown.real, shown.imag, c=shade, **looks)
        # the colour of one motion would not stand for its side
        ax.scatter([], [], s=12, lw=width, marker=marker, color=style.GREY, label=side)
    ax.figure.colorbar(cloud, ax=ax, label="frequency [rad/s]")
    edge = 1.08 * np.clip(np.nanmax(np.abs(result.multipliers[known])), 1.0, _WIDEST)
    ax.set(xlim=(-edge, edge), ylim=(-edge, edge))
