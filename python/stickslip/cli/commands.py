"""The command line: ``stickslip run STUDY.toml``, ``show``, ``plot``, ``certify``, ``schema``.

The command ``report`` is added by `stickslip.cli.reporting`.

Exit codes: 0 all is well, 1 some points did not converge, 2 the input is refused, 70 a defect of
the program, 130 interrupted by Ctrl-C, 143 by SIGTERM, 129 by SIGHUP: 128 and the signal's number.
"""

from __future__ import annotations

import io
import json
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, NamedTuple, cast

import typer

from stickslip.cli.guard import NOT_CONVERGED, Command, Commands, guarded, integer
from stickslip.errors import Interrupted, ModelError
from stickslip.files import make_folder, require_place, require_writable, write
from stickslip.interruption import Interruption

if TYPE_CHECKING:
    from stickslip.results import ForcedResponse
    from stickslip.results.result import Result
    from stickslip.study import Case, Study

__all__ = ["app"]

Files = Annotated[
    list[Path], typer.Argument(help="Result files of 'stickslip run'.", metavar="RESULT.nc")
]

app = typer.Typer(
    name="stickslip",
    cls=Commands,
    help="Steady vibration of structures damped by dry friction.",
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _epilog(*examples: str) -> str:
    # paragraphs, because the help would join lines
    return "\n\n".join(("[bold]Examples[/bold]", *(f"  {example}" for example in examples)))


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


# ------------------------------------------------------------------------------------------- run


class Curve(NamedTuple):
    """A computed result and where it was saved."""

    case: Case
    result: Result
    file: Path


class Clock(dict[str, float]):
    """Seconds spent, by what was done."""

    @contextmanager
    def __call__(self, label: str) -> Iterator[None]:
        """Add the time of a block."""
        begin = time.perf_counter()
        try:
            yield
        finally:
            self[label] = self.get(label, 0.0) + time.perf_counter() - begin


@app.command(
    cls=Command,
    epilog=_epilog(
        "stickslip run study.toml",
        "stickslip run study.toml --out results/first --timings",
        "stickslip run study.toml --quiet --no-plot",
    )
    + "\n\nExit code 0: all points converged; 1: some did not; 2: the study is refused.",
)
@guarded
def run(
    study: Annotated[Path, typer.Argument(help="Study file.", metavar="STUDY.toml")],
    out: Annotated[Path, typer.Option(help="Folder for the results.", metavar="DIR")] = Path(
        "results"
    ),
    timings: Annotated[bool, typer.Option("--timings", help="Print where the time went.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print problems only.")] = False,
    no_plot: Annotated[bool, typer.Option("--no-plot", help="Draw no picture.")] = False,
) -> None:
    """Compute a study: one result per level, saved as NetCDF, with a table and a picture."""
    from stickslip.cli import console
    from stickslip.cli.stores import storing
    from stickslip.study import Study
    from stickslip.views.kinds import view_of

    clock = Clock()
    with clock("reading the study"):
        loaded = storing(Study.load(study), out)
        make_folder(out)
        require_writable(out)
    curves = _compute(loaded, out, clock, quiet=quiet)
    if not quiet:
        with clock("refining peaks, printing"):
            console.show_all(
                view_of([curve.result for curve in curves]).tables(
                    [(_level(curve.case), curve.result) for curve in curves],
                    "" if loaded.tables.analysis.levels is None else "level",
                    loaded.dofs,
                    loaded.tables.output.length_unit,
                )
            )
    picture = None if no_plot else out / f"{loaded.name}.png"
    undrawn = None
    if picture is not None:
        try:
            with clock("drawing"):
                _draw_study(loaded, curves, picture)
        except ModelError as error:
            # The results are saved: what there is to say of them comes first.
            picture, undrawn = None, error
    if timings:
        console.stages([curve.result for curve in curves], clock)
    if not quiet:
        _tell_files(loaded, curves, picture)
    complete = _warned([(curve.case.name, curve.result) for curve in curves])
    if undrawn is not None:
        raise undrawn
    if not complete:
        raise typer.Exit(NOT_CONVERGED)


def _compute(study: Study, out: Path, clock: Clock, *, quiet: bool) -> list[Curve]:
    from stickslip.cli.console import complain, progress

    curves: list[Curve] = []
    cases = study.cases
    with progress(study.name, wanted=not quiet) as advance, Interruption(advance) as watch:
        results = study.run(watch)
        try:
            for case, result in zip(cases, results, strict=True):
                file = out / f"{case.name}.nc"
                with clock("saving"), _counted(len(curves), study, out):
                    result.save(file)
                    _remove_partial(_partial(out, case))
                curves.append(Curve(case, result, file))
                watch.heed()
        except Interrupted as stop:
            complain("interrupted", "saving what was computed")
            case, result = cases[len(curves)], cast("Result", stop.result)
            # a part under another name, so that a complete curve of an earlier run is not lost
            file = _partial(out, case) if result.interrupted else out / f"{case.name}.nc"
            with _counted(len(curves), study, out):
                result.save(file)
            if result.interrupted:
                rest = f"the next one as far as it went in {file}{_rest(study)}"
                raise KeyboardInterrupt(f"{_complete(curves, study, out)}, {rest}") from None
            curves.append(Curve(case, result, file))
            raise KeyboardInterrupt(_complete(curves, study, out)) from None
        except KeyboardInterrupt:
            raise KeyboardInterrupt(_complete(curves, study, out)) from None
    return curves


def _complete(curves: Sequence[Curve], study: Study, out: Path) -> str:
    return f"{len(curves)} of {len(study.cases)} {_nouns(study)} complete in {out}"


@contextmanager
def _counted(complete: int, study: Study, out: Path) -> Iterator[None]:
    """Say beside an error how much of a study there is."""
    try:
        yield
    except ModelError as error:
        raise ModelError(
            f"{error}; {complete} of {len(study.cases)} {_nouns(study)} complete in {out}"
            f"{_rest(study)}"
        ) from None


def _partial(out: Path, case: Case) -> Path:
    """Return where a run that was stopped leaves what it has."""
    return out / f"{case.name}-partial.nc"


def _remove_partial(file: Path) -> None:
    """Remove what an interrupted run left, once the run is complete."""
    from stickslip import load

    # Another study may have this name; its results say that they are whole.
    with suppress(ModelError, OSError):
        if file.is_file() and load(file).interrupted:
            file.unlink()


def _nouns(study: Study) -> str:
    nouns = {"transient": "runs", "mistuning-study": "studies"}
    return nouns.get(study.tables.analysis.kind, "curves")


def _rest(study: Study) -> str:
    stored = study.tables.analysis.kind == "mistuning-study"
    return "; run it again to go on from there" if stored else ""


def _level(case: Case) -> str:
    return "" if case.level is None else f"{case.level:.10g}"


def _tell_files(study: Study, curves: Sequence[Curve], picture: Path | None) -> None:
    from stickslip.cli.console import tell

    tell("")
    if picture is not None:
        tell(f"picture: {picture}")
    first = curves[0].file
    if len(curves) == 1:
        tell(f"results: {first}")
    else:
        tell(f"results: {first.with_name(f'{study.name}-*.nc')} ({len(curves)} files)")
    tell(f"details: stickslip show {first}")
    tell(f"page:    stickslip report {first}")


def _warned(results: Sequence[tuple[str, Result]]) -> bool:
    """Name what did not converge; False if there is anything."""
    from stickslip.cli.console import complain
    from stickslip.views.kinds import cautions, failures

    for name, result in results:
        for text in cautions(result):
            complain("warning", f"{name}: {text}")
    failed = [f"{name}: {text}" for name, result in results for text in failures(result)]
    for line in failed:
        complain("warning", line)
    return not failed


def _draw_study(study: Study, curves: Sequence[Curve], picture: Path) -> None:
    from stickslip.views.kinds import view_of
    from stickslip.views.picture import draw

    results = [curve.result for curve in curves]
    draw(view_of(results).panels(results, study.dofs, study.tables.output), picture)


# ---------------------------------------------------------------------------- show, plot, schema


@app.command(cls=Command, epilog=_epilog("stickslip show results/snecma-beam-20.313.nc"))
@guarded
def show(results: Files) -> None:
    """Print what results hold: the model, the numbers, what was assumed, what did not converge."""
    from stickslip import load
    from stickslip.cli import console
    from stickslip.study import notable_dofs
    from stickslip.views.kinds import failures, view_of

    for number, file in enumerate(results):
        result = load(file)
        if number > 0:
            console.tell("")
        console.tell(str(file))
        view = view_of([result])
        console.grid(view.facts(result))
        console.tell("")
        shown = notable_dofs(result.model, result.dofs)
        console.show_all(view.tables([("", result)], "", shown, "m"))
        for text in failures(result):
            console.complain("warning", f"{file.name}: {text}")


@app.command(
    cls=Command,
    epilog=_epilog(
        "stickslip plot results/snecma-beam-*.nc",
        "stickslip plot results/snecma-beam-*.nc --dof tip --hertz --linear --out tip.pdf",
        "stickslip plot results/snecma-beam-20.313.nc --dof tip --waveform 170",
        'stickslip plot results/snecma-beam-20.313.nc --loop "27 Hz"',
    ),
)
@guarded
def plot(
    results: Files,
    dof: Annotated[
        list[str] | None,
        typer.Option(help="DOF to draw, repeatable; default: with a force or a contact."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Picture (.png, .pdf, .svg); default: beside the result.", metavar="FILE"
        ),
    ] = None,
    hertz: Annotated[bool, typer.Option("--hertz", help="Frequency axis in Hz.")] = False,
    log: Annotated[bool, typer.Option("--log/--linear", help="Amplitude axis.")] = True,
    per_force: Annotated[
        bool, typer.Option("--per-force", help="Amplitude per unit of force.")
    ] = False,
    waveform: Annotated[
        str | None,
        typer.Option(help="Draw one period at this frequency instead.", metavar="OMEGA"),
    ] = None,
    loop: Annotated[
        str | None,
        typer.Option(help="Draw the hysteresis loop at this frequency.", metavar="OMEGA"),
    ] = None,
    contact: Annotated[
        str, typer.Option(help="Contact of the loop: position, from 0, or name.")
    ] = "0",
    events: Annotated[
        str | None,
        typer.Option(help="Draw stick and slip over the period, of orbits.", metavar="OMEGA"),
    ] = None,
    multipliers: Annotated[
        bool, typer.Option("--multipliers", help="Draw the Floquet multipliers of orbits.")
    ] = False,
) -> None:
    """Draw results, or of curves one period of the motion, a loop, events or multipliers."""
    from stickslip import load
    from stickslip.cli import console
    from stickslip.cli.drawing import Wanted, picture_of
    from stickslip.views.picture import draw

    wanted = Wanted(
        dofs=dof,
        hertz=hertz,
        log=log,
        per_force=per_force,
        waveform=waveform,
        loop=loop,
        contact=contact,
        events=events,
        multipliers=multipliers,
    )
    name, panels = picture_of(
        [load(file) for file in results], [file.stem for file in results], wanted
    )
    picture = out or results[0].with_name(f"{results[0].stem}-{name}.png")
    draw(panels, picture)
    console.tell(f"picture: {picture}")


@app.command(
    cls=Command,
    epilog=_epilog(
        "stickslip certify results/snecma-beam-20.313.nc",
        "stickslip certify results/snecma-beam-20.313.nc --points 50 --seed 1",
        "stickslip certify results/snecma-beam-20.313.nc --points all --out certified.nc",
    )
    + "\n\nExit code 0: every point was compared; 1: some were not; 2: the input is refused.",
)
@guarded
def certify(
    result: Annotated[
        Path, typer.Argument(help="Result file of a forced response.", metavar="RESULT.nc")
    ],
    points: Annotated[
        str, typer.Option(help="How many points, chosen at random, or 'all'.", metavar="NUMBER")
    ] = "20",
    seed: Annotated[
        int, typer.Option(help="Of the random choice.", metavar="INTEGER", parser=integer)
    ] = 0,
    dof: Annotated[
        list[str] | None, typer.Option(help="DOF to compare, repeatable; default: all.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="File to write; default: the same.", metavar="FILE")
    ] = None,
) -> None:
    """Compare a curve with exact orbits, and put its true error into the file."""
    from stickslip import certify, load
    from stickslip.cli import console
    from stickslip.views.curves import certificates

    wanted = _points(points)
    target = out or result
    require_place(target)
    with (
        console.progress(result.name, wanted=True) as advance,
        Interruption(advance) as watch,
    ):
        try:
            certified = certify(load(result), wanted, seed=seed, dofs=dof, progress=watch)
        except Interrupted as stop:
            console.complain("interrupted", "saving what was compared")
            cast("ForcedResponse", stop.result).save(target)
            raise KeyboardInterrupt(f"{stop}, now in {target}") from None
    console.show_all(certificates([("", certified)], "", "m"))
    certified.save(target)
    console.tell("")
    console.tell(f"certified: {target}")
    if not _warned([(result.stem, certified)]):
        raise typer.Exit(NOT_CONVERGED)


def _points(text: str) -> int | Literal["all"]:
    if text == "all":
        return "all"
    try:
        return integer(text)
    except typer.BadParameter:
        raise ModelError(f"--points = {text!r}: give a number, or all") from None


@app.command(cls=Command, epilog=_epilog("stickslip schema --out stickslip.schema.json"))
@guarded
def schema(
    out: Annotated[
        Path | None, typer.Option(help="File to write; default: the terminal.", metavar="FILE")
    ] = None,
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
