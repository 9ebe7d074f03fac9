"""What is said and drawn of the travelling waves of a tuned disk in a flow."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import partial
from math import isnan

import numpy as np

from stickslip.drawn import plots
from stickslip.results.flutter_map import FATES, FlutterMap
from stickslip.results.stability import STATES
from stickslip.views.kinds import Dofs, Output, Rows, View
from stickslip.views.picture import Panel, Panels
from stickslip.views.tables import Row


class FlutterView(View[FlutterMap]):
    """A row per limit cycle, the least stable wave first; waves without one have a row too."""

    texts = ("wave",)
    last = ("stable", "by itself")

    def headings(self, dofs: Dofs, length_unit: str) -> list[str]:
        """Return the headings of the numbers, among them one for every DOF."""
        shown = (f"{dof} [{length_unit}]" for dof in dofs)
        return ["damping ratio", "from flow", "rad/s", *shown, "rel. error"]

    def rows(self, result: FlutterMap, dofs: Dofs, length: float) -> Rows:
        """Return the rows, by rising amplitude in a wave."""
        arrays, columns = result.arrays, [result._column(dof) for dof in dofs]
        for wave in result.order.tolist():
            # zero has no sign
            ratios = arrays.rest_ratio[wave] + 0.0, arrays.rest_aerodynamic_ratio[wave] + 0.0
            rest = tuple(f"{ratio:.6g}" for ratio in ratios)
            name, fate = f"{result.signed(wave):+d}", result.fate(wave)
            found = np.flatnonzero(arrays.cycle_wave == wave)
            for index, one in zip(found.tolist(), result.cycles(wave), strict=True):
                sizes = arrays.cycle_displacement[index, columns] / length
                answer = STATES[one.stability].answer
                shown = (
                    *(f"{x:#.6g}" for x in sizes),
                    "" if isnan(one.error) else f"{one.error:.1e}",
                )
                yield name, *rest, f"{one.omega:#.8g}", *shown, answer, fate
            if not found.size:
                yield (
                    name,
                    *rest,
                    f"{arrays.rest_omega[wave]:#.8g}",
                    *("" for _ in dofs),
                    "",
                    "",
                    fate,
                )

    def about(self, result: FlutterMap) -> list[Row]:
        """Say which mode it is, and what becomes of its waves."""
        fates = Counter(result.fate(wave) for wave in range(result.rest_ratio.size))
        rows = [
            ("mode", f"{result.settings.mode}, {result.rest_ratio.size} waves"),
            ("harmonics", f"{result.settings.harmonics}"),
            ("amplitudes", f"{result.modal_amplitude.size}"),
        ]
        return [
            *rows,
            *((f"{fates[one]} waves", text) for one, text in FATES.items() if fates[one]),
        ]

    def panels(self, results: Sequence[FlutterMap], dofs: Dofs, output: Output) -> Panels:
        """Return amplitudes over nodal diameter, and over aerodynamic damping where it is held."""
        length = output.length_unit
        made: list[Panel] = []
        for one in results:
            held = one.held_ratio
            for dof in dofs:
                made.append(partial(plots.flutter_map, one, dof, length_unit=length))
                if np.isfinite(held).any() and np.nanmin(held) < 0.0:
                    made.append(partial(plots.aerodynamic_limits, one, dof, length_unit=length))
        return made
