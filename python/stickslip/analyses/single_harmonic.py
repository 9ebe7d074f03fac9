"""Steady response to harmonic forces, by a single harmonic."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from stickslip.analyses.arguments import (
    Progress,
    grid_of,
    observed_dofs,
    prepare,
    require_model,
    require_progress,
)
from stickslip.analyses.assumptions import assumptions_of
from stickslip.analyses.memory import require_memory
from stickslip.checks import brief
from stickslip.errors import ModelError
from stickslip.interruption import Interruption, stopped
from stickslip.model import Model
from stickslip.results import ForcedResponse
from stickslip.results.arrays import Arrays
from stickslip.results.diagnostic import diagnostic
from stickslip.results.status import Status
from stickslip.settings.balance import ForcedSettings
from stickslip.settings.orbits import SingleHarmonicSettings
from stickslip.settings.settings import configured

__all__ = ["single_harmonic"]

_METHOD = (
    "The motion was taken to be harmonic, and of every contact force its first harmonic: Griffin's "
    "method with complex amplitudes."
)
_NO_ESTIMATE = (
    "The error of leaving the higher harmonics out was not estimated; estimate=True does it."
)


@configured(SingleHarmonicSettings)
def single_harmonic(
    model: Model,
    omega: ArrayLike,
    settings: SingleHarmonicSettings,
    *,
    observe: Iterable[str] | str | None = None,
    progress: Progress = None,
) -> ForcedResponse:
    """Steady response over excitation frequency, by a single harmonic.

    Every contact is replaced by its describing function, the complex stiffness that its amplitude
    gives it, and the complex amplitudes are solved for by Newton's method with its closed-form
    Jacobian. The equations are those of `forced_response` with `harmonics=1`, at a fraction of its
    time. `ForcedResponse.damper_displacement` follows the friction law through a period and gives
    the corners that one harmonic lacks.

    Parameters
    ----------
    model : Model
        Structure, contacts to ground or between degrees of freedom, any number of them, and forces
        of harmonic 1.
    omega : array_like, shape (n,)
        Angular frequencies [rad/s], swept in the order given.

    Returns
    -------
    ForcedResponse
        One entry per frequency, with one harmonic. Its settings are those of the balance of one
        harmonic, which refines its peaks.

    Raises
    ------
    ModelError
        If an argument is of the wrong type or outside its range, a force has another harmonic than
        the first, or the result would not fit into the memory.
    Interrupted
        On Ctrl-C; its `result` holds the points that had been computed.

    References
    ----------
    Griffin (1980); Guillen (1999), chapter II, with the sign of eq. (2.13) corrected and the phases
    between several dampers kept, which eqs. (2.40)-(2.43) drop.
    """
    require_model(model)
    grid = grid_of(omega)
    if isinstance(grid, tuple):
        reason = (
            f"omega: {brief(omega)} is a range, which a single harmonic cannot choose steps in; "
            "give a grid, as"
        )
        raise ModelError(
            f"{reason} np.linspace(start, end, 400)",
            study=f"{reason} {{from = ..., to = ..., points = 400}}",
        )
    kept = ForcedSettings.of(harmonics=1, max_iterations=settings.max_iterations)
    dofs = observed_dofs(observe, model)
    require_progress(progress)
    for position, force in enumerate(model.forces, start=1):
        if force.harmonic != 1 and force.amplitude:
            reason = (
                f"force {position} at {force.dof!r}: harmonic {force.harmonic}; a single harmonic "
                "takes forces of harmonic 1 alone"
            )
            raise ModelError(
                f"{reason}, use forced_response", study=f'{reason}, use kind = "forced-response"'
            )
    require_memory(grid.size, 1, len(dofs), sum(contact.points for contact in model.contacts))
    prepare(model)
    with Interruption(progress) as watch:
        result = _solve(model, grid, dofs, kept, settings, watch)
        if result.interrupted:
            done = int((result.arrays.status != Status.NOT_COMPUTED.code).sum())
            raise stopped("single-harmonic response", f"{done} of {grid.size} points", result)
        return watch.completed(result, "single-harmonic response")


def _solve(
    model: Model,
    grid: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
    dofs: tuple[str, ...],
    kept: ForcedSettings,
    settings: SingleHarmonicSettings,
    progress: Progress,
) -> ForcedResponse:
    from stickslip import _core

    try:
        solution = _core.single_harmonic(
            model.problem,
            grid,
            np.array([model.structure.index(dof) for dof in dofs], dtype=np.int64),
            settings,
            progress,
        )
    except ModelError:
        raise
    except ValueError as error:
        raise ModelError(str(error)) from error
    arrays = Arrays.of(solution)
    told = assumptions_of(
        model,
        kept,
        dofs,
        arrays,
        half_wave=solution.half_wave,
        missing=grid.size - solution.computed,
        interrupted=solution.interrupted,
        single=True,
    )
    return ForcedResponse.of(
        solution,
        model=model,
        settings=kept,
        dofs=dofs,
        arrays=arrays,
        diagnostics=(
            diagnostic("method", _METHOD),
            *told,
            *(() if settings.estimate else (diagnostic("no-error-estimate", _NO_ESTIMATE),)),
        ),
    )
