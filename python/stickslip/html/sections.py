"""What stands in a report: groups of results that are drawn together, each result, each model."""

from __future__ import annotations

import hashlib
import io
import platform
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib.metadata import version
from importlib.resources import files
from math import pi
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from stickslip import _core
from stickslip.disk import BladedDisk
from stickslip.errors import ModelError
from stickslip.html.figures import Drawn, drawn
from stickslip.model import Model, natural_frequencies
from stickslip.model.configurations import every_point
from stickslip.model.damping import Rayleigh
from stickslip.model.notable import notable_dofs
from stickslip.model.structure import Structure
from stickslip.results.diagnostic import Severity
from stickslip.results.result import Result
from stickslip.results.store import content_of
from stickslip.study.tables import OutputTable
from stickslip.views.kinds import VIEWS, View, cautions, failures, texts_of, view_of
from stickslip.views.picture import Panel
from stickslip.views.tables import Row, Table, model_rows, tabulated

_MODES = 12


@dataclass(frozen=True)
class ModelSummary:
    """A model, and the results that are of it."""

    names: list[str]
    rows: list[Row]
    frequencies: Table | str
    """Natural frequencies, or why there are none."""


def summaries(results: Sequence[tuple[str, Result]]) -> list[ModelSummary]:
    """Return the models of results; those that differ in their forces only stand together."""
    groups: list[list[tuple[str, Model]]] = []
    for name, result in results:
        group = next((one for one in groups if _same(one[0][1], result.model)), None)
        if group is None:
            groups.append(group := [])
        group.append((name, result.model))
    return [_summary(group) for group in groups]


def _summary(named: Sequence[tuple[str, Model]]) -> ModelSummary:
    model = named[0][1]
    rows = model_rows(model)
    rows.insert(1, ("damping", _damping(model.structure)))
    if any(other.forces != model.forces for _, other in named):
        rows = [row for row in rows if row[0] not in ("force", "forces")]
        rows.append(("forces", "those of each result"))
    try:
        frequencies: Table | str = _frequencies(model)
    except ModelError as error:
        frequencies = f"No natural frequencies: {error}"
    return ModelSummary([name for name, _ in named], rows, frequencies)


def _same(one: Model, other: Model) -> bool:
    first, second = one.structure, other.structure
    matrices = ("mass", "damping", "stiffness")
    return (type(one), one.contacts, first.dofs) == (
        type(other),
        other.contacts,
        second.dofs,
    ) and all(np.array_equal(getattr(first, name), getattr(second, name)) for name in matrices)


def _damping(structure: Structure) -> str:
    law = structure.damping_law
    if isinstance(law, Rayleigh):
        return f"Rayleigh, C = {law.mass:g}/s M + {law.stiffness:g} s K"
    if law is not None:
        ratios = np.unique(np.atleast_1d(law.ratio))
        span = f"{ratios[0]:g}" if ratios.size == 1 else f"{ratios[0]:g} to {ratios[-1]:g}"
        return f"modal, ratio {span}"
    return "a matrix" if structure.damping.any() else "none"


def _frequencies(model: Model) -> Table:
    """Tabulate the lowest natural frequencies, all contacts stuck and all free to slip."""
    slipping = every_point(model, finite=True)
    stuck, free = natural_frequencies(model), natural_frequencies(model, slipping)
    columns = {"stuck": stuck, "free": free} if slipping else {"": stuck}
    headings = [f"{state} [{unit}]".strip() for state in columns for unit in ("rad/s", "Hz")]
    values = np.stack([omega / part for omega in columns.values() for part in (1.0, 2 * pi)], 1)
    rows = [("", (f"{mode}", *(f"{x:#.6g}" for x in row))) for mode, row in enumerate(values)]
    table = tabulated("", (), ["mode", *headings], (), rows[:_MODES])
    table.title = "natural frequencies"
    notes = ["all contacts stuck, and all slipping without friction"] if slipping else []
    if stuck.size > _MODES:
        notes.append(f"the lowest {_MODES} of {stuck.size}")
    if isinstance(model, BladedDisk):
        notes.append("of the nodal diameter that the engine order excites")
    table.caption = "; ".join(notes) or None
    return table


class Entry(NamedTuple):
    """A result of the report."""

    name: str
    result: Result
    source: Path | None
    """The file it was read from."""
    anchor: str


def content(
    entries: Sequence[Entry], dofs: Sequence[str] | None, output: OutputTable, title: str | None
) -> dict[str, object]:
    """Return what the template shows, by its names.

    Without `dofs` those of notice are shown, without `title` the page gets one of its own.

    Raises
    ------
    ModelError
        If a result is of a kind of which nothing is known to show.
    """
    from plotly.offline import get_plotlyjs

    page = files("stickslip.html") / "page"
    names = [entry.name for entry in entries]
    return {
        "title": title or f"Report: {', '.join(names[:3])}{', ...' if len(names) > 3 else ''}",
        "date": datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        "overview": _overview(entries),
        "links": [entry.anchor for entry in entries],
        "groups": [_group(members, dofs, output) for members in _grouped(entries)],
        "versions": _versions(),
        "plotly": get_plotlyjs(),
        "style": (page / "report.css").read_text(encoding="utf-8"),
        "script": (page / "report.js").read_text(encoding="utf-8"),
    }


def _grouped(entries: Iterable[Entry]) -> list[list[Entry]]:
    """Put together what has a common view, the same kind of model and the same dofs."""
    groups: dict[object, list[Entry]] = {}
    for entry in entries:
        view_of([entry.result])  # an unknown kind is refused before anything is drawn
        model = entry.result.model
        key = VIEWS[entry.result.kind], type(model), model.structure.dofs, entry.result.dofs
        groups.setdefault(key, []).append(entry)
    return list(groups.values())


def _group(
    members: Sequence[Entry], dofs: Sequence[str] | None, output: OutputTable
) -> dict[str, object]:
    """Return results that are drawn and tabulated together, and each of them by itself."""
    results = [entry.result for entry in members]
    view, first = view_of(results, output.frequency_unit), results[0]
    notable = list(notable_dofs(first.model, first.dofs))
    shown = [dof for dof in dofs or notable if dof in first.dofs] or notable
    named = [(entry.name, entry.result) for entry in members]
    label = "result" if len(members) > 1 else ""
    models = summaries(named)
    known = {row for model in models for row in model.rows}
    sections = []
    for entry in members:
        result = entry.result
        section = {
            "anchor": entry.anchor,
            "name": entry.name,
            "failures": failures(result),
            "cautions": cautions(result),
            "facts": [
                row for row in view.facts(result) if row[0] != "assumed" and row not in known
            ],
            "assumptions": texts_of(result, Severity.NOTE),
            "figures": _figures(view.details(result, shown, output)),
            "settings": _settings(result),
            "effort": _effort(result),
            "provenance": _provenance(entry),
        }
        sections.append(section)
    return {
        "heading": " and ".join(dict.fromkeys(map(_kind, results))),
        "figures": _together(view, named, shown, output),
        "tables": view.tables(named, label, shown, output.length_unit),
        "models": models,
        "sections": sections,
    }


def _together(
    view: View[Any], named: Sequence[tuple[str, Result]], dofs: Sequence[str], output: OutputTable
) -> list[Drawn | str]:
    """Return the figures that results have together, or why there is none."""
    try:
        return _figures(view.named_panels(named, dofs, output))
    except ModelError as error:
        return [str(error)]


def _figures(panels: Iterable[Panel]) -> list[Drawn | str]:
    """Return figures, or why there is none."""
    figures: list[Drawn | str] = []
    for panel in panels:
        try:
            figures.append(drawn(panel))
        except ModelError as error:
            figures.append(str(error))
    return figures


def _overview(entries: Sequence[Entry]) -> Table:
    rows = []
    for entry in entries:
        result = entry.result
        status = _status(result)
        if result.interrupted and "interrupted" not in status:
            status += ", interrupted"
        time = f"{result.timings['total']:.3g}" if "total" in result.timings else ""
        rows.append((entry.name, (_kind(result), status, f"{len(result.assumptions)}", time)))
    return tabulated("result", ("kind", "status"), ("assumptions", "computed in [s]"), (), rows)


def _kind(result: Result) -> str:
    return result.kind.replace("_", " ").capitalize()


def _status(result: Any) -> str:
    """Count how the points ended, or say how the one computation did."""
    found = [getattr(one, "status", "") for one in getattr(result, "results", [result])]
    if len(found) == 1 and isinstance(found[0], str):
        return str(found[0])
    counted: Counter[str] = Counter()
    for one in found:
        counted.update([one] * bool(one) if isinstance(one, str) else map(str, one))
    return ", ".join(f"{count} {name}" for name, count in counted.items())


def _settings(result: Any) -> list[Row]:
    settings = getattr(result, "settings", None)
    keys = {} if settings is None else settings.model_dump()
    return [(name.replace("_", " "), _text(value)) for name, value in keys.items()]


def _text(value: object) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{name} {_text(one)}" for name, one in value.items())
    if isinstance(value, list | tuple):
        return ", ".join(map(_text, value))
    if isinstance(value, float):
        return f"{value:.6g}"
    return "none" if value is None else str(value)


def _effort(result: Any) -> list[Row]:
    rows = [(f"{stage.replace('_', ' ')} [s]", f"{s:.3g}") for stage, s in result.timings.items()]
    counters = {name.replace("_", " "): f"{count}" for name, count in result.counters.items()}
    iterations = getattr(result, "iterations", None)
    if isinstance(iterations, np.ndarray) and iterations.size:
        told = f"{iterations.sum()} in all, at most {iterations.max()} at a point"
        counters["iterations"] = told
    return [*rows, *counters.items()]


def _provenance(entry: Entry) -> list[Row]:
    if entry.source is None:
        return [("source", "computed by the program that wrote the report")]
    import h5py

    content = content_of(entry.source)
    with h5py.File(io.BytesIO(content)) as stored:
        writer = stored.attrs.get("stickslip_version", "unknown")
    written = datetime.fromtimestamp(entry.source.stat().st_mtime, UTC)
    return [
        ("file", str(entry.source)),
        ("written", f"{written:%Y-%m-%d %H:%M UTC}, by stickslip {writer}"),
        ("size", f"{len(content)} bytes"),
        ("SHA-256", hashlib.sha256(content).hexdigest()),
    ]


def _versions() -> list[Row]:
    libraries = [(name, version(name)) for name in ("numpy", "scipy", "matplotlib", "plotly")]
    return [("stickslip", _core.__version__), ("Python", platform.python_version()), *libraries]
