"""What is said and drawn of transients."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from stickslip.units import quantity
from stickslip.views.tables import Row, Table, assumed, model_rows, new_table

if TYPE_CHECKING:
    from stickslip.results.transient import Transient
    from stickslip.study.tables import OutputTable
    from stickslip.views.picture import Panel

__all__ = ["details", "facts", "failures", "panels", "tables"]


def tables(
    results: Sequence[tuple[str, Transient]], label: str, dofs: Iterable[str], length_unit: str
) -> list[Table]:
    """Tabulate the amplitudes of the last period, per run and DOF."""
    table = new_table()
    if label:
        table.add_column(label, overflow="fold")
    table.add_column("dof", overflow="fold")
    for heading in (f"amplitude [{length_unit}]", "periods", "change", "rad/s"):
        table.add_column(heading, justify="right", overflow="fold")
    table.add_column("status", overflow="fold")
    shown = list(dofs)
    length = quantity(f"1 {length_unit}", "m", "unit of length")
    for name, result in results:
        change = f"{result.change[-1]:.1e}" if result.periods else ""
        for dof in shown:
            if dof in result.dofs:
                table.add_row(
                    *([name] if label else []),
                    dof,
                    f"{result.amplitude(dof) / length:.6e}",
                    f"{result.periods}",
                    change,
                    f"{result.omega:#.6g}",
                    str(result.status),
                )
    return [table]


def facts(result: Transient) -> list[Row]:
    """Say what a result is of, how it was computed and what it took for granted."""
    settings = result.settings
    limit = "" if settings.tolerance is None else f", until the change is {settings.tolerance:g}"
    steps = f" of {settings.steps} steps" if settings.scheme == "rk4" else ""
    rows = [
        *model_rows(result.model),
        ("omega", f"{result.omega:.6g} rad/s"),
        ("scheme", settings.scheme),
        ("periods", f"{result.periods}{steps} of at most {settings.periods}{limit}"),
        ("kept", f"{result.time.size} instants of the last {result.kept_periods} periods"),
        ("status", str(result.status)),
    ]
    if settings.scheme == "exact":
        rows.append(("events", f"{len(result.events)} in the periods kept"))
    return rows + assumed(result)


def failures(result: Transient) -> list[str]:
    """Say that a run has not come to its end, in one line; empty if it has."""
    if result.status in ("settled", "completed"):
        return []
    return [f"{result.status} after {result.periods} periods. {result.status.advice}"]


def panels(results: Sequence[Transient], dofs: Sequence[str], output: OutputTable) -> list[Panel]:
    """Return the histories of DOFs and contacts, section and spectrum of the first DOF, per run."""
    from stickslip import plot

    drawn: list[Panel] = []
    for result in results:
        unit = output.length_unit
        drawn += [partial(plot.history, result, dof, length_unit=unit) for dof in dofs]
        drawn += [
            partial(plot.contact_history, result, contact)
            for contact in result.model.contact_names[:2]
        ]
        drawn.append(partial(plot.poincare, result, dofs[0], length_unit=unit))
        if result.kept_periods:
            drawn.append(partial(plot.spectrum, result, dofs[0], omega_unit=output.omega_unit))
    return drawn


def details(result: Transient, dofs: Sequence[str], output: OutputTable) -> list[Panel]:
    """Return the phase plane of the first DOF."""
    from stickslip import plot

    if not result.periods:
        return []
    return [partial(plot.phase, result, dofs[0], length_unit=output.length_unit)]
