"""The command ``stickslip``: how commands join it, and the options that several have."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Literal, ParamSpec

import typer

from stickslip.cli.exit_codes import Command, Commands, guarded
from stickslip.errors import ModelError

P = ParamSpec("P")

Files = Annotated[
    list[Path], typer.Argument(help="Result files of 'stickslip run'.", metavar="RESULT.nc")
]
Dofs = Annotated[
    list[str] | None,
    typer.Option(
        "--dof",
        help="Degree of freedom to show; several times for more. Default: those with a force "
        "or a contact.",
    ),
]
Hertz = Annotated[bool, typer.Option("--hertz", help="Frequency axes in Hz.")]
Rpm = Annotated[
    bool, typer.Option("--rpm", help="Frequencies in rpm; of a disk the speed of its rotor.")
]


def omega_unit(*, hertz: bool, rpm: bool) -> Literal["Hz", "rpm"] | None:
    """Return the unit of frequency axes that the options ask for, None if none."""
    if hertz and rpm:
        raise ModelError("--hertz and --rpm exclude each other; give one")
    return "Hz" if hertz else "rpm" if rpm else None


app = typer.Typer(
    name="stickslip",
    cls=Commands,
    help="Steady vibration of structures damped by dry friction.",
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def command(
    *examples: str, note: str = "", name: str | None = None
) -> Callable[[Callable[P, None]], Callable[P, None]]:
    """Let a function be a command, with examples and a note below its help."""

    def add(function: Callable[P, None]) -> Callable[P, None]:
        epilog = _epilog(*examples, note=note)
        return app.command(name, cls=Command, epilog=epilog)(guarded(function))

    return add


def _epilog(*examples: str, note: str = "") -> str | None:
    # paragraphs, because the help would join lines
    headed = ["[bold]Examples[/bold]", *(f"  {one}" for one in examples)] if examples else []
    return "\n\n".join([*headed, note] if note else headed) or None


def _print_version(wanted: bool) -> None:
    if wanted:
        from stickslip import __version__

        sys.stdout.write(f"stickslip {__version__}\n")
        raise typer.Exit


@app.callback(
    epilog=_epilog(
        "stickslip run examples/snecma-beam/study.toml",
        "stickslip show results/snecma-beam-20.313.nc",
        "stickslip plot results/snecma-beam-*.nc --dof tip --log",
    )
)
def main(
    version: Annotated[
        bool,
        typer.Option(
            "--version", help="Print the version.", callback=_print_version, is_eager=True
        ),
    ] = False,
) -> None:
    """Steady vibration of structures damped by dry friction."""
    for stream in (sys.stdout, sys.stderr):
        # a file name that the terminal cannot show is no reason to fail
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")
