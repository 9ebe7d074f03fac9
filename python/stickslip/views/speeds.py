"""What is said and drawn of responses along the speed of rotation."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from math import pi

import numpy as np

from stickslip.drawn import plots
from stickslip.results.speed_response import SpeedResponse
from stickslip.views.kinds import Dofs, Output, Rows, View
from stickslip.views.picture import Panels, labelled
from stickslip.views.tables import Row


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
        draw = partial(plots.speed_response, length_unit=output.length_unit)
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
