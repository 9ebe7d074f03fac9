"""What is said and drawn of response curves."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from math import inf, pi

import numpy as np

from stickslip.disk import MistunedDisk
from stickslip.drawn import plots
from stickslip.results.certificate import Certificate
from stickslip.results.exact_response import ExactResponse
from stickslip.results.fields import Int
from stickslip.results.forced_response import ForcedResponse
from stickslip.results.stability import stability_counts
from stickslip.views.kinds import LENGTHS, RPM, Dofs, Output, Rows, View
from stickslip.views.picture import Panel, Panels, labelled
from stickslip.views.tables import Row, Table, bound_rows, tabulated

_SLIP_POINTS = 12
_LOOPS = 2


class CurveView(View[ForcedResponse]):
    """The peaks of curves, and their true errors where they have been compared."""

    texts = ("dof",)
    # short headings: eight columns have to fit on a terminal of 80
    numbers = ("rad/s", "Hz", RPM, "peak [{}]", "error [{}]", "H", "converged")

    def rows(self, result: ForcedResponse, dofs: Dofs, length: float) -> Rows:
        """Return a row per DOF."""
        for row in result.summary(dofs):
            mark = "*" * row.at_edge + "?" * row.beside_gap
            yield (
                row.dof,
                f"{row.omega:#.6g}{mark}",
                f"{row.omega / (2 * pi):#.6g}",
                *self.in_rpm(result.model, row.omega),
                f"{row.amplitude / length:#.5g}",
                "-" if row.amplitude == inf else f"{row.error_estimate / length:.1g}",
                "exact" if isinstance(result, ExactResponse) else f"{row.harmonics}",
                _converged(result),
            )

    def tables(
        self,
        results: Sequence[tuple[str, ForcedResponse]],
        label: str,
        dofs: Iterable[str],
        length_unit: str,
    ) -> list[Table]:
        """Tabulate peaks, with notes on their marks, and true errors."""
        shown = list(dofs)
        length_unit = self.length_unit(results, shown, length_unit)
        (table,) = super().tables(results, label, shown, length_unit)
        curves = [result for _, result in results]
        peaks = [row for one in curves for row in one.summary(set(shown) & set(one.dofs))]
        notes = {
            "* at an end of the computed frequencies: the true peak may lie outside": any(
                peak.at_edge for peak in peaks
            ),
            "? beside points that are not solved: the true peak may be there, and higher": any(
                peak.beside_gap for peak in peaks
            ),
            "inf: neither damping nor friction bounds the resonance there": any(
                peak.amplitude == inf for peak in peaks
            ),
        }
        table.caption = "\n".join(note for note, holds in notes.items() if holds) or None
        return [table, *certificates(results, label, length_unit)]

    def about(self, result: ForcedResponse) -> list[Row]:
        """Say which points were computed, and by how many harmonics."""
        omega = result.omega
        span = f"from {omega.min():.6g} to {omega.max():.6g} rad/s"
        rows = [
            ("points", f"{omega.size} {span}, {_converged(result)} converged"),
            ("harmonics", _harmonics(result)),
        ]
        if result.samples.any():
            march = result.settings.march
            samples = f"{march}" if isinstance(march, int) else _kept(result, result.samples)
            rows.append(("samples", f"{samples} per period"))
        rows += bound_rows(result)
        rows += _state_rows(result)
        return rows + (_orbit_rows(result) if isinstance(result, ExactResponse) else [])

    def failures(self, result: ForcedResponse) -> list[str]:
        """Word what did not converge: how many points, where, and what to do."""
        places = defaultdict(list)
        for omega, status in zip(result.omega.tolist(), result.status, strict=True):
            if status != "converged":
                places[status].append(omega)
        found = [
            f"{len(where)} of {result.omega.size} points {status}, "
            f"{_where(where)} rad/s. {status.advice}"
            for status, where in places.items()
        ]
        compared = () if result.certificate is None else result.certificate.status
        failed = [one for one in compared if one != "converged"]
        if failed:
            count = f"{len(failed)} of {len(compared)} points could not be compared"
            found.append(f"{count} ({failed[0]}). {failed[0].advice}")
        return found

    def panels(self, results: Sequence[ForcedResponse], dofs: Dofs, output: Output) -> Panels:
        """Return the response curves, one panel per DOF."""
        length, omega = output.length_unit, output.frequency_unit
        draw = partial(plots.curves, results, omega_unit=omega, length_unit=length)
        return [partial(draw, dof) for dof in dofs]

    def told_apart(
        self, results: Sequence[tuple[str, ForcedResponse]], dofs: Dofs, output: Output
    ) -> Panels:
        """Return curves in one figure, with their names and what distinguishes them."""
        from stickslip.plot.curves import traits_of

        names, curves = zip(*results, strict=True)
        return labelled(self.panels(curves, dofs, output), names, traits_of(curves))

    def details(self, result: ForcedResponse, dofs: Dofs, output: Output) -> Panels:
        """Return blades, slip, loops at the peak and multipliers, as far as a curve has them."""
        return list(_details(result, dofs, output)) if result.arrays.solved.any() else []


def _details(result: ForcedResponse, dofs: Dofs, output: Output) -> Iterator[Panel]:
    length, omega = output.length_unit, output.frequency_unit
    if isinstance(result.model, MistunedDisk):
        for dof in _of_sectors(result.model, dofs):
            yield partial(plots.blade_bars, result, dof, omega_unit=omega, length_unit=length)
            yield partial(plots.blade_curves, result, dof, omega_unit=omega, length_unit=length)
    contacts = result.model.contacts
    if contacts:
        from stickslip.plot.curves import contacts_with_states

        points = sum(contact.points for contact in contacts)
        if points <= _SLIP_POINTS and result.omega.size > 1 and contacts_with_states(result):
            yield partial(plots.slip, result, omega_unit=omega)
        at = int(np.nanargmax(result.amplitude(dofs[0])))
        if any(not one.core_phases for one in contacts) and points <= _SLIP_POINTS:
            yield partial(plots.events, result, at, omega_unit=omega)
        shares = [result.slip_fraction(contact)[at].max() for contact in range(len(contacts))]
        # The contacts that slip most tell most.
        for contact in sorted(np.argsort(shares)[::-1][:_LOOPS].tolist()):
            drawn = partial(plots.hysteresis, result, contact, at, omega_unit=omega)
            yield partial(drawn, length_unit=length)
    if isinstance(result, ExactResponse):
        yield partial(plots.multipliers, result, omega_unit=omega)


def _of_sectors(disk: MistunedDisk, dofs: Dofs) -> list[str]:
    """Return the DOFs of a sector to which DOFs of a mistuned disk belong."""
    known = disk.disk.structure.dofs
    return [one for one in dict.fromkeys(dof.partition(".")[2] for dof in dofs) if one in known]


def _converged(result: ForcedResponse) -> str:
    return f"{int(result.converged.sum())} of {result.omega.size}"


def _harmonics(result: ForcedResponse) -> str:
    harmonics = result.settings.harmonics
    if isinstance(result, ExactResponse):
        return f"exact orbits, reported up to {harmonics}"
    return _kept(result, result.harmonics) if harmonics == "auto" else f"{harmonics}"


def _kept(result: ForcedResponse, counts: Int) -> str:
    """Say between which numbers an automatic choice lies, of the points that are solved."""
    kept = counts[result.arrays.solved]
    return f"auto, {kept.min()} to {kept.max()}" if kept.size else "auto"


def _where(omega: list[float]) -> str:
    low, high = min(omega), max(omega)
    return f"at {low:.6g}" if low == high else f"between {low:.6g} and {high:.6g}"


def _state_rows(result: ForcedResponse) -> list[Row]:
    """Say which shares of the period the nodes of contacts are open, slip and stick."""
    solved = result.arrays.solved
    rows = []
    for name, contact in zip(result.model.contact_names, result.model.contacts, strict=True):
        if "N" in contact.components and solved.any():
            slips, opens = (of(name)[solved] for of in (result.slip_fraction, result.open_fraction))
            shares = {"open": opens, "slips": slips, "sticks": 1.0 - slips - opens}
            said = (
                # rounding may leave less than nothing
                f"{state} {max(0.0, one.min()):.0%} to {max(0.0, one.max()):.0%}"
                for state, one in shares.items()
            )
            rows.append(("states", f"{name}: {', '.join(said)} of the period"))
    return rows


def _orbit_rows(result: ExactResponse) -> list[Row]:
    solved = result.arrays.solved
    counts = np.diff(result.arrays.event_offset)[solved]
    if not counts.size:
        return []
    moving = np.arange(result.multipliers.shape[1]) >= result.neutral[:, None]
    size = np.where(moving, np.abs(result.multipliers), 0.0)[solved].max()
    known = f"largest multiplier {size:.4g}"
    largest = "multipliers of a wave unknown" if np.isnan(size) else known
    return [
        ("events", f"{counts.min()} to {counts.max()} per period"),
        ("stability", f"{stability_counts(result.stability[solved])}, {largest}"),
    ]


def certificates(
    results: Sequence[tuple[str, ForcedResponse]], label: str, length_unit: str
) -> list[Table]:
    """Tabulate the true errors of the curves that were compared with exact orbits."""
    compared = [(name, one.certificate) for name, one in results if one.certificate is not None]
    if not compared:
        return []
    promised = any(certificate.tolerance is not None for _, certificate in compared)
    headings = ("orbits", "rad/s", f"error [{length_unit}]", "relative", "estimate holds")
    length = LENGTHS[length_unit]
    rows = [
        (name, (dof, *_certificate(certificate, column, length)[: 6 if promised else 5]))
        for name, certificate in compared
        for column, dof in enumerate(certificate.dofs)
    ]
    numbers = (*headings, "tolerance holds") if promised else headings
    table = tabulated(label, ("dof",), numbers, (), rows)
    table.title = "largest true error, against exact orbits"
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
