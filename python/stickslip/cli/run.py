"""The command ``stickslip run``: a study, its results in files, a table and a picture."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated, Any, cast

import typer

from stickslip.cli.application import command
from stickslip.cli.exit_codes import NOT_CONVERGED
from stickslip.errors import Interrupted, ModelError
from stickslip.files import make_folder, require_writable
from stickslip.interruption import Interruption

if TYPE_CHECKING:
    from stickslip.results.result import Result
    from stickslip.study import Case, Study
    from stickslip.study.tables import OutputTable
    from stickslip.views.kinds import View
    from stickslip.views.picture import Panels


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


@command(
    "stickslip run study.toml",
    "stickslip run study.toml --out results/first --timings",
    "stickslip run study.toml --quiet --no-plot",
    note="Exit code 0: all points converged; 1: some did not; 2: the study is refused.",
)
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
    from stickslip.study import Study
    from stickslip.views.kinds import view_of
    from stickslip.views.picture import draw

    clock = Clock()
    with clock("reading the study"):
        loaded = _stored(Study.load(study), out)
        make_folder(out)
        require_writable(out)
    results = _compute(loaded, out, clock, quiet=quiet)
    output = loaded.tables.output
    view = view_of(results, output.frequency_unit)
    levels = ["" if one.level is None else f"{one.level:.10g}" for one in loaded.cases]
    named = list(zip(levels, results, strict=True))
    if not quiet:
        label = "" if loaded.tables.analysis.levels is None else "level"
        with clock("refining peaks, printing"):
            console.show_all(view.tables(named, label, loaded.dofs, output.length_unit))
    picture = None if no_plot else out / f"{loaded.name}.png"
    undrawn = None
    if picture is not None:
        try:
            with clock("drawing"):
                draw(_panels(view, named, loaded.dofs, output), picture)
        except ModelError as error:
            # The results are saved: what there is to say of them comes first.
            picture, undrawn = None, error
    if timings:
        console.stages(results, clock)
    if not quiet:
        _tell_files(loaded, out, picture)
    complete = warned([*zip((case.name for case in loaded.cases), results, strict=True)])
    if undrawn is not None:
        raise undrawn
    if not complete:
        raise typer.Exit(NOT_CONVERGED)


def _panels(
    view: View[Any], named: Sequence[tuple[str, Result]], dofs: Sequence[str], output: OutputTable
) -> Panels:
    """Return the picture of results at the levels that are their names."""
    from stickslip.results.forced_response import ForcedResponse

    results = [result for _, result in named]
    if isinstance(results[0], ForcedResponse):
        # the legend has their forces
        return view.panels(results, dofs, output)
    at_levels = [(f"level {level}", result) for level, result in named]
    return view.named_panels(at_levels, dofs, output)


def warned(results: Sequence[tuple[str, Result]]) -> bool:
    """Name what did not converge; False if there is anything."""
    from stickslip.cli.console import complain
    from stickslip.views.kinds import cautions, failures

    doubted = [f"{name}: {text}" for name, result in results for text in cautions(result)]
    failed = [f"{name}: {text}" for name, result in results for text in failures(result)]
    for line in doubted + failed:
        complain("warning", line)
    return not failed


def _stored(study: Study, folder: Path) -> Study:
    """Return a study that can go on where it was stopped with a store beside its result."""
    from stickslip.study.analysis import MistuningStudyTable, UncertaintyTable

    analysis = study.tables.analysis
    kinds = MistuningStudyTable | UncertaintyTable
    if not isinstance(analysis, kinds) or analysis.store is not None:
        return study
    kept = analysis.model_copy(update={"store": str(folder / f"{study.name}.db")})
    return replace(study, tables=study.tables.model_copy(update={"analysis": kept}))


def _compute(study: Study, out: Path, clock: Clock, *, quiet: bool) -> list[Result]:
    from stickslip import load
    from stickslip.cli.console import complain, progress

    computed: list[Result] = []
    cases = study.cases

    def complete() -> str:
        nouns = {"transient": "runs", "mistuning-study": "studies", "uncertainty": "studies"}
        noun = nouns.get(study.tables.analysis.kind, "curves")
        return f"{len(computed)} of {len(cases)} {noun} complete in {out}"

    stored = study.tables.analysis.kind in ("mistuning-study", "uncertainty")
    rest = "; run it again to go on from there" if stored else ""

    def save(result: Result, file: Path) -> None:
        try:
            result.save(file)
        except ModelError as error:
            raise ModelError(f"{error}; {complete()}{rest}") from None

    with progress(study.name, wanted=not quiet) as advance, Interruption(advance) as watch:
        try:
            for case, result in zip(cases, study.run(watch), strict=True):
                with clock("saving"):
                    save(result, _file(out, case))
                    computed.append(result)
                    part = _file(out, case, "-partial")
                    # Another study may have this name; its results say that they are whole.
                    with suppress(ModelError, OSError):
                        if part.is_file() and load(part).interrupted:
                            part.unlink()
            # Before, a signal is heeded where the next curve is kept as far as it went.
            watch.heed()
        except KeyboardInterrupt as stop:
            kept: list[tuple[int, Interrupted]] = list(getattr(stop, "beside", ()))
            if isinstance(stop, Interrupted):
                kept.insert(0, (len(computed), stop))
            if kept:
                complain("interrupted", "saving what was computed")
            parts = []
            for number, ended in kept:
                result = cast("Result", ended.result)
                # a part under another name, so that a complete curve of an earlier run is not lost
                file = _file(out, cases[number], "-partial" if result.interrupted else "")
                save(result, file)
                if result.interrupted:
                    parts.append(str(file))
                else:
                    computed.append(result)
            left = f", the next one as far as it went in {parts[0]}" if parts else ""
            if parts[1:]:
                left = f", the next ones as far as they went in {', '.join(parts)}"
            raise KeyboardInterrupt(f"{complete()}{left}{rest if parts else ''}") from None
    return computed


def _file(out: Path, case: Case, part: str = "") -> Path:
    """Return where a result is saved, or the part of one that a run has when it is stopped."""
    return out / f"{case.name}{part}.nc"


def _tell_files(study: Study, out: Path, picture: Path | None) -> None:
    from stickslip.cli.console import tell

    tell("")
    if picture is not None:
        tell(f"picture: {picture}")
    first, count = _file(out, study.cases[0]), len(study.cases)
    several = f"{out / f'{study.name}-*.nc'} ({count} files)"
    tell(f"results: {first if count == 1 else several}")
    tell(f"details: stickslip show {quote(str(first))}")
    tell(f"page:    stickslip report {quote(str(first))}")
