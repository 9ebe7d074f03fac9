"""What is said and drawn of limit cycles."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from stickslip.results.stability import STATES, stability_counts
from stickslip.units import quantity
from stickslip.views.tables import Row, Table, assumed, counted, model_rows, new_table

if TYPE_CHECKING:
    from stickslip.results.limit_cycles import LimitCycles
    from stickslip.study.tables import OutputTable
    from stickslip.views.picture import Panel

__all__ = ["details", "facts", "failures", "panels", "tables"]


def tables(
    results: Sequence[tuple[str, LimitCycles]], label: str, dofs: Iterable[str], length_unit: str
) -> list[Table]:
    """Say ends and limit of every branch, or all cycles of a list."""
    table = new_table()
    shown = list(dofs)
    if label:
        table.add_column(label, overflow="fold")
    for heading in ("", "followed"):
        table.add_column(heading, overflow="fold")
    for heading in ("r", "rad/s", *(f"{dof} [{length_unit}]" for dof in shown), "|multiplier|"):
        table.add_column(heading, justify="right", overflow="fold")
    table.add_column("stable")
    length = quantity(f"1 {length_unit}", "m", "unit of length")
    for name, result in results:
        for place, index in _rows(result):
            neutral = int(result.neutral[index])
            sizes = np.abs(result.multipliers[index, neutral:])
            table.add_row(
                *([name] if label else []),
                place,
                f"{result.values[index]:.6g}",
                f"{result.ratio[index]:.6g}",
                f"{result.omega[index]:#.7g}",
                *(f"{result.amplitude(dof)[index] / length:.6e}" for dof in shown),
                f"{sizes.max():.4g}" if sizes.size else "",
                STATES[str(result.stability[index])].answer,
            )
    return [table]


def _rows(result: LimitCycles) -> list[tuple[str, int]]:
    if result.settings.values is not None:
        return [(str(side), index) for index, side in enumerate(result.branch)]
    if not result.omega.size:
        return []
    rows = [("sticking end", 0)]
    limit = result.limit
    if limit is not None:
        distance = np.abs(result.values / limit.value - 1.0) + np.abs(
            result.omega / limit.omega - 1
        )
        rows.append(("limit", int(np.argmin(distance))))
    return [*rows, (f"{result.branch[-1]} end", result.omega.size - 1)]


def facts(result: LimitCycles) -> list[Row]:
    """Say what a result is of, how it was computed and what it took for granted."""
    settings = result.settings
    rows = [
        *model_rows(result.model),
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
    return rows + assumed(result)


def failures(result: LimitCycles) -> list[str]:
    """Word what was not solved, one line per cause."""
    unsolved = [status for status in result.status if not status.solved]
    return counted(unsolved, f"{result.omega.size} cycles")


def panels(results: Sequence[LimitCycles], dofs: Sequence[str], output: OutputTable) -> list[Panel]:
    """Return amplitude over what is followed, one panel per DOF, and the multipliers."""
    from stickslip import plot

    length, omega = output.length_unit, output.omega_unit
    drawn: list[Panel] = [
        partial(
            plot.limit_cycles,
            list(results),
            dof,
            length_unit=length,
            omega_unit=omega,
            frequency=False,
        )
        for dof in dofs
    ]
    known = [result for result in results if result.arrays.known.any()]
    return drawn + [partial(plot.cycle_multipliers, result) for result in known]


def details(result: LimitCycles, dofs: Sequence[str], output: OutputTable) -> list[Panel]:
    """Return nothing: the default picture says it all."""
    return []
