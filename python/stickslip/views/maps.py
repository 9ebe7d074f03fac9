"""What is said and drawn of stability maps."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from stickslip.views.tables import Row, Table, assumed, model_rows, new_table

if TYPE_CHECKING:
    from stickslip.results.stability_map import StabilityMap
    from stickslip.study.tables import OutputTable
    from stickslip.views.picture import Panel

__all__ = ["details", "facts", "failures", "panels", "tables"]


def tables(
    results: Sequence[tuple[str, StabilityMap]], label: str, dofs: Iterable[str], length_unit: str
) -> list[Table]:
    """Say the limits at every value."""
    table = new_table()
    if label:
        table.add_column(label, overflow="fold")
    for heading in ("varied", "value", "limit r", "rad/s", "stable up to r"):
        table.add_column(heading, justify="right", overflow="fold")
    for name, result in results:
        variation = result.settings.variation
        for row in zip(result.values, result.limit, result.omega, result.stable_limit, strict=True):
            *numbers, stable = (f"{number:.6g}" for number in row)
            varied = f"{variation.parameter} [{variation.unit}]"
            stable = "not decided" if stable == "nan" else stable
            table.add_row(*([name] if label else []), varied, *numbers, stable)
    return [table]


def facts(result: StabilityMap) -> list[Row]:
    """Say what a result is of, how it was computed and what it took for granted."""
    settings = result.settings
    rows = [
        *model_rows(result.model),
        ("varied", f"{settings.variation.parameter} of {', '.join(settings.variation.names)}"),
        ("mode", f"{settings.mode}"),
        ("method", "exact orbits" if settings.method == "exact" else "harmonic balance"),
    ]
    return rows + assumed(result)


def failures(result: StabilityMap) -> list[str]:
    """Return nothing: the diagnostics name every value without a limit."""
    return []


def panels(
    results: Sequence[StabilityMap], dofs: Sequence[str], output: OutputTable
) -> list[Panel]:
    """Return the maps."""
    from stickslip import plot

    return [partial(plot.stability_map, result) for result in results]


def details(result: StabilityMap, dofs: Sequence[str], output: OutputTable) -> list[Panel]:
    """Return nothing: the default picture says it all."""
    return []
