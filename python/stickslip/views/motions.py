"""What is said and drawn of classified motions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from stickslip.results.fate_arrays import Motion
from stickslip.units import quantity
from stickslip.views.tables import Row, Table, assumed, model_rows, new_table

if TYPE_CHECKING:
    from stickslip.results.motion_class import MotionClass
    from stickslip.study.tables import OutputTable
    from stickslip.views.picture import Panel

__all__ = ["details", "facts", "failures", "panels", "tables"]


def tables(
    results: Sequence[tuple[str, MotionClass]], label: str, dofs: Iterable[str], length_unit: str
) -> list[Table]:
    """Say class, mode and amplitudes of motions."""
    table = new_table()
    if label:
        table.add_column(label, overflow="fold")
    for heading in ("dof", "motion", "mode"):
        table.add_column(heading, overflow="fold")
    for heading in (f"amplitude [{length_unit}]", "rad/s", "decided [s]"):
        table.add_column(heading, justify="right", overflow="fold")
    length = quantity(f"1 {length_unit}", "m", "unit of length")
    shown = list(dofs)
    for name, result in results:
        settled = result.motion == Motion.SETTLED
        for dof in shown:
            if dof in result.dofs:
                table.add_row(
                    *([name] if label else []),
                    dof,
                    str(result.motion),
                    "" if result.mode is None else f"{result.mode}",
                    f"{result.amplitude(dof) / length:.6e}",
                    f"{result.omega:#.6g}" if settled else "",
                    f"{result.time:.4g}",
                )
    return [table]


def facts(result: MotionClass) -> list[Row]:
    """Say what a result is of, how it was computed and what it took for granted."""
    settings = result.settings
    rows = [
        *model_rows(result.model),
        ("motion", str(result.motion)),
        ("because", result.reason.advice),
        ("span", f"at most {settings.periods} periods of the lowest stuck mode"),
    ]
    return rows + assumed(result)


def failures(result: MotionClass) -> list[str]:
    """Say that a motion is undecided, in one line; empty if it is not."""
    if result.motion != Motion.UNDECIDED:
        return []
    return [f"{result.motion}. {result.reason.advice}"]


def panels(results: Sequence[MotionClass], dofs: Sequence[str], output: OutputTable) -> list[Panel]:
    """Return the spectra of motions that have one."""
    from stickslip import plot
    from stickslip.errors import ModelError

    drawn: list[Panel] = [
        partial(plot.lines, result, dof, omega_unit=output.omega_unit)
        for result in results
        if len(result.tail)
        for dof in dofs
    ]
    if not drawn:
        raise ModelError("motion: one that decays or grows for ever has no picture")
    return drawn


def details(result: MotionClass, dofs: Sequence[str], output: OutputTable) -> list[Panel]:
    """Return nothing: the default picture says it all."""
    return []
