"""What is said and drawn of damper curves."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from stickslip.units import quantity
from stickslip.views.tables import Row, Table, assumed, counted, model_rows, new_table

if TYPE_CHECKING:
    from stickslip.results.damper_curve import DamperCurve
    from stickslip.study.tables import OutputTable
    from stickslip.views.picture import Panel

__all__ = ["details", "facts", "failures", "panels", "tables"]


def tables(
    results: Sequence[tuple[str, DamperCurve]], label: str, dofs: Iterable[str], length_unit: str
) -> list[Table]:
    """Tabulate the ends of every curve and its lowest peak."""
    table = new_table()
    if label:
        table.add_column(label, overflow="fold")
    for heading in ("dof", "", "varied"):
        table.add_column(heading, overflow="fold")
    for heading in ("value", f"peak [{length_unit}]", "rad/s", "error", "H"):
        table.add_column(heading, justify="right", overflow="fold")
    length = quantity(f"1 {length_unit}", "m", "unit of length")
    for name, result in results:
        for place, index in _rows(result):
            table.add_row(
                *([name] if label else []),
                result.settings.dof,
                place,
                f"{result.parameter} [{result.settings.variation.unit}]",
                f"{result.values[index]:.6g}",
                f"{result.amplitude[index] / length:.6e}",
                f"{result.omega[index]:#.6g}",
                f"{result.error_estimate[index] / result.amplitude[index]:.1e}",
                f"{result.harmonics[index]}",
            )
    return [table]


def _rows(result: DamperCurve) -> list[tuple[str, int]]:
    """Return first, lowest and last solved value, each under its name."""
    solved = [index for index, known in enumerate(result.arrays.solved) if known]
    if not solved:
        return []
    objective = result.objective
    lowest = min(solved, key=lambda index: float(objective[index]))
    return [("first", solved[0]), ("lowest", lowest), ("last", solved[-1])]


def facts(result: DamperCurve) -> list[Row]:
    """Say what a result is of, how it was computed and what it took for granted."""
    settings = result.settings
    values = result.values
    low, high = settings.span
    varied = settings.variation.names
    rows = [
        *model_rows(result.model),
        (
            "varied",
            f"{result.parameter} of {', '.join(varied) or 'all forces'}",
        ),
        ("values", f"{values.size} from {values.min():.6g} to {values.max():.6g}"),
        ("peak of", f"{settings.dof} ({settings.measure}), {low:.6g} to {high:.6g} rad/s"),
        ("harmonics", f"{settings.harmonics}"),
        ("solutions", f"{result.counters['points']}"),
    ]
    return rows + assumed(result)


def failures(result: DamperCurve) -> list[str]:
    """Word what was not solved, one line per cause."""
    unsolved = [status for status in result.status if not status.solved]
    return counted(unsolved, f"{result.values.size} values")


def panels(results: Sequence[DamperCurve], dofs: Sequence[str], output: OutputTable) -> list[Panel]:
    """Return the damper performance curves."""
    from stickslip import plot

    length, omega = output.length_unit, output.omega_unit
    return [
        partial(plot.damper, result, length_unit=length, omega_unit=omega) for result in results
    ]


def details(result: DamperCurve, dofs: Sequence[str], output: OutputTable) -> list[Panel]:
    """Return nothing more: the curve shows amplitude, frequency, limits and optimum."""
    return []
