"""Steady response to periodic forces, by harmonic balance."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.analyses.assumptions import assumptions_of
from stickslip.analyses.memory import require_memory
from stickslip.checks import brief, choice, real_number, text, unknown, whole_number
from stickslip.errors import Interrupted, ModelError
from stickslip.model import Model
from stickslip.results import ForcedResponse
from stickslip.results.arrays import Arrays
from stickslip.results.status import Status

if TYPE_CHECKING:
    from stickslip import _core

__all__ = ["METHODS", "RESIDUALS", "Settings", "forced_response"]

METHODS = ("newton",)
"""Solvers of the balance equations."""

RESIDUALS = ("centred", "from_rest")
"""Named assumptions on the mean force of a contact that never slips."""

MAX_HARMONICS = 255
MAX_ITERATIONS = 50

Residual: TypeAlias = Literal["centred", "from_rest"] | float
Span: TypeAlias = tuple[float, float]


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
    method : {"newton"}, optional
        Solver of the balance equations.
    max_harmonics : int, optional
        Highest harmonic that may be kept.
    max_iterations : int, optional
        Iterations per point before it is reported as stalled.
    span : (float, float), optional
        Ends of an adaptive sweep [rad/s]. Default: omega was given point by point.

    Raises
    ------
    ModelError
        If a value is of the wrong type or outside its range.
    """

    harmonics: int | Literal["auto"] = "auto"
    tolerance: float = 1e-3
    residual: Residual = "centred"
    method: str = "newton"
    max_harmonics: int = MAX_HARMONICS
    max_iterations: int = MAX_ITERATIONS
    span: Span | None = None

    def __post_init__(self) -> None:
        limit = whole_number(self.max_harmonics, "max_harmonics", smallest=1)
        iterations = whole_number(self.max_iterations, "max_iterations", smallest=1)
        checked: dict[str, object] = {
            "harmonics": _harmonics(self.harmonics, limit),
            "tolerance": _tolerance(self.tolerance),
            "residual": _residual(self.residual),
            "method": choice(self.method, "method", METHODS),
            "max_harmonics": limit,
            "max_iterations": iterations,
            "span": None if self.span is None else _span(self.span),
        }
        for name, value in checked.items():
            object.__setattr__(self, name, value)

    @property
    def fixed_harmonics(self) -> int | None:
        """The highest harmonic kept; None if it is chosen per point."""
        return None if self.harmonics == "auto" else self.harmonics


def forced_response(
    model: Model,
    omega: ArrayLike | Span,
    harmonics: int | Literal["auto"] = "auto",
    *,
    tolerance: float = 1e-3,
    residual: Residual = "centred",
    method: str = "newton",
    observe: Iterable[str] | str | None = None,
    progress: Callable[[float], None] | None = None,
    max_harmonics: int = MAX_HARMONICS,
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
        Relative accuracy of automatic harmonics and steps, from 1e-8 to 0.5.
    residual : {"centred", "from_rest"} or float, optional
        Force [N] that a contact holds at mid-range of its displacement if it never slips; the
        steady state alone does not determine it. See `ForcedResponse.residual_bounds`.
    method : {"newton"}, optional
        Solver of the balance equations.
    observe : iterable of str, optional
        Degrees of freedom whose motion is kept. Default: all.
    progress : callable, optional
        Called about ten times per second with the fraction of the work that is done.
    max_harmonics : int, optional
        Highest harmonic that may be kept.
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
    Guillen (1999), chapter III: the multi-harmonic balance. Cameron and Griffin (1989): alternating
    frequency and time. The receptance form in contact displacements, its closed-form tangent and
    the error estimate are this package's.
    """
    if not isinstance(model, Model):
        raise ModelError(f"model: {brief(model)} is not a Model; give ss.Model(structure, ...)")
    grid = _grid(omega)
    settings = Settings(
        harmonics=harmonics,
        tolerance=tolerance,
        residual=residual,
        method=method,
        max_harmonics=max_harmonics,
        max_iterations=max_iterations,
        span=grid if isinstance(grid, tuple) else None,
    )
    dofs = _observed(observe, model)
    if progress is not None and not callable(progress):
        raise ModelError(
            f"progress: {brief(progress)} cannot be called; give a function of a fraction"
        )
    if not isinstance(grid, tuple):
        kept = settings.fixed_harmonics or max(
            (force.harmonic for force in model.forces), default=1
        )
        points = sum(contact.points for contact in model.contacts)
        require_memory(grid.size, max(kept, 1), len(dofs), points)
    _require_held(model, settings.residual)
    solution = _solve(model, grid, dofs, settings, progress)
    result = _result(model, settings, dofs, solution)
    if result.interrupted:
        done = sum(status is not Status.NOT_COMPUTED for status in result.status)
        of_all = f" of {grid.size}" if isinstance(grid, np.ndarray) else ""
        raise Interrupted(
            f"forced response interrupted after {done}{of_all} points, which the result of this "
            "exception holds",
            result,
        )
    if progress is not None:
        progress(1.0)
    return result


def _solve(
    model: Model,
    grid: NDArray[np.float64] | Span,
    dofs: tuple[str, ...],
    settings: Settings,
    progress: Callable[[float], None] | None,
) -> _core.Solution:
    from stickslip import _core

    try:
        return _core.forced_response(
            model.problem,
            grid,
            np.array([model.structure.index(dof) for dof in dofs], dtype=np.int64),
            settings.fixed_harmonics,
            settings.tolerance,
            settings.residual,
            settings.method,
            settings.max_harmonics,
            settings.max_iterations,
            progress,
        )
    except ModelError:
        raise
    except ValueError as error:
        raise ModelError(str(error)) from error


def _result(
    model: Model, settings: Settings, dofs: tuple[str, ...], solution: _core.Solution
) -> ForcedResponse:
    arrays = Arrays.of(solution)
    return ForcedResponse(
        model=model,
        settings=settings,
        dofs=dofs,
        arrays=arrays,
        half_wave=solution.half_wave,
        interrupted=solution.interrupted,
        timings=dict(solution.timings),
        counters=dict(solution.counters),
        assumptions=assumptions_of(
            model,
            settings,
            dofs,
            arrays,
            half_wave=solution.half_wave,
            missing=solution.omega.size - arrays.omega.size,
            interrupted=solution.interrupted,
        ),
    )


def _grid(omega: ArrayLike | Span) -> NDArray[np.float64] | Span:
    """Tell a range from a grid, and return either checked."""
    if isinstance(omega, tuple) and len(omega) == 2:
        return _span(omega)
    try:
        values = np.asarray(omega)
    except ValueError:
        raise ModelError("omega: a ragged list; give one list of frequencies in rad/s") from None
    if values.dtype.kind not in "fiu":
        shown = repr(omega) if values.size < 5 else f"an array of {values.dtype}"
        raise ModelError(f"omega: {shown} holds no real numbers; give frequencies in rad/s")
    if values.ndim != 1:
        remedy = f"write [{values:g}]" if values.ndim == 0 else "give one list of frequencies"
        raise ModelError(f"omega: shape {values.shape} instead of (n,); {remedy}")
    if not values.size:
        raise ModelError("omega: empty; give at least one frequency in rad/s")
    grid = np.array(values, dtype=np.float64)
    bad = np.flatnonzero(~(np.isfinite(grid) & (grid > 0.0)))
    if bad.size:
        raise ModelError(
            f"omega[{bad[0]}] is {grid[bad[0]]:g}; give finite frequencies above 0 rad/s"
        )
    return grid


def _span(span: tuple[object, ...]) -> Span:
    if len(span) != 2:
        raise ModelError(f"omega: a range has two ends, not {len(span)}; write (start, end)")
    start, end = (real_number(value, "omega: end of the range") for value in span)
    if not (start > 0.0 and end > 0.0 and start != end):
        raise ModelError(
            f"omega: the range ({start:g}, {end:g}) must have two different ends above 0 rad/s; "
            "write a list for single frequencies"
        )
    return start, end


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


def _tolerance(tolerance: object) -> float:
    value = real_number(tolerance, "tolerance")
    if not 1e-8 <= value <= 0.5:
        raise ModelError(f"tolerance: {value:g}; give a fraction from 1e-8 to 0.5")
    return value


def _residual(residual: object) -> Residual:
    if isinstance(residual, str):
        if residual not in RESIDUALS:
            raise ModelError(f"{unknown('residual', residual, RESIDUALS)}, or a force in N")
        return "centred" if residual == "centred" else "from_rest"
    return real_number(residual, "residual")


def _observed(observe: Iterable[str] | str | None, model: Model) -> tuple[str, ...]:
    known = model.structure.dofs
    if observe is None:
        return known
    if not isinstance(observe, Iterable):
        raise ModelError(f"observe: {brief(observe)} is not a list of names; write [{known[0]!r}]")
    names = (observe,) if isinstance(observe, str) else tuple(observe)
    if not names:
        raise ModelError("observe: no dof; name at least one, or leave it out for all")
    for position, name in enumerate(names):
        text(name, f"observe[{position}]")
        if name not in known:
            raise ModelError(f"observe: {unknown('dof', name, known)}")
        if name in names[:position]:
            raise ModelError(f"observe: {name!r} is given more than once; name each dof once")
    return tuple(map(str, names))


def _require_held(model: Model, residual: Residual) -> None:
    """Refuse a static load that nothing, or only contacts of prescribed mean force, would hold."""
    static = [
        (n, one)
        for n, one in enumerate(model.forces, start=1)
        if not one.harmonic and one.amplitude
    ]
    if not static:
        return
    position, force = static[0]
    entry = f"force {position} at {force.dof!r}: a static load of {force.amplitude:g} N"
    if model.problem.static_singular:
        raise ModelError(
            f"{entry} on a structure that moves freely even with all contacts stuck; ground the "
            "structure or leave the static load out"
        )
    load = np.zeros(len(model.structure))
    for _, force in static:
        load[model.structure.index(force.dof)] += force.amplitude
    prescribed = bool(model.contacts) and residual != "from_rest" and bool(load.any())
    if prescribed and not _holds(model.structure.stiffness, load):
        raise ModelError(
            f"{entry} rests on contacts alone, whose mean force residual={residual!r} prescribes; "
            'use residual="from_rest" or ground the structure'
        )


def _holds(stiffness: NDArray[np.float64], load: NDArray[np.float64]) -> bool:
    """Whether a stiffness matrix has an equilibrium under a load."""
    try:
        displacement = np.linalg.solve(stiffness, load)
    except np.linalg.LinAlgError:
        return False
    # A singular matrix that rounding made regular answers with a displacement of no digits.
    rounding = np.finfo(np.float64).eps * np.linalg.norm(stiffness) * np.linalg.norm(displacement)
    return bool(rounding < 1e-3 * np.linalg.norm(load))
