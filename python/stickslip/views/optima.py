"""What is said and drawn of optimal dampers."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from stickslip.units import quantity
from stickslip.views import dampers
from stickslip.views.tables import Row, Table, assumed, new_table

if TYPE_CHECKING:
    from stickslip.results.optimal_damper import OptimalDamper
    from stickslip.study.tables import OutputTable
    from stickslip.views.picture import Panel

__all__ = ["details", "facts", "failures", "panels", "tables"]


def tables(
    results: Sequence[tuple[str, OptimalDamper]], label: str, dofs: Iterable[str], length_unit: str
) -> list[Table]:
    """Tabulate every local minimum, the least first."""
    table = new_table()
    if label:
        table.add_column(label, overflow="fold")
    for heading in ("dof", "varied"):
        table.add_column(heading, overflow="fold")
    for heading in ("value", f"peak [{length_unit}]", "rad/s"):
        table.add_column(heading, justify="right", overflow="fold")
    length = quantity(f"1 {length_unit}", "m", "unit of length")
    for name, result in results:
        settings = result.curve.settings
        for minimum in result.minima:
            table.add_row(
                *([name] if label else []),
                settings.dof,
                f"{result.parameter} [{settings.variation.unit}]",
                f"{minimum.value:.6g}",
                f"{minimum.amplitude / length:.6e}",
                f"{minimum.omega:#.6g}",
            )
    return [table]


def facts(result: OptimalDamper) -> list[Row]:
    """Say what a result is of, how it was computed and what it took for granted."""
    of_curve = set(assumed(result.curve))
    own = [row for row in assumed(result) if row not in of_curve]
    return dampers.facts(result.curve) + own


def failures(result: OptimalDamper) -> list[str]:
    """Word what was not solved, one line per cause."""
    return dampers.failures(result.curve)


def panels(
    results: Sequence[OptimalDamper], dofs: Sequence[str], output: OutputTable
) -> list[Panel]:
    """Return the damper performance curves."""
    return dampers.panels([result.curve for result in results], dofs, output)


def details(result: OptimalDamper, dofs: Sequence[str], output: OutputTable) -> list[Panel]:
    """Return what a damper curve has."""
    return dampers.details(result.curve, dofs, output)
