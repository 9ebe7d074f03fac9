"""What the drawing functions are given, checked before anything is drawn."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from stickslip.checks import brief, text
from stickslip.errors import ModelError
from stickslip.results import ForcedResponse

__all__ = ["at", "dofs_of", "labels_of", "require_solved", "result_of", "results_of"]


def result_of(result: object, entry: str = "result") -> ForcedResponse:
    """Return a result, or refuse anything else."""
    if not isinstance(result, ForcedResponse):
        raise ModelError(
            f"{entry}: {brief(result)} is not a ForcedResponse; give what forced_response returned"
        )
    return result


def results_of(results: object) -> list[ForcedResponse]:
    """Return one or several results as a list that is not empty."""
    if isinstance(results, str) or not isinstance(results, Iterable):
        return [result_of(results, "results")]
    given = [result_of(result, f"results[{place}]") for place, result in enumerate(results)]
    if not given:
        raise ModelError("results: empty; give at least one ForcedResponse")
    return given


def dofs_of(dof: object) -> list[str]:
    """Return one or several names of degrees of freedom as a list that is not empty."""
    if isinstance(dof, str) or not isinstance(dof, Iterable):
        return [text(dof, "dof")]
    names = [text(one, f"dof[{place}]") for place, one in enumerate(dof)]
    if not names:
        raise ModelError("dof: empty; name at least one")
    return names


def labels_of(labels: object, count: int) -> list[str]:
    """Return the labels of `count` results."""
    if isinstance(labels, str) or not isinstance(labels, Iterable):
        raise ModelError(f"labels: {brief(labels)} is not a list; give one text per result")
    given = [text(label, f"labels[{place}]") for place, label in enumerate(labels)]
    if len(given) != count:
        raise ModelError(f"labels: {len(given)} for {count} results; give one each")
    return given


def require_solved(result: ForcedResponse, indices: Sequence[int]) -> None:
    """Refuse points without a solution."""
    for index in indices:
        status = result.status[result.position(index)]
        if not status.solved:
            raise ModelError(
                f"index: {at(result, index)} has no solution to draw ({status}). {status.advice}"
            )


def at(result: ForcedResponse, index: int) -> str:
    """Return the frequency of a point as it is written in figures."""
    return f"ω = {result.omega[index]:.5g} rad/s"
