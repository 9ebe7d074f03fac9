"""Mistuned disks: their blades side by side."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from stickslip.checks import brief, members, whole_number
from stickslip.errors import ModelError
from stickslip.plot.arguments import at, of_kind, require_solved
from stickslip.plot.documentation import figure
from stickslip.plot.style import (
    BLUE,
    GREY,
    RESPONSE,
    STUCK,
    LengthUnit,
    Looks,
    OmegaUnit,
    colours,
    fit,
    framed,
    length_scale,
    omega_scale,
)
from stickslip.results import ForcedResponse
from stickslip.results.arrays import Measure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["blade_bars", "blade_curves"]


@figure
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
    dof : str
        Degree of freedom of a sector: "tip".
    index : int, optional
        Position of a point of the sweep. Default: the largest amplitude of each blade among the
        computed points.
    tuned : ForcedResponse, optional
        The response of the tuned disk, drawn as a line: its peak, or its amplitude at the computed
        frequency nearest to that of `index`.
    """
    result, length = of_kind(ForcedResponse, result), length_scale(length_unit)
    amplitudes = result.blade_amplitudes(dof, measure)
    if index is None:
        if not result.arrays.solved.any():
            raise ModelError("result: no point is solved, and nothing to draw; see status")
        heights, title = np.nanmax(amplitudes, axis=0), "largest over frequency"
    else:
        require_solved(result, [index])
        heights, title = amplitudes[result.position(index)], at(result, index)
    level = np.nan
    if tuned is not None:
        reference = _tuned(tuned)
        if index is None:
            level = reference.peak(dof, measure).amplitude
        else:
            near = reference.index(float(result.omega[index]))
            level = float(reference.amplitude(dof, measure)[near])
    from matplotlib.ticker import MaxNLocator

    with framed(ax) as ax:
        blades = result.blades(dof)
        ax.bar(blades, length.factor * heights, width=0.8, color=BLUE, label="mistuned")
        if tuned is not None:
            ax.axhline(length.factor * level, color=GREY, lw=1.2, ls=STUCK, label="tuned")
        ax.xaxis.set_major_locator(MaxNLocator(integer=True))
        ax.set_xlim(-0.7, result.model.sectors - 0.3)  # type: ignore[attr-defined]
        ax.set(xlabel="blade", ylabel=f"amplitude of {dof} [{length.label}]")
        ax.set_title(title, fontsize="medium")
    return ax


@figure
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
    dof : str
        Degree of freedom of a sector: "tip".
    blades : sequence of int, optional
        The blades, counted from 0. Default: all that were observed.
    tuned : ForcedResponse, optional
        The response of the tuned disk, drawn beside them.
    """
    result = of_kind(ForcedResponse, result)
    omega, length = omega_scale(omega_unit), length_scale(length_unit)
    observed = result.blades(dof)
    given = observed if blades is None else members(blades, "blades", "blades=[0, 1]")
    chosen = [whole_number(blade, "blades") for blade in given]
    for blade in chosen:
        if blade not in observed:
            raise ModelError(f"blades: {blade} was not observed at {dof!r}; observed: {observed}")
    x = omega.factor * result.omega
    curves = [result.amplitude(f"{blade}.{dof}", measure) for blade in chosen]
    reference = None if tuned is None else _tuned(tuned).amplitude(dof, measure)
    with framed(ax) as ax:
        for blade, curve, colour in zip(chosen, curves, colours(len(chosen)), strict=True):
            label = f"blade {blade}" if len(chosen) <= 12 else None
            ax.plot(x, length.factor * curve, color=colour, lw=1.3, label=label, gid=RESPONSE)
        if tuned is not None and reference is not None:
            looks: Looks = {"color": "black", "lw": 1.4, "ls": STUCK, "gid": RESPONSE}
            ax.plot(omega.factor * tuned.omega, length.factor * reference, label="tuned", **looks)
        ax.set(xlabel=omega.label, ylabel=f"amplitude of {dof} [{length.label}]")
        fit(ax, log=log)
    return ax


def _tuned(tuned: object) -> ForcedResponse:
    if not isinstance(tuned, ForcedResponse) or not tuned.model.travels:
        raise ModelError(
            f"tuned: {brief(tuned)} is not the response of a BladedDisk; give "
            "forced_response(disk, ...)"
        )
    return tuned
