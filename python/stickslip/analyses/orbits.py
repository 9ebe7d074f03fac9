"""Exact orbits at given frequencies, of models and of travelling waves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stickslip import _core
from stickslip.analyses.arguments import columns_of, points_of
from stickslip.analyses.memory import require_memory
from stickslip.analyses.run import Progress, refusals
from stickslip.disk.wave_ring import moving
from stickslip.model import Model
from stickslip.results.arrays import Float
from stickslip.results.orbit_arrays import OrbitArrays
from stickslip.settings.orbits import OrbitSettings

__all__ = ["Orbits", "orbits_of"]


@dataclass(frozen=True)
class Orbits:
    """Exact orbits at some frequencies; of a wave, those of sector 0 among the others."""

    model: Model
    dofs: tuple[str, ...]
    arrays: OrbitArrays
    solution: _core.Solution
    problem: _core.Problem
    sectors: int | None
    """Those that a travelling wave tells apart."""

    def waveforms(self, place: int, samples: int) -> Float:
        """Return one period of all displacements, shape (samples, d)."""
        if not self.arrays.solved[place]:
            return np.full((samples, len(self.dofs)), np.nan)
        omega, state = float(self.arrays.omega[place]), self.arrays.state[place]
        columns = columns_of(self.dofs, self.model)
        with refusals(self.model):
            motion, *_ = _core.orbit_history(self.problem, omega, state, columns, samples)
        return motion


def orbits_of(
    model: Model,
    omega: Float,
    dofs: tuple[str, ...],
    settings: OrbitSettings,
    progress: Progress,
    *,
    half_wave: bool,
) -> Orbits:
    """Return the exact orbits that are found before an interruption."""
    problem, rotation = moving(model, half_wave=half_wave)
    sectors = 1 if rotation is None else rotation.sectors
    points = sectors * points_of(model)
    state = 2 * sectors * len(model.structure) + points
    further = 3 * state + 2 * len(dofs) + 16
    require_memory(omega.size, settings.harmonics, len(dofs), points, extra=further)
    columns = columns_of(dofs, model)
    with refusals(model):
        solution = _core.exact_response(
            problem, omega, columns, settings.harmonics, settings, progress, rotation
        )
    found = None if rotation is None else sectors
    return Orbits(model, dofs, OrbitArrays.of(solution), solution, problem, found)
