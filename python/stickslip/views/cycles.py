"""What is said and drawn of limit cycles, of their limits, and of the waves of a disk in a flow."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import partial
from math import isnan

import numpy as np

from stickslip.drawn import plots
from stickslip.results.flutter_map import FATES, FlutterMap
from stickslip.results.limit_cycles import LimitCycles, StabilityMap
from stickslip.results.stability import STATES, stability_counts
from stickslip.views.kinds import Dofs, Output, Rows, View
from stickslip.views.picture import Panel, Panels, labelled, titled
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
        length, omega = output.length_unit, output.frequency_unit
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
    frequencies = False

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


class FlutterView(View[FlutterMap]):
    """A row per limit cycle, the least stable wave first; waves without one have a row too."""

    texts = ("wave",)
    last = ("stable", "by itself")
    frequencies = False

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
