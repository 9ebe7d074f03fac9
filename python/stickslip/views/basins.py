"""What is said and drawn of basin maps."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from stickslip.results.fate_arrays import Motion
from stickslip.views.tables import Row, Table, assumed, model_rows, new_table

if TYPE_CHECKING:
    from stickslip.results.basin_map import BasinMap
    from stickslip.study.tables import OutputTable
    from stickslip.views.picture import Panel

__all__ = ["details", "facts", "failures", "panels", "tables"]


def tables(
    results: Sequence[tuple[str, BasinMap]], label: str, dofs: Iterable[str], length_unit: str
) -> list[Table]:
    """Say what the starts lead to, and how many of them."""
    table = new_table()
    if label:
        table.add_column(label, overflow="fold")
    for heading in ("motion", "mode"):
        table.add_column(heading, overflow="fold")
    for heading in ("starts", "share", "rad/s"):
        table.add_column(heading, justify="right", overflow="fold")
    for name, result in results:
        for place, (outcome, count) in enumerate(result.outcomes.items()):
            omega = result.omega[result.codes == place]
            known = omega[np.isfinite(omega)]
            table.add_row(
                *([name] if label else []),
                str(outcome.motion),
                "" if outcome.mode is None else f"{outcome.mode}",
                f"{count}",
                f"{count / len(result):.1%}",
                f"{np.median(known):#.6g}" if known.size else "",
            )
    return [table]


def facts(result: BasinMap) -> list[Row]:
    """Say what a result is of, how it was computed and what it took for granted."""
    settings = result.settings
    rows = model_rows(result.model)
    for axis, values in settings.axes:
        meant = f"mode {axis}" if isinstance(axis, int) else axis
        rows.append(
            ("axis", f"{meant}: {len(values)} from {min(values):.6g} to {max(values):.6g} m")
        )
    rows += [
        ("starts", f"{len(result)}"),
        ("span", f"at most {settings.periods} periods of the lowest stuck mode"),
        ("events", f"{result.counters['events']}"),
    ]
    return rows + assumed(result)


def failures(result: BasinMap) -> list[str]:
    """Word what was not decided, one line per cause."""
    counts = Counter(reason for reason in result.reason if reason.motion == Motion.UNDECIDED)
    return [
        f"{count} of {len(result)} starts undecided. {reason.advice}"
        for reason, count in counts.items()
    ]


def panels(results: Sequence[BasinMap], dofs: Sequence[str], output: OutputTable) -> list[Panel]:
    """Return the maps over two axes."""
    from stickslip import plot
    from stickslip.errors import ModelError

    drawn: list[Panel] = [
        partial(plot.basins, result, length_unit=output.length_unit)
        for result in results
        if result.settings.axes
    ]
    if not drawn:
        raise ModelError("basin map: of a list of starts, which has no picture; give it axes")
    return drawn


def details(result: BasinMap, dofs: Sequence[str], output: OutputTable) -> list[Panel]:
    """Return nothing: the default picture says it all."""
    return []
