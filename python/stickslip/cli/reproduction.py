"""The command ``stickslip reproduce``: tables and figures of the dissertation."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

from stickslip.cli.commands import app
from stickslip.cli.guard import Command, guarded
from stickslip.files import make_folder, require_writable

__all__ = ["reproduce"]

_EXAMPLES = (
    "stickslip reproduce",
    "stickslip reproduce table-2.3 fig-4.22",
    "stickslip reproduce all --out reproduction",
)


@app.command(
    cls=Command,
    epilog="\n\n".join(("[bold]Examples[/bold]", *(f"  {line}" for line in _EXAMPLES))),
)
@guarded
def reproduce(
    names: Annotated[
        list[str] | None,
        typer.Argument(help="Tables and figures, or all; none lists them.", metavar="NAME"),
    ] = None,
    out: Annotated[
        Path, typer.Option(help="Folder for pictures, numbers and index.", metavar="DIR")
    ] = Path("reproduction"),
    coarse: Annotated[
        bool, typer.Option("--coarse", help="Fewer points and cases, in a fraction of the time.")
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print problems only.")] = False,
) -> None:
    """Reproduce tables and figures of the dissertation that this program comes from."""
    from stickslip.cli.console import tell
    from stickslip.reproduce import COARSE, FULL, chosen, write
    from stickslip.reproduce.folder import INDEX

    if not names:
        _list()
        return
    wanted = chosen(names)
    make_folder(out)
    require_writable(out)
    resolution = COARSE if coarse else FULL
    for done, item in enumerate(wanted):
        begin = time.perf_counter()
        try:
            numbers = item.compute(resolution)
            seconds = time.perf_counter() - begin
            write(item, numbers, seconds, resolution, out)
        except KeyboardInterrupt:
            kept = f"{done} of {len(wanted)} complete in {out}"
            raise KeyboardInterrupt(f"{kept}, {item.name} was not finished") from None
        if not quiet:
            tell(f"{item.name:<10} {seconds:6.1f} s  {out / item.name}.png")
    if not quiet:
        tell(f"index: {out / INDEX}")


def _list() -> None:
    """Print every table and figure with its status and what it takes."""
    from stickslip.cli import console
    from stickslip.reproduce import SUBJECTS, costs, items
    from stickslip.views.tables import new_table

    done, measured = items(), costs()
    table = new_table()
    table.add_column("name")
    table.add_column("status")
    table.add_column("cost [s]", justify="right")
    table.add_column("subject")
    for name, subject in SUBJECTS.items():
        cost = f"{measured[name]:.2g}" if name in done and name in measured else ""
        table.add_row(name, "done" if name in done else "not yet", cost, subject)
    console.show(table)
    whole = sum(measured.get(name, 0.0) for name in done)
    console.tell(f"{len(done)} of {len(SUBJECTS)} are reproduced, all of them in {whole:.0f} s")
