"""Steady response to periodic forces, by harmonic balance."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.analyses.arguments import (
    RESIDUALS,
    Residual,
    Span,
    driving_dofs,
    grid_of,
    observed_dofs,
    prepare,
    require_forced,
    require_held,
    require_model,
    require_progress,
    residual_of,
    span_of,
    tolerance_of,
)
from stickslip.analyses.assumptions import assumptions_of
from stickslip.analyses.memory import require_memory
from stickslip.checks import choice, whole_number
from stickslip.errors import ModelError
from stickslip.interruption import Interruption, stopped
from stickslip.model import Model
from stickslip.results import ForcedResponse
from stickslip.results.arrays import Arrays

if TYPE_CHECKING:
    from stickslip import _core

__all__ = [
    "EVALUATIONS",
    "JACOBIANS",
    "METHODS",
    "RESIDUALS",
    "Residual",
    "Settings",
    "forced_response",
]

METHODS = ("newton", "broyden")
"""Solvers of the balance equations."""

JACOBIANS = ("exact", "differences")
"""Where Broyden's method takes its first Jacobian from."""

EVALUATIONS = ("exact", "marched")
"""How the friction laws are evaluated."""

MAX_HARMONICS = 255
MAX_SAMPLES = 16384
MAX_ITERATIONS = 100
_FEWEST_SAMPLES, _MOST_SAMPLES = 32, 1 << 20


@dataclass(frozen=True, kw_only=True)
class Settings:
    """How a forced response is computed.

    Parameters
    ----------
    harmonics : int or "auto", optional
        Highest harmonic kept, or "auto": per point, as many as `tolerance` asks for.
    tolerance : float, optional
        Relative accuracy of what is chosen automatically, from 1e-8 to 0.5.
    residual : {"centred", "from_rest"} or float, optional
        Force that a contact holds at mid-range of its displacement if it never slips, where the
        steady state leaves it open: none, what it builds up from zero displacement, or this force
        [N].
    method : {"newton", "broyden"}, optional
        Solver of the balance equations.
    jacobian : {"exact", "differences"}, optional
        First Jacobian of Broyden's method.
    evaluation : {"exact", "marched"}, optional
        Evaluation of the friction laws.
    samples : int or "auto", optional
        Samples per period of the marched evaluation, or "auto": per point, as many as `tolerance`
        asks for.
    max_harmonics : int, optional
        Highest harmonic that may be kept.
    max_samples : int, optional
        Most automatic samples per period, a power of two.
    max_iterations : int, optional
        Iterations per point before it is reported as stalled.
    span : (float, float), optional
        Ends of an adaptive sweep [rad/s]. Default: omega was given point by point.

    Raises
    ------
    ModelError
        If a value is of the wrong type or outside its range.
    """

    methods: ClassVar[tuple[str, ...]] = METHODS

    harmonics: int | Literal["auto"] = "auto"
    tolerance: float = 1e-3
    residual: Residual = "centred"
    method: str = "newton"
    jacobian: str = "exact"
    evaluation: str = "exact"
    samples: int | Literal["auto"] = "auto"
    max_harmonics: int = MAX_HARMONICS
    max_samples: int = MAX_SAMPLES
    max_iterations: int = MAX_ITERATIONS
    span: Span | None = None

    def __post_init__(self) -> None:
        limit = whole_number(self.max_harmonics, "max_harmonics", smallest=1)
        iterations = whole_number(self.max_iterations, "max_iterations", smallest=1)
        harmonics = _harmonics(self.harmonics, limit)
        kept = limit if harmonics == "auto" else harmonics
        checked: dict[str, object] = {
            "harmonics": harmonics,
            "tolerance": tolerance_of(self.tolerance),
            "residual": residual_of(self.residual),
            "method": choice(self.method, "method", self.methods),
            "jacobian": _jacobian(self.jacobian, self.method),
            "evaluation": choice(self.evaluation, "evaluation", EVALUATIONS),
            "samples": _samples(self.samples, self.evaluation, kept),
            "max_harmonics": limit,
            "max_samples": _max_samples(self.max_samples, self.march, kept),
            "max_iterations": iterations,
            "span": None if self.span is None else span_of(self.span),
        }
        for name, value in checked.items():
            object.__setattr__(self, name, value)

    @property
    def fixed_harmonics(self) -> int | None:
        """The highest harmonic kept; None if it is chosen per point."""
        return None if self.harmonics == "auto" else self.harmonics

    @property
    def march(self) -> int | Literal["auto"] | None:
        """Samples per period of a marched evaluation; None if the evaluation is exact."""
        return None if self.evaluation == "exact" else self.samples


def forced_response(
    model: Model,
    omega: ArrayLike | Span,
    harmonics: int | Literal["auto"] = "auto",
    *,
    tolerance: float = 1e-3,
    residual: Residual = "centred",
    method: str = "newton",
    jacobian: str = "exact",
    evaluation: str = "exact",
    samples: int | Literal["auto"] = "auto",
    observe: Iterable[str] | str | None = None,
    outputs: Iterable[str] | str = (),
    progress: Callable[[float], None] | None = None,
    max_harmonics: int = MAX_HARMONICS,
    max_samples: int = MAX_SAMPLES,
    max_iterations: int = MAX_ITERATIONS,
) -> ForcedResponse:
    """Steady response over excitation frequency, by harmonic balance.

    The relative displacements at the contacts are solved for, on the structure with all contacts
    stuck; everything else follows from them linearly.

    Parameters
    ----------
    model : Model
        Structure, contacts and forces.
    omega : array_like, shape (n,), or (float, float)
        Angular frequencies [rad/s], swept in the order given. A tuple of two numbers is a range
        from the first to the second, upwards or downwards, in which the frequencies are chosen to
        `tolerance`; write ``[one, two]`` or an array for a grid of two.
    harmonics : int or "auto", optional
        Highest harmonic kept, or "auto": per point, as many as `tolerance` asks for.
    tolerance : float, optional
        Relative accuracy of automatic harmonics, samples and steps, from 1e-8 to 0.5.
    residual : {"centred", "from_rest"} or float, optional
        Force [N] that a contact holds at mid-range of its displacement if it never slips; the
        steady state alone does not determine it. See `ForcedResponse.residual_bounds`.
    method : {"newton", "broyden"}, optional
        Solver of the balance equations. Broyden's updates one Jacobian per point by rank one; on
        failure both go over to the same homotopy.
    jacobian : {"exact", "differences"}, optional
        First Jacobian of Broyden's method: the exact one, or forward differences.
    evaluation : {"exact", "marched"}, optional
        Friction laws by exact Fourier integrals, or marched through equidistant samples: the
        alternating frequency/time scheme, for comparisons and for laws without a closed form. Its
        sampling error is part of the error estimate.
    samples : int or "auto", optional
        Samples per period of the marched evaluation, even and at least 4 (H + 1), or "auto": per
        point the power of two whose sampling error stays below a quarter of `tolerance`.
    observe : iterable of str, optional
        Degrees of freedom whose motion is kept. Default: all but modal coordinates
        ("mode-1", ...). Automatic harmonics, samples and steps follow those that are named, or
        else those with a force or a contact; `error_estimate` says how accurate the others are.
    outputs : iterable of str, optional
        Without `observe`: degrees of freedom that the automatic choices follow as well.
    progress : callable, optional
        Called about ten times per second with the fraction of the work that is done.
    max_harmonics : int, optional
        Highest harmonic that may be kept.
    max_samples : int, optional
        Most automatic samples per period, a power of two.
    max_iterations : int, optional
        Iterations per point before it is reported as stalled.

    Returns
    -------
    ForcedResponse
        One entry per frequency. Points that failed say so in `status`.

    Raises
    ------
    ModelError
        If an argument is of the wrong type or outside its range, the result would not fit into
        the memory, or the model has a static load that nothing holds.
    Interrupted
        On Ctrl-C; its `result` holds the points that had been computed.

    References
    ----------
    Guillen (1999), chapter III: the multi-harmonic balance, section 3.4.2: Broyden's method.
    Cameron and Griffin (1989): alternating frequency and time. The receptance form in contact
    displacements, its closed-form tangent and the error estimate are this package's.
    """
    require_model(model)
    grid = grid_of(omega)
    settings = Settings(
        harmonics=harmonics,
        tolerance=tolerance,
        residual=residual,
        method=method,
        jacobian=jacobian,
        evaluation=evaluation,
        samples=samples,
        max_harmonics=max_harmonics,
        max_samples=max_samples,
        max_iterations=max_iterations,
        span=grid if isinstance(grid, tuple) else None,
    )
    dofs = observed_dofs(observe, model)
    driving = driving_dofs(model, dofs, observe, outputs)
    require_progress(progress)
    if not isinstance(grid, tuple):
        kept = settings.fixed_harmonics or max(
            (force.harmonic for force in model.forces), default=1
        )
        points = sum(contact.points for contact in model.contacts)
        require_memory(grid.size, max(kept, 1), len(dofs), points)
    fixed = settings.fixed_harmonics
    entry = "max_harmonics" if fixed is None else "harmonics"
    require_forced(model, settings.max_harmonics if fixed is None else fixed, entry)
    require_held(model, settings.residual)
    prepare(model)
    with Interruption(progress) as watch:
        solution = _solve(model, grid, dofs, driving, settings, watch)
        result = _result(model, settings, dofs, solution, grid)
        if result.interrupted:
            of_all = f" of {grid.size}" if isinstance(grid, np.ndarray) else ""
            raise stopped("forced response", f"{solution.computed}{of_all} points", result)
        return watch.completed(result, "forced response")


def _solve(
    model: Model,
    grid: NDArray[np.float64] | Span,
    dofs: tuple[str, ...],
    driving: NDArray[np.int64],
    settings: Settings,
    progress: Callable[[float], None] | None,
) -> _core.Solution:
    from stickslip import _core

    try:
        return _core.forced_response(
            model.problem,
            grid,
            np.array([model.structure.index(dof) for dof in dofs], dtype=np.int64),
            driving,
            settings.fixed_harmonics,
            settings.tolerance,
            settings.residual,
            settings.method,
            settings.jacobian,
            settings.march,
            settings.max_harmonics,
            settings.max_samples,
            settings.max_iterations,
            progress,
        )
    except ModelError:
        raise
    except ValueError as error:
        raise ModelError(str(error)) from error


def _result(
    model: Model,
    settings: Settings,
    dofs: tuple[str, ...],
    solution: _core.Solution,
    grid: NDArray[np.float64] | Span,
) -> ForcedResponse:
    arrays = Arrays.of(solution)
    missing = grid.size - solution.computed if isinstance(grid, np.ndarray) else 0
    return ForcedResponse(
        model=model,
        settings=settings,
        dofs=dofs,
        arrays=arrays,
        half_wave=solution.half_wave,
        interrupted=solution.interrupted,
        timings=dict(solution.timings),
        counters=dict(solution.counters),
        diagnostics=assumptions_of(
            model,
            settings,
            dofs,
            arrays,
            half_wave=solution.half_wave,
            missing=missing,
            interrupted=solution.interrupted,
        ),
    )


def _harmonics(harmonics: object, limit: int) -> int | Literal["auto"]:
    if isinstance(harmonics, str):
        if harmonics != "auto":
            raise ModelError(f'harmonics: {harmonics!r}; give "auto" or an integer from 1')
        return "auto"
    count = whole_number(harmonics, "harmonics", smallest=1)
    if count > limit:
        raise ModelError(
            f"harmonics: {count} lies above max_harmonics = {limit}; lower it, or raise "
            "max_harmonics"
        )
    return count


def _jacobian(jacobian: object, method: str) -> str:
    name = choice(jacobian, "jacobian", JACOBIANS)
    if name != "exact" and method != "broyden":
        raise ModelError(
            f"jacobian: {name!r} is a first Jacobian of Broyden's method; give method='broyden' "
            "with it, or leave it out"
        )
    return name


def _samples(samples: object, evaluation: str, kept: int) -> int | Literal["auto"]:
    if isinstance(samples, str):
        if samples != "auto":
            raise ModelError(f'samples: {samples!r}; give "auto" or an even number')
        return "auto"
    count = whole_number(samples, "samples", smallest=1)
    if evaluation == "exact":
        raise ModelError(
            f"samples: {count} for the exact evaluation, which has none; give evaluation='marched' "
            "with them, or leave them out"
        )
    least = 4 * (kept + 1)
    if count < least or count % 2:
        raise ModelError(
            f"samples: {count} for harmonics up to {kept}; give an even number from {least}"
        )
    return count


def _max_samples(most: object, march: int | Literal["auto"] | None, kept: int) -> int:
    count = whole_number(most, "max_samples", smallest=_FEWEST_SAMPLES, largest=_MOST_SAMPLES)
    if count & (count - 1):
        raise ModelError(f"max_samples: {count} is not a power of two; give one, such as 4096")
    least = 4 * (kept + 1)
    if march == "auto" and count < least:
        raise ModelError(
            f"max_samples: {count} for harmonics up to {kept}; give a power of two from {least}, "
            "or keep fewer harmonics"
        )
    return count
