"""Responses along the speed of rotation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Unpack

import numpy as np
from matplotlib.axes import Axes

from stickslip.errors import ModelError
from stickslip.plot import style
from stickslip.plot.arguments import checked_labels, several
from stickslip.plot.figure import figure
from stickslip.plot.options import SpeedOptions
from stickslip.results.campbell import Campbell
from stickslip.results.speed_response import SpeedResponse


@figure
def speed_response(
    ax: Axes,
    /,
    results: SpeedResponse | Sequence[SpeedResponse],
    **options: Unpack[SpeedOptions],
) -> None:
    """Draw amplitudes over the speed of the rotor, a line per engine order.

    Above the axis of one engine order stand the frequencies.
    """
    listed = several(SpeedResponse, results, lambda one: f"the amplitude of {one.dof}")
    names = checked_labels(options["labels"], [f"EO {one.engine_order:g}" for one in listed])
    rpm, length = style.OMEGA["rpm"].factor, style.LENGTH[options["length_unit"]]
    for one, name, colour in zip(listed, names, style.colours(len(listed)), strict=True):
        ax.plot(rpm * one.speed, length.factor * one.amplitude, color=colour, lw=1.6, label=name)
        if options["diagram"] is not None:
            _mark_resonances(ax, one, options["diagram"], colour)
    ends = rpm * np.array([f(one.speed) for one in listed for f in (np.min, np.max)])
    if ends.min() < ends.max():
        ax.set_xlim(ends.min(), ends.max())
    ax.set_yscale("log" if options["log"] else "linear")
    orders = {one.engine_order for one in listed}
    style.label_omega(ax, style.rotor_speed(orders.pop() if len(orders) == 1 else None))
    ax.set_ylabel(f"half peak-to-peak of {style.named(listed[0].dof)} [{length.label}]")


def _mark_resonances(
    ax: Axes, response: SpeedResponse, diagram: Campbell, colour: style.Colour
) -> None:
    """Draw lines at the speeds at which the engine order meets natural frequencies."""
    order = response.engine_order
    if order not in diagram.orders:
        known = ", ".join(map(str, diagram.orders))
        raise ModelError(f"diagram: it has the engine orders {known}, not {order:g}; give orders=")
    ends = response.speed.min(), response.speed.max()
    slips = bool(diagram.model.contacts)
    for slipping, line in ((False, style.STUCK), (True, style.FREE))[: 1 + slips]:
        state = (", slipping" if slipping else ", stuck") * slips
        label = f"resonances of EO {order:g}{state}"
        for one in diagram.crossings(slipping=slipping):
            if one.order == order and ends[0] <= one.speed <= ends[1]:
                at = style.OMEGA["rpm"].factor * one.speed
                ax.axvline(at, color=colour, lw=1.0, ls=line, label=label, zorder=1.5)
                label = "_"
