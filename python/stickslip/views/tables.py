"""What views are made of: tables, and rows of facts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, TypeAlias

from rich.table import Table

# The command says its version without loading these.
if TYPE_CHECKING:
    from stickslip.model import Model
    from stickslip.results.damper_curve import DamperCurve
    from stickslip.results.forced_response import ForcedResponse
    from stickslip.results.result import Result
    from stickslip.results.status import Status


__all__ = ["Row", "Table", "assumed", "bound_rows", "counted", "listed", "model_rows", "tabulated"]

Row: TypeAlias = tuple[str, str]
"""A fact: what it is of, and what it is."""

_SHOWN_PARTS = 6
_SHOWN_ENDS = 24


def tabulated(
    label: str,
    texts: Sequence[str],
    numbers: Sequence[str],
    last: Sequence[str],
    rows: Iterable[tuple[str, Sequence[str]]],
) -> Table:
    """Return a table of texts, of numbers flush right, and of texts behind them.

    `label` is the heading of the names of the rows, which are left out if it is empty. The
    attributes `title` and `caption` are for what stands above and below.
    """
    table = Table()
    for heading in [*([label] if label else []), *texts]:
        table.add_column(heading, overflow="fold")
    for heading in numbers:
        table.add_column(heading, justify="right", overflow="fold")
    for heading in last:
        table.add_column(heading, overflow="fold")
    for name, cells in rows:
        table.add_row(*([name] if label else []), *cells)
    return table


def model_rows(model: Model) -> list[Row]:
    """Return what a result is of, as rows of its facts."""
    from stickslip.disk import BladedDisk, MistunedDisk

    rows = [("dofs", f"{len(model.structure)}: {listed(model.structure.dofs)}")]
    if isinstance(model, BladedDisk):
        order = f"engine order {model.engine_order}"
        rows.append(("disk", f"{model.sectors} equal sectors, {order}; of sector 0:"))
    elif isinstance(model, MistunedDisk):
        order = f"engine order {model.disk.engine_order}"
        rows.append(("disk", f"{model.sectors} sectors of their own, {order}"))
    for contact in model.contacts[:_SHOWN_PARTS]:
        # a sum of degrees of freedom names one several times
        ends = list(dict.fromkeys(dof or "ground" for dof in contact.dofs))
        place = " - ".join(ends) if len(ends) == 2 else listed(ends, _SHOWN_ENDS)
        rows.append(("contact", f"{contact.name}: {contact.law} at {place}, {contact.summary()}"))
    for force in model.forces[:_SHOWN_PARTS]:
        values = f"amplitude {force.amplitude:g} N, phase {force.phase:g} rad"
        rows.append(("force", f"{force.dof}: harmonic {force.harmonic}, {values}"))
    for name, parts in (("contacts", model.contacts), ("forces", model.forces)):
        if len(parts) > _SHOWN_PARTS:
            rows.append((name, f"{len(parts)} in all"))
    return rows


def assumed(result: Result) -> list[Row]:
    """Return what was assumed, chosen, doubted and missed, as rows of facts."""
    return [("assumed", text) for text in result.assumptions]


def counted(states: Iterable[Status], noun: str) -> list[str]:
    """Count what was not solved, one line per cause with what to do; `noun` is what is counted."""
    counts = Counter(state for state in states if not state.solved)
    return [f"{count} of {noun} {state}. {state.advice}" for state, count in counts.items()]


def listed(names: Sequence[str], most: int = 8) -> str:
    """Return the first names, and dots if that is not all."""
    return ", ".join(names[:most]) + (", ..." if len(names) > most else "")


def bound_rows(result: ForcedResponse | DamperCurve) -> list[Row]:
    """Say how far the past may have left residual tractions that change the result."""
    if not result.bounded:
        return []
    names = ("yes", "no", "shakedown", "not decided", "not found")
    counts = {name: int((result.unique == name).sum()) for name in names}
    said = ", ".join(f"{count} {name}" for name, count in counts.items() if count)
    kind = "guaranteed" if result.guaranteed[result.unique != "not asked"].all() else "inner"
    return [("unique", f"{said} ({kind} bounds over residual tractions)")]
