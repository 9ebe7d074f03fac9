"""The true error of a response curve, from exact orbits at some of its points."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from stickslip.analyses.arguments import Progress, require_progress
from stickslip.analyses.exact_response import exact_response
from stickslip.checks import brief, members, whole_number
from stickslip.errors import Interrupted, ModelError
from stickslip.results import ForcedResponse
from stickslip.results.arrays import Int
from stickslip.results.certificate import Certificate
from stickslip.results.exact_response import ExactResponse

__all__ = ["certify"]

POINTS = 20

_SAMPLES = 1024
"""Instants per period at which curve and orbit are compared."""


def certify(
    result: ForcedResponse,
    points: int | Literal["all"] | Sequence[int] = POINTS,
    *,
    seed: int = 0,
    dofs: Iterable[str] | str | None = None,
    progress: Progress = None,
) -> ForcedResponse:
    """Compare a harmonic balance with exact orbits at some of its points.

    The error estimate of a result is an estimate; this is the error itself. A point costs a few
    times what it does with ``harmonics="auto"``.

    Parameters
    ----------
    result : ForcedResponse
        A harmonic balance.
    points : int, "all" or sequence of int, optional
        How many points to choose at random, all, or the positions of points. Points that are not
        solved are passed over.
    seed : int, optional
        Of the random choice: the same seed chooses the same points.
    dofs : iterable of str, optional
        The observed degrees of freedom to compare. Default: all observed ones.
    progress : callable, optional
        Called about ten times per second with the fraction of the work that is done.

    Returns
    -------
    ForcedResponse
        The same curve, with its `certificate`. The curve that was given is left as it is.

    Raises
    ------
    ModelError
        If the result is no harmonic balance or has no solved point, or an argument is of the wrong
        type or outside its range.
    Interrupted
        On Ctrl-C; its `result` is certified at the points that had been compared.
    """
    _require_balance(result)
    require_progress(progress)
    compared = _dofs(result, dofs)
    indices = _indices(result, points, seed)
    try:
        exact = exact_response(
            result.model,
            result.omega[indices],
            harmonics=1,
            residual=result.settings.residual,
            observe=compared,
            progress=progress,
        )
    except Interrupted as stop:
        done: ExactResponse = stop.result  # type: ignore[assignment]
        certified = replace(result, certificate=_certificate(result, done, indices))
        raise Interrupted(
            f"certification interrupted after {done.omega.size} of {indices.size} points, which "
            "the result of this exception holds",
            certified,
        ) from None
    return replace(result, certificate=_certificate(result, exact, indices))


def _certificate(result: ForcedResponse, exact: ExactResponse, indices: Int) -> Certificate:
    indices = indices[: exact.omega.size]
    amplitude = np.stack([exact.amplitude(dof) for dof in exact.dofs], axis=1)
    curve = np.stack([result.amplitude(dof)[indices] for dof in exact.dofs], axis=1)
    estimate = np.stack([result.error_estimate(dof)[indices] for dof in exact.dofs], axis=1)
    apart = [
        [_apart(result, exact, dof, int(index), place) for dof in exact.dofs]
        for place, index in enumerate(indices)
    ]
    automatic = result.settings.harmonics == "auto"
    return Certificate(
        dofs=exact.dofs,
        tolerance=result.settings.tolerance if automatic else None,
        indices=indices,
        omega=exact.omega,
        code=exact.arrays.status,
        amplitude=amplitude,
        error=curve - amplitude,
        waveform_error=np.array(apart).reshape(amplitude.shape),
        estimate=estimate,
    )


def _apart(result: ForcedResponse, exact: ExactResponse, dof: str, index: int, place: int) -> float:
    """Return the largest difference between curve and orbit over the period."""
    curve = result.waveform(dof, index, _SAMPLES)
    return float(np.abs(curve - exact.waveform(dof, place, _SAMPLES)).max())


def _require_balance(result: object) -> None:
    if isinstance(result, ExactResponse):
        raise ModelError("result: is exact already; give what forced_response returned")
    if not isinstance(result, ForcedResponse):
        raise ModelError(
            f"result: {brief(result)} is not a ForcedResponse; give what forced_response returned"
        )


def _dofs(result: ForcedResponse, dofs: Iterable[str] | str | None) -> tuple[str, ...]:
    if dofs is None:
        return result.dofs
    names = (dofs,) if isinstance(dofs, str) else members(dofs, "dofs", "dofs=[...]")
    if not names:
        raise ModelError("dofs: empty; name at least one, or leave it out for all")
    for name in names:
        result.error_estimate(name)  # refuses what is unknown
    return tuple(dict.fromkeys(names))


def _indices(result: ForcedResponse, points: int | str | Sequence[int], seed: int) -> Int:
    """Return the positions of the points to compare, ascending, each once."""
    solved = np.flatnonzero(result.arrays.solved)
    if not solved.size:
        raise ModelError(f"result: none of the {result.omega.size} points is solved; see status")
    if isinstance(points, str):
        if points != "all":
            raise ModelError(f'points: {brief(points)}; give "all", a number, or positions')
        return solved
    if not isinstance(points, Iterable):
        count = whole_number(points, "points", smallest=1)
        generator = np.random.default_rng(whole_number(seed, "seed"))
        return np.sort(generator.choice(solved, min(count, solved.size), replace=False))
    given = members(points, "points", "points=[...]")
    if not given:
        raise ModelError("points: empty; give at least one position")
    chosen = np.unique([result.position(index) for index in given])
    unsolved = np.setdiff1d(chosen, solved)
    if unsolved.size:
        status = result.status[unsolved[0]]
        raise ModelError(
            f"points: point {unsolved[0]} is not solved ({status}); name solved points"
        )
    return chosen
