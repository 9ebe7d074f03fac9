"""Mistuned disks: their blades side by side."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Unpack

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from stickslip.checks import members, whole_number
from stickslip.errors import ModelError
from stickslip.plot import style
from stickslip.plot.arguments import at, solved_points
from stickslip.plot.figure import figure
from stickslip.plot.options import BladeBarOptions, BladeCurveOptions
from stickslip.plot.style import Looks
from stickslip.results import ForcedResponse
from stickslip.results.blades import response_of_disk

_NAMED = 12
"""Blades of which each has a name in the legend."""


@figure
def blade_bars(
    ax: Axes, /, result: ForcedResponse, dof: str, **options: Unpack[BladeBarOptions]
) -> None:
    """Draw the amplitude of every blade of a mistuned disk as a bar.

    Parameters
    ----------
    dof : str
        Degree of freedom of a sector: "tip".
    """
    length, index, measure = (
        style.LENGTH[options["length_unit"]],
        options["index"],
        options["measure"],
    )
    amplitudes = result.blade_amplitudes(dof, measure)
    if index is None:
        if not result.arrays.solved.any():
            raise ModelError("result: no point is solved, and nothing to draw; see status")
        heights, title = np.nanmax(amplitudes, axis=0), "largest over frequency"
    else:
        solved_points(result, index)
        heights = amplitudes[result.position(index)]
        title = at(result, index, options["omega_unit"])
    if options["tuned"] is not None:
        tuned = response_of_disk(options["tuned"])
        level = tuned.peak(dof, measure).amplitude
        if index is not None:
            level = tuned.amplitude(dof, measure)[tuned.index(float(result.omega[index]))]
        ax.axhline(length.factor * level, color=style.GREY, lw=1.2, ls=style.STUCK, label="tuned")
    blades = result.blades(dof)
    ax.bar(blades, length.factor * heights, width=0.8, color=style.BLUE, label="mistuned")
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    ax.set_xlim(-0.7, result.model.sectors - 0.3)  # type: ignore[attr-defined]
    ax.set(xlabel="blade", ylabel=f"amplitude of {style.named(dof)} [{length.label}]")
    ax.set_title(title, fontsize="medium")


@figure
def blade_curves(
    ax: Axes,
    /,
    result: ForcedResponse,
    dof: str,
    blades: Sequence[int] | None = None,
    **options: Unpack[BladeCurveOptions],
) -> None:
    """Draw the response curves of blades of a mistuned disk.

    Parameters
    ----------
    dof : str
        Degree of freedom of a sector: "tip".
    blades : sequence of int, optional
        The blades, counted from 0. Default: all that were observed.
    """
    omega = style.omega_scale(options["omega_unit"], result)
    length = style.LENGTH[options["length_unit"]]
    observed = result.blades(dof)
    given = observed if blades is None else members(blades, "blades", "blades=[0, 1]")
    chosen = [whole_number(blade, "blades") for blade in given]
    if not chosen:
        raise ModelError("blades: empty; give at least one, or leave it out for all")
    for blade in chosen:
        if blade not in observed:
            raise ModelError(f"blades: {blade} was not observed at {dof!r}; observed: {observed}")
    x = omega.factor * result.omega
    curves = [result.amplitude(f"{blade}.{dof}", options["measure"]) for blade in chosen]
    tuned = None if options["tuned"] is None else response_of_disk(options["tuned"])
    for blade, curve, colour in zip(chosen, curves, style.colours(len(chosen)), strict=True):
        # Of many the ends of the colours are named.
        named = len(chosen) <= _NAMED or blade in (chosen[0], chosen[-1])
        label = f"blade {blade}" if named else None
        ax.plot(x, length.factor * curve, color=colour, lw=1.3, label=label, gid=style.RESPONSE)
    if tuned is not None:
        looks: Looks = {"color": "black", "lw": 1.4, "ls": style.STUCK, "gid": style.RESPONSE}
        reference = length.factor * tuned.amplitude(dof, options["measure"])
        ax.plot(omega.factor * tuned.omega, reference, label="tuned", **looks)
    style.label_omega(ax, omega)
    ax.set(ylabel=f"amplitude of {style.named(dof)} [{length.label}]")
    style.fit(ax, log=options["log"])
