"""The command ``stickslip report``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal, cast

import typer

from stickslip.cli.commands import Files, _epilog, app
from stickslip.cli.guard import Command, guarded

__all__ = ["report"]


@app.command(
    cls=Command,
    epilog=_epilog(
        "stickslip report results/snecma-beam-*.nc",
        "stickslip report results/*.nc --out beam.html --title 'SNECMA beam' --hertz",
    )
    + "\n\nNeeds plotly and jinja2: pip install 'stickslip\\[report]'.",
)
@guarded
def report(
    results: Files,
    out: Annotated[
        Path | None,
        typer.Option(help="Page to write; default: report.html beside the result.", metavar="FILE"),
    ] = None,
    title: Annotated[str | None, typer.Option(help="Heading of the page.")] = None,
    dof: Annotated[
        list[str] | None,
        typer.Option(help="DOF to show, repeatable; default: with a force or a contact."),
    ] = None,
    hertz: Annotated[bool, typer.Option("--hertz", help="Frequency axes in Hz.")] = False,
    length: Annotated[
        str, typer.Option("--length-unit", help="Of amplitudes: m, mm or um.", metavar="UNIT")
    ] = "m",
) -> None:
    """Write results of any kind as one HTML page that is read without a network."""
    from stickslip import report as write
    from stickslip.cli.console import tell

    page = out or results[0].with_name("report.html")
    write(
        results,
        page,
        title=title,
        dofs=dof,
        omega_unit="Hz" if hertz else "rad/s",
        length_unit=cast("Literal['m', 'mm', 'um']", length),
    )
    tell(f"report: {page}")
