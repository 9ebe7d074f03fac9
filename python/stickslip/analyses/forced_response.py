"""Steady response to periodic forces, by harmonic balance."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.analyses.arguments import (
    Progress,
    driving_dofs,
    grid_of,
    observed_dofs,
    prepare,
    require_forced,
    require_held,
    require_model,
    require_progress,
)
from stickslip.analyses.assumptions import assumptions_of
from stickslip.analyses.memory import require_memory
from stickslip.errors import ModelError
from stickslip.interruption import Interruption, stopped
from stickslip.model import Model
from stickslip.results import ForcedResponse
from stickslip.results.arrays import Arrays
from stickslip.settings.balance import BalanceSettings, ForcedSettings
from stickslip.settings.entries import Span
from stickslip.settings.settings import configured

if TYPE_CHECKING:
    from stickslip import _core

__all__ = ["forced_response"]


@configured(BalanceSettings, "harmonics")
def forced_response(
    model: Model,
    omega: ArrayLike | Span,
    settings: BalanceSettings,
    *,
    observe: Iterable[str] | str | None = None,
    outputs: Iterable[str] | str = (),
    progress: Progress = None,
) -> ForcedResponse:
    """Steady response over excitation frequency, by harmonic balance.

    The relative displacements at the contacts are solved for, on the structure with all contacts
    stuck; everything else follows from them linearly.

    Parameters
    ----------
    omega : array_like, shape (n,), or (float, float)
        Angular frequencies [rad/s], swept in the order given. A tuple of two numbers is a range
        from the first to the second, upwards or downwards, in which the frequencies are chosen to
        `tolerance`; write ``[one, two]`` or an array for a grid of two.
    observe : iterable of str, optional
        Degrees of freedom whose motion is kept. Default: all but modal coordinates
        ("mode-1", ...). Automatic harmonics, samples and steps follow those that are named, or
        else those with a force or a contact; `error_estimate` says how accurate the others are.
    outputs : iterable of str, optional
        Without `observe`: degrees of freedom that the automatic choices follow as well.

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
    kept = ForcedSettings.of(**dict(settings), span=grid if isinstance(grid, tuple) else None)
    dofs = observed_dofs(observe, model)
    driving = driving_dofs(model, dofs, observe, outputs)
    require_progress(progress)
    if not isinstance(grid, tuple):
        orders = settings.fixed_harmonics or max(
            (force.harmonic for force in model.forces), default=1
        )
        points = sum(contact.points for contact in model.contacts)
        require_memory(grid.size, max(orders, 1), len(dofs), points)
    require_forced(model, settings)
    require_held(model, settings.residual)
    prepare(model)
    with Interruption(progress) as watch:
        solution = _solve(model, grid, dofs, driving, kept, watch)
        result = _result(model, kept, dofs, solution, grid)
        if result.interrupted:
            of_all = f" of {grid.size}" if isinstance(grid, np.ndarray) else ""
            raise stopped("forced response", f"{solution.computed}{of_all} points", result)
        return watch.completed(result, "forced response")


def _solve(
    model: Model,
    grid: NDArray[np.float64] | Span,
    dofs: tuple[str, ...],
    driving: NDArray[np.int64],
    settings: ForcedSettings,
    progress: Progress,
) -> _core.Solution:
    from stickslip import _core

    try:
        return _core.forced_response(
            model.problem,
            grid,
            np.array([model.structure.index(dof) for dof in dofs], dtype=np.int64),
            driving,
            settings,
            progress,
        )
    except ModelError:
        raise
    except ValueError as error:
        raise ModelError(str(error)) from error


def _result(
    model: Model,
    settings: ForcedSettings,
    dofs: tuple[str, ...],
    solution: _core.Solution,
    grid: NDArray[np.float64] | Span,
) -> ForcedResponse:
    arrays = Arrays.of(solution)
    missing = grid.size - solution.computed if isinstance(grid, np.ndarray) else 0
    return ForcedResponse.of(
        solution,
        model=model,
        settings=settings,
        dofs=dofs,
        arrays=arrays,
        diagnostics=assumptions_of(
            model,
            settings,
            dofs,
            arrays,
            half_wave=solution.half_wave,
            missing=missing,
            interrupted=solution.interrupted,
            orbits=solution.counters["orbits"],
        ),
    )
