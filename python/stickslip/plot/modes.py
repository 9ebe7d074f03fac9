"""Nonlinear modes: frequency and damping against amplitude."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Unpack

import numpy as np
from matplotlib import pyplot
from matplotlib.axes import Axes

from stickslip.plot import style
from stickslip.plot.arguments import checked_labels, several
from stickslip.plot.figure import keywords
from stickslip.plot.options import BackboneOptions, DampingOptions
from stickslip.plot.style import Colour, Looks
from stickslip.results.fields import Float
from stickslip.results.nonlinear_modes import NonlinearModes

_AMPLITUDE = r"modal amplitude [m kg$^{1/2}$]"
_INSETS = (0.08, 0.42, 0.76)
"""Where the shapes stand across the figure of the frequency."""
_MOST_BARS = 30
"""Degrees of freedom up to which a bar of a shape is two pixels wide."""
_BELOW = 0.45
"""Room for them below the frequencies, over the height of these."""


@keywords
def backbone(
    results: NonlinearModes | Sequence[NonlinearModes], **options: Unpack[BackboneOptions]
) -> Axes:
    """Draw frequency and damping ratio of nonlinear modes against modal amplitude.

    Dotted lines are the viscous part of the damping. The insets show the moduli of the
    fundamental at the least, a middle and the largest amplitude of the first mode, DOF by DOF.

    Returns
    -------
    matplotlib.axes.Axes
        The axes of the frequency.
    """
    branches = several(NonlinearModes, results)
    names = checked_labels(options["labels"], names_of(branches))
    omega = style.omega_scale(options["omega_unit"], branches)
    made, ax, below = options["ax"] is None, options["ax"], None
    if made and options["damping"]:
        tall = pyplot.figure(figsize=(6.4, 6.4), layout="constrained")
        ax, below = tall.subplots(2, 1, sharex=True)
    ax = style.new_axes(ax)
    for one, name, colour in zip(branches, names, style.colours(len(branches)), strict=True):
        marker = "" if one.settings.whole else "o"
        ax.plot(one.amplitude, omega.factor * one.omega, color=colour, label=name, marker=marker)
        _band(ax, one, omega.factor * one.omega_bounds, colour)
        if below is not None:
            _damping(below, one, colour, name)
    ax.set(xscale="log", ylabel=omega.label)
    lowest = below or ax
    lowest.set_xlabel(_AMPLITUDE)
    if below is not None:
        below.set(ylabel="damping ratio")
        style.bare(below)
    if options["shapes"]:
        _shapes(ax, branches[0])
    style.finish(ax, made=made)
    return ax


@keywords
def mode_damping(
    results: NonlinearModes | Sequence[NonlinearModes], **options: Unpack[DampingOptions]
) -> Axes:
    """Draw the damping ratio of nonlinear modes against modal amplitude, viscous parts dotted."""
    branches = several(NonlinearModes, results)
    names = checked_labels(options["labels"], names_of(branches))
    made, ax = options["ax"] is None, style.new_axes(options["ax"])
    for one, name, colour in zip(branches, names, style.colours(len(branches)), strict=True):
        _damping(ax, one, colour, name)
    ax.set(xscale="log", xlabel=_AMPLITUDE, ylabel="damping ratio")
    style.finish(ax, made=made)
    return ax


def names_of(branches: Sequence[NonlinearModes]) -> list[str]:
    """Return the modes by number, with the method and nodal diameter where these differ."""
    names = [f"mode {one.settings.mode}" for one in branches]
    if len({one.settings.method for one in branches}) > 1:
        names = [
            f"{name}, {one.settings.method}" for name, one in zip(names, branches, strict=True)
        ]
    if len({one.settings.nodal_diameter for one in branches}) > 1:
        diameters = [one.settings.nodal_diameter for one in branches]
        names = [
            name if diameter is None else f"{name}, ND {diameter}"
            for name, diameter in zip(names, diameters, strict=True)
        ]
    return names


def _damping(ax: Axes, one: NonlinearModes, colour: Colour, name: str) -> None:
    marker = "" if one.settings.whole else "o"
    ax.plot(one.amplitude, one.damping_ratio, color=colour, marker=marker, label=name)
    ax.plot(one.amplitude, one.viscous_ratio, color=colour, ls=":", label=f"{name}, viscous part")
    _band(ax, one, one.damping_bounds, colour)


def _band(ax: Axes, one: NonlinearModes, bounds: Float, colour: Colour) -> None:
    if np.isfinite(bounds).any():
        looks: Looks = {"color": colour, "alpha": 0.15, "lw": 0.0}
        ax.fill_between(one.amplitude, *bounds.T, **looks, label="all residual tractions")


def _shapes(ax: Axes, mode: NonlinearModes) -> None:
    known = np.flatnonzero(np.isfinite(mode.omega))
    if not known.size or mode.arrays.displacement.shape[-1] > _MOST_BARS:
        return
    low, high = ax.get_ylim()
    ax.set_ylim(low - _BELOW * (high - low), high)
    for left, index in zip(_INSETS, known[[0, known.size // 2, -1]], strict=True):
        inset = ax.inset_axes((left, 0.06, 0.16, 0.2))
        shape = np.abs(mode.arrays.displacement[index, 1])
        inset.bar(np.arange(shape.size), shape / max(shape.max(), np.finfo(float).tiny))
        inset.set(xticks=[], yticks=[], ylim=(0.0, 1.05))
        inset.set_title("shape", fontsize="x-small", pad=2.0)
