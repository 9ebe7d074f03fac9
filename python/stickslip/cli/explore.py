"""The command ``stickslip explore``: a study on a local page whose sliders move its numbers."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from stickslip.cli.application import command
from stickslip.cli.exit_codes import integer
from stickslip.errors import ModelError

_PORT = 8350
_LAST_PORT = 65535


@command(
    "stickslip explore examples/snecma-beam/study.toml",
    "stickslip explore study.toml --port 0 --no-browser",
    note="Needs tornado, tomlkit and plotly: pip install 'stickslip\\[explore]'. Ctrl-C ends it.",
)
def explore(
    study: Annotated[Path, typer.Argument(help="Study file.", metavar="STUDY.toml")],
    port: Annotated[
        int,
        typer.Option(
            help="Port on this machine; 0: any free one.", metavar="INTEGER", parser=integer
        ),
    ] = _PORT,
    no_browser: Annotated[
        bool, typer.Option("--no-browser", help="Open no browser; the address is printed.")
    ] = False,
) -> None:
    """Open a study as a local page: sliders move its numbers, curves follow."""
    if not 0 <= port <= _LAST_PORT:
        raise ModelError(f"--port {port}: give a number from 0 to {_LAST_PORT}")
    try:
        import plotly  # noqa: F401
        import tomlkit  # noqa: F401
        import tornado  # noqa: F401
    except ImportError as error:
        raise ModelError(
            f"explore: {error.name} is not installed; install it with pip install "
            "'stickslip[explore]'"
        ) from None
    from stickslip.cli.console import tell
    from stickslip.explore.draft import Draft
    from stickslip.explore.server import serve

    # refused before anything is opened
    Draft(study)
    try:
        serve(
            study,
            port,
            lambda address: tell(f"explorer: {address}  (Ctrl-C ends it)"),
            browser=not no_browser,
        )
    except KeyboardInterrupt:
        raise KeyboardInterrupt("the explorer has ended") from None
