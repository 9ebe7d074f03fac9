"""Steady response to harmonic forces, by a single harmonic."""

from __future__ import annotations

import numpy as np

from stickslip import _core
from stickslip.analyses.arguments import columns_of, observed_dofs, points_of
from stickslip.analyses.assumptions import arrays_of, balance_assumptions
from stickslip.analyses.run import Progress, Run, refusals
from stickslip.analyses.texts import told
from stickslip.errors import ModelError
from stickslip.memory import require_memory
from stickslip.model import Model
from stickslip.results import ForcedResponse
from stickslip.settings.balance import ForcedSettings
from stickslip.settings.orbits import SingleHarmonicKeys
from stickslip.settings.settings import configured


@configured(SingleHarmonicKeys, "omega")
def single_harmonic(
    model: Model, settings: SingleHarmonicKeys, *, progress: Progress = None
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

    Returns
    -------
    ForcedResponse
        One entry per frequency, with one harmonic. Its settings are those of the balance of one
        harmonic, which refines its peaks.

    Raises
    ------
    ModelError
        If a force has another harmonic than the first.

    References
    ----------
    Griffin (1980); Guillen (1999), chapter II, with the sign of eq. (2.13) corrected and the phases
    between several dampers kept, which eqs. (2.40)-(2.43) drop.
    """
    grid = np.asarray(settings.omega)
    kept = ForcedSettings.of(harmonics=1, max_iterations=settings.max_iterations)
    dofs = observed_dofs(settings, model)
    for position, force in enumerate(model.forces, start=1):
        if force.harmonic != 1 and force.amplitude:
            reason = (
                f"force {position} at {force.dof!r}: harmonic {force.harmonic}; a single harmonic "
                "takes forces of harmonic 1 alone"
            )
            raise ModelError(
                f"{reason}, use forced_response", study=f'{reason}, use kind = "forced-response"'
            )
    require_memory(grid.size, 1, len(dofs), points_of(model))
    with Run("single-harmonic response", progress, model) as run:
        with refusals(model):
            found = _core.single_harmonic(
                model.problem, grid, columns_of(dofs, model), settings, run
            )

        def result(look: Progress) -> ForcedResponse:
            solution = found.solution(look)
            arrays = arrays_of(solution, model)
            diagnostics = balance_assumptions(
                model, kept, dofs, arrays, solution, grid.size, single=True
            )
            if not settings.estimate:
                diagnostics = (*diagnostics, told("no-error-estimate"))
            return ForcedResponse.of(
                solution,
                model=model,
                settings=kept,
                dofs=dofs,
                arrays=arrays,
                diagnostics=diagnostics,
            )

        return run.found(found, f" of {grid.size} points", result)
