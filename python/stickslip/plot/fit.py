"""Fits: what was measured beside what the model predicts, and how well parameters are known."""

from __future__ import annotations

from typing import Any, Unpack

import numpy as np
from matplotlib.axes import Axes

from stickslip.errors import ModelError
from stickslip.plot import style
from stickslip.plot.figure import figure
from stickslip.plot.options import Drawing, FitBackboneOptions, FitOptions
from stickslip.results.fit import AGAINST, QUANTITIES, Fit

_FREQUENCY, _DISPLACEMENT, _AMPLITUDE, _MODAL = range(len(AGAINST))
_OMEGA = QUANTITIES.index("omega")


@figure
def fit(ax: Axes, /, result: Fit, **options: Unpack[FitOptions]) -> None:
    """Draw what was measured as points, and what the fitted model predicts as lines.

    Response curves and peaks over frequency; of a fit without them, forces of loops over
    displacements. Backbones have a figure of their own.
    """
    arrays = result.arrays
    loops = not (arrays.against == _FREQUENCY).any()
    shown = np.flatnonzero(arrays.against == (_DISPLACEMENT if loops else _FREQUENCY))
    if not shown.size:
        raise ModelError("fit: backbones alone were measured; draw them with plot_backbone()")
    scale = style.LENGTH[options["length_unit"]]
    omega = style.omega_scale(options["omega_unit"], result)
    for number, colour in zip(shown, style.colours(shown.size), strict=True):
        # Peaks may have their frequency among the numbers.
        own = result.of_test(int(number)) & (arrays.quantity != _OMEGA)
        x, seen = arrays.abscissa[own], arrays.observed[own]
        said = np.where(arrays.solved[own], arrays.predicted[own], np.nan)
        if loops:
            x, behind = x * scale.factor, slice(0, 1)
        else:
            x, seen, said = x * omega.factor, seen * scale.factor, said * scale.factor
            behind = slice(0, 0)
        ax.plot(
            x, seen, **style.mark("o", 3.5, colour, "none"), label=style.named(result.names[number])
        )
        if x.size > 1:
            line = [np.append(one, one[behind]) for one in (x, said)]
            ax.plot(*line, color=colour, lw=1.3, label=_predicted(result, number))
        else:
            ax.plot(x, said, **style.mark("_", 12, colour), label=_predicted(result, number))
    if loops:
        ax.set(xlabel=f"displacement [{scale.label}]", ylabel="force [N]")
        return
    ax.set(xlabel=omega.label, ylabel=f"amplitude [{scale.label}]")
    if options["log"]:
        ax.set_yscale("log")


@figure
def fit_backbone(ax: Axes, /, result: Fit, **options: Unpack[FitBackboneOptions]) -> None:
    """Draw measured frequencies, or damping ratios, over the amplitude, and what is predicted.

    Over amplitudes of degrees of freedom; modal amplitudes are drawn where there are no others.
    """
    arrays = result.arrays
    damping = options["damping"]
    if damping is None:
        damping = not result.of_backbones(damping=False).any()
    wanted = np.array(result.of_backbones(damping=damping))
    against = arrays.against[arrays.test]
    modal = not (against[wanted] == _AMPLITUDE).any()
    wanted &= against == (_MODAL if modal else _AMPLITUDE)
    if not wanted.any():
        raise ModelError(
            f"fit_backbone: no {'damping ratios' if damping else 'frequencies'} of a backbone were "
            "measured"
        )
    length = style.LENGTH[options["length_unit"]]
    omega = style.omega_scale(options["omega_unit"], result)
    factor = 1.0 if damping else omega.factor
    shown = np.unique(arrays.test[wanted])
    for number, colour in zip(shown, style.colours(shown.size), strict=True):
        own = np.flatnonzero(wanted & (arrays.test == number))
        own = own[np.argsort(arrays.abscissa[own], kind="stable")]
        x = arrays.abscissa[own] * (1.0 if modal else length.factor)
        seen, said = factor * arrays.observed[own], factor * arrays.predicted[own]
        ax.plot(
            x, seen, **style.mark("o", 3.5, colour, "none"), label=style.named(result.names[number])
        )
        found = arrays.solved[own]
        ax.plot(x[found], said[found], color=colour, lw=1.3, label=_predicted(result, number))
    below = "modal amplitude [m kg$^{1/2}$]" if modal else f"amplitude [{length.label}]"
    ax.set(xscale="log", xlabel=below, ylabel="damping ratio" if damping else omega.label)


def _predicted(result: Fit, number: np.integer[Any]) -> str:
    """Return the name of what is predicted of a test."""
    return f"{style.named(result.names[number])}, predicted"


@figure
def fit_residuals(ax: Axes, /, result: Fit, **options: Unpack[Drawing]) -> None:
    """Draw the residuals of every number in standard deviations, measurement by measurement."""
    names = result.names
    for number, colour in zip(range(len(names)), style.colours(len(names)), strict=True):
        own = np.flatnonzero(result.of_test(number))
        ax.plot(
            own,
            result.residuals[own],
            **style.mark("o", 3, colour),
            label=style.named(names[number]),
        )
    ax.axhline(0.0, color=style.GREY, lw=0.9)
    for side, label in ((-2.0, "_"), (2.0, f"2 x scatter of {result.scatter:.3g}")):
        level = side * result.scatter
        ax.axhline(level, color=style.GREY, lw=0.9, ls=style.STUCK, label=label)
    ax.set(xlabel="number of the measurement")
    ax.set_ylabel("prediction less measurement [standard deviations]")


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
    ax.set_yticks(place, [*map(style.named, names)])
    confidence = f"{100.0 * result.settings.confidence:g} %"
    ax.set_xlabel(f"{confidence} interval relative to the value")
    ax.set_ylim(len(names) - 0.5, -0.5)
