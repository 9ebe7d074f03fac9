"""What the command line prints: tables, progress and messages, plain where no one is watching."""

from __future__ import annotations

import io
import os
import sys
import time
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from stickslip.errors import ModelError

if TYPE_CHECKING:
    from stickslip.model import Model
    from stickslip.results.result import Result

__all__ = [
    "complain",
    "grid",
    "listed",
    "model_rows",
    "new_table",
    "progress",
    "show",
    "stages",
    "tell",
]

_SHOWN_PARTS = 6

_STAGES = {
    "compliance": "compliance",
    "law": "law (force, tangent)",
    "linear_solve": "linear solve",
    "recovery": "recovery",
}
_PLAIN_WIDTH = 10_000
_PATIENCE = 0.5
_NARROW = 80


def tell(text: str) -> None:
    """Print a line on standard output; nothing once its reader has gone.

    Raises
    ------
    ModelError
        If it cannot be written, for lack of space for instance.
    """
    try:
        print(text, flush=True)
    except OSError as error:
        # What is still buffered would fail once more at the end of the program.
        sink = os.open(os.devnull, os.O_WRONLY)
        os.dup2(sink, sys.stdout.fileno())
        os.close(sink)
        if not isinstance(error, BrokenPipeError):
            raise ModelError(
                f"standard output: {error.strerror}; results that were announced are saved"
            ) from None


def complain(kind: str, text: str) -> None:
    """Print one line on standard error: ``error: ...``, ``warning: ...``."""
    import typer

    colour = {"error": "red", "warning": "yellow"}.get(kind)
    typer.echo(f"{typer.style(f'{kind}:', fg=colour, bold=True)} {text}", err=True)


@contextmanager
def progress(title: str, *, wanted: bool) -> Iterator[Callable[[float], None] | None]:
    """Show a bar on standard error while something is computed that takes longer than a moment.

    Parameters
    ----------
    title : str
        What is computed.
    wanted : bool
        False shows nothing.

    Yields
    ------
    callable or None
        To be called with the fraction done; None where there is no terminal to show it on.
    """
    if not (wanted and sys.stdout.isatty() and sys.stderr.isatty()):
        yield None
        return
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

    columns = TextColumn("{task.description}"), BarColumn(), TaskProgressColumn()
    bar = Progress(*columns, TimeElapsedColumn(), console=Console(stderr=True), transient=True)
    task = bar.add_task(title, total=1.0)
    begin = time.perf_counter()

    def advance(fraction: float) -> None:
        if time.perf_counter() - begin > _PATIENCE:
            bar.start()
            bar.update(task, completed=fraction)

    try:
        yield advance
    finally:
        bar.stop()


def model_rows(model: Model) -> list[tuple[str, str]]:
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
        place = " - ".join(dof or "ground" for dof in contact.dofs)
        rows.append(("contact", f"{contact.name}: {contact.law} at {place}, {contact.described()}"))
    for force in model.forces[:_SHOWN_PARTS]:
        values = f"amplitude {force.amplitude:g} N, phase {force.phase:g} rad"
        rows.append(("force", f"{force.dof}: harmonic {force.harmonic}, {values}"))
    for name, parts in (("contacts", model.contacts), ("forces", model.forces)):
        if len(parts) > _SHOWN_PARTS:
            rows.append((name, f"{len(parts)} in all"))
    return rows


def grid(rows: Iterable[tuple[str, str]]) -> None:
    """Print rows of two columns without headings."""
    table = Table.grid(padding=(0, 2))
    for row in rows:
        table.add_row(*row)
    show(table)


def stages(results: Iterable[Result], clock: dict[str, float]) -> None:
    """Print where the time went.

    Parameters
    ----------
    results : iterable of Result
        The results; their stages and counters are added up.
    clock : dict of float
        Seconds by what was done beside computing them.
    """
    seconds: defaultdict[str, float] = defaultdict(float)
    counts: defaultdict[str, int] = defaultdict(int)
    for result in results:
        for stage, value in result.timings.items():
            seconds[stage] += value
        for kind, count in result.counters.items():
            counts[kind] += count
    rows = {label: seconds[key] for key, label in _STAGES.items() if key in seconds}
    rows["other in the solver"] = max(0.0, seconds["total"] - sum(rows.values()))
    rows |= clock
    whole = sum(rows.values()) or 1.0
    table = new_table()
    table.add_column("stage")
    table.add_column("ms", justify="right")
    table.add_column("share", justify="right")
    for label, value in (*rows.items(), ("total", sum(rows.values()))):
        table.add_row(label, f"{1e3 * value:.1f}", f"{value / whole:.0%}")
    show(table)
    tell(", ".join(f"{name.replace('_', ' ')} {count}" for name, count in counts.items()))


def listed(names: Sequence[str], most: int = 8) -> str:
    """Return the first names, and dots if that is not all."""
    return ", ".join(names[:most]) + (", ..." if len(names) > most else "")


def new_table() -> Table:
    """Return an empty table, framed where someone is watching."""
    if _framed():
        return Table(box=SIMPLE_HEAD, show_edge=False)
    return Table(box=None, padding=(0, 2, 0, 0))


def _framed() -> bool:
    return sys.stdout.isatty() and Console().width >= _NARROW


def show(table: Table) -> None:
    """Print a table."""
    if _framed():
        Console(highlight=False, markup=False).print(table)
        return
    # the reader is a program, a file or a narrow terminal: lines are not broken and carry no
    # blanks at their end
    page = io.StringIO()
    Console(file=page, width=_PLAIN_WIDTH, highlight=False, markup=False, no_color=True).print(
        table
    )
    for line in page.getvalue().splitlines():
        tell(line.rstrip())
