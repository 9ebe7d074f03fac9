"""Which module prints and draws which kind of result."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, Any, Protocol, cast

from stickslip.errors import ModelError

if TYPE_CHECKING:
    from stickslip.cli.picture import Panel
    from stickslip.results.result import Result
    from stickslip.study.tables import OutputTable

__all__ = ["MODULES", "View", "view_of"]

MODULES: Mapping[str, str] = {
    "forced_response": "stickslip.cli.curves",
    "exact_response": "stickslip.cli.curves",
    "transient": "stickslip.cli.transients",
    "damper_curve": "stickslip.cli.dampers",
    "optimal_damper": "stickslip.cli.optima",
    "limit_cycles": "stickslip.cli.cycles",
    "stability_map": "stickslip.cli.maps",
}
"""The module of every kind of result; results of one module are drawn together."""


class View(Protocol):
    """What a module can say of its kind of result."""

    def tables(
        self, results: Sequence[tuple[str, Any]], label: str, dofs: Iterable[str], length_unit: str
    ) -> None:
        """Print what matters of results, each with what tells it from the others."""
        ...

    def facts(self, result: Any) -> None:
        """Print what a result is of, how it was computed and what it took for granted."""
        ...

    def panels(
        self, results: Sequence[Any], dofs: Sequence[str], output: OutputTable
    ) -> list[Panel]:
        """Return the default picture."""
        ...

    def failures(self, name: str, result: Any) -> list[str]:
        """Word what went wrong, one line per cause."""
        ...

    def cautions(self, name: str, result: Any) -> list[str]:
        """Return what puts the numbers in doubt, one line each."""
        ...


def view_of(results: Sequence[Result]) -> View:
    """Return the module for some results.

    Raises
    ------
    ModelError
        If they are of kinds that are not drawn together.
    """
    modules = {MODULES[result.kind]: result.kind for result in results}
    if len(modules) > 1:
        kinds = " and ".join(kind.replace("_", " ") for kind in modules.values())
        raise ModelError(f"results: {kinds} do not go together; name one kind at a time")
    (module,) = modules
    return cast("View", import_module(module))
