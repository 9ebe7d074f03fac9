"""What the command line prints: tables, progress and messages, plain where no one is watching."""

from __future__ import annotations

import io
import os
import sys
import time
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from math import pi
from typing import TYPE_CHECKING

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from stickslip.errors import ModelError
from stickslip.units import quantity

if TYPE_CHECKING:
    from stickslip.results import ForcedResponse, Summary

__all__ = ["cautions", "complain", "facts", "failures", "peaks", "progress", "stages", "tell"]

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


def peaks(
    results: Sequence[tuple[str, ForcedResponse]], label: str, dofs: Iterable[str], length_unit: str
) -> None:
    """Print the peak of every curve and DOF.

    Parameters
    ----------
    results : sequence of (str, ForcedResponse)
        Curves, each with what tells it from the others.
    label : str
        What that is: heading of the first column, which is left out if this is empty.
    dofs : iterable of str
        The DOFs to tabulate, as far as a curve has them.
    length_unit : str
        Unit of the amplitudes.
    """
    table = _table()
    if label:
        table.add_column(label, overflow="fold")
    table.add_column("dof", overflow="fold")
    # short headings: eight columns have to fit on a terminal of 80
    lengths = (f"peak [{length_unit}]", f"error [{length_unit}]")
    for heading in ("rad/s", "Hz", *lengths, "H", "converged"):
        table.add_column(heading, justify="right", overflow="fold")
    shown = list(dofs)
    length = quantity(f"1 {length_unit}", "m", "unit of length")
    at_edge = beside_gap = False
    for name, result in results:
        for row in result.summary([dof for dof in shown if dof in result.dofs]):
            cells = (*_peak(row, length), _converged(result))
            table.add_row(*([name] if label else []), *cells)
            at_edge = at_edge or row.at_edge
            beside_gap = beside_gap or row.beside_gap
    _print(table)
    if at_edge:
        tell("* at an end of the computed frequencies: the true peak may lie outside")
    if beside_gap:
        tell("? beside points that are not solved: the true peak may be there, and higher")


def _peak(row: Summary, length: float) -> tuple[str, ...]:
    mark = "*" * row.at_edge + "?" * row.beside_gap
    return (
        row.dof,
        f"{row.omega:#.6g}{mark}",
        f"{row.omega / (2 * pi):#.6g}",
        f"{row.amplitude / length:.4e}",
        f"{row.error_estimate / length:.0e}",
        f"{row.harmonics}",
    )


def _harmonics(result: ForcedResponse) -> str:
    if result.settings.harmonics != "auto":
        return f"{result.settings.harmonics}"
    kept = result.harmonics[result.arrays.solved]
    return f"auto, {kept.min()} to {kept.max()}" if kept.size else "auto"


def _converged(result: ForcedResponse) -> str:
    return f"{int(result.converged.sum())} of {result.omega.size}"


def failures(name: str, result: ForcedResponse) -> list[str]:
    """Word what did not converge, one line per cause: how many points, where, and what to do.

    Parameters
    ----------
    name : str
        What the result is called.
    result : ForcedResponse
        The curve.

    Returns
    -------
    list of str
        Empty if every point converged.
    """
    places = defaultdict(list)
    for omega, status in zip(result.omega, result.status, strict=True):
        if status != "converged":
            places[status].append(float(omega))
    return [
        f"{name}: {len(where)} of {result.omega.size} points {status}, "
        f"{_where(where)} rad/s. {status.advice}"
        for status, where in places.items()
    ]


def cautions(name: str, result: ForcedResponse) -> list[str]:
    """Return the assumptions that put the numbers in doubt, one line each."""
    doubtful = ("The discarded harmonics could", "The damping leaves", "The damping is negative")
    return [f"{name}: {line}" for line in result.assumptions if line.startswith(doubtful)]


def _where(omega: list[float]) -> str:
    low, high = min(omega), max(omega)
    return f"at {low:.6g}" if low == high else f"between {low:.6g} and {high:.6g}"


def facts(result: ForcedResponse) -> None:
    """Print what a result is of, how it was computed and what it took for granted."""
    model, omega = result.model, result.omega
    table = Table.grid(padding=(0, 2))
    table.add_row("dofs", f"{len(model.structure)}: {_listed(model.structure.dofs)}")
    for contact in model.contacts:
        values = ", ".join(f"{name} {value:g}" for name, value in contact.parameters().items())
        place = " - ".join(contact.dofs)
        table.add_row("contact", f"{contact.name}: {contact.law} at {place}, {values}")
    for force in model.forces:
        values = f"amplitude {force.amplitude:g} N, phase {force.phase:g} rad"
        table.add_row("force", f"{force.dof}: harmonic {force.harmonic}, {values}")
    span = f"from {omega.min():.6g} to {omega.max():.6g} rad/s"
    table.add_row("points", f"{omega.size} {span}, {_converged(result)} converged")
    table.add_row("harmonics", _harmonics(result))
    for text in result.assumptions:
        table.add_row("assumed", text)
    _print(table)


def stages(results: Iterable[ForcedResponse], clock: dict[str, float]) -> None:
    """Print where the time went.

    Parameters
    ----------
    results : iterable of ForcedResponse
        The curves; their stages and counters are added up.
    clock : dict of float
        Seconds by what was done beside computing the curves.
    """
    seconds: defaultdict[str, float] = defaultdict(float)
    counts: defaultdict[str, int] = defaultdict(int)
    for result in results:
        for stage, value in result.timings.items():
            seconds[stage] += value
        for kind, count in result.counters.items():
            counts[kind] += count
    rows = {label: seconds[key] for key, label in _STAGES.items()}
    rows["other in the solver"] = max(0.0, seconds["total"] - sum(rows.values()))
    rows |= clock
    whole = sum(rows.values()) or 1.0
    table = _table()
    table.add_column("stage")
    table.add_column("ms", justify="right")
    table.add_column("share", justify="right")
    for label, value in (*rows.items(), ("total", sum(rows.values()))):
        table.add_row(label, f"{1e3 * value:.1f}", f"{value / whole:.0%}")
    _print(table)
    tell(", ".join(f"{name.replace('_', ' ')} {count}" for name, count in counts.items()))


def _listed(names: Sequence[str], most: int = 8) -> str:
    return ", ".join(names[:most]) + (", ..." if len(names) > most else "")


def _table() -> Table:
    if _framed():
        return Table(box=SIMPLE_HEAD, show_edge=False)
    return Table(box=None, padding=(0, 2, 0, 0))


def _framed() -> bool:
    return sys.stdout.isatty() and Console().width >= _NARROW


def _print(table: Table) -> None:
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
