"""Figures of travelling waves under aerodynamic forces."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

import numpy as np

from stickslip.checks import brief
from stickslip.disk.waves import AerodynamicWaves
from stickslip.errors import ModelError
from stickslip.plot.style import GREY, finish, new_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["WaveOptions", "aerodynamic"]


class WaveOptions(TypedDict, total=False):
    """Keywords of `aerodynamic`."""

    ax: Axes | None


def aerodynamic(waves: AerodynamicWaves, *, ax: Axes | None = None) -> Axes:
    """Draw the damping ratio of the travelling waves over their nodal diameter: the S-curve.

    Parameters
    ----------
    waves : AerodynamicWaves
        What `aerodynamic_waves` returned.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.

    Returns
    -------
    matplotlib.axes.Axes
        The axes. Waves above n/2 are drawn at d - n: they run backwards.

    Raises
    ------
    ModelError
        If `waves` is something else.
    """
    from matplotlib.ticker import MaxNLocator

    if not isinstance(waves, AerodynamicWaves):
        raise ModelError(f"waves: {brief(waves)} is none; give what aerodynamic_waves returned")
    made, ax = ax is None, new_axes(ax)
    n = waves.disk.sectors
    signed = np.where(waves.diameters > n / 2, waves.diameters - n, waves.diameters)
    order = np.argsort(signed)
    x = signed[order]
    ax.axhline(0.0, color=GREY, lw=0.8)
    ax.plot(x, 100.0 * waves.aerodynamic_ratio[order], marker="o", ms=3.5, lw=1.0, label="flow")
    if not np.array_equal(waves.ratio, waves.aerodynamic_ratio):
        ax.plot(x, 100.0 * waves.ratio[order], marker="s", ms=3.5, lw=1.0, label="flow and disk")
    least = int(waves.ratio.argmin())
    ax.plot(
        signed[least],
        100.0 * waves.ratio[least],
        ls="",
        marker="o",
        ms=8,
        mfc="none",
        mec="crimson",
        label=f"least stable: {signed[least]}",
    )
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    ax.set_xlabel("nodal diameter")
    ax.set_ylabel("damping ratio [%]")
    finish(ax, made=made)
    return ax
