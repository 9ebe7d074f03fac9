"""Figures of limit cycles: amplitude and frequency along the branch, Floquet multipliers."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, TypedDict

import numpy as np

from stickslip.checks import brief
from stickslip.errors import ModelError
from stickslip.plot.arguments import labels_of
from stickslip.plot.states import LINES, Colour, marks, name_states, pieces
from stickslip.plot.style import (
    GREY,
    LengthUnit,
    OmegaUnit,
    colours,
    finish,
    length_scale,
    new_axes,
    omega_scale,
)
from stickslip.results.arrays import Float, Measure
from stickslip.results.limit_cycles import LimitCycles
from stickslip.results.stability import STATES, States

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["CycleOptions", "cycle_multipliers", "limit_cycles"]

_AXES = {"ratio": "negative damping ratio r", "stiffness": "$k_d$", "slip_force": "$F_d$"}
# Widest part of the plane of multipliers that is drawn: large ones say no more than unstable.
_WIDEST = 3.0


class CycleOptions(TypedDict, total=False):
    """Keywords of `limit_cycles`."""

    ax: Axes | None
    measure: Measure
    length_unit: LengthUnit
    omega_unit: OmegaUnit
    frequency: bool
    labels: Sequence[str] | None


def limit_cycles(
    results: LimitCycles | Sequence[LimitCycles],
    dof: str,
    *,
    ax: Axes | None = None,
    measure: Measure = "half_range",
    length_unit: LengthUnit = "m",
    omega_unit: OmegaUnit = "rad/s",
    frequency: bool = True,
    labels: Sequence[str] | None = None,
) -> Axes:
    """Draw amplitude and frequency of limit cycles, and say by the lines what is stable.

    Stable cycles are solid, unstable ones dashed, those whose stability is not decided dotted; the
    legend says which there are. Single cycles are full and hollow circles, and crosses.

    Parameters
    ----------
    results : LimitCycles or sequence of LimitCycles
        One branch each, of the same parameter.
    dof : str
        The degree of freedom.
    ax : matplotlib.axes.Axes, optional
        Where to draw the amplitude. Default: a new figure.
    measure : {"half_range", "max", "fundamental"}, optional
        See `LimitCycles.amplitude`.
    length_unit : {"m", "mm", "um"}, optional
        Unit of the amplitude.
    omega_unit : {"rad/s", "Hz"}, optional
        Unit of the frequency.
    frequency : bool, optional
        Draw the frequency too, on axes below those of a new figure.
    labels : sequence of str, optional
        One per branch. Default: the mode.

    Returns
    -------
    matplotlib.axes.Axes
        The axes of the amplitude. Circles mark where a branch turns for good.

    Raises
    ------
    ModelError
        If an argument is of the wrong type, or the branches follow several parameters.
    """
    branches = _branches(results)
    names = [f"mode {one.settings.mode}" for one in branches]
    if labels is not None:
        names = labels_of(labels, len(branches))
    length, omega = length_scale(length_unit), omega_scale(omega_unit)
    made = ax is None
    below = None
    if made and frequency:
        import matplotlib.pyplot as plt

        _, (ax, below) = plt.subplots(2, 1, sharex=True, figsize=(6.4, 6.4), layout="constrained")
    ax = new_axes(ax)
    for one, name, colour in zip(branches, names, colours(len(branches)), strict=True):
        heights = [(ax, length.factor * one.amplitude(dof, measure))]
        if below is not None:
            heights.append((below, omega.factor * one.omega))
        for axes, height in heights:
            _line(axes, one, height, colour, name)
    wide = branches[0].settings.followed != "ratio"
    unit = branches[0].settings.unit
    label = _AXES[branches[0].settings.followed]
    last = ax if below is None else below
    last.set_xlabel(label if unit == "1" else f"{label} [{unit}]")
    if wide:
        ax.set_xscale("log")
    for single in (False, True):
        of = [one.stability for one in branches if (one.settings.values is not None) == single]
        name_states(ax, of, single=single)
    ax.set_yscale("log")
    ax.set_ylabel(f"amplitude of {dof} [{length.label}]")
    if below is not None:
        below.set_ylabel(omega.label)
    finish(ax, made=made)
    return ax


def _line(
    ax: Axes,
    one: LimitCycles,
    height: Float,
    colour: Colour,
    name: str,
) -> None:
    """Draw one branch in pieces of equal stability; single points of a list as marks."""
    ax.plot([], [], color=colour, lw=1.5, label=name)
    if one.settings.values is not None:
        for state in STATES:
            mask = one.stability == state
            if mask.any():
                ax.plot(one.values[mask], height[mask], **marks(state, colour))
        return
    x, drawn, states = _refined(one, height)
    for piece, state in pieces(states):
        ax.plot(x[piece], drawn[piece], color=colour, lw=1.5, ls=LINES[state])
    limit = one.limit
    if limit is not None:
        at = int(np.argmin(np.abs(one.values - limit.value) + np.abs(one.omega - limit.omega)))
        ax.plot(limit.value, height[at], ls="", marker="o", ms=5, mfc="white", mec=colour)


def _refined(one: LimitCycles, height: Float) -> tuple[Float, Float, States]:
    """Return a branch with its changes of stability as further points, between their neighbours."""
    x, y, states = (list(column) for column in (one.values, height, one.stability))
    for change in reversed(one.changes):
        at = change.after
        if at + 1 >= one.omega.size:
            continue
        before, after = one.omega[at], one.omega[at + 1]
        share = float(np.clip((change.omega - before) / (after - before), 0.0, 1.0))
        x.insert(at + 1, change.value)
        y.insert(at + 1, height[at] + share * (height[at + 1] - height[at]))
        states.insert(at + 1, states[at])
    return np.array(x), np.array(y), np.array(states)


def cycle_multipliers(result: LimitCycles, *, ax: Axes | None = None) -> Axes:
    """Draw the Floquet multipliers along a branch in the complex plane, with the unit circle.

    Parameters
    ----------
    result : LimitCycles
        The branch.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.

    Returns
    -------
    matplotlib.axes.Axes
        The axes, cut where multipliers are larger than 3. Circles belong to the sticking side,
        crosses to the slipping side; colours tell the frequency.

    Raises
    ------
    ModelError
        If there are no multipliers.
    """
    (result,) = _branches(result)
    known = result.arrays.known
    if not known.any():
        raise ModelError("result: no multipliers are known; compute with stability=True")
    made, ax = ax is None, new_axes(ax)
    turn = np.exp(2j * np.pi * np.linspace(0.0, 1.0, 361))
    ax.plot(turn.real, turn.imag, color=GREY, lw=0.9, zorder=1.5)
    low, high = float(result.omega[known].min()), float(result.omega[known].max())
    cloud = None
    for side, marker in (("sticking", "o"), ("slipping", "x")):
        chosen = known & (result.branch == side)
        if not chosen.any():
            continue
        values = result.multipliers[chosen]
        counted = np.arange(values.shape[1]) >= result.neutral[chosen][:, None]
        shade = np.broadcast_to(result.omega[chosen][:, None], values.shape)
        cloud = ax.scatter(
            values[counted].real,
            values[counted].imag,
            c=shade[counted],
            vmin=low,
            vmax=high,
            cmap="viridis",
            s=12,
            lw=0.8 if marker == "x" else 0.0,
            marker=marker,
            label=side,
            zorder=2.5,
        )
    if cloud is not None:
        ax.figure.colorbar(cloud, ax=ax, label="frequency [rad/s]")
    size = float(np.nanmax(np.abs(result.multipliers[known])))
    edge = 1.08 * min(max(size, 1.0), _WIDEST)
    ax.set_xlim(-edge, edge)
    ax.set_ylim(-edge, edge)
    ax.set_aspect("equal")
    ax.set_xlabel("real part of the multiplier")
    ax.set_ylabel("imaginary part")
    finish(ax, made=made)
    return ax


def _branches(results: object) -> list[LimitCycles]:
    listed = list(results) if isinstance(results, Iterable) else [results]
    for place, one in enumerate(listed):
        if not isinstance(one, LimitCycles):
            raise ModelError(
                f"results[{place}]: {brief(one)} is no LimitCycles; give what limit_cycles returned"
            )
    branches = [one for one in listed if isinstance(one, LimitCycles)]
    if not branches:
        raise ModelError("results: empty; give at least one LimitCycles")
    followed = {one.settings.followed for one in branches}
    if len(followed) > 1:
        raise ModelError(
            f"results: branches over {' and '.join(sorted(followed))}; draw one parameter at a time"
        )
    return branches
