"""What is said and drawn of a kind of result, and which view does it."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from importlib import import_module
from math import inf, pi
from typing import TYPE_CHECKING, Any, Generic, TypeAlias, TypeVar

from stickslip.disk.bladed_disk import rotor_order
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.results.diagnostic import Severity
from stickslip.results.result import Result
from stickslip.views.picture import Panels, titled
from stickslip.views.tables import Row, Table, assumed, model_rows, tabulated

if TYPE_CHECKING:
    from stickslip.study.tables import OutputTable

VIEWS: Mapping[str, tuple[str, str]] = {
    "forced_response": ("stickslip.views.curves", "CurveView"),
    "exact_response": ("stickslip.views.curves", "CurveView"),
    "transient": ("stickslip.views.transients", "TransientView"),
    "damper_curve": ("stickslip.views.dampers", "DamperView"),
    "optimal_damper": ("stickslip.views.dampers", "OptimumView"),
    "motion_class": ("stickslip.views.motions", "MotionView"),
    "basin_map": ("stickslip.views.motions", "BasinView"),
    "mistuning_study": ("stickslip.views.mistuning", "MistuningView"),
    "static_response": ("stickslip.views.statics", "StaticView"),
    "fit": ("stickslip.views.fits", "FitView"),
    "uncertainty": ("stickslip.views.uncertainty", "UncertaintyView"),
    "limit_cycles": ("stickslip.views.cycles", "CycleView"),
    "campbell": ("stickslip.views.speeds", "CampbellView"),
    "speed_response": ("stickslip.views.speeds", "SpeedView"),
    "sweep": ("stickslip.views.sweeps", "SweepView"),
    "stability_map": ("stickslip.views.cycles", "MapView"),
    "flutter_map": ("stickslip.views.cycles", "FlutterView"),
    "nonlinear_modes": ("stickslip.views.modes", "ModeView"),
}
"""Module and class of the view of every kind; results of one view are drawn together."""


_ANY = "?"
RPM = "{rpm}"
"""Heading of frequencies in rpm, which tables have on demand."""
LENGTHS = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "nm": 1e-9}
"""Units of amplitudes in tables, in metres."""
_NUMBER = re.compile(r"[+-]?[0-9.]+(e[+-]?[0-9]+)?")

Kind = TypeVar("Kind", bound=Result)
Dofs: TypeAlias = Sequence[str]
"""Names of DOFs."""
Output: TypeAlias = "OutputTable"
"""What a study asks of its figures and tables."""
Rows: TypeAlias = Iterable[Sequence[str]]
"""Cells of tables, row by row."""


class View(ABC, Generic[Kind]):
    """What is said and drawn of a kind of result.

    A view prints nothing. Tables are those of rich; panels draw on Matplotlib axes, from which a
    report makes its interactive figures.
    """

    texts: Sequence[str] = ()
    """Headings of the first columns."""
    numbers: Sequence[str] = ()
    """Headings of the numbers behind them; ``{}`` stands for the unit of length."""
    rpm: str = ""
    """What `RPM` stands for; empty: tables are without that column."""
    last: Sequence[str] = ()
    """Headings of texts behind the numbers."""
    frequencies: bool = True
    """Whether a unit of frequency or speed changes the default picture."""

    def headings(self, dofs: Dofs, length_unit: str) -> list[str]:
        """Return the headings of the numbers."""
        wanted = [heading for heading in self.numbers if heading != RPM or self.rpm]
        return [heading.format(length_unit, rpm=self.rpm) for heading in wanted]

    def in_rpm(self, model: Model, omega: float) -> list[str]:
        """Return the cell of the column `RPM`, if there is one; of a disk it is its rotor's."""
        speed = omega / (rotor_order(model) or 1.0)
        return [f"{speed * 30 / pi:#.6g}"] if self.rpm else []

    @abstractmethod
    def rows(self, result: Kind, dofs: Dofs, length: float) -> Rows:
        """Return the rows of a result, with amplitudes in units of a length."""

    def tables(
        self, results: Sequence[tuple[str, Kind]], label: str, dofs: Iterable[str], length_unit: str
    ) -> list[Table]:
        """Tabulate what matters of results, each with what tells it from the others.

        What that is heads the first column, which is left out if the label is empty. DOFs are
        tabulated as far as a result has them; the unit of length "auto" is that which suits the
        amplitudes.
        """
        shown = list(dofs)
        length_unit = self.length_unit(results, shown, length_unit)
        length = LENGTHS[length_unit]
        rows = [
            (name, row)
            for name, result in results
            for row in self.rows(result, [dof for dof in shown if dof in result.dofs], length)
        ]
        return [tabulated(label, self.texts, self.headings(shown, length_unit), self.last, rows)]

    def length_unit(self, results: Sequence[tuple[str, Kind]], dofs: Dofs, length_unit: str) -> str:
        """Return a unit of length, or for "auto" that which suits the amplitudes of a table."""
        if length_unit != "auto":
            return length_unit
        first = len(self.texts)
        headings = enumerate(self.headings(dofs, _ANY))
        columns = [first + place for place, heading in headings if _ANY in heading]
        cells = [
            row[column]
            for _, result in results
            for row in map(
                list, self.rows(result, [one for one in dofs if one in result.dofs], 1.0)
            )
            for column in columns
            if column < len(row)
        ]
        sizes = [abs(float(cell)) for cell in cells if _NUMBER.fullmatch(cell)]
        largest = max((size for size in sizes if 0.0 < size < inf), default=1.0)
        return next((unit for unit, size in LENGTHS.items() if largest >= size), "nm")

    def facts(self, result: Kind) -> list[Row]:
        """Say what a result is of, how it was computed and, as "assumed", what it assumes."""
        return [*model_rows(result.model), *self.about(result), *assumed(result)]

    def about(self, result: Kind) -> list[Row]:
        """Say how a result was computed."""
        return []

    def failures(self, result: Kind) -> list[str]:
        """Word what the states of its points say went wrong, one line per cause."""
        return []

    @abstractmethod
    def panels(self, results: Sequence[Kind], dofs: Dofs, output: Output) -> Panels:
        """Return the default picture of results, together."""

    def named_panels(
        self, results: Sequence[tuple[str, Kind]], dofs: Dofs, output: Output
    ) -> Panels:
        """Return the default picture of results, each with its name where there are several.

        Single ones without a picture are left out; it is refused if none has one.
        """
        if len(results) == 1:
            return self.panels([results[0][1]], dofs, output)
        return self.told_apart(results, dofs, output)

    def told_apart(self, results: Sequence[tuple[str, Kind]], dofs: Dofs, output: Output) -> Panels:
        """Return the pictures of several results, each below its name."""
        drawn: Panels = []
        refused: ModelError | None = None
        for name, result in results:
            try:
                drawn += [titled(panel, name) for panel in self.panels([result], dofs, output)]
            except ModelError as error:
                refused = error
        if refused is not None and not drawn:
            raise refused
        return drawn

    def details(self, result: Kind, dofs: Dofs, output: Output) -> Panels:
        """Return what a report shows of one result beside the default picture."""
        return []


def failures(result: Result) -> list[str]:
    """Word what is missing from a result, one line per cause."""
    return [*view_of([result]).failures(result), *texts_of(result, Severity.FAILURE)]


def cautions(result: Result) -> list[str]:
    """Word what puts the numbers of a result in doubt, one line each."""
    part = ["The run was interrupted: this is what it had computed."] * result.interrupted
    return part + texts_of(result, Severity.CAUTION)


def texts_of(result: Result, severity: Severity) -> list[str]:
    """Return what is said of a result with one severity."""
    return [one.text for one in result.diagnostics if one.severity is severity]


def view_of(results: Sequence[Result], omega_unit: str | None = None) -> View[Any]:
    """Return the view of some results; refused if there is none, or they do not go together.

    Tables have frequencies in rpm too where that is the unit, and of a disk the rotor's speed.
    """
    for result in results:
        if result.kind not in VIEWS:
            known = ", ".join(kind.replace("_", " ") for kind in VIEWS)
            raise ModelError(
                f"results: nothing is known to show of a {result.kind.replace('_', ' ')}; "
                f"known: {known}"
            )
    views = {VIEWS[result.kind]: result.kind for result in results}
    if len(views) > 1:
        kinds = " and ".join(kind.replace("_", " ") for kind in views.values())
        raise ModelError(f"results: {kinds} do not go together; name one kind at a time")
    ((module, name),) = views
    view: View[Any] = getattr(import_module(module), name)()
    if any(rotor_order(result.model) for result in results):
        view.rpm = "rotor rpm"
    elif omega_unit == "rpm":
        view.rpm = "rpm"
    return view
