"""Which module says and draws what of which kind of result."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, Any, Protocol, cast

from stickslip.errors import ModelError
from stickslip.results.diagnostic import Severity

if TYPE_CHECKING:
    from stickslip.results.result import Result
    from stickslip.study.tables import OutputTable
    from stickslip.views.picture import Panel
    from stickslip.views.tables import Row, Table

__all__ = ["MODULES", "View", "cautions", "failures", "view_of"]

MODULES: Mapping[str, str] = {
    "forced_response": "stickslip.views.curves",
    "exact_response": "stickslip.views.curves",
    "transient": "stickslip.views.transients",
    "damper_curve": "stickslip.views.dampers",
    "optimal_damper": "stickslip.views.optima",
    "motion_class": "stickslip.views.motions",
    "basin_map": "stickslip.views.basins",
    "mistuning_study": "stickslip.views.mistuning",
    "limit_cycles": "stickslip.views.cycles",
    "stability_map": "stickslip.views.maps",
}
"""The module of every kind of result; results of one module are drawn together."""


class View(Protocol):
    """What a module says of its kind of result: the same to terminal, picture and report.

    Nothing is printed here. Tables are those of rich, made by `new_table`; panels draw on
    Matplotlib axes, from which a report makes its interactive figures.
    """

    def tables(
        self, results: Sequence[tuple[str, Any]], label: str, dofs: Iterable[str], length_unit: str
    ) -> list[Table]:
        """Tabulate what matters of results, each with what tells it from the others."""
        ...

    def facts(self, result: Any) -> list[Row]:
        """Say what a result is of, how it was computed and, as "assumed", what it assumes."""
        ...

    def panels(
        self, results: Sequence[Any], dofs: Sequence[str], output: OutputTable
    ) -> list[Panel]:
        """Return the default picture of results, together."""
        ...

    def details(self, result: Any, dofs: Sequence[str], output: OutputTable) -> list[Panel]:
        """Return what a report shows of one result beside the default picture."""
        ...

    def failures(self, result: Any) -> list[str]:
        """Word what the states of its points say went wrong, one line per cause."""
        ...


def failures(result: Result) -> list[str]:
    """Word what is missing from a result, one line per cause."""
    return [*view_of([result]).failures(result), *_texts(result, Severity.FAILURE)]


def cautions(result: Result) -> list[str]:
    """Word what puts the numbers of a result in doubt, one line each."""
    return _texts(result, Severity.CAUTION)


def _texts(result: Result, severity: Severity) -> list[str]:
    return [one.text for one in result.diagnostics if one.severity is severity]


def view_of(results: Sequence[Result]) -> View:
    """Return the module for some results.

    Raises
    ------
    ModelError
        If there is none for a kind, or they are of kinds that are not drawn together.
    """
    for result in results:
        if result.kind not in MODULES:
            known = ", ".join(kind.replace("_", " ") for kind in MODULES)
            raise ModelError(
                f"results: nothing is known to show of a {result.kind.replace('_', ' ')}; "
                f"known: {known}"
            )
    modules = {MODULES[result.kind]: result.kind for result in results}
    if len(modules) > 1:
        kinds = " and ".join(kind.replace("_", " ") for kind in modules.values())
        raise ModelError(f"results: {kinds} do not go together; name one kind at a time")
    (module,) = modules
    return cast("View", import_module(module))
