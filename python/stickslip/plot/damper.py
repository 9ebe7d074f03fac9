"""The damper performance curve: peak amplitude and frequency against a parameter."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Literal, NamedTuple, TypedDict

import numpy as np

from stickslip.checks import brief, choice
from stickslip.errors import ModelError
from stickslip.plot.arguments import labels_of
from stickslip.plot.limits import force_level, limit_curve
from stickslip.plot.style import (
    FREE,
    GREY,
    LIMIT,
    RESPONSE,
    STUCK,
    LengthUnit,
    OmegaUnit,
    Scale,
    colours,
    finish,
    length_scale,
    new_axes,
    omega_scale,
)
from stickslip.results.arrays import Float, Int
from stickslip.results.damper_curve import DamperCurve

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["DamperOptions", "damper"]

_SYMBOLS = {"slip_force": "slip force $F_d$", "stiffness": "contact stiffness $k_d$"}


class DamperOptions(TypedDict, total=False):
    """Keywords of `damper`."""

    ax: Axes | None
    normalise: Literal["force"] | None
    length_unit: LengthUnit
    omega_unit: OmegaUnit
    frequency: bool
    limits: bool
    optimum: bool
    labels: Sequence[str] | None


def damper(
    results: DamperCurve | Sequence[DamperCurve],
    *,
    ax: Axes | None = None,
    normalise: Literal["force"] | None = None,
    length_unit: LengthUnit = "m",
    omega_unit: OmegaUnit = "rad/s",
    frequency: bool = True,
    limits: bool = True,
    optimum: bool = True,
    labels: Sequence[str] | None = None,
) -> Axes:
    """Draw damper performance curves: the peak against what was varied, on logarithmic axes.

    Parameters
    ----------
    results : DamperCurve or sequence of DamperCurve
        One curve each, of the same parameter.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.
    normalise : {"force"}, optional
        Divide amplitudes by the largest force, and show curves over the level against the force
        over the slip force, P/F_d. Without it curves over the level rise with the force.
    length_unit : {"m", "mm", "um"}, optional
        Unit of the amplitude.
    omega_unit : {"rad/s", "Hz"}, optional
        Unit of the frequency.
    frequency : bool, optional
        Draw the frequency of the peak too, dashed, on an axis at the right.
    limits : bool, optional
        Draw the peaks of the two linear limits: all contacts free, and all stuck unless the
        stiffness was varied.
    optimum : bool, optional
        Mark the lowest computed peak.
    labels : sequence of str, optional
        One per curve. Default: the degree of freedom.

    Returns
    -------
    matplotlib.axes.Axes
        The axes of the amplitude.

    Raises
    ------
    ModelError
        If an argument is of the wrong type, the curves are of several parameters, none has a
        value to draw, or one without force is to be normalised.
    """
    curves = _curves(results)
    if normalise is not None:
        choice(normalise, "normalise", ["force"])
    names = [one.settings.dof for one in curves]
    if labels is not None:
        names = labels_of(labels, len(curves))
    length, omega = length_scale(length_unit), omega_scale(omega_unit)
    views = [_view(curve, length, per_force=normalise == "force") for curve in curves]
    made, ax = ax is None, new_axes(ax)
    beside = ax.twinx() if frequency else None
    for curve, view, name, colour in zip(curves, views, names, colours(len(curves)), strict=True):
        (line,) = ax.plot(view.x, view.y, color=colour, lw=1.6, label=name, marker=view.marker)
        line.set_gid(RESPONSE)
        if beside is not None:
            shown = omega.factor * curve.omega[view.shown]
            beside.plot(view.x, shown, color=colour, lw=1.0, ls="--", alpha=0.8)
        if optimum:
            _mark_optimum(ax, view, colour)
        _draw_rigid(ax, curve, view, colour)
    if limits:
        _draw_limits(ax, curves[0], views[0])
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_xlabel(views[0].label)
    per_force = "/N" if normalise == "force" else ""
    ax.set_ylabel(f"peak amplitude [{length.label}{per_force}]")
    if beside is not None:
        beside.set_ylabel(f"peak {omega.label} (dashed)")
    finish(ax, made=made)
    return ax


class _View(NamedTuple):
    """What of a curve is drawn."""

    x: Float
    y: Float
    shown: Int
    """Positions of the drawn values."""
    label: str
    factor: Float
    """From amplitude [m] to what is drawn, for every drawn value."""
    stretch: Float
    """Level of the forces at every drawn value."""
    marker: str
    best: int
    unit: str


def _curves(results: object) -> list[DamperCurve]:
    listed = list(results) if isinstance(results, Iterable) else [results]
    for place, one in enumerate(listed):
        if not isinstance(one, DamperCurve):
            raise ModelError(
                f"results[{place}]: {brief(one)} is not a DamperCurve; give what damper_curve "
                "returned"
            )
    curves = [one for one in listed if isinstance(one, DamperCurve)]
    if not curves:
        raise ModelError("results: empty; give at least one DamperCurve")
    parameters = {one.parameter for one in curves}
    if len(parameters) > 1:
        raise ModelError(
            f"results: curves over {' and '.join(sorted(parameters))}; draw one parameter at a time"
        )
    return curves


def _view(curve: DamperCurve, length: Scale, *, per_force: bool) -> _View:
    values = curve.values
    # A logarithmic axis has no place for zero and infinity.
    drawn = curve.arrays.solved & np.isfinite(values) & (values > 0.0)
    shown: Int = np.flatnonzero(drawn)
    if not shown.size:
        raise ModelError("results: a curve has no peak at a finite value above 0 to draw")
    order: Int = shown[np.argsort(values[shown], kind="stable")]
    x, level = values[order], force_level(curve.model)
    stretch = x if curve.parameter == "level" else np.ones(x.size)
    factor = np.full(x.size, length.factor)
    unit = length.label
    if per_force:
        if level == 0.0:
            raise ModelError(
                'normalise: "force" needs a harmonic force, and the model has none; use None'
            )
        factor, unit = length.factor / (level * stretch), f"{length.label}/N"
    x, label = _abscissa(curve, x, level, per_force=per_force)
    y = factor * curve.amplitude[order]
    best = int(np.nanargmin(curve.objective[order]))
    marker = "." if x.size == 1 else ""
    return _View(x, y, order, label, factor, stretch, marker, best, unit)


def _abscissa(curve: DamperCurve, x: Float, level: float, *, per_force: bool) -> tuple[Float, str]:
    """Return what a curve is drawn against: force over slip force where there is one of each."""
    variation = curve.settings.variation
    if variation.common == "factor" and curve.parameter != "level":
        return x, f"factor on the {curve.parameter.replace('_', ' ')}"
    if curve.parameter != "level":
        return x, f"{_SYMBOLS[curve.parameter]} [{variation.unit}]"
    limits = {limit for contact in curve.model.contacts for limit in contact.limits}
    limits = {limit for limit in limits if 0.0 < limit < np.inf}
    if per_force and len(limits) == 1:
        return x * level / limits.pop(), "force over slip force $P/F_d$"
    if level:
        return x * level, "force $P$ [N]"
    return x, "level of the forces"


def _mark_optimum(ax: Axes, view: _View, colour: tuple[float, float, float, float]) -> None:
    x, y = view.x[view.best], view.y[view.best]
    ax.plot(
        x,
        y,
        ls="",
        marker="o",
        ms=5,
        mfc="white",
        mec=colour,
        mew=1.3,
        label=f"lowest: {y:.4g} {view.unit} at {x:.4g}",
    )


def _draw_rigid(
    ax: Axes, curve: DamperCurve, view: _View, colour: tuple[float, float, float, float]
) -> None:
    """Draw the limit of a rigid contact, which has no place on the axis."""
    if curve.parameter != "stiffness":
        return
    at = np.flatnonzero(np.isinf(curve.values) & curve.arrays.solved)
    if at.size:
        height = float(view.factor[0] * curve.amplitude[at[0]])
        ax.axhline(height, color=colour, lw=1.0, ls=":", label="rigid contact", zorder=1.5)


def _draw_limits(ax: Axes, curve: DamperCurve, view: _View) -> None:
    """Draw the peaks of the linear responses with all contacts stuck, and with none."""
    settings = curve.settings
    if not force_level(curve.model):
        return
    for stuck in (True, False):
        if stuck and curve.parameter == "stiffness":
            continue
        _, amplitude = limit_curve(
            curve.model, settings.dof, settings.span, settings.measure, stuck=stuck
        )
        (line,) = ax.plot(
            view.x,
            float(amplitude.max()) * view.stretch * view.factor,
            color=GREY,
            lw=1.1,
            ls=STUCK if stuck else FREE,
            label="stuck (linear)" if stuck else "free (linear)",
            zorder=1.5,
        )
        line.set_gid(LIMIT)
