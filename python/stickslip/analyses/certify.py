"""The true error of a response curve, from exact orbits at some of its points."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np

from stickslip.analyses.arguments import require_held
from stickslip.analyses.exact_response import orbits_at
from stickslip.analyses.run import Progress, Run, share
from stickslip.checks import brief, members
from stickslip.errors import Interrupted, ModelError
from stickslip.results import ForcedResponse
from stickslip.results.arrays import period_of
from stickslip.results.certificate import Certificate
from stickslip.results.exact_response import ExactResponse
from stickslip.results.fields import Bool, Float, Int
from stickslip.results.status import Status
from stickslip.settings.orbits import CertifySettings, ExactSettings
from stickslip.settings.settings import configured

_SAMPLES = 1024
"""Instants per period at which curve and orbit are compared."""

# Share of the largest displacement, means included, below which a difference is rounding.
_NO_ERROR = 1e-12
# Share of the distance from its own point at which an orbit is that of another part of the curve.
_NEARER = 0.5
# Share of the progress that the orbits are given; following them through the period takes the rest.
_ORBITS = 0.5


@configured(CertifySettings, "points")
def certify(
    result: ForcedResponse,
    settings: CertifySettings,
    *,
    dofs: Iterable[str] | str | None = None,
    progress: Progress = None,
) -> ForcedResponse:
    """Compare a harmonic balance with exact orbits at some of its points.

    The error estimate of a result is an estimate; this is the error itself. A point costs its
    orbit, and as much again to follow it through the period. The orbit of a travelling wave is that
    of all sectors that move differently, sought on the part of a period after which they have
    changed their roles: see `stickslip.disk.wave_ring`.

    Parameters
    ----------
    result : ForcedResponse
        A harmonic balance.
    dofs : iterable of str, optional
        The observed degrees of freedom to compare. Default: all observed ones.

    Returns
    -------
    ForcedResponse
        The same curve, with its `certificate`. The curve that was given is left as it is.

    Raises
    ------
    ModelError
        If the result is no harmonic balance or has no solved point.
    Interrupted
        Certified are the points whose orbits had been found. Their `waveform_error` is not-a-number
        where the orbit had not been followed yet.
    """
    _require_balance(result)
    compared = result.dofs if dofs is None else _dofs(result, dofs)
    indices = _indices(result, settings)
    model, residual = result.model, result.settings.residual
    require_held(model, residual)
    with Run("certification", progress, model) as run:
        kept = ExactSettings.of(harmonics=1, residual=residual)
        exact = orbits_at(model, result.omega[indices], compared, kept, share(run, 0.0, _ORBITS))
        apart = np.full((exact.arrays.omega.size, len(compared)), np.nan)
        if exact.interrupted:
            raise _interrupted(result, exact, indices, apart, 0)
        place = 0
        try:
            with run.at_once():
                compare = _comparison(result, exact, indices)
                for place in range(indices.size):
                    apart[place] = compare(place)
                    run.reached(_ORBITS + (1.0 - _ORBITS) * (place + 1) / indices.size)
        except KeyboardInterrupt:
            raise _interrupted(result, exact, indices, apart, place) from None
        certified = replace(result, certificate=_certificate(result, exact, indices, apart))
        return run.completed(certified, "certification")


def _interrupted(
    result: ForcedResponse, exact: ExactResponse, indices: Int, apart: Float, followed: int
) -> Interrupted:
    """Return the exception that holds the orbits so far, whose waveforms may be missing."""
    certificate = _certificate(result, exact, _found(result, exact, indices), apart)
    return Interrupted(
        f"certification interrupted after {exact.arrays.omega.size} of {indices.size} points, "
        f"{followed} of them over the whole period, which the result of this exception holds",
        replace(result, certificate=certificate),
    )


def _found(result: ForcedResponse, exact: ExactResponse, indices: Int) -> Int:
    """Return the points of which an orbit was found; parts of a sweep are followed at a time."""
    places: dict[float, list[int]] = {}
    for index in indices[::-1].tolist():
        places.setdefault(float(result.omega[index]), []).append(index)
    return np.array([places[omega].pop() for omega in exact.arrays.omega.tolist()], dtype=np.int64)


def _comparison(
    result: ForcedResponse, exact: ExactResponse, indices: Int
) -> Callable[[int], Float]:
    """Return what gives the largest differences between curve and orbit over a period, (d,)."""
    series = np.stack([result.coefficients(dof) for dof in exact.dofs], axis=2)

    def compare(place: int) -> Float:
        curve = period_of(series[indices[place]], _SAMPLES)
        largest: Float = np.abs(curve - exact.waveforms(place, _SAMPLES)).max(axis=0)
        return largest

    return compare


def _certificate(
    result: ForcedResponse, exact: ExactResponse, indices: Int, apart: Float
) -> Certificate:
    low, high = exact.arrays.range[..., 0], exact.arrays.range[..., 1]
    amplitude = 0.5 * (high - low)
    curve = np.stack([result.amplitude(dof)[indices] for dof in exact.dofs], axis=1)
    estimate = np.stack([result.error_estimate(dof)[indices] for dof in exact.dofs], axis=1)
    error = curve - amplitude
    largest = np.maximum(np.abs(low), np.abs(high))
    # Beside a large mean, or a large motion elsewhere, less than this is rounding, not an error.
    error[np.abs(error) <= _NO_ERROR * largest.max(axis=1, keepdims=True)] = 0.0
    automatic = result.settings.harmonics == "auto"
    code, other = exact.arrays.status.copy(), _of_other_motions(result, exact, indices, curve)
    code[other] = Status.OTHER_MOTION.code
    apart = np.where(other[:, np.newaxis], np.nan, apart)
    amplitude[other] = error[other] = np.nan
    return Certificate(
        dofs=exact.dofs,
        tolerance=result.settings.tolerance if automatic else None,
        indices=indices,
        omega=exact.arrays.omega,
        code=code,
        amplitude=amplitude,
        error=error,
        waveform_error=apart,
        estimate=estimate,
    )


def _of_other_motions(
    result: ForcedResponse, exact: ExactResponse, indices: Int, curve: Float
) -> Bool:
    """Return at which points the orbit belongs to another part of a curve that folds, (p,).

    Orbits begin at the motion that the balance finds at their frequency, which may be another one
    than that of the curve.
    """
    found = np.zeros(indices.size, dtype=np.bool_)
    if not result.arrays.fold.any():
        return found
    omega, whole = result.omega, np.stack([result.amplitude(dof) for dof in exact.dofs], axis=1)
    joined = ~(result.arrays.jump | result.arrays.further)[1:] & (np.diff(omega) != 0.0)
    orbit = 0.5 * (exact.arrays.range[..., 1] - exact.arrays.range[..., 0])
    for place, index in enumerate(indices.tolist()):
        apart = omega - omega[index]
        across = np.flatnonzero(joined & (apart[:-1] * apart[1:] <= 0.0))
        across = across[(across != index) & (across + 1 != index)]
        share = (apart[across] / (apart[across] - apart[across + 1]))[:, np.newaxis]
        others = (1.0 - share) * whole[across] + share * whole[across + 1]
        nearest = np.abs(others - orbit[place]).max(axis=1).min(initial=np.inf)
        found[place] = nearest < _NEARER * np.abs(curve[place] - orbit[place]).max()
    return found


def _require_balance(result: object) -> None:
    if isinstance(result, ExactResponse):
        raise ModelError("result: is exact already; give what forced_response returned")
    if not isinstance(result, ForcedResponse):
        raise ModelError(
            f"result: {brief(result)} is not a ForcedResponse; give what forced_response returned"
        )


def _dofs(result: ForcedResponse, dofs: Iterable[str] | str) -> tuple[str, ...]:
    given = (dofs,) if isinstance(dofs, str) else members(dofs, "dofs", "dofs=[...]")
    names = tuple(dict.fromkeys(given))
    if not names:
        raise ModelError("dofs: empty; name at least one, or leave it out for all")
    for name in names:
        result.error_estimate(name)  # refuses what is unknown
    return names


def _indices(result: ForcedResponse, settings: CertifySettings) -> Int:
    """Return the positions of the points to compare, ascending, each once."""
    solved = np.flatnonzero(result.arrays.solved)
    if not solved.size:
        raise ModelError(f"result: none of the {result.omega.size} points is solved; see status")
    points = settings.points
    if points == "all":
        return solved
    if isinstance(points, int):
        generator = np.random.default_rng(settings.seed)
        return np.sort(generator.choice(solved, min(points, solved.size), replace=False))
    try:
        chosen = np.unique([result.position(index) for index in points])
    except ModelError as error:
        raise ModelError(f"points: {error}") from None
    unsolved = np.setdiff1d(chosen, solved)
    if unsolved.size:
        status = result.status[unsolved[0]]
        raise ModelError(
            f"points: point {unsolved[0]} is not solved ({status}); name solved points"
        )
    return chosen
