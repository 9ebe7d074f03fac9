"""Campbell diagrams: natural frequencies over the speed, crossed by engine orders."""

from __future__ import annotations

from typing import Unpack

import numpy as np
from matplotlib.axes import Axes

from stickslip.plot import style
from stickslip.plot.figure import figure
from stickslip.plot.options import CampbellOptions
from stickslip.plot.style import Looks
from stickslip.results.campbell import Campbell

_MARGIN = 1.15
"""How far the diagram reaches above the highest excitation."""


@figure
def campbell(ax: Axes, /, result: Campbell, **options: Unpack[CampbellOptions]) -> None:
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
