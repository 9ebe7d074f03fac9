"""Steady response to periodic forces, by harmonic balance."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from stickslip import _core
from stickslip.analyses.arguments import (
    columns_of,
    driving_dofs,
    highest_harmonic,
    observed_dofs,
    points_of,
    require_forced,
    require_held,
    warn_of_effort,
)
from stickslip.analyses.assumptions import arrays_of, balance_assumptions
from stickslip.analyses.branch_assumptions import branch_assumptions
from stickslip.analyses.doubts import is_unique
from stickslip.analyses.free_flight import with_free_flight
from stickslip.analyses.run import Progress, Run, refusals
from stickslip.memory import require_memory
from stickslip.model import Model
from stickslip.results import ForcedResponse
from stickslip.results.fields import Complex
from stickslip.settings.balance import BalanceKeys, BalanceSettings, ForcedSettings, StabilityKey
from stickslip.settings.settings import configured


@configured(BalanceKeys, "omega", "harmonics")
def forced_response(
    model: Model,
    settings: BalanceKeys,
    *,
    outputs: Iterable[str] | str = (),
    progress: Progress = None,
) -> ForcedResponse:
    """Steady response over excitation frequency, by harmonic balance.

    The relative displacements at the contacts are solved for, on the structure with all contacts
    stuck; everything else follows from them linearly.

    Where contact laws leave open whether a solution is the only one (`Stop`, `Cubic`), a range is
    followed by arclength, around its folds: `omega` of the result may turn back, unstable motions
    are part of it, and the curve ends where it leaves the range. Over given frequencies the sweep
    stays on its branch as long as there is one, and a diagnostic names its jumps.

    With ``residual="bounds"`` the tractions that the past may have left in contacts which stick are
    varied over all that Coulomb allows, at every point: `lower` and `upper` are the least and the
    largest amplitude found, `unique` says whether they differ and `guaranteed` whether theory
    excludes others. It costs some times the curve, more the more degrees of freedom are observed.

    Parameters
    ----------
    outputs : iterable of str, optional
        Without `observe`: degrees of freedom that automatic harmonics, samples and steps follow
        like those with a force or a contact; `error_estimate` says how accurate the others are.
        With it, they follow all that are observed.

    Returns
    -------
    ForcedResponse
        One entry per frequency. Points that failed say so in `status`.

    Raises
    ------
    ModelError
        If the model has a static load that nothing holds.

    References
    ----------
    Guillen (1999), chapter III: the multi-harmonic balance, section 3.4.2: Broyden's method.
    Cameron and Griffin (1989): alternating frequency and time. The receptance form in contact
    displacements, its closed-form tangent and the error estimate are this package's.
    """
    return begun_with(None, model, settings, outputs, progress)


def begun_with(
    start: Complex | None,
    model: Model,
    settings: BalanceKeys,
    outputs: Iterable[str] | str = (),
    progress: Progress = None,
) -> ForcedResponse:
    """Return the forced response whose first point begins with a motion of its contacts.

    It has the displacements (points, H+1) [m] of a model beside this one; where that has more or
    fewer contacts, and of a range, the first point begins without.
    """
    grid, bounded = settings.omega, settings.bounded
    settings = settings.nominal(model)
    span = grid if isinstance(grid, tuple) else None
    own = settings.part(BalanceSettings) | settings.part(StabilityKey)
    kept = ForcedSettings.of(**own, span=span, bounds=bounded)
    dofs = observed_dofs(settings, model)
    driving = driving_dofs(model, dofs, outputs, named=settings.observe is not None)
    asked = grid.size if isinstance(grid, np.ndarray) else None
    if asked is not None:
        orders = settings.fixed_harmonics or highest_harmonic(model)
        require_memory(asked, orders, len(dofs), points_of(model))
    require_forced(model, settings)
    require_held(model, kept.residual)
    warn_of_effort(settings, model, dofs)
    with Run("forced response", progress, model) as run:
        with refusals(model):
            found = _core.forced_response(
                model.problem,
                grid,
                columns_of(dofs, model),
                driving,
                kept,
                run,
                is_unique(model) if bounded else None,
                start,
            )

        def result(look: Progress) -> ForcedResponse:
            solution = found.solution(look)
            arrays = arrays_of(solution, model)
            response = ForcedResponse.of(
                solution,
                model=model,
                settings=kept,
                dofs=dofs,
                arrays=arrays,
                diagnostics=(
                    *balance_assumptions(model, kept, dofs, arrays, solution, asked),
                    *branch_assumptions(model, kept, arrays, solution),
                ),
            )
            return with_free_flight(response)

        return run.found(found, " points" if asked is None else f" of {asked} points", result)
