"""Floquet multipliers in the complex plane, of exact orbits and of limit cycles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from stickslip.errors import ModelError
from stickslip.plot.arguments import at, of_kind, require_solved
from stickslip.plot.documentation import figure
from stickslip.plot.style import GREY, Looks, OmegaUnit, framed, omega_scale, unit_circle
from stickslip.results.exact_response import ExactResponse
from stickslip.results.limit_cycles import LimitCycles

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["cycle_multipliers", "multipliers"]

# Widest part of the plane of multipliers that is drawn: large ones say no more than unstable.
_WIDEST = 3.0


@figure
def multipliers(
    result: ExactResponse,
    *,
    index: int | Sequence[int] | None = None,
    ax: Axes | None = None,
    omega_unit: OmegaUnit = "rad/s",
) -> Axes:
    """Draw Floquet multipliers in the complex plane, with the unit circle.

    Parameters
    ----------
    index : int or sequence of int, optional
        Positions of points of the sweep. Default: all.

    Returns
    -------
    matplotlib.axes.Axes
        The axes. Neutral multipliers, of contacts that never slip, are hollow.
    """
    result, omega = of_kind(ExactResponse, result), omega_scale(omega_unit)
    chosen = _chosen(result, index)
    with framed(ax) as ax:
        values = result.multipliers[chosen]
        neutral = np.arange(values.shape[1]) < result.neutral[chosen][:, None]
        shade = np.broadcast_to(omega.factor * result.omega[chosen][:, None], values.shape)
        unit_circle(ax)
        moving, kept = values[~neutral], values[neutral]
        looks: Looks = {"cmap": "viridis", "s": 14, "lw": 0.0, "zorder": 2.5}
        cloud = ax.scatter(moving.real, moving.imag, c=shade[~neutral], **looks)
        if kept.size:
            hollow: Looks = {"ls": "", "marker": "o", "mfc": "none", "mec": GREY}
            ax.plot(kept.real, kept.imag, **hollow, label="neutral: a contact never slips")
        if len(chosen) > 1:
            ax.figure.colorbar(cloud, ax=ax, label=omega.label)
        else:
            ax.set_title(at(result, chosen[0]), fontsize="medium")
    if kept.size:
        ax.legend(frameon=False, fontsize="small", loc="lower left")
    return ax


@figure
def cycle_multipliers(result: LimitCycles, *, ax: Axes | None = None) -> Axes:
    """Draw the Floquet multipliers along a branch in the complex plane, with the unit circle.

    Returns
    -------
    matplotlib.axes.Axes
        The axes, cut where multipliers are larger than 3. Circles belong to the sticking side,
        crosses to the slipping side; colours tell the frequency.
    """
    known = of_kind(LimitCycles, result).arrays.known
    if not known.any():
        raise ModelError("result: no multipliers are known; compute with stability=True")
    with framed(ax) as ax:
        unit_circle(ax)
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
            looks |= {"lw": width, "marker": marker, "label": side, "zorder": 2.5}
            cloud = ax.scatter(shown.real, shown.imag, c=shade, **looks)
        ax.figure.colorbar(cloud, ax=ax, label="frequency [rad/s]")
        edge = 1.08 * np.clip(np.nanmax(np.abs(result.multipliers[known])), 1.0, _WIDEST)
        ax.set(xlim=(-edge, edge), ylim=(-edge, edge))
    return ax


def _chosen(result: ExactResponse, index: int | Sequence[int] | None) -> list[int]:
    if index is None:
        chosen = [int(place) for place in np.flatnonzero(result.arrays.solved)]
        if not chosen:
            raise ModelError("result: no point is solved, so that there are no multipliers")
        return chosen
    places = list(index) if isinstance(index, Sequence | np.ndarray) else [index]
    if not places:
        raise ModelError("index: empty; give the position of at least one point")
    require_solved(result, places)
    return [result.position(place) for place in places]
