"""Limit cycles of structures with negative damping, and their stability."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _core
from stickslip.analyses.arguments import require_lowest, require_onset, require_time
from stickslip.analyses.cycle_assumptions import cycle_assumptions
from stickslip.analyses.run import Progress, Run, refusals
from stickslip.analyses.variation import variation_of
from stickslip.checks import brief, constant
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.model.damping import DampingLaw
from stickslip.model.destabilised import is_proportional, negative_matrix
from stickslip.results.limit_cycles import CycleArrays, LimitCycles
from stickslip.settings.cycles import LOWEST_RATIO, BranchSettings, CycleKeys, CycleSettings
from stickslip.settings.settings import configured

AROUND = 1e3
"""Factor beyond the values of a parameter of contacts within which the branch is followed."""


@configured(CycleKeys)
def limit_cycles(
    model: Model,
    negative_damping: ArrayLike | DampingLaw,
    *,
    settings: CycleKeys,
    progress: Progress = None,
) -> LimitCycles:
    """Limit cycles under the damping C + r C_neg: friction bounds what flutter feeds.

    The branch of a mode begins where its stuck motion just reaches the slip limit of a contact,
    turns where friction dissipates as much as it can, and returns with large amplitudes that slip
    most of the time. It is followed by arclength around every fold and past the corners where a
    contact begins to slip at a further place of the period.

    Parameters
    ----------
    model : Model
        Structure and contacts; its forces are left out. A tuned `BladedDisk` moves in the wave of
        nodal diameter `engine_order`.
    negative_damping : array_like, shape (N, N), or damping law
        C_neg [kg/s], also unsymmetric; or `Rayleigh` or `ModalDamping` with negative numbers. Of
        a tuned disk also complex matrices of shape (n, N, N)
        by nodal diameter, which add i omega r C_neg to the dynamic stiffness.

    Returns
    -------
    LimitCycles
        Along the branch, from its sticking to its slipping side.

    Raises
    ------
    ModelError
        If the mode is not excited or moves no contact that can slip, or there is no limit cycle
        at the ratio.

    References
    ----------
    Guillen (1999), chapter V, there by Broyden's method without condensation and without
    stability. Sinha and Griffin (1983), J. Engng Gas Turb. Power 105, 684: limit cycles of one
    blade.
    """
    negative = NegativeDamping.of(negative_damping, model)
    kept = _settings(model, settings)
    if settings.method == "exact":
        require_time(model)
    require_lowest(model, kept.mode)
    require_onset(model)
    with Run("limit cycles", progress, model) as run:
        found = negative.cycles(model, kept, run)

        def result(look: Progress) -> LimitCycles:
            solution = found.solution(look)
            arrays = CycleArrays.of(solution, negative_damping=negative.matrix)
            return LimitCycles.of(
                solution,
                model=model,
                dofs=model.structure.dofs,
                settings=kept,
                arrays=arrays,
                counters={**solution.counters, "jumps": solution.jumps},
                diagnostics=cycle_assumptions(model, kept, arrays, solution),
            )

        return run.found(found, " points", result)


@dataclass(frozen=True, eq=False)
class NegativeDamping:
    """C_neg, and whether a damping law made it."""

    matrix: NDArray[Any]
    """Shape (N, N); of a tuned disk complex, shape (n, N, N). Read-only."""
    proportional: bool

    @classmethod
    def of(cls, given: ArrayLike | DampingLaw, model: Model) -> Self:
        """Return a negative damping that fits a model."""
        matrix = _matrix(given, model)
        if not matrix.any():
            raise ModelError("negative_damping: all zero; without it nothing excites a limit cycle")
        return cls(constant(matrix), is_proportional(given))

    def cycles(
        self, model: Model, settings: CycleSettings, progress: Progress
    ) -> _core.Found[_core.LimitCycles]:
        """Return what the core makes of checked settings."""
        varied = None if settings.variation is None else settings.variation.varied(model)
        with refusals(model):
            return _core.limit_cycles(
                model.problem, self.matrix, self.proportional, varied, settings, progress
            )


def _matrix(given: ArrayLike | DampingLaw, model: Model) -> NDArray[Any]:
    if not model.travels or isinstance(given, DampingLaw):
        given = negative_matrix(given, model.structure)
    if not model.travels:
        return np.array(given)
    size = len(model.structure)
    sectors = model.sectors  # type: ignore[attr-defined]
    shapes = (size, size), (sectors, size, size)
    try:
        values = np.asarray(given)
    except ValueError:
        raise ModelError("negative_damping: a ragged list; give matrices") from None
    if values.dtype.kind not in "fiuc" or values.shape not in shapes:
        raise ModelError(
            f"negative_damping: {brief(given)}; give numbers of shape {shapes[0]} or {shapes[1]}, "
            "a matrix per nodal diameter"
        )
    if not np.isfinite(values).all():
        raise ModelError("negative_damping: every entry must be finite")
    return np.array(np.broadcast_to(values, shapes[1]), dtype=np.complex128)


def _settings(model: Model, keys: CycleKeys) -> CycleSettings:
    rest = keys.part(BranchSettings)
    name = keys.followed
    given = getattr(keys, name)
    values = tuple(given.tolist()) if isinstance(given, np.ndarray) else None
    if name == "ratio":
        span = (LOWEST_RATIO, inf) if given is None else given
        if values is not None:
            span = (min(LOWEST_RATIO, values[0]), inf)
        return CycleSettings.of(values=values, span=span, **rest)
    # The other side of the branch is reached around a fold that may lie far outside.
    span = given if values is None else (values[0] / AROUND, values[-1] * AROUND)
    ratio = 1.0 if keys.ratio is None else float(np.asarray(keys.ratio)[0])
    variation = variation_of(model, name, keys)
    return CycleSettings.of(variation=variation, ratio=ratio, values=values, span=span, **rest)
