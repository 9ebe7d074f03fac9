"""Which view says and draws what of which kind of result."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, Any

from stickslip.errors import ModelError
from stickslip.results.diagnostic import Severity

if TYPE_CHECKING:
    from stickslip.results.result import Result
    from stickslip.views.view import View

__all__ = ["VIEWS", "cautions", "failures", "view_of"]

VIEWS: Mapping[str, tuple[str, str]] = {
    "forced_response": ("stickslip.views.curves", "CurveView"),
    "exact_response": ("stickslip.views.curves", "CurveView"),
    "transient": ("stickslip.views.transients", "TransientView"),
    "damper_curve": ("stickslip.views.dampers", "DamperView"),
    "optimal_damper": ("stickslip.views.dampers", "OptimumView"),
    "motion_class": ("stickslip.views.motions", "MotionView"),
    "basin_map": ("stickslip.views.motions", "BasinView"),
    "mistuning_study": ("stickslip.views.mistuning", "MistuningView"),
    "limit_cycles": ("stickslip.views.cycles", "CycleView"),
    "stability_map": ("stickslip.views.cycles", "MapView"),
}
"""Module and class of the view of every kind; results of one view are drawn together."""


def failures(result: Result) -> list[str]:
    """Word what is missing from a result, one line per cause."""
    return [*view_of([result]).failures(result), *_texts(result, Severity.FAILURE)]


def cautions(result: Result) -> list[str]:
    """Word what puts the numbers of a result in doubt, one line each."""
    return _texts(result, Severity.CAUTION)


def _texts(result: Result, severity: Severity) -> list[str]:
    return [one.text for one in result.diagnostics if one.severity is severity]


def view_of(results: Sequence[Result]) -> View[Any]:
    """Return the view of some results.

    Raises
    ------
    ModelError
        If there is none for a kind, or they are of kinds that are not drawn together.
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
    return view
