"""Steady response to periodic forces, by exact periodic orbits."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from stickslip.analyses.arguments import (
    Progress,
    grid_of,
    observed_dofs,
    prepare,
    require_held,
    require_model,
    require_progress,
)
from stickslip.analyses.assumptions import orbit_assumptions
from stickslip.analyses.forced_response import forced_response
from stickslip.analyses.memory import require_memory
from stickslip.disk.wave_ring import Rotation, moving
from stickslip.errors import Interrupted, ModelError
from stickslip.interruption import Interruption, stopped
from stickslip.model import Model
from stickslip.model.model import refusal
from stickslip.results.arrays import Float
from stickslip.results.exact_response import ExactResponse, OrbitArrays
from stickslip.settings.entries import Span
from stickslip.settings.orbits import ExactSettings, OrbitSettings
from stickslip.settings.settings import configured

if TYPE_CHECKING:
    from stickslip import _core

__all__ = ["exact_response"]

# Share of the progress that choosing the frequencies of a range is given.
_CHOOSING = 0.2


@configured(OrbitSettings)
def exact_response(
    model: Model,
    omega: ArrayLike | Span,
    settings: OrbitSettings,
    *,
    observe: Iterable[str] | str | None = None,
    progress: Progress = None,
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
    omega : array_like, shape (n,), or (float, float)
        Angular frequencies [rad/s], in the order given. A tuple of two numbers is a range: its
        frequencies are chosen by an adaptive harmonic balance first.

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
    kept = ExactSettings.of(**dict(settings), span=grid if isinstance(grid, tuple) else None)
    dofs = observed_dofs(observe, model)
    require_progress(progress)
    require_held(model, settings.residual)
    prepare(model)
    with Interruption(progress) as watch:
        share: Progress = watch
        if isinstance(grid, tuple):
            grid = _frequencies(model, kept, dofs, watch)
            share = _later(watch)
        moved = moving(model, half_wave=model.problem.half_wave(settings.residual))
        sectors = 1 if moved[1] is None else moved[1].sectors
        points = sectors * sum(contact.points for contact in model.contacts)
        state = 2 * sectors * len(model.structure) + points
        require_memory(
            grid.size, settings.harmonics, len(dofs), points, extra=3 * state + 2 * len(dofs) + 16
        )
        solution = _solve(model, moved, grid, dofs, kept, share)
        arrays = OrbitArrays.of(solution)
        if moved[1] is not None:
            arrays = arrays.of_sector(points // sectors, sectors)
        result = _result(model, kept, dofs, solution, arrays, grid.size - solution.computed)
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
) -> _core.Solution:
    from stickslip import _core

    try:
        return _core.exact_response(
            moved[0],
            grid,
            np.array([model.structure.index(dof) for dof in dofs], dtype=np.int64),
            settings.harmonics,
            settings,
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
    solution: _core.Solution,
    arrays: OrbitArrays,
    missing: int,
) -> ExactResponse:
    return ExactResponse.of(
        solution,
        model=model,
        settings=settings,
        dofs=dofs,
        arrays=arrays,
        diagnostics=orbit_assumptions(
            model,
            settings,
            dofs,
            arrays,
            half_wave=solution.half_wave,
            missing=missing,
        ),
    )
