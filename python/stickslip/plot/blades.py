"""Figures of mistuned disks: their blades side by side."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, TypedDict

import numpy as np

from stickslip.checks import brief, members, whole_number
from stickslip.errors import ModelError
from stickslip.plot.arguments import require_solved, result_of
from stickslip.plot.style import (
    GREY,
    RESPONSE,
    STUCK,
    LengthUnit,
    OmegaUnit,
    colours,
    finish,
    fit,
    length_scale,
    new_axes,
    omega_scale,
)
from stickslip.results import ForcedResponse
from stickslip.results.arrays import Measure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["BladeBarOptions", "BladeCurveOptions", "blade_bars", "blade_curves"]

_COLOUR = "#31688e"


class BladeBarOptions(TypedDict, total=False):
    """Keywords of `blade_bars`."""

    index: int | None
    tuned: ForcedResponse | None
    ax: Axes | None
    measure: Measure
    length_unit: LengthUnit


class BladeCurveOptions(TypedDict, total=False):
    """Keywords of `blade_curves`."""

    tuned: ForcedResponse | None
    ax: Axes | None
    measure: Measure
    omega_unit: OmegaUnit
    length_unit: LengthUnit
    log: bool


def blade_bars(
    result: ForcedResponse,
    dof: str,
    *,
    index: int | None = None,
    tuned: ForcedResponse | None = None,
    ax: Axes | None = None,
    measure: Measure = "half_range",
    length_unit: LengthUnit = "m",
) -> Axes:
    """Draw the amplitude of every blade of a mistuned disk as a bar.

    Parameters
    ----------
    result : ForcedResponse
        The result of a `MistunedDisk`.
    dof : str
        Degree of freedom of a sector: "tip".
    index : int, optional
        Position of a point of the sweep. Default: the largest amplitude of each blade among the
        computed points.
    tuned : ForcedResponse, optional
        The response of the tuned disk, drawn as a line: its peak, or its amplitude at the computed
        frequency nearest to that of `index`.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.
    measure : {"half_range", "max", "fundamental"}, optional
        Measure of the amplitude.
    length_unit : {"m", "mm", "um"}, optional
        Unit of the amplitude axis.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ModelError
        If the result is not one of a `MistunedDisk`, there is no such degree of freedom, unit or
        solved point.
    """
    result, length = result_of(result), length_scale(length_unit)
    amplitudes = result.blade_amplitudes(dof, measure)
    if index is None:
        if not result.arrays.solved.any():
            raise ModelError("result: no point is solved, and nothing to draw; see status")
        heights, title = np.nanmax(amplitudes, axis=0), "largest over frequency"
    else:
        require_solved(result, [index])
        place = result.position(index)
        heights, title = amplitudes[place], f"ω = {result.omega[place]:.5g} rad/s"
    level = None if tuned is None else _tuned_level(result, tuned, dof, measure, index)
    from matplotlib.ticker import MaxNLocator

    made, ax = ax is None, new_axes(ax)
    blades = result.blades(dof)
    ax.bar(blades, length.factor * heights, width=0.8, color=_COLOUR, label="mistuned")
    if level is not None:
        ax.axhline(length.factor * level, color=GREY, lw=1.2, ls=STUCK, label="tuned")
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    ax.set_xlim(-0.7, result.model.sectors - 0.3)  # type: ignore[attr-defined]
    ax.set_xlabel("blade")
    ax.set_ylabel(f"amplitude of {dof} [{length.label}]")
    ax.set_title(title, fontsize="medium")
    finish(ax, made=made)
    return ax


def blade_curves(
    result: ForcedResponse,
    dof: str,
    blades: Sequence[int] | None = None,
    *,
    tuned: ForcedResponse | None = None,
    ax: Axes | None = None,
    measure: Measure = "half_range",
    omega_unit: OmegaUnit = "rad/s",
    length_unit: LengthUnit = "m",
    log: bool = True,
) -> Axes:
    """Draw the response curves of blades of a mistuned disk.

    Parameters
    ----------
    result : ForcedResponse
        The result of a `MistunedDisk`.
    dof : str
        Degree of freedom of a sector: "tip".
    blades : sequence of int, optional
        The blades, counted from 0. Default: all that were observed.
    tuned : ForcedResponse, optional
        The response of the tuned disk, drawn beside them.
    ax : matplotlib.axes.Axes, optional
        Where to draw. Default: a new figure.
    measure : {"half_range", "max", "fundamental"}, optional
        Measure of the amplitude.
    omega_unit : {"rad/s", "Hz"}, optional
        Unit of the frequency axis.
    length_unit : {"m", "mm", "um"}, optional
        Unit of the amplitude axis.
    log : bool, optional
        Logarithmic amplitude axis.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ModelError
        If the result is not one of a `MistunedDisk`, or there is no such degree of freedom, blade
        or unit.
    """
    result = result_of(result)
    omega, length = omega_scale(omega_unit), length_scale(length_unit)
    observed = result.blades(dof)
    given = observed if blades is None else members(blades, "blades", "blades=[0, 1]")
    chosen = [whole_number(blade, "blades") for blade in given]
    for blade in chosen:
        if blade not in observed:
            raise ModelError(f"blades: {blade} was not observed at {dof!r}; observed: {observed}")
    curves = [result.amplitude(f"{blade}.{dof}", measure) for blade in chosen]
    reference = None if tuned is None else _tuned(tuned).amplitude(dof, measure)
    made, ax = ax is None, new_axes(ax)
    for blade, curve, colour in zip(chosen, curves, colours(len(chosen)), strict=True):
        label = f"blade {blade}" if len(chosen) <= 12 else None
        (line,) = ax.plot(
            omega.factor * result.omega, length.factor * curve, color=colour, lw=1.3, label=label
        )
        line.set_gid(RESPONSE)
    if tuned is not None:
        (line,) = ax.plot(
            omega.factor * tuned.omega,
            length.factor * np.asarray(reference),
            color="black",
            lw=1.4,
            ls=STUCK,
            label="tuned",
        )
        line.set_gid(RESPONSE)
    ax.set_xlabel(omega.label)
    ax.set_ylabel(f"amplitude of {dof} [{length.label}]")
    fit(ax, log=log)
    finish(ax, made=made)
    return ax


def _tuned(tuned: object) -> ForcedResponse:
    if not isinstance(tuned, ForcedResponse) or not tuned.model.travels:
        raise ModelError(
            f"tuned: {brief(tuned)} is not the response of a BladedDisk; give "
            "forced_response(disk, ...)"
        )
    return tuned


def _tuned_level(
    result: ForcedResponse, tuned: object, dof: str, measure: Measure, index: int | None
) -> float:
    reference = _tuned(tuned)
    if index is None:
        return reference.peak(dof, measure).amplitude
    near = reference.index(float(result.omega[result.position(index)]))
    return float(reference.amplitude(dof, measure)[near])
