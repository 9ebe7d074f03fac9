"""What the command line prints: tables, progress and messages, plain where no one is watching."""

from __future__ import annotations

import io
import os
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from copy import copy
from typing import TYPE_CHECKING, Any, TextIO

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from stickslip.errors import ModelError
from stickslip.views.tables import tabulated

if TYPE_CHECKING:
    from stickslip.results.result import Result

_STAGES = {
    "compliance": "compliance",
    "law": "law (force, tangent)",
    "linear_solve": "linear solve",
    "recovery": "recovery",
    "estimate": "error estimate",
    "stability": "stability",
}
_PLAIN_WIDTH = 10_000
_PATIENCE = 0.5
_LONG = 5.0
_TELLING = 0.01
_NARROW = 80


def tell(text: str) -> None:
    """Print a line on standard output; nothing once its reader has gone."""
    try:
        print(text, flush=True)
    except OSError as error:
        give_up(error)


def give_up(error: OSError) -> None:
    """Write nothing more to standard output; an error unless it is because its reader has gone."""
    _silence(sys.stdout)
    if not isinstance(error, BrokenPipeError):
        raise ModelError(
            f"standard output: {error.strerror}; results that were announced are saved"
        ) from None


def _silence(stream: TextIO) -> None:
    # What is still buffered would fail once more at the end of the program.
    sink = os.open(os.devnull, os.O_WRONLY)
    os.dup2(sink, stream.fileno())
    os.close(sink)


def complain(kind: str, text: str) -> None:
    """Print one line on standard error: ``error: ...``, ``warning: ...``."""
    import typer

    colour = {"error": "red", "warning": "yellow"}.get(kind)
    try:
        typer.echo(f"{typer.style(f'{kind}:', fg=colour, bold=True)} {text}", err=True)
    except OSError:
        # The exit code still says it.
        _silence(sys.stderr)


@contextmanager
def progress(title: str, *, wanted: bool) -> Iterator[Callable[[float], None] | None]:
    """Show a bar on standard error while something is computed that takes longer than a moment.

    Where no one watches, one line says how long the rest of long work will take. Yields what is to
    be called with the fraction done, or None where nothing is to be shown.
    """
    if not wanted:
        yield None
        return
    if not (sys.stdout.isatty() and sys.stderr.isatty()):
        yield _forecast(title)
        return
    from rich.progress import Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    shown = *Progress.get_default_columns()[:3], TimeElapsedColumn()
    left = TextColumn("left"), TimeRemainingColumn()
    # The speed is that of the last minute: curves differ in effort along their way.
    looks: dict[str, Any] = {"transient": True, "speed_estimate_period": 60.0}
    bar = Progress(*shown, *left, console=Console(stderr=True), **looks)
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


def _forecast(title: str) -> Callable[[float], None]:
    """Return what says once, from the speed so far, how long the rest will take if it is long."""
    begin = time.perf_counter()
    said = False

    def advance(fraction: float) -> None:
        nonlocal said
        spent = time.perf_counter() - begin
        # a first point says little of a whole curve
        if said or spent < _LONG or fraction < _TELLING:
            return
        said = True
        left = spent * (1.0 - fraction) / fraction
        if left > _LONG:
            complain("note", f"{title}: about {left:.2g} s left ({fraction:.0%} in {spent:.2g} s)")

    return advance


def grid(rows: Iterable[tuple[str, str]]) -> None:
    """Print rows of two columns without headings."""
    table = Table.grid(padding=(0, 2))
    for row in rows:
        table.add_row(*row)
    _print(table)


def stages(results: Iterable[Result], clock: dict[str, float]) -> None:
    """Print where the time went: in the solver, for all results, and by the clock beside it."""
    seconds, counts = Counter[str](), Counter[str]()
    for result in results:
        seconds.update(result.timings)
        counts.update(result.counters)
    rows: dict[str, float] = {
        label: seconds[key] for key, label in _STAGES.items() if key in seconds
    }
    rows["other in the solver"] = max(0.0, seconds["total"] - sum(rows.values()))
    rows |= clock
    whole = sum(rows.values()) or 1.0
    told = {**rows, "total": sum(rows.values())}
    cells = ((name, (f"{1e3 * s:.1f}", f"{s / whole:.0%}")) for name, s in told.items())
    show(tabulated("stage", (), ("ms", "share"), (), cells))
    tell(", ".join(f"{name.replace('_', ' ')} {count}" for name, count in counts.items()))


def _framed() -> bool:
    return sys.stdout.isatty() and Console().width >= _NARROW


def show_all(tables: Sequence[Table]) -> None:
    """Print tables with a line between them."""
    for number, table in enumerate(tables):
        if number > 0:
            tell("")
        show(table)


def show(table: Table) -> None:
    """Print a table, its title above and its notes below it."""
    # rich would break both at the width of the table
    bare = copy(table)
    bare.title = bare.caption = None
    if _framed():
        bare.box, bare.show_edge = SIMPLE_HEAD, False
    else:
        bare.box, bare.padding = None, (0, 2, 0, 0)
    if table.title:
        tell(str(table.title))
    _print(bare)
    if table.caption:
        tell(str(table.caption))


def _print(table: Table) -> None:
    if _framed():
        Console(highlight=False, markup=False).print(table)
        return
    # the reader is a program, a file or a narrow terminal: lines are not broken and carry no
    # blanks at their end
    page = io.StringIO()
    plain = Console(file=page, width=_PLAIN_WIDTH, highlight=False, markup=False, no_color=True)
    plain.print(table)
    for line in page.getvalue().splitlines():
        tell(line.rstrip())
