"""Responses and natural frequencies along the speed of rotation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Unpack

import numpy as np
from matplotlib.axes import Axes

from stickslip.errors import ModelError
from stickslip.plot import style
from stickslip.plot.arguments import checked_labels, several
from stickslip.plot.figure import figure
from stickslip.plot.options import DiameterOptions, SpeedOptions
from stickslip.plot.style import Looks
from stickslip.results.campbell import Campbell
from stickslip.results.speed_response import SpeedResponse

_MARGIN = 1.15
"""How far the diagram reaches above the highest excitation."""


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
    unit, length = options["omega_unit"], style.LENGTH[options["length_unit"]]
    factor = style.OMEGA[unit].factor
    for one, name, colour in zip(listed, names, style.colours(len(listed)), strict=True):
        ax.plot(factor * one.speed, length.factor * one.amplitude, color=colour, lw=1.6, label=name)
        if options["diagram"] is not None:
            _mark_resonances(ax, one, options["diagram"], colour, factor)
    ends = factor * np.array([f(one.speed) for one in listed for f in (np.min, np.max)])
    if ends.min() < ends.max():
        ax.set_xlim(ends.min(), ends.max())
    ax.set_yscale("log" if options["log"] else "linear")
    orders = {one.engine_order for one in listed}
    style.label_omega(ax, style.rotor_speed(orders.pop() if len(orders) == 1 else None, unit))
    ax.set_ylabel(f"half peak-to-peak of {style.named(listed[0].dof)} [{length.label}]")


def _mark_resonances(
    ax: Axes, response: SpeedResponse, diagram: Campbell, colour: style.Colour, factor: float
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
                ax.axvline(
                    factor * one.speed, color=colour, lw=1.0, ls=line, label=label, zorder=1.5
                )
                label = "_"


@figure
def campbell(ax: Axes, /, result: Campbell, **options: Unpack[DiameterOptions]) -> None:
    """Draw natural frequencies over the speed of rotation, and the lines of engine orders.

    Of a disk the modes of the nodal diameters are drawn that the orders excite. Only modes that the
    highest order comes near are drawn.

    Parameters
    ----------
    result : Campbell
        What `campbell` returned.

    Returns
    -------
    matplotlib.axes.Axes
        The axes. Circles mark resonances with all contacts stuck.
    """
    omega, orders = style.OMEGA[options["omega_unit"]], result.orders
    rising = np.argsort(result.speed)
    x = result.speed[rising] * style.OMEGA["rpm"].factor
    top = _MARGIN * max(orders) * float(result.speed.max())
    places = sorted({result.place(order) for order in orders})
    ends = np.array([0.0, x.max()])
    lines: Looks = {"color": "crimson", "lw": 0.8, "zorder": 1.8}
    for order in orders:
        ax.plot(ends, omega.factor * order * ends / style.OMEGA["rpm"].factor, **lines)
        ax.annotate(
            f"EO {order}",
            (x.max(), omega.factor * order * result.speed.max()),
            (-4.0, 3.0),
            textcoords="offset points",
            ha="right",
            color="crimson",
            fontsize="small",
        )
    several = len(result.diameter) > 1
    slips = options["slipping"] and bool(result.model.contacts)
    for place, colour in zip(places, style.colours(len(places)), strict=True):
        of = f"nodal diameter {result.diameter[place]}" if several else "natural frequencies"
        label = f"{of}, stuck" if slips else of
        for which, values in enumerate((result.stuck, result.slipping)[: 1 + slips]):
            name = label if not which else f"{of}, slipping"
            looks: Looks = {"color": colour, "ls": (style.STUCK, style.FREE)[which], "lw": 1.3}
            own = values[rising, place]
            for curve in own.T[own.min(axis=0) <= top]:
                ax.plot(x, omega.factor * curve, label=name, **looks)
                name = "_"
    found = result.crossings()
    if found:
        at = [one.speed * style.OMEGA["rpm"].factor for one in found]
        height = [omega.factor * one.omega for one in found]
        ax.plot(at, height, **style.mark("o", 5, "crimson"), label="resonances" + ", stuck" * slips)
    ax.set(xlim=(min(0.98 * x.min(), x.max()), x.max()), ylim=(0.0, omega.factor * top))
    ax.set(xlabel="rotor speed [rpm]")
    ax.set_ylabel(omega.label.replace("angular frequency ω", "natural frequency"))
