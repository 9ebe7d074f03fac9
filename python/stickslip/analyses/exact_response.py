"""Steady response to periodic forces, by exact periodic orbits."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from stickslip.analyses.arguments import (
    Progress,
    Residual,
    Span,
    grid_of,
    observed_dofs,
    prepare,
    require_held,
    require_model,
    require_progress,
)
from stickslip.analyses.assumptions import orbit_assumptions
from stickslip.analyses.forced_response import (
    MAX_HARMONICS,
    MAX_ITERATIONS,
    Settings,
    forced_response,
)
from stickslip.analyses.memory import require_memory
from stickslip.checks import whole_number
from stickslip.disk.wave_ring import Rotation, moving
from stickslip.errors import Interrupted, ModelError
from stickslip.interruption import Interruption, stopped
from stickslip.model import Model
from stickslip.model.model import refusal
from stickslip.results.arrays import Float
from stickslip.results.exact_response import ExactResponse
from stickslip.results.orbit_arrays import OrbitArrays

if TYPE_CHECKING:
    from stickslip import _core

__all__ = ["REPORTED_HARMONICS", "ExactSettings", "exact_response"]

REPORTED_HARMONICS = 32
"""Highest harmonic reported unless another is asked for; the orbits do not depend on it."""

# Share of the progress that choosing the frequencies of a range is given.
_CHOOSING = 0.2


@dataclass(frozen=True, kw_only=True)
class ExactSettings(Settings):
    """How exact orbits are computed.

    Parameters
    ----------
    harmonics : int, optional
        Highest harmonic reported.
    tolerance : float, optional
        Relative accuracy to which the frequencies of a range are chosen.
    residual : {"centred", "from_rest"} or float, optional
        As in `Settings`.
    max_iterations : int, optional
        Iterations of shooting per point.
    span : (float, float), optional
        Ends of the range of frequencies [rad/s].

    Raises
    ------
    ModelError
        If a value is of the wrong type or outside its range.
    """

    methods: ClassVar[tuple[str, ...]] = ("exact",)

    harmonics: int | Literal["auto"] = REPORTED_HARMONICS
    method: str = "exact"

    def __post_init__(self) -> None:
        whole_number(self.harmonics, "harmonics", smallest=1, largest=MAX_HARMONICS)
        super().__post_init__()


def exact_response(
    model: Model,
    omega: ArrayLike | Span,
    *,
    harmonics: int = REPORTED_HARMONICS,
    tolerance: float = 1e-3,
    residual: Residual = "centred",
    observe: Iterable[str] | str | None = None,
    progress: Progress = None,
    max_iterations: int = MAX_ITERATIONS,
) -> ExactResponse:
    """Steady response over excitation frequency, by exact periodic orbits.

    Between two changes of stick and slip the structure is linear: the motion is a power series
    exact to rounding, and the instants of change are zeros of polynomials. The state that returns
    after a period is found by shooting with the analytic derivative of the flow. There is no
    truncation and nothing to choose.

    Of a tuned `BladedDisk` the orbit is that of all sectors that its travelling wave tells apart,
    sought on the part of a period after which they have changed their roles; the result shows
    sector 0, and others by `sector`. What breaks the symmetry of the wave is not followed: its
    multipliers are not-a-number, and its stability is not decided. `disk.mistuned(0)` has them.

    Parameters
    ----------
    model : Model
        Structure, contacts and forces.
    omega : array_like, shape (n,), or (float, float)
        Angular frequencies [rad/s], in the order given. A tuple of two numbers is a range: its
        frequencies are chosen by an adaptive harmonic balance first.
    harmonics : int, optional
        How many harmonics of each orbit are reported; the orbits do not depend on it.
    tolerance : float, optional
        Relative accuracy to which the frequencies of a range are chosen, from 1e-8 to 0.5.
    residual : {"centred", "from_rest"} or float, optional
        Force [N] that a contact holds at mid-range of its displacement if it never slips; the
        steady state alone does not determine it. See `ForcedResponse.residual_bounds`.
    observe : iterable of str, optional
        Degrees of freedom whose motion is kept. Default: all but modal coordinates
        ("mode-1", ...).
    progress : callable, optional
        Called about ten times per second with the fraction of the work that is done.
    max_iterations : int, optional
        Iterations of shooting per point before it is reported as stalled.

    Returns
    -------
    ExactResponse
        A `ForcedResponse` with events and Floquet multipliers. Points that failed say so in
        `status`.

    Raises
    ------
    ModelError
        If an argument is of the wrong type or outside its range, the result would not fit into
        the memory, or the model has a static load that nothing holds.
    Interrupted
        On Ctrl-C; its `result` holds the points that had been computed. While the frequencies of a
        range are chosen that is the harmonic balance.

    References
    ----------
    Guillen (1999), section 4.2, integrates the same motion step by step. For shooting with jumps
    see R. I. Leine, H. Nijmeijer, "Dynamics and Bifurcations of Non-Smooth Mechanical Systems"
    (Springer, 2004).
    """
    require_model(model)
    grid = grid_of(omega)
    settings = ExactSettings(
        harmonics=harmonics,
        tolerance=tolerance,
        residual=residual,
        max_iterations=max_iterations,
        span=grid if isinstance(grid, tuple) else None,
    )
    dofs = observed_dofs(observe, model)
    require_progress(progress)
    require_held(model, settings.residual)
    prepare(model)
    with Interruption(progress) as watch:
        share: Progress = watch
        if isinstance(grid, tuple):
            grid = _frequencies(model, settings, dofs, watch)
            share = _later(watch)
        orders = settings.fixed_harmonics or REPORTED_HARMONICS
        moved = moving(model, half_wave=model.problem.half_wave(settings.residual))
        sectors = 1 if moved[1] is None else moved[1].sectors
        points = sectors * sum(contact.points for contact in model.contacts)
        state = 2 * sectors * len(model.structure) + points
        require_memory(grid.size, orders, len(dofs), points, extra=3 * state + 2 * len(dofs) + 16)
        solution = _solve(model, moved, grid, dofs, settings, share)
        arrays = OrbitArrays.of_orbits(solution)
        if moved[1] is not None:
            arrays = arrays.of_sector(points // sectors, sectors)
        result = _result(model, settings, dofs, solution, arrays, grid.size - solution.computed)
        if result.interrupted:
            raise stopped("exact response", f"{solution.computed} of {grid.size} points", result)
        return watch.completed(result, "exact response")


def _frequencies(
    model: Model, settings: ExactSettings, dofs: tuple[str, ...], watch: Interruption
) -> Float:
    """Return the frequencies that an adaptive harmonic balance chooses in a range."""
    assert settings.span is not None
    try:
        return forced_response(
            model,
            settings.span,
            tolerance=settings.tolerance,
            residual=settings.residual,
            observe=dofs,
            progress=lambda share: watch(_CHOOSING * share),
        ).omega
    except Interrupted as stop:
        raise Interrupted(
            "exact response interrupted while its frequencies were chosen; the result of this "
            "exception holds the harmonic balance so far",
            stop.result,
        ) from None


def _later(watch: Interruption) -> Progress:
    return lambda share: watch(_CHOOSING + (1.0 - _CHOOSING) * share)


def _solve(
    model: Model,
    moved: tuple[_core.Problem, Rotation | None],
    grid: Float,
    dofs: tuple[str, ...],
    settings: ExactSettings,
    progress: Progress,
) -> _core.Orbits:
    from stickslip import _core

    try:
        return _core.exact_response(
            moved[0],
            grid,
            np.array([model.structure.index(dof) for dof in dofs], dtype=np.int64),
            settings.fixed_harmonics or REPORTED_HARMONICS,
            settings.residual,
            settings.max_iterations,
            progress,
            moved[1],
        )
    except ModelError:
        raise
    except ValueError as error:
        raise refusal(error, model) from error


def _result(
    model: Model,
    settings: ExactSettings,
    dofs: tuple[str, ...],
    solution: _core.Orbits,
    arrays: OrbitArrays,
    missing: int,
) -> ExactResponse:
    return ExactResponse(
        model=model,
        settings=settings,
        dofs=dofs,
        arrays=arrays,
        half_wave=solution.half_wave,
        interrupted=solution.interrupted,
        timings=dict(solution.timings),
        counters=dict(solution.counters),
        diagnostics=orbit_assumptions(
            model,
            settings,
            dofs,
            arrays,
            half_wave=solution.half_wave,
            missing=missing,
        ),
    )
