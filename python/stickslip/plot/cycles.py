"""Limit cycles: their amplitude and frequency, where they are stable, and Floquet multipliers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Unpack

import numpy as np
from matplotlib import pyplot
from matplotlib.axes import Axes

from stickslip.errors import ModelError
from stickslip.plot import style
from stickslip.plot.arguments import at, checked_labels, label_of, several, solved_points
from stickslip.plot.figure import figure, keywords
from stickslip.plot.options import CycleOptions, Drawing, MultiplierOptions
from stickslip.plot.style import Colour, Looks
from stickslip.results.exact_response import ExactResponse
from stickslip.results.fields import Float
from stickslip.results.limit_cycles import LimitCycles, StabilityMap
from stickslip.results.stability import STATES, States

_AXES = {"ratio": "negative damping ratio r", "stiffness": "$k_d$", "slip_force": "$F_d$"}
# Widest part of the plane of multipliers that is drawn: large ones say no more than unstable.
_WIDEST = 3.0


@keywords
def limit_cycles(
    results: LimitCycles | Sequence[LimitCycles], dof: str, **options: Unpack[CycleOptions]
) -> Axes:
    """Draw amplitude and frequency of limit cycles, and say by the lines what is stable.

    Stable cycles are solid, unstable ones dashed, those whose stability is not decided dotted; the
    legend says which there are. Single cycles are full and hollow circles, and crosses.

    Returns
    -------
    matplotlib.axes.Axes
        The axes of the amplitude. Circles mark where a branch turns for good.
    """
    branches = several(LimitCycles, results, lambda one: one.settings.followed)
    names = checked_labels(options["labels"], [f"mode {one.settings.mode}" for one in branches])
    omega = style.omega_scale(options["omega_unit"], branches)
    length = style.LENGTH[options["length_unit"]]
    made, ax, below = options["ax"] is None, options["ax"], None
    if made and options["frequency"]:
        tall = pyplot.figure(figsize=(6.4, 6.4), layout="constrained")
        ax, below = tall.subplots(2, 1, sharex=True)
    ax = style.new_axes(ax)
    for one, name, colour in zip(branches, names, style.colours(len(branches)), strict=True):
        _line(ax, one, length.factor * one.amplitude(dof, options["measure"]), colour, name)
        if below is not None:
            _line(below, one, omega.factor * one.omega, colour, name)
    followed, unit = branches[0].settings.followed, branches[0].settings.unit
    (below or ax).set_xlabel(_AXES[followed] + ("" if unit == "1" else f" [{unit}]"))
    if followed != "ratio":
        ax.set_xscale("log")
    for single in (False, True):
        of = [one.stability for one in branches if (one.settings.values is not None) == single]
        style.name_states(ax, of, single=single)
    ax.set(yscale="log", ylabel=f"amplitude of {style.named(dof)} [{length.label}]")
    if below is not None:
        below.set_ylabel(omega.label)
        style.bare(below)
    style.finish(ax, made=made, lengths=options["length_unit"] == "auto")
    return ax


@figure
def stability_map(ax: Axes, /, result: StabilityMap, **options: Unpack[Drawing]) -> None:
    """Draw where friction bounds negative damping, and where the bounded motion is stable.

    Crosses stand at values of which the stability is not decided.
    """
    known = np.isfinite(result.limit)
    if not known.any():
        raise ModelError("result: no branch turns, so that there is nothing to draw")
    x, limit, stable = (a[known] for a in (result.values, result.limit, result.stable_limit))
    # Not-a-number leaves a gap in both areas: nothing is decided there.
    area: Looks = {"alpha": 0.25, "lw": 0.0}
    ax.fill_between(x, 0.0, stable, color=style.BLUE, **area, label="stable limit cycle")
    ax.fill_between(x, stable, limit, color=style.ORANGE, **area, label="unstable one")
    none = np.isnan(stable)
    if none.any():
        looks = style.marks("not decided", style.GREY)
        ax.plot(x[none], 0.5 * limit[none], **looks, label="not decided")
    ax.plot(x, limit, color="0.2", lw=1.5, label="no limit cycle above")
    ax.set(xlabel=label_of(result.settings.variation), ylabel="negative damping ratio r")
    ax.set_xscale("log")
    ax.set_ylim(bottom=0.0)


def _line(ax: Axes, one: LimitCycles, height: Float, colour: Colour, name: str) -> None:
    """Draw one branch in pieces of equal stability; single points of a list as marks."""
    ax.plot([], [], color=colour, lw=1.5, label=name)
    if one.settings.values is not None:
        for state in STATES:
            mask = one.stability == state
            if mask.any():
                ax.plot(one.values[mask], height[mask], **style.marks(state, colour))
        return
    x, drawn, states = _refined(one, height)
    for piece, state in style.pieces(states):
        ax.plot(x[piece], drawn[piece], color=colour, lw=1.5, ls=style.LINES[state])
    limit = one.limit
    if limit is not None:
        at = int(np.argmin(np.abs(one.values - limit.value) + np.abs(one.omega - limit.omega)))
        ax.plot(limit.value, height[at], **style.mark("o", 5, colour))


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
