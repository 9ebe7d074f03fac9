"""What is said and drawn of mistuning studies."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from stickslip.errors import ModelError
from stickslip.results.status import Status
from stickslip.views.tables import Row, Table, assumed, counted, listed, model_rows, new_table

if TYPE_CHECKING:
    from stickslip.results.arrays import Float
    from stickslip.results.mistuning import MistuningStudy
    from stickslip.study.tables import OutputTable
    from stickslip.views.picture import Panel

__all__ = ["details", "facts", "failures", "panels", "tables"]

_HIGH = 99.9
"""Percentile of the fit that is printed."""


class _Group(NamedTuple):
    """The disks of one deviation and one coupling, of one degree of freedom."""

    deviation: float
    coupling: float
    dof: str
    factors: Float


def _groups(result: MistuningStudy) -> Iterator[_Group]:
    for d, deviation in enumerate(result.deviation):
        for c, coupling in enumerate(result.coupling_stiffness):
            for dof in result.dofs:
                row = result.amplification(dof)[d, c]
                yield _Group(float(deviation), float(coupling), dof, row[np.isfinite(row)])


def tables(
    results: Sequence[tuple[str, MistuningStudy]],
    label: str,
    dofs: Iterable[str],
    length_unit: str,
) -> list[Table]:
    """Say mean, largest and percentiles of the amplification factors of every group."""
    from stickslip.results.weibull import fit_weibull

    table = new_table()
    if label:
        table.add_column(label, overflow="fold")
    table.add_column("dof", overflow="fold")
    headings = ("deviation", "coupling [N/m]", "disks", "mean", "largest", f"{_HIGH:g} %", "95 %")
    for heading in headings:
        table.add_column(heading, justify="right", overflow="fold")
    for name, result in results:
        for group in _groups(result):
            factors = group.factors
            try:
                found = fit_weibull(factors).percentile(_HIGH)
                fit = [f"{found.value:.4f}", f"{found.low:.4f} to {found.high:.4f}"]
            except ModelError:
                fit = ["-", "too few or equal"]
            known = factors.size > 0
            table.add_row(
                *([name] if label else []),
                group.dof,
                f"{group.deviation:g}",
                "-" if np.isnan(group.coupling) else f"{group.coupling:g}",
                f"{factors.size}",
                f"{factors.mean():.4f}" if known else "-",
                f"{factors.max():.4f}" if known else "-",
                *fit,
            )
    return [table]


def facts(result: MistuningStudy) -> list[Row]:
    """Say what a result is of, how it was computed and what it took for granted."""
    settings = result.settings
    low, high = settings.span
    count, sectors = result.patterns.shape
    drawn = (
        "given"
        if settings.distribution is None
        else f"{settings.distribution}, seed {settings.seed}"
    )
    couplings = [f"{value:g}" for value in result.coupling_stiffness if np.isfinite(value)]
    rows = [
        *model_rows(result.model),
        ("patterns", f"{count} of {sectors} sectors, {drawn}"),
        ("deviations", listed([f"{value:g}" for value in result.deviation])),
        ("couplings", f"{listed(couplings)} N/m" if couplings else "as the disk has them"),
        ("peaks", f"{settings.measure}, {low:.6g} to {high:.6g} rad/s"),
        ("harmonics", f"{settings.harmonics}"),
        ("solutions", f"{result.counters['points']}"),
    ]
    return rows + assumed(result)


def failures(result: MistuningStudy) -> list[str]:
    """Word what was not solved, one line per cause."""
    every = [Status.from_code(int(code)) for code in result.arrays.status.ravel()]
    return counted([one for one in every if not one.solved], f"{len(every)} peaks")


def panels(
    results: Sequence[MistuningStudy], dofs: Sequence[str], output: OutputTable
) -> list[Panel]:
    """Return the distributions; of several deviations or couplings how they move them."""
    from stickslip import plot

    drawn: list[Panel] = []
    for result in results:
        for dof in [dof for dof in dofs if dof in result.dofs] or result.dofs:
            several = (result.deviation.size > 1, result.coupling_stiffness.size > 1)
            if several[0]:
                drawn.append(partial(plot.amplification, result, dof, "deviation"))
            if several[1]:
                drawn.append(partial(plot.amplification, result, dof, "coupling"))
            if not any(several):
                drawn.append(partial(plot.distribution, result, dof))
    return drawn


def details(result: MistuningStudy, dofs: Sequence[str], output: OutputTable) -> list[Panel]:
    """Return the distributions behind a picture of several deviations or couplings."""
    from stickslip import plot

    if result.deviation.size == 1 and result.coupling_stiffness.size == 1:
        return []
    chosen = [dof for dof in dofs if dof in result.dofs] or result.dofs
    return [partial(plot.distribution, result, dof) for dof in chosen]
