"""The exact orbits that a harmonic balance is compared with, of models and of travelling waves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from stickslip.analyses.arguments import Progress, require_held
from stickslip.analyses.memory import require_memory
from stickslip.disk.wave_ring import moving
from stickslip.errors import ModelError
from stickslip.model.model import refusal
from stickslip.results import ForcedResponse
from stickslip.results.arrays import Float
from stickslip.results.exact_response import OrbitArrays
from stickslip.settings.orbits import OrbitSettings

if TYPE_CHECKING:
    from stickslip import _core

__all__ = ["Orbits", "orbits_of"]


@dataclass(frozen=True)
class Orbits:
    """Exact orbits at some frequencies; of a wave, those of sector 0 among the others."""

    dofs: tuple[str, ...]
    arrays: OrbitArrays
    interrupted: bool
    problem: _core.Problem
    columns: tuple[int, ...]

    def waveforms(self, place: int, samples: int) -> Float:
        """Return one period of all displacements, shape (samples, d)."""
        from stickslip import _core

        if not self.arrays.solved[place]:
            return np.full((samples, len(self.dofs)), np.nan)
        try:
            motion: Float = _core.orbit_history(
                self.problem,
                float(self.arrays.omega[place]),
                self.arrays.state[place],
                np.array(self.columns, dtype=np.int64),
                samples,
            )[0]
        except ValueError as error:
            raise ModelError(str(error)) from error
        return motion


def orbits_of(
    result: ForcedResponse, omega: Float, dofs: tuple[str, ...], progress: Progress
) -> Orbits:
    """Return the exact orbits of the model of a harmonic balance.

    Parameters
    ----------
    result : ForcedResponse
        The harmonic balance.
    omega : ndarray of float64, shape (n,)
        Frequencies [rad/s].
    dofs : tuple of str
        Degrees of freedom of the model to observe.
    progress : callable or None
        Called with the fraction of the work that is done.

    Returns
    -------
    Orbits
        Those that were found before an interruption.

    Raises
    ------
    ModelError
        If the orbits would not fit into the memory, or the model has a static load that nothing
        holds.
    """
    from stickslip import _core

    model = result.model
    require_held(model, result.settings.residual)
    problem, rotation = moving(model, half_wave=result.half_wave)
    sectors = 1 if rotation is None else rotation.sectors
    points = sectors * sum(contact.points for contact in model.contacts)
    state = 2 * sectors * len(model.structure) + points
    require_memory(omega.size, 1, len(dofs), points, extra=3 * omega.size * state)
    columns = tuple(model.structure.index(dof) for dof in dofs)
    try:
        solution = _core.exact_response(
            problem,
            omega,
            np.array(columns, dtype=np.int64),
            1,
            OrbitSettings(residual=result.settings.residual),
            progress,
            rotation,
        )
    except ModelError:
        raise
    except ValueError as error:
        raise refusal(error, model) from error
    return Orbits(dofs, OrbitArrays.of(solution), solution.interrupted, problem, columns)
