"""What is said and drawn of limit cycles, and of the ratios that limit them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from stickslip.drawn import plots
from stickslip.results.limit_cycles import LimitCycles, StabilityMap
from stickslip.results.stability import STATES, stability_counts
from stickslip.views.kinds import Dofs, Output, Rows, View
from stickslip.views.picture import Panels, labelled, titled
from stickslip.views.tables import Row, counted


class CycleView(View[LimitCycles]):
    """Ends and limit of every branch, or all cycles of a list."""

    texts = ("", "followed")
    last = ("stable",)

    def headings(self, dofs: Dofs, length_unit: str) -> list[str]:
        """Return the headings of the numbers, among them one for every DOF."""
        return ["r", "rad/s", *(f"{dof} [{length_unit}]" for dof in dofs), "|multiplier|"]

    def rows(self, result: LimitCycles, dofs: Dofs, length: float) -> Rows:
        """Return a row per cycle."""
        for place, index in _places(result):
            sizes = np.abs(result.multipliers[index, int(result.neutral[index]) :])
            yield (
                place,
                f"{result.values[index]:.6g}",
                f"{result.ratio[index]:.6g}",
                f"{result.omega[index]:#.7g}",
                *(f"{result.amplitude(dof)[index] / length:#.7g}" for dof in dofs),
                f"{sizes.max():.4g}" if sizes.size else "",
                STATES[str(result.stability[index])].answer,
            )

    def about(self, result: LimitCycles) -> list[Row]:
        """Say what was followed, and what was found on the branch."""
        settings = result.settings
        rows = [
            ("followed", f"{settings.followed}, {result.omega.size} limit cycles"),
            ("mode", f"{settings.mode}"),
            ("method", "exact orbits" if settings.method == "exact" else "harmonic balance"),
            ("harmonics", f"{settings.harmonics}"),
            ("stability", stability_counts(result.stability)),
        ]
        if result.limit is not None:
            rows.append(("limit", f"{result.limit.value:.8g} at {result.limit.omega:.7g} rad/s"))
        for change in result.changes:
            counts = f"{change.unstable_before} to {change.unstable_after} unstable multipliers"
            rows.append(("change", f"{change.kind} at {change.value:.6g}: {counts}"))
        return rows

    def failures(self, result: LimitCycles) -> list[str]:
        """Word what was not solved, one line per cause."""
        return counted(result.status, f"{result.omega.size} cycles")

    def panels(self, results: Sequence[LimitCycles], dofs: Dofs, output: Output) -> Panels:
        """Return amplitude over what is followed, one panel per DOF, and the multipliers."""
        length, omega = output.length_unit, output.omega_unit
        curves = partial(
            plots.limit_cycles,
            list(results),
            length_unit=length,
            omega_unit=omega,
            frequency=False,
        )
        known = [result for result in results if result.arrays.known.any()]
        return [
            *(partial(curves, dof) for dof in dofs),
            *(partial(plots.cycle_multipliers, result) for result in known),
        ]

    def told_apart(
        self, results: Sequence[tuple[str, LimitCycles]], dofs: Dofs, output: Output
    ) -> Panels:
        """Return branches in one figure, with their names and modes."""
        names, branches = zip(*results, strict=True)
        drawn = self.panels(branches, dofs, output)
        modes = [f"mode {one.settings.mode}" for one in branches]
        known = [name for name, one in results if one.arrays.known.any()]
        return [
            *labelled(drawn[: len(dofs)], names, modes),
            *(titled(panel, name) for panel, name in zip(drawn[len(dofs) :], known, strict=True)),
        ]


def _places(result: LimitCycles) -> list[tuple[str, int]]:
    if result.settings.values is not None:
        return [(str(side), index) for index, side in enumerate(result.branch)]
    if not result.omega.size:
        return []
    rows, limit = [("sticking end", 0)], result.limit
    if limit is not None:
        away = np.abs(result.values / limit.value - 1.0) + np.abs(result.omega / limit.omega - 1)
        rows.append(("limit", int(np.argmin(away))))
    return [*rows, (f"{result.branch[-1]} end", result.omega.size - 1)]


class MapView(View[StabilityMap]):
    """The limits at every value; the diagnostics name every value without one."""

    numbers = ("varied", "value", "limit r", "rad/s", "stable up to r")

    def rows(self, result: StabilityMap, dofs: Dofs, length: float) -> Rows:
        """Return a row per value."""
        variation = result.settings.variation
        columns = (result.values, result.limit, result.omega, result.stable_limit)
        for row in zip(*columns, strict=True):
            *numbers, stable = (f"{number:.6g}" for number in row)
            stable = "not decided" if stable == "nan" else stable
            yield variation.heading, *numbers, stable

    def about(self, result: StabilityMap) -> list[Row]:
        """Say what was varied."""
        settings = result.settings
        return [
            ("varied", f"{settings.variation.parameter} of {', '.join(settings.variation.names)}"),
            ("mode", f"{settings.mode}"),
            ("method", "exact orbits" if settings.method == "exact" else "harmonic balance"),
        ]

    def panels(self, results: Sequence[StabilityMap], dofs: Dofs, output: Output) -> Panels:
        """Return the maps."""
        return [partial(plots.stability_map, result) for result in results]
