"""What is said and drawn of response curves."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from math import inf, pi
from typing import TYPE_CHECKING

import numpy as np

from stickslip.results.exact_response import ExactResponse
from stickslip.results.stability import stability_counts
from stickslip.units import quantity
from stickslip.views.tables import Row, Table, assumed, model_rows, new_table

if TYPE_CHECKING:
    from stickslip.disk import MistunedDisk
    from stickslip.results import Certificate, ForcedResponse, Summary
    from stickslip.study.tables import OutputTable
    from stickslip.views.picture import Panel

__all__ = ["certificates", "details", "facts", "failures", "panels", "peaks", "tables"]


_SLIP_POINTS = 12
_LOOPS = 2


def tables(
    results: Sequence[tuple[str, ForcedResponse]], label: str, dofs: Iterable[str], length_unit: str
) -> list[Table]:
    """Tabulate the peaks of curves, and their true errors where they have been compared."""
    return [
        *peaks(results, label, dofs, length_unit),
        *certificates(results, label, length_unit),
    ]


def peaks(
    results: Sequence[tuple[str, ForcedResponse]], label: str, dofs: Iterable[str], length_unit: str
) -> list[Table]:
    """Tabulate the peak of every curve and DOF.

    Parameters
    ----------
    results : sequence of (str, ForcedResponse)
        Curves, each with what tells it from the others.
    label : str
        What that is: heading of the first column, which is left out if this is empty.
    dofs : iterable of str
        The DOFs to tabulate, as far as a curve has them.
    length_unit : str
        Unit of the amplitudes.
    """
    table = new_table()
    if label:
        table.add_column(label, overflow="fold")
    table.add_column("dof", overflow="fold")
    # short headings: eight columns have to fit on a terminal of 80
    lengths = (f"peak [{length_unit}]", f"error [{length_unit}]")
    for heading in ("rad/s", "Hz", *lengths, "H", "converged"):
        table.add_column(heading, justify="right", overflow="fold")
    shown = list(dofs)
    length = quantity(f"1 {length_unit}", "m", "unit of length")
    at_edge = beside_gap = unbounded = False
    for name, result in results:
        for row in result.summary([dof for dof in shown if dof in result.dofs]):
            cells = (*_peak(result, row, length), _converged(result))
            table.add_row(*([name] if label else []), *cells)
            at_edge = at_edge or row.at_edge
            beside_gap = beside_gap or row.beside_gap
            unbounded = unbounded or row.amplitude == inf
    notes = []
    if at_edge:
        notes.append("* at an end of the computed frequencies: the true peak may lie outside")
    if beside_gap:
        notes.append("? beside points that are not solved: the true peak may be there, and higher")
    if unbounded:
        notes.append("inf: neither damping nor friction bounds the resonance there")
    table.caption = "\n".join(notes) or None
    return [table]


def _peak(result: ForcedResponse, row: Summary, length: float) -> tuple[str, ...]:
    mark = "*" * row.at_edge + "?" * row.beside_gap
    return (
        row.dof,
        f"{row.omega:#.6g}{mark}",
        f"{row.omega / (2 * pi):#.6g}",
        f"{row.amplitude / length:.4e}",
        "-" if row.amplitude == inf else f"{row.error_estimate / length:.0e}",
        "exact" if isinstance(result, ExactResponse) else f"{row.harmonics}",
    )


def _harmonics(result: ForcedResponse) -> str:
    if isinstance(result, ExactResponse):
        return f"exact orbits, reported up to {result.settings.harmonics}"
    if result.settings.harmonics != "auto":
        return f"{result.settings.harmonics}"
    kept = result.harmonics[result.arrays.solved]
    return f"auto, {kept.min()} to {kept.max()}" if kept.size else "auto"


def _samples(result: ForcedResponse) -> str:
    taken = result.samples[result.arrays.solved]
    if result.settings.march != "auto" or not taken.size:
        return f"{result.settings.march} per period"
    return f"auto, {taken.min()} to {taken.max()} per period"


def _converged(result: ForcedResponse) -> str:
    return f"{int(result.converged.sum())} of {result.omega.size}"


def failures(result: ForcedResponse) -> list[str]:
    """Word what did not converge, one line per cause: how many points, where, and what to do.

    Parameters
    ----------
    result : ForcedResponse
        The curve.

    Returns
    -------
    list of str
        Empty if every point converged.
    """
    places = defaultdict(list)
    for omega, status in zip(result.omega, result.status, strict=True):
        if status != "converged":
            places[status].append(float(omega))
    return [
        f"{len(where)} of {result.omega.size} points {status}, "
        f"{_where(where)} rad/s. {status.advice}"
        for status, where in places.items()
    ] + _without_orbit(result)


def _without_orbit(result: ForcedResponse) -> list[str]:
    certificate = result.certificate
    if certificate is None:
        return []
    failed = [one for one in certificate.status if one != "converged"]
    if not failed:
        return []
    return [
        f"{len(failed)} of {len(certificate.status)} points could not be compared "
        f"({failed[0]}). {failed[0].advice}"
    ]


def _where(omega: list[float]) -> str:
    low, high = min(omega), max(omega)
    return f"at {low:.6g}" if low == high else f"between {low:.6g} and {high:.6g}"


def facts(result: ForcedResponse) -> list[Row]:
    """Say what a result is of, how it was computed and what it took for granted."""
    omega = result.omega
    span = f"from {omega.min():.6g} to {omega.max():.6g} rad/s"
    rows = [
        *model_rows(result.model),
        ("points", f"{omega.size} {span}, {_converged(result)} converged"),
        ("harmonics", _harmonics(result)),
    ]
    if result.samples.any():
        rows.append(("samples", _samples(result)))
    if isinstance(result, ExactResponse):
        rows += _orbit_rows(result)
    return rows + assumed(result)


def _orbit_rows(result: ExactResponse) -> list[tuple[str, str]]:
    solved = result.arrays.solved
    counts = np.diff(result.arrays.event_offset)[solved]
    if not counts.size:
        return []
    moving = np.arange(result.multipliers.shape[1]) >= result.neutral[:, None]
    size = np.where(moving, np.abs(result.multipliers), 0.0)[solved].max()
    largest = (
        "multipliers of a wave unknown" if np.isnan(size) else f"largest multiplier {size:.4g}"
    )
    return [
        ("events", f"{counts.min()} to {counts.max()} per period"),
        (
            "stability",
            f"{stability_counts(result.stability[solved])}, {largest}",
        ),
    ]


def panels(
    results: Sequence[ForcedResponse], dofs: Sequence[str], output: OutputTable
) -> list[Panel]:
    """Return the response curves, one panel per DOF."""
    from stickslip import plot

    return [
        partial(
            plot.curves,
            results,
            dof,
            omega_unit=output.omega_unit,
            length_unit=output.length_unit,
        )
        for dof in dofs
    ]


def details(result: ForcedResponse, dofs: Sequence[str], output: OutputTable) -> list[Panel]:
    """Return blades, slip, loops at the peak and multipliers, as far as a curve has them."""
    if not result.arrays.solved.any():
        return []
    return list(_details(result, dofs, output))


def _details(result: ForcedResponse, dofs: Sequence[str], output: OutputTable) -> Iterator[Panel]:
    from stickslip import plot
    from stickslip.disk import MistunedDisk

    length, omega = output.length_unit, output.omega_unit
    if isinstance(result.model, MistunedDisk):
        for dof in _of_sectors(result.model, dofs):
            yield partial(plot.blade_bars, result, dof, length_unit=length)
            yield partial(plot.blade_curves, result, dof, omega_unit=omega, length_unit=length)
    contacts = result.model.contacts
    if contacts:
        points = sum(contact.points for contact in contacts)
        if points <= _SLIP_POINTS and result.omega.size > 1:
            yield partial(plot.slip, result, omega_unit=omega)
        at = int(np.nanargmax(result.amplitude(dofs[0])))
        shares = [result.slip_fraction(contact)[at].max() for contact in range(len(contacts))]
        # The contacts that slip most tell most.
        for contact in sorted(np.argsort(shares)[::-1][:_LOOPS].tolist()):
            yield partial(plot.hysteresis, result, contact, at, length_unit=length)
    if isinstance(result, ExactResponse):
        yield partial(plot.multipliers, result, omega_unit=omega)


def _of_sectors(disk: MistunedDisk, dofs: Sequence[str]) -> list[str]:
    """Return the DOFs of a sector to which DOFs of a mistuned disk belong."""
    known = disk.disk.structure.dofs
    return [one for one in dict.fromkeys(dof.partition(".")[2] for dof in dofs) if one in known]


def certificates(
    results: Sequence[tuple[str, ForcedResponse]], label: str, length_unit: str
) -> list[Table]:
    """Tabulate the true errors of the curves that were compared with exact orbits."""
    compared = [(name, one.certificate) for name, one in results if one.certificate is not None]
    if not compared:
        return []
    table = new_table("largest true error, against exact orbits")
    if label:
        table.add_column(label, overflow="fold")
    table.add_column("dof", overflow="fold")
    for heading in ("orbits", "rad/s", f"error [{length_unit}]", "relative", "estimate holds"):
        table.add_column(heading, justify="right", overflow="fold")
    promised = any(certificate.tolerance is not None for _, certificate in compared)
    if promised:
        table.add_column("tolerance holds", justify="right", overflow="fold")
    length = quantity(f"1 {length_unit}", "m", "unit of length")
    for name, certificate in compared:
        for column, dof in enumerate(certificate.dofs):
            cells = _certificate(certificate, column, length)
            table.add_row(*([name] if label else []), dof, *cells[: 6 if promised else 5])
    return [table]


def _certificate(certificate: Certificate, column: int, length: float) -> tuple[str, ...]:
    relative = certificate.relative[:, column]
    known = np.isfinite(relative)
    count = int(known.sum())
    orbits = f"{count} of {relative.size}"
    if not count:
        return orbits, "", "", "", "", ""
    worst = int(np.nanargmax(np.abs(relative)))
    within = certificate.within_tolerance
    return (
        orbits,
        f"{certificate.omega[worst]:#.6g}",
        f"{certificate.error[worst, column] / length:+.1e}",
        f"{relative[worst]:+.2g}",
        f"{int(certificate.within_estimate[known, column].sum())} of {count}",
        "" if within is None else f"{int(within[known, column].sum())} of {count}",
    )
