"""Peaks against a parameter, the damper performance curve, or against two of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Unpack

import numpy as np
from matplotlib.axes import Axes

from stickslip.errors import ModelError
from stickslip.plot import style
from stickslip.plot.arguments import checked_labels, label_of, several
from stickslip.plot.figure import figure
from stickslip.plot.limits import force_level, limit_curve, unit_level
from stickslip.plot.options import DamperOptions, Frame
from stickslip.plot.style import Looks, Scale
from stickslip.results.damper_curve import DamperCurve, DesignMap
from stickslip.results.fields import Float, Int

_DECADES = 30.0
"""Values that go so far, over the least, were chosen by factors."""


@figure
def damper(
    ax: Axes, /, results: DamperCurve | Sequence[DamperCurve], **options: Unpack[DamperOptions]
) -> None:
    """Draw damper performance curves: the peak against what was varied, on logarithmic axes.

    Returns
    -------
    matplotlib.axes.Axes
        The axes of the amplitude.
    """
    curves = several(DamperCurve, results, lambda one: one.parameter)
    names = checked_labels(options["labels"], [style.named(one.settings.dof) for one in curves])
    omega = style.omega_scale(options["omega_unit"], curves)
    length = style.LENGTH[options["length_unit"]]
    views = [_view(curve, length, per_force=options["normalise"] == "force") for curve in curves]
    beside = ax.twinx() if options["frequency"] else None
    shades = style.colours(len(curves))
    for one, view, name, colour in zip(curves, views, names, shades, strict=True):
        x, y = view.x, view.y
        looks: Looks = {"color": colour, "lw": 1.6, "gid": style.RESPONSE}
        ax.plot(x, y, marker="." if x.size == 1 else "", label=name, **looks)
        if one.bounded:
            lower, upper = (view.factor * bound[view.shown] for bound in (one.lower, one.upper))
            ax.fill_between(
                view.x,
                lower,
                upper,
                color=colour,
                alpha=0.15,
                lw=0.7,
                label="all residual tractions",
            )
        if beside is not None:
            shown = omega.factor * one.omega[view.shown]
            beside.plot(x, shown, color=colour, lw=1.0, ls="--", alpha=0.8)
        if options["optimum"]:
            x, y = x[view.best], y[view.best]
            auto = options["length_unit"] == "auto"
            least = style.prefixed(y, view.unit, 4) if auto else f"{y:.4g} {view.unit}"
            label = f"lowest: {least} at {style.written(x, style.unit_of(view.label))}"
            ax.plot(x, y, **style.mark("o", 5, colour), mew=1.3, label=label)
        rigid = np.flatnonzero(np.isinf(one.values) & one.arrays.solved)
        if rigid.size and one.parameter == "stiffness":
            # The limit of a rigid contact has no place on the axis.
            height = float(view.factor[0] * one.amplitude[rigid[0]])
            ax.axhline(height, color=colour, lw=1.0, ls=":", label="rigid contact", zorder=1.5)
    if options["limits"]:
        _draw_limits(ax, curves[0], views[0])
    scale = "linear" if any(map(_is_linear, curves)) else "log"
    ax.set(xscale=scale, yscale="log", xlabel=views[0].label)
    ax.set_ylabel(f"peak amplitude [{views[0].unit}]")
    if beside is not None:
        beside.set_ylabel(f"peak {omega.label} (dashed)")


class _View(NamedTuple):
    """The part of a curve that is drawn."""

    x: Float
    y: Float
    shown: Int
    """Positions of the drawn values, in ascending order of these."""
    label: str
    factor: Float
    """From amplitude [m] to what is drawn, for every drawn value."""
    stretch: Float
    """Level of the forces at every drawn value."""
    best: int
    unit: str


def _is_linear(curve: DamperCurve) -> bool:
    """Whether values, as gaps, may be negative, or none is above zero."""
    values = curve.values[curve.arrays.solved]
    return bool((values < 0.0).any() or not (values > 0.0).any())


def _view(curve: DamperCurve, length: Scale, *, per_force: bool) -> _View:
    values = curve.values
    # An axis has no place for infinity, a logarithmic one none for zero.
    finite = curve.arrays.solved & np.isfinite(values)
    drawn: Int = np.flatnonzero(finite if _is_linear(curve) else finite & (values > 0.0))
    if not drawn.size:
        raise ModelError("results: a curve has no peak at a finite value to draw")
    shown: Int = drawn[np.argsort(values[drawn], kind="stable")]
    x, level = values[shown], force_level(curve.model)
    stretch = x if curve.parameter == "level" else np.ones(x.size)
    factor, unit = np.full(x.size, length.factor), length.label
    if per_force:
        factor, unit = length.factor / (unit_level(curve.model) * stretch), f"{length.label}/N"
    x, label = _abscissa(curve, x, level, per_force=per_force)
    best = int(np.nanargmin(curve.objective[shown]))
    return _View(x, factor * curve.amplitude[shown], shown, label, factor, stretch, best, unit)


def _abscissa(curve: DamperCurve, x: Float, level: float, *, per_force: bool) -> tuple[Float, str]:
    """Return what a curve is drawn against: force over slip force where there is one of each."""
    if curve.parameter != "level":
        return x, label_of(curve.settings.variation)
    limits = {limit for contact in curve.model.contacts for limit in contact.limits}
    limits = {limit for limit in limits if 0.0 < limit < np.inf}
    if per_force and len(limits) == 1:
        return x * level / limits.pop(), "force over slip force $P/F_d$"
    if level:
        return x * level, "force $P$ [N]"
    return x, "level of the forces"


def _draw_limits(ax: Axes, curve: DamperCurve, view: _View) -> None:
    """Draw the peaks of the linear responses with all contacts stuck, and with none."""
    kept = curve.settings
    if not force_level(curve.model):
        return
    for stuck in (True, False):
        if stuck and curve.parameter.endswith("stiffness"):
            continue
        _, amplitude = limit_curve(curve.model, kept.dof, kept.span, kept.measure, stuck=stuck)
        height = float(amplitude.max()) * view.stretch * view.factor
        ax.plot(view.x, height, **style.linear_limit(stuck=stuck))


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
    first, second = (np.argsort(values) for values in result.values)
    heights = scale.factor * result.amplitude[np.ix_(first, second)].T
    x, y = result.values[0][first], result.values[1][second]
    shade = ax.pcolormesh(x, y, heights, shading="nearest", cmap="viridis")
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
