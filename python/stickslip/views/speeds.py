"""What is said and drawn along the speed of rotation: responses and natural frequencies."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from math import pi

import numpy as np

from stickslip.drawn import plots
from stickslip.results.campbell import Campbell
from stickslip.results.speed_response import SpeedResponse
from stickslip.views.kinds import Dofs, Output, Rows, View
from stickslip.views.picture import Panels, labelled
from stickslip.views.tables import Row

_NEAR = 3


class SpeedView(View[SpeedResponse]):
    """The highest of the computed amplitudes, and where it is."""

    texts = ("dof", "engine order")
    numbers = ("rotor rpm", "Hz", "highest [{}]", "error [{}]", "solved")

    def rows(self, result: SpeedResponse, dofs: Dofs, length: float) -> Rows:
        """Return a row; none if nothing was found."""
        found = np.isfinite(result.amplitude)
        if not found.any():
            return
        at = int(np.nanargmax(result.amplitude))
        yield (
            result.dof,
            f"{result.engine_order:g}",
            f"{result.speed[at] * 30 / pi:#.6g}",
            f"{result.omega[at] / (2 * pi):#.6g}",
            f"{result.amplitude[at] / length:#.5g}",
            f"{result.error_estimate[at] / length:.1g}",
            f"{found.sum()} of {found.size}",
        )

    def about(self, result: SpeedResponse) -> list[Row]:
        """Say at which speeds, and under which order."""
        low, high = (float(end) * 30 / pi for end in (result.speed.min(), result.speed.max()))
        return [
            ("speeds", f"{result.speed.size} from {low:.6g} to {high:.6g} rpm"),
            ("order", f"{result.engine_order:g}"),
            ("harmonics", f"{result.settings.harmonics}"),
        ]

    def failures(self, result: SpeedResponse) -> list[str]:
        """Say at how many speeds nothing was found, and between which."""
        missing = result.speed[np.isnan(result.amplitude)] * 30 / pi
        if not missing.size:
            return []
        return [
            f"{missing.size} of {result.speed.size} speeds not solved, between "
            f"{missing.min():.6g} and {missing.max():.6g} rpm. Keep more harmonics, or compute a "
            "response curve at such a speed, which follows the solution along the frequency."
        ]

    def panels(self, results: Sequence[SpeedResponse], dofs: Dofs, output: Output) -> Panels:
        """Return amplitudes over the speed, one panel per DOF with a line per engine order."""
        unit, length = output.omega_unit or "rpm", output.length_unit
        draw = partial(plots.speed_response, omega_unit=unit, length_unit=length)
        return [
            partial(draw, [one for one in results if one.dof == dof])
            for dof in dict.fromkeys(one.dof for one in results)
        ]

    def told_apart(
        self, results: Sequence[tuple[str, SpeedResponse]], dofs: Dofs, output: Output
    ) -> Panels:
        """Return responses of a degree of freedom in one figure, with their names and orders."""
        drawn = self.panels([one for _, one in results], dofs, output)
        panels: Panels = []
        for panel, dof in zip(drawn, dict.fromkeys(one.dof for _, one in results), strict=True):
            own = [(name, one) for name, one in results if one.dof == dof]
            orders = [f"EO {one.engine_order:g}" for _, one in own]
            panels += labelled([panel], [name for name, _ in own], orders)
        return panels


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
        unit = output.omega_unit or "Hz"
        for one in results:
            match one.settings.diagram:
                case "campbell":
                    drawn.append(partial(plots.campbell, one, omega_unit=unit))
                case "safe":
                    orders = list(one.orders)
                    tables = [(one.at(place), speed) for place, speed in enumerate(one.speed)]
                    drawn += [
                        partial(plots.safe, table, float(speed), orders=orders, omega_unit=unit)
                        for table, speed in tables
                    ]
                case _:
                    drawn.append(partial(plots.nodal_diameters, one.at(0), omega_unit=unit))
        return drawn
