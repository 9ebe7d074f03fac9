"""Figures of forced responses, drawn on Matplotlib axes.

Every function takes the axes to draw on, or makes a figure where none are given, and returns the
axes: ``frf.plot("tip").figure.savefig("tip.pdf")``.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal, NamedTuple, TypedDict

import numpy as np

from stickslip.checks import choice
from stickslip.errors import ModelError
from stickslip.model import PointRef
from stickslip.plot.arguments import at, dofs_of, require_solved, result_of, results_of
from stickslip.plot.curve_view import CurveView, names_of, span_of
from stickslip.plot.limits import force_level
from stickslip.plot.style import (
    GREY,
    STUCK,
    LengthUnit,
    OmegaUnit,
    colours,
    finish,
    fit,
    length_scale,
    new_axes,
    omega_scale,
    prefixed,
)
from stickslip.results import ForcedResponse
from stickslip.results.arrays import Float, Measure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["CurveOptions", "Frame", "LoopOptions", "curves", "hysteresis", "slip", "waveform"]


class Frame(TypedDict, total=False):
    """Where, and in which unit, a displacement is drawn."""

    ax: Axes | None
    length_unit: LengthUnit


class LoopOptions(Frame, total=False):
    """Keywords of `hysteresis`."""

    samples: int


class CurveOptions(Frame, total=False):
    """Keywords of `curves`."""

    measure: Measure
    normalise: Literal["force"] | None
    omega_unit: OmegaUnit
    log: bool
    stuck: bool
    free: bool
    peaks: bool
    labels: Sequence[str] | None
    error_band: bool | None


def curves(
    results: ForcedResponse | Sequence[ForcedResponse],
    dof: str,
    *,
    ax: Axes | None = None,
    measure: Measure = "half_range",
    normalise: Literal["force"] | None = None,
    omega_unit: OmegaUnit = "rad/s",
    length_unit: LengthUnit = "m",
    log: bool = True,
    stuck: bool = True,
    free: bool = True,
    peaks: bool = True,
    labels: Sequence[str] | None = None,
    error_band: bool | None = None,
) -> Axes:
    """Draw response curves over frequency, between their two linear limits.

    Parameters
    ----------
    results : ForcedResponse or sequence of ForcedResponse
        One curve each, for example over excitation levels.
    dof : str
        An observed degree of freedom.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.
    measure : {"half_range", "max", "fundamental"}, optional
        Measure of the amplitude.
    normalise : {"force"}, optional
        Divide every curve by its largest force amplitude.
    omega_unit : {"rad/s", "Hz"}, optional
        Unit of the frequency axis.
    length_unit : {"m", "mm", "um"}, optional
        Unit of the amplitude axis.
    log : bool, optional
        Logarithmic amplitude axis. A linear one ends above the curves and cuts the linear limits.
    stuck, free : bool, optional
        Draw the linear responses with every contact stuck, and with none. Unless normalised, they
        are those to the largest force among the results.
    peaks : bool, optional
        Mark the refined peaks.
    labels : sequence of str, optional
        One per result. Default: what distinguishes them (force, slip force, harmonics).
    error_band : bool, optional
        Shade what the discarded harmonics could still change. Default: for a single curve.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ModelError
        If an argument is of the wrong type; if there is no result, or no such degree of freedom,
        measure or unit; if the number of labels is not that of the results; or if a curve without
        force is to be normalised.
    """
    listed = results_of(results)
    names = names_of(listed, labels)
    if normalise is not None:
        choice(normalise, "normalise", ["force"])
    omega, length = omega_scale(omega_unit), length_scale(length_unit)
    for result in listed:
        result.amplitude(dof, measure)  # what is unknown is refused before anything is drawn
    made, ax = ax is None, new_axes(ax)
    view = CurveView(ax, dof, measure, omega, length, per_force=normalise == "force")
    _draw_limits(view, listed, stuck=stuck, free=free)
    single = len(listed) == 1
    for result, name, colour in zip(listed, names, colours(len(listed)), strict=True):
        view.draw(result, colour, name)
        if error_band or (error_band is None and single):
            view.shade_error(result, colour)
        view.mark_certificate(result, colour)
        if peaks:
            view.mark_peak(result, colour, named=single)
    view.label_axes()
    fit(ax, log=log)
    finish(ax, made=made)
    return ax


def waveform(
    result: ForcedResponse,
    dof: str | Sequence[str],
    index: int,
    *,
    ax: Axes | None = None,
    length_unit: LengthUnit = "m",
    samples: int = 512,
) -> Axes:
    """Draw one period of the motion of one or several degrees of freedom.

    Parameters
    ----------
    result : ForcedResponse
        The result.
    dof : str or sequence of str
        Observed degrees of freedom.
    index : int
        Position of the point of the sweep; see `ForcedResponse.index`.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.
    length_unit : {"m", "mm", "um"}, optional
        Unit of the displacement.
    samples : int, optional
        Instants per period.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such degree of freedom or unit, or no solved point of that position.
    """
    dofs = dofs_of(dof)
    result, length = result_of(result), length_scale(length_unit)
    require_solved(result, [index])
    waves = [result.waveform(one, index, samples) for one in dofs]
    made, ax = ax is None, new_axes(ax)
    time = np.linspace(0.0, 1.0, samples + 1)
    for one, wave, colour in zip(dofs, waves, colours(len(dofs)), strict=True):
        ax.plot(time, length.factor * _closed(wave), color=colour, lw=1.6, label=one)
    ax.set_xlim(0.0, 1.0)
    ax.set_xlabel("time over period t/T")
    ax.set_ylabel(f"displacement{f' of {dofs[0]}' if len(dofs) == 1 else ''} [{length.label}]")
    ax.set_title(at(result, index), fontsize="medium")
    finish(ax, made=made)
    return ax


def hysteresis(
    result: ForcedResponse,
    contact: PointRef,
    index: int | Sequence[int],
    *,
    ax: Axes | None = None,
    length_unit: LengthUnit = "m",
    samples: int = 512,
) -> Axes:
    """Draw the contact force against the relative displacement, over one period.

    Parameters
    ----------
    result : ForcedResponse
        The result.
    contact : int, str or (int or str, int)
        The contact, or one of its points.
    index : int or sequence of int
        Positions of points of the sweep, one loop each; see `ForcedResponse.index`.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.
    length_unit : {"m", "mm", "um"}, optional
        Unit of the displacement.
    samples : int, optional
        Instants per period.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such contact or unit, or no solved point of a position.
    """
    indices = list(index) if isinstance(index, Sequence | np.ndarray) else [index]
    if not indices:
        raise ModelError("index: empty; give the position of at least one point")
    result, length = result_of(result), length_scale(length_unit)
    require_solved(result, indices)
    loops = _loops(result, contact, indices, samples)
    made, ax = ax is None, new_axes(ax)
    for loop, colour in zip(loops, colours(len(loops)), strict=True):
        u = length.factor * loop.displacement
        ax.plot(u, loop.force, color=colour, lw=1.6, solid_joinstyle="round", label=loop.label)
    _draw_slip_limits(ax, result, contact)
    ax.set_xlabel(f"relative displacement u [{length.label}]")
    ax.set_ylabel("contact force f [N]")
    number, point = result.locate(contact)
    title = result.model.contact_names[number] + ("" if point is None else f"[{point}]")
    if len(indices) == 1:
        title += f" at {at(result, indices[0])}"
    if len(loops) == 1:
        title += f": {loops[0].label}"
    ax.set_title(title, fontsize="medium")
    finish(ax, made=made)
    return ax


def slip(
    result: ForcedResponse,
    contact: PointRef | None = None,
    *,
    ax: Axes | None = None,
    omega_unit: OmegaUnit = "rad/s",
) -> Axes:
    """Draw the share of the period that contact points slip, over frequency.

    Parameters
    ----------
    result : ForcedResponse
        The result.
    contact : int, str or (int or str, int), optional
        The contact, or one of its points. Default: all.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.
    omega_unit : {"rad/s", "Hz"}, optional
        Unit of the frequency axis.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no contact, or no such contact or unit.
    """
    result, omega = result_of(result), omega_scale(omega_unit)
    contacts = range(len(result.model.contacts)) if contact is None else [contact]
    lines = [line for one in contacts for line in _shares(result, one)]
    if not lines:
        raise ModelError("contact: the model has none, so that nothing slips")
    made, ax = ax is None, new_axes(ax)
    for (label, share), colour in zip(lines, colours(len(lines)), strict=True):
        ax.plot(omega.factor * result.omega, share, color=colour, lw=1.6, label=label)
    if result.omega.min() < result.omega.max():
        ax.set_xlim(omega.factor * result.omega.min(), omega.factor * result.omega.max())
    ax.set_ylim(-0.03, 1.03)
    ax.set_xlabel(omega.label)
    ax.set_ylabel("slipping share of the period")
    if len(lines) == 1:
        ax.set_title(lines[0][0], fontsize="medium")
    finish(ax, made=made)
    return ax


class _Loop(NamedTuple):
    displacement: Float
    force: Float
    label: str


def _draw_limits(
    view: CurveView, results: Sequence[ForcedResponse], *, stuck: bool, free: bool
) -> None:
    """Draw the linear limits of the most strongly forced result."""
    levels = [force_level(result.model) for result in results]
    model = results[int(np.argmax(levels))].model
    low, high = span_of(results)
    if not model.contacts or low == high or not max(levels):
        return
    at = "" if view.per_force or len(set(levels)) == 1 else f", {max(levels):.5g} N"
    for is_stuck, wanted in ((True, stuck), (False, free)):
        if wanted:
            view.draw_limit(model, (low, high), at, stuck=is_stuck)


def _draw_slip_limits(ax: Axes, result: ForcedResponse, contact: PointRef) -> None:
    """Draw the forces that the contact cannot exceed, where the law has one such force."""
    number, point = result.locate(contact)
    limits = result.model.contacts[number].limits
    limit = limits[point or 0] if point is not None or len(limits) == 1 else np.inf
    if np.isfinite(limit):
        for side in (-limit, limit):
            ax.axhline(side, color=GREY, lw=0.9, ls=STUCK, zorder=1.5)
        ax.annotate(
            f"$F_d$ = {limit:.4g} N",
            (1.0, limit),
            (0.0, 2.0),
            xycoords=ax.get_yaxis_transform(),
            textcoords="offset points",
            ha="right",
            va="bottom",
            color=GREY,
            fontsize="small",
        )
        ax.margins(y=0.08)


def _loops(
    result: ForcedResponse, contact: PointRef, indices: Sequence[int], samples: int
) -> list[_Loop]:
    """Return the loops of all points of a contact, at some points of the sweep."""
    loops = []
    for index in indices:
        u = result.contact_waveform(contact, index, samples).reshape(samples, -1)
        f = result.contact_force(contact, index, samples).reshape(samples, -1)
        lost = np.atleast_1d(result.dissipation(contact)[index])
        for point, work in enumerate(lost):
            label = f"{prefixed(float(work), 'J')} per cycle" if work else "sticks"
            if len(lost) > 1:
                label = f"point {point}: {label}"
            if len(indices) > 1:
                label = f"{at(result, index)}: {label}"
            loops.append(_Loop(_closed(u[:, point]), _closed(f[:, point]), label))
    return loops


def _shares(result: ForcedResponse, contact: PointRef) -> list[tuple[str, Float]]:
    """Return label and slip fraction of every point meant by an address."""
    number, only = result.locate(contact)
    shares = result.slip_fraction(contact).reshape(result.omega.size, -1)
    name = result.model.contact_names[number]
    if only is None and shares.shape[1] == 1:
        return [(name, shares[:, 0])]
    first = only or 0
    return [(f"{name}[{first + point}]", share) for point, share in enumerate(shares.T)]


def _closed(period: Float) -> Float:
    """Append the first instant, which the period ends with."""
    return np.append(period, period[:1])
