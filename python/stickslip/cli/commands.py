"""The commands that take result files: show, plot, certify, report and export; schema, explore."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, cast

import typer

from stickslip.cli.application import Dofs, Files, Hertz, Rpm, command, omega_unit
from stickslip.cli.exit_codes import NOT_CONVERGED, integer
from stickslip.cli.run import warned
from stickslip.errors import Interrupted, ModelError
from stickslip.files import require_place, write
from stickslip.interruption import Interruption

if TYPE_CHECKING:
    from stickslip.results import ForcedResponse


_file = partial(typer.Option, metavar="FILE")
_omega = partial(typer.Option, metavar="OMEGA")
_PORT = 8350
_LAST_PORT = 65535


@command("stickslip show results/snecma-beam-20.313.nc")
def show(results: Files, rpm: Rpm = False) -> None:
    """Print what results hold: the model, the numbers, what was assumed, what did not converge."""
    from stickslip import load
    from stickslip.cli import console
    from stickslip.model.notable import notable_dofs
    from stickslip.views.kinds import failures, view_of

    for number, file in enumerate(results):
        result = load(file)
        if number > 0:
            console.tell("")
        console.tell(str(file))
        view = view_of([result], omega_unit(hertz=False, rpm=rpm))
        console.grid(view.facts(result))
        console.tell("")
        shown = notable_dofs(result.model, result.dofs)
        console.show_all(view.tables([("", result)], "", shown, "auto"))
        for text in failures(result):
            console.complain("warning", f"{file.name}: {text}")


@command(
    "stickslip plot results/snecma-beam-*.nc",
    "stickslip plot results/snecma-beam-*.nc --dof tip --hertz --linear --out tip.pdf",
    "stickslip plot results/snecma-beam-20.313.nc --dof tip --waveform 170",
    'stickslip plot results/snecma-beam-20.313.nc --loop "27 Hz"',
)
def plot(
    results: Files,
    dof: Dofs = None,
    out: Annotated[
        Path | None, _file(help="Picture to write (.png, .pdf, .svg). Default: beside the result.")
    ] = None,
    hertz: Hertz = False,
    rpm: Rpm = False,
    log: Annotated[bool, typer.Option("--log/--linear", help="Amplitude axis.")] = True,
    per_force: Annotated[
        bool, typer.Option("--per-force", help="Amplitude per unit of force.")
    ] = False,
    waveform: Annotated[
        str | None, _omega(help="Draw one period at this frequency instead.")
    ] = None,
    loop: Annotated[str | None, _omega(help="Draw the hysteresis loop at this frequency.")] = None,
    contact: Annotated[
        str | None,
        typer.Option(help="Contact of the loop: its position from 0, or its name. Default: 0."),
    ] = None,
    events: Annotated[
        str | None,
        _omega(help="Draw stick and slip over one period of an exact orbit."),
    ] = None,
    multipliers: Annotated[
        bool, typer.Option("--multipliers", help="Draw the Floquet multipliers of exact orbits.")
    ] = False,
) -> None:
    """Draw results; of a response curve also one period, a hysteresis loop or multipliers."""
    from stickslip import load
    from stickslip.cli import console, drawing
    from stickslip.views.picture import draw

    named = [(file.stem, load(file)) for file in results]
    pictures = {"waveform": waveform, "loop": loop, "events": events}
    asked = {name: omega for name, omega in pictures.items() if omega is not None}
    asked |= {"multipliers": ""} if multipliers else {}
    unit = omega_unit(hertz=hertz, rpm=rpm)
    wanted = drawing.Wanted(dof, unit, log, per_force, contact)
    name, panels = wanted.picture(asked, named)
    picture = out or results[0].with_name(f"{results[0].stem}-{name}.png")
    draw(panels, picture)
    console.tell(f"picture: {picture}")


@command(
    "stickslip certify results/snecma-beam-20.313.nc",
    "stickslip certify results/snecma-beam-20.313.nc --points 50 --seed 1",
    "stickslip certify results/snecma-beam-20.313.nc --points all --out certified.nc",
    note="Exit code 0: every point was compared; 1: some were not; 2: the input is refused.",
)
def certify(
    result: Annotated[
        Path, typer.Argument(help="Result file of a forced response.", metavar="RESULT.nc")
    ],
    points: Annotated[
        str, typer.Option(help="How many points, chosen at random, or 'all'.", metavar="NUMBER")
    ] = "20",
    seed: Annotated[
        int,
        typer.Option(help="Seed of the random points.", metavar="INTEGER", parser=integer),
    ] = 0,
    dof: Annotated[
        list[str] | None,
        typer.Option(help="Degree of freedom to compare, several times for more. Default: all."),
    ] = None,
    out: Annotated[Path | None, _file(help="File to write; default: the same.")] = None,
) -> None:
    """Compare a curve with exact orbits, and put its true error into the file."""
    from stickslip import certify, load
    from stickslip.cli import console
    from stickslip.views.curves import certificates

    try:
        wanted: int | Literal["all"] = "all" if points == "all" else integer(points)
    except typer.BadParameter:
        raise ModelError(f"--points = {points!r}: give a number, or all") from None
    target = out or result
    require_place(target)
    with console.progress(result.name, wanted=True) as advance, Interruption(advance) as watch:
        try:
            certified = certify(load(result), wanted, seed=seed, dofs=dof, progress=watch)
        except Interrupted as stop:
            console.complain("interrupted", "saving what was compared")
            cast("ForcedResponse", stop.result).save(target)
            raise KeyboardInterrupt(f"{stop}, now in {target}") from None
        certified.save(target)
    console.show_all(certificates([("", certified)], "", "m"))
    console.tell("")
    console.tell(f"certified: {target}")
    if not warned([(result.stem, certified)]):
        raise typer.Exit(NOT_CONVERGED)


@command("stickslip schema --out stickslip.schema.json")
def schema(
    out: Annotated[Path | None, _file(help="File to write; default: the terminal.")] = None,
) -> None:
    """Print the JSON schema of study files, with which editors complete and check them."""
    from stickslip.cli.console import tell
    from stickslip.study import json_schema

    text = json.dumps(json_schema(), indent=2, ensure_ascii=False)
    if out is None:
        tell(text)
    else:
        write(out, f"{text}\n".encode())
        tell(f"schema: {out}")


@command(
    "stickslip report results/snecma-beam-*.nc",
    "stickslip report results/*.nc --out beam.html --title 'SNECMA beam' --hertz",
    note="Needs plotly and jinja2: pip install 'stickslip\\[report]'.",
)
def report(
    results: Files,
    out: Annotated[
        Path | None, _file(help="Page to write; default: report.html beside the result.")
    ] = None,
    title: Annotated[str | None, typer.Option(help="Heading of the page.")] = None,
    dof: Dofs = None,
    hertz: Hertz = False,
    rpm: Rpm = False,
    length: Annotated[
        str,
        typer.Option("--length-unit", help="Unit of amplitudes: auto, m, mm, um.", metavar="UNIT"),
    ] = "auto",
) -> None:
    """Write results of any kind as one HTML page that is read without a network."""
    from stickslip import report
    from stickslip.cli.console import tell

    page = out or results[0].with_name("report.html")
    report(
        results,
        page,
        title=title,
        dofs=dof,
        omega_unit=omega_unit(hertz=hertz, rpm=rpm),
        length_unit=cast("Literal['auto', 'm', 'mm', 'um']", length),
    )
    tell(f"report: {page}")


@command(
    "stickslip export results/snecma-beam-*.nc --to csv",
    "stickslip export results/snecma-beam-20.313.nc --out beam.xlsx",
    "stickslip export results/snecma-beam-20.313.nc --to parquet --table omega-harmonic-dof",
    "stickslip export results/snecma-beam-20.313.nc --to csv --table all",
    note="Needs for Excel and Parquet: pip install 'stickslip\\[export]'; for Universal Files "
    "'stickslip\\[fe]'.",
)
def export(
    results: Files,
    to: Annotated[
        str | None,
        typer.Option(help="csv, parquet, xlsx (Excel), mat (MATLAB) or uff.", metavar="FORMAT"),
    ] = None,
    out: Annotated[Path | None, _file(help="File to write; its ending says the format.")] = None,
    table: Annotated[
        str | None, typer.Option(help="Table to write, or 'all'; default: that of the amplitudes.")
    ] = None,
) -> None:
    """Write the numbers of results for other programs, beside the results."""
    from stickslip import load
    from stickslip.cli.console import tell
    from stickslip.results.export import FORMATS, ending

    if (to is None) == (out is None):
        raise ModelError("export: give --to, as csv, or --out, as beam.csv")
    if out is not None and (len(results) > 1 or table == "all"):
        raise ModelError(f"--out = {str(out)!r} is one file; give --to for several")
    suffix = ending(out.suffix if out else f".{to}", "--out" if out else "--to")
    for file in results:
        result = load(file)
        several = table == "all" and FORMATS[suffix].tables == "one"
        names = list(result.tables()) if several else [None if table == "all" else table]
        for name in names:
            part = "" if name is None else f"-{name}"
            target = out or file.with_name(f"{file.stem}{part}{suffix}")
            result.export(target, name)
            tell(f"export: {target}")


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
