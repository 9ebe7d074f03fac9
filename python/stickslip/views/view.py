"""What is said and drawn of a kind of result: the same to terminal, picture and report."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Generic, TypeVar

from stickslip.results.result import Result
from stickslip.units import quantity
from stickslip.views.tables import Row, Table, assumed, model_rows, tabulated

if TYPE_CHECKING:
    from stickslip.study.tables import OutputTable
    from stickslip.views.picture import Panel

__all__ = ["View"]

Kind = TypeVar("Kind", bound=Result)


class View(ABC, Generic[Kind]):
    """What is said and drawn of a kind of result.

    A view prints nothing. Tables are those of rich; panels draw on Matplotlib axes, from which a
    report makes its interactive figures.
    """

    texts: Sequence[str] = ()
    """Headings of the first columns."""
    numbers: Sequence[str] = ()
    """Headings of the numbers behind them; ``{}`` stands for the unit of length."""
    last: Sequence[str] = ()
    """Headings of texts behind the numbers."""

    def headings(self, dofs: Sequence[str], length_unit: str) -> list[str]:
        """Return the headings of the numbers."""
        return [heading.format(length_unit) for heading in self.numbers]

    @abstractmethod
    def rows(self, result: Kind, dofs: Sequence[str], length: float) -> Iterable[Sequence[str]]:
        """Return the rows of a result, with amplitudes in units of a length."""

    def tables(
        self, results: Sequence[tuple[str, Kind]], label: str, dofs: Iterable[str], length_unit: str
    ) -> list[Table]:
        """Tabulate what matters of results.

        Parameters
        ----------
        results : sequence of (str, Result)
            Results, each with what tells it from the others.
        label : str
            What that is: heading of the first column, which is left out if this is empty.
        dofs : iterable of str
            The DOFs to tabulate, as far as a result has them.
        length_unit : str
            Unit of the amplitudes.
        """
        shown, length = list(dofs), quantity(f"1 {length_unit}", "m", "unit of length")
        rows = [
            (name, row)
            for name, result in results
            for row in self.rows(result, [dof for dof in shown if dof in result.dofs], length)
        ]
        return [tabulated(label, self.texts, self.headings(shown, length_unit), self.last, rows)]

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
    def panels(
        self, results: Sequence[Kind], dofs: Sequence[str], output: OutputTable
    ) -> list[Panel]:
        """Return the default picture of results, together."""

    def details(self, result: Kind, dofs: Sequence[str], output: OutputTable) -> list[Panel]:
        """Return what a report shows of one result beside the default picture."""
        return []
