"""What is said and drawn of natural frequencies over the speed."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from math import pi

import numpy as np

from stickslip.drawn import plots
from stickslip.results.campbell import Campbell
from stickslip.views.kinds import Dofs, Output, Rows, View
from stickslip.views.picture import Panels
from stickslip.views.tables import Row

_NEAR = 3


class CampbellView(View[Campbell]):
    """Resonances within the speeds, or the modes nearest to the excitation at one."""

    texts = ("", "engine order", "nodal diameter", "mode")
    numbers = ("rpm", "Hz", "distance")

    def rows(self, result: Campbell, dofs: Dofs, length: float) -> Rows:
        """Return a row per resonance; at one speed the nearest modes of every order.

        Without excitation a row per nodal diameter, with the lowest modes.
        """
        if result.settings.diagram == "nodal-diameters":
            for name, values in (("stuck", result.stuck), ("slipping", result.slipping)):
                for diameter, own in zip(result.diameter, values[0], strict=True):
                    lowest = own[:_NEAR] / (2 * pi)
                    modes = f"0 to {lowest.size - 1}" if lowest.size > 1 else "0"
                    hertz = ", ".join(f"{one:.6g}" for one in lowest)
                    yield name, "", f"{diameter}", modes, "", hertz, ""
            return
        if result.settings.diagram == "campbell":
            for name, slipping in (("stuck", False), ("slipping", True)):
                for one in result.crossings(slipping=slipping):
                    where = (name, f"{one.order}", f"{one.diameter}", f"{one.mode}")
                    yield *where, f"{one.speed * 30 / pi:.6g}", f"{one.omega / (2 * pi):.6g}", ""
            return
        for at, speed in enumerate(result.speed.tolist()):
            for order in result.orders:
                place = result.place(order)
                for name, values in (("stuck", result.stuck), ("slipping", result.slipping)):
                    own = values[at, place]
                    apart = own / (order * speed) - 1.0
                    for mode in sorted(np.argsort(np.abs(apart))[:_NEAR].tolist()):
                        yield (
                            name,
                            f"{order}",
                            f"{result.diameter[place]}",
                            f"{mode}",
                            f"{speed * 30 / pi:.6g}",
                            f"{own[mode] / (2 * pi):.6g}",
                            f"{apart[mode]:+.2%}",
                        )

    def about(self, result: Campbell) -> list[Row]:
        """Say at which speeds, and which orders."""
        low, high = (float(end) * 30 / pi for end in (result.speed.min(), result.speed.max()))
        return [
            ("speeds", f"{result.speed.size} from {low:.6g} to {high:.6g} rpm"),
            ("orders", ", ".join(map(str, result.orders))),
        ]

    def panels(self, results: Sequence[Campbell], dofs: Dofs, output: Output) -> Panels:
        """Return the diagram that the settings name."""
        drawn: Panels = []
        for one in results:
            match one.settings.diagram:
                case "campbell":
                    drawn.append(partial(plots.campbell, one))
                case "safe":
                    tables = [(one.at(place), speed) for place, speed in enumerate(one.speed)]
                    drawn += [
                        partial(plots.safe, table, float(speed), orders=list(one.orders))
                        for table, speed in tables
                    ]
                case _:
                    drawn.append(partial(plots.nodal_diameters, one.at(0)))
        return drawn
