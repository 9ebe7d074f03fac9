"""The command ``stickslip reproduce``, which the program finds by an entry point."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.files import make_folder, require_writable

if TYPE_CHECKING:
    from stickslip_reproduce.numbers import Numbers
    from stickslip_reproduce.resolution import Resolution

__all__ = ["key_numbers", "reproduce"]

_SHOWN = 6
"""Facts of an item that the terminal shows."""


def reproduce(
    names: Annotated[
        list[str] | None,
        typer.Argument(
            help="Tables and figures, claims, or all; list or none lists them.", metavar="NAME"
        ),
    ] = None,
    out: Annotated[
        Path, typer.Option(help="Folder for pictures, numbers and index.", metavar="DIR")
    ] = Path("reproduction"),
    coarse: Annotated[
        bool, typer.Option("--coarse", help="Fewer points and cases, in a fraction of the time.")
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print problems only.")] = False,
) -> None:
    """Reproduce tables and figures of the dissertation that this program comes from.

    stickslip reproduce table-2.3 fig-4.22

    stickslip reproduce claims

    stickslip reproduce all --out reproduction
    """
    from stickslip.cli.console import tell
    from stickslip_reproduce import COARSE, FULL, chosen, write
    from stickslip_reproduce.claims import computed
    from stickslip_reproduce.folder import INDEX

    if not names or names == ["list"]:
        _list()
        return
    wanted = chosen(name for name in names if name != "claims")
    make_folder(out)
    require_writable(out)
    resolution = COARSE if coarse else FULL
    for done, item in enumerate(wanted):
        begin = time.perf_counter()
        try:
            numbers = computed(item, resolution)
            seconds = time.perf_counter() - begin
            write(item, numbers, seconds, resolution, out)
        except KeyboardInterrupt:
            kept = f"{done} of {len(wanted)} complete in {out}"
            raise KeyboardInterrupt(f"{kept}, {item.name} was not finished") from None
        if not quiet:
            tell(f"{item.name:<18} {seconds:6.1f} s  {out / item.name}.png")
            for line in key_numbers(numbers):
                tell(f"  {line}")
    if {"claims", "all"} & set(names):
        _claims(resolution, out, quiet=quiet)
    if not quiet:
        tell(f"index: {out / INDEX}")


def key_numbers(numbers: Numbers) -> Iterator[str]:
    """Yield what a terminal shows of the facts of an item, those with a printed value first."""
    from stickslip_reproduce.index import number

    facts = sorted(numbers.facts, key=lambda fact: fact.printed is None)
    for fact in facts[:_SHOWN]:
        printed = "" if fact.printed is None else f" (printed {number(fact.printed)})"
        yield f"{fact.what}: {number(fact.value)} {fact.unit}".rstrip() + printed
    if len(facts) > _SHOWN:
        yield f"and {len(facts) - _SHOWN} more in the index"


def _claims(resolution: Resolution, out: Path, *, quiet: bool) -> None:
    """Judge what the text claims, and write the page."""
    from stickslip.cli.console import tell
    from stickslip_reproduce.claims import claims
    from stickslip_reproduce.claims_page import counts, write_claims
    from stickslip_reproduce.folder import write_index
    from stickslip_reproduce.index import CLAIMS

    begin = time.perf_counter()
    findings = []
    for one in claims().values():
        findings.append(one.finding(resolution))
        if not quiet:
            tell(f"{one.section:<6} {findings[-1].verdict:<17} {one.name}")
    kept = write_claims(findings, out)
    write_index(out)
    if not quiet:
        tell(f"claims     {time.perf_counter() - begin:6.1f} s  {out / CLAIMS}")
        tell(counts(kept))


def _list() -> None:
    """Print everything numbered with its status and what it takes, and the number of claims."""
    from stickslip.cli.console import tell
    from stickslip_reproduce import SUBJECTS, costs, items
    from stickslip_reproduce.claims import claims
    from stickslip_reproduce.numbered import NUMBERED

    done, measured = items(), costs()
    tell(f"{'name':<18}  {'status':<7}  {'cost [s]':>8}  subject")
    for name, subject in SUBJECTS.items():
        cost = f"{measured[name]:.2g}" if name in done and name in measured else ""
        tell(f"{name:<18}  {'done' if name in done else 'not yet':<7}  {cost:>8}  {subject}")
    whole = sum(measured.get(name, 0.0) for name in done)
    for name, (subject, place) in NUMBERED.items():
        status = {"claim": "judged", "none": "left"}.get(place.partition(" ")[0], "given")
        tell(f"{name:<18}  {status:<7}  {'':>8}  {subject}: {place}")
    tell(f"{len(done)} of {len(SUBJECTS)} are reproduced, all of them in {whole:.0f} s")
    tell(f"{len(claims())} claims of the text have verdicts: stickslip reproduce claims")
