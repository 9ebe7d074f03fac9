"""Fits: what was measured beside what the model predicts, and how well parameters are known."""

from __future__ import annotations

from typing import Unpack

import numpy as np
from matplotlib.axes import Axes

from stickslip.errors import ModelError
from stickslip.plot import style
from stickslip.plot.figure import figure
from stickslip.plot.options import Drawing, FitOptions
from stickslip.results.fit import KINDS, Fit

_LOOP = KINDS.index("measured loop")


@figure
def fit(ax: Axes, /, result: Fit, **options: Unpack[FitOptions]) -> None:
    """Draw what was measured as points, and what the fitted model predicts as lines.

    Response curves and peaks over frequency; of a fit to loops alone, forces over displacements.
    """
    loops = bool((result.arrays.test_kind == _LOOP).all())
    shown = [
        number for number, kind in enumerate(result.arrays.test_kind) if (kind == _LOOP) == loops
    ]
    scale = style.LENGTH[options["length_unit"]]
    omega = style.omega_scale(options["omega_unit"], result)
    for number, colour in zip(shown, style.colours(len(shown)), strict=True):
        own = result.of_test(number)
        x, seen = result.arrays.abscissa[own], result.arrays.observed[own]
        said = result.arrays.predicted[own]
        if loops:
            x = x * scale.factor
        elif KINDS[result.arrays.test_kind[number]] == "measured peak":
            # Behind the height of a peak stands its frequency.
            x, seen, said = x[:1] * omega.factor, seen[:1] * scale.factor, said[:1] * scale.factor
        else:
            x, seen, said = x * omega.factor, seen * scale.factor, said * scale.factor
        ax.plot(x, seen, **style.mark("o", 3.5, colour, "none"), label=result.names[number])
        if x.size > 1:
            if loops:
                x, said = np.append(x, x[0]), np.append(said, said[0])
            ax.plot(x, said, color=colour, lw=1.3)
        else:
            ax.plot(x, said, **style.mark("_", 12, colour))
    if loops:
        ax.set(xlabel=f"displacement [{scale.label}]", ylabel="force [N]")
        return
    ax.set(xlabel=omega.label, ylabel=f"amplitude [{scale.label}]")
    if options["log"]:
        ax.set_yscale("log")


@figure
def fit_residuals(ax: Axes, /, result: Fit, **options: Unpack[Drawing]) -> None:
    """Draw the residuals of every number in standard deviations, measurement by measurement."""
    names = result.names
    for number, colour in zip(range(len(names)), style.colours(len(names)), strict=True):
        own = np.flatnonzero(result.of_test(number))
        ax.plot(own, result.residuals[own], **style.mark("o", 3, colour), label=names[number])
    ax.axhline(0.0, color=style.GREY, lw=0.9)
    for side in (-2.0, 2.0):
        ax.axhline(side * result.scatter, color=style.GREY, lw=0.9, ls=style.STUCK)
    ax.set(xlabel="number", ylabel="prediction less measurement [standard deviations]")


@figure
def fit_intervals(ax: Axes, /, result: Fit, **options: Unpack[Drawing]) -> None:
    """Draw the intervals of the parameters relative to their values."""
    if not np.all(result.arrays.value):
        raise ModelError("fit_intervals: a value is zero; see intervals instead")
    names = result.parameters
    place = np.arange(len(names))
    low, high = result.arrays.interval.T / result.arrays.value
    known = np.array(list(result.identifiable.values()))
    for which, colour, label in (
        (known, style.BLUE, "determined"),
        (~known, style.ORANGE, "not determined by the data"),
    ):
        if which.any():
            ax.errorbar(
                np.ones(int(which.sum())),
                place[which],
                xerr=[(1.0 - low)[which], (high - 1.0)[which]],
                fmt="o",
                color=colour,
                capsize=4,
                label=label,
            )
    ax.axvline(1.0, color=style.GREY, lw=0.9)
    ax.set_yticks(place, names)
    ax.set(xlabel="interval over value", ylim=(len(names) - 0.5, -0.5))
