"""What a report says of a model: size, damping, natural frequencies, contacts, forces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np

from stickslip.disk import BladedDisk
from stickslip.errors import ModelError
from stickslip.model import Model, natural_frequencies
from stickslip.model.configurations import every_point
from stickslip.model.damping import Rayleigh
from stickslip.model.structure import Structure
from stickslip.results.result import Result
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
