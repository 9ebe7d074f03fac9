"""What becomes of free motions from many starts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TypeAlias

import numpy as np

from stickslip.analyses.arguments import columns_of, observed_dofs, state_of
from stickslip.analyses.assumptions import free_assumptions
from stickslip.analyses.classify import fates_of, free
from stickslip.analyses.run import Progress, Run
from stickslip.checks import members, unknown, whole_number
from stickslip.errors import ModelError
from stickslip.memory import require_numbers
from stickslip.model import Model
from stickslip.model.damping import held_stiffness, modes_of
from stickslip.model.state import State
from stickslip.results.basin_map import BasinMap
from stickslip.results.fate_arrays import FateArrays
from stickslip.results.fields import Float
from stickslip.settings.motion import Axis, BasinKeys, BasinSettings, ClassifySettings
from stickslip.settings.settings import configured

Grid: TypeAlias = tuple[tuple[Axis, tuple[float, ...]], ...]


@configured(BasinKeys, "axes")
def basin_map(
    model: Model,
    *,
    settings: BasinKeys,
    starts: Iterable[State | Mapping[str, float]] | None = None,
    progress: Progress = None,
) -> BasinMap:
    """Find out what becomes of free motions from many starts, on all processors.

    Parameters
    ----------
    model : Model
        Structure and contacts; its forces play no part. See `classify`.
    starts : iterable of State or mapping, optional
        Instead of axes: the starts, each as `classify` takes it.

    Returns
    -------
    BasinMap
        The class and mode of every start.

    Raises
    ------
    ModelError
        If the model is a travelling wave, not exactly one of axes and starts is given, or there
        are not two axes.

    References
    ----------
    Guillen (1999), section 5.4.1, which tries eight starts about each orbit.
    """
    alone = free(model)
    dofs = observed_dofs(settings, alone)
    grid: Grid = ()
    if starts is None:
        if settings.axes is None:
            raise ModelError("axes, starts: neither is given; give one of them")
        grid = _axes(alone, settings.axes)
        base = state_of(alone, settings.base or {}, "base")
        states = _over_axes(alone, grid, base)
        given: list[object] = [settings.base] * len(states)
    else:
        for name in ("axes", "base"):
            if getattr(settings, name) is not None:
                raise ModelError(f"{name}: given beside starts; give one of them")
        given = list(members(starts, "starts", "starts=[...]"))
        states = _listed(alone, given)
    kept = BasinSettings.of(**settings.part(ClassifySettings), axes=grid)
    with Run("basin map", progress, alone) as run:
        fates = fates_of(alone, states, kept, settings.threads or 0, run)
        amplitude = fates.columns["amplitude"][:, columns_of(dofs, alone)]
        arrays = FateArrays.of(fates, start=states, amplitude=amplitude)
        result = BasinMap(
            model=alone,
            dofs=dofs,
            settings=kept,
            arrays=arrays,
            interrupted=fates.interrupted,
            timings={"total": fates.seconds},
            counters={"events": int(arrays.events.sum())},
            diagnostics=free_assumptions(model, kept, given),
        )
        done = sum(reason != "interrupted" for reason in result.reason)
        return run.ended(result, f"{done} of {len(result)} starts")


def _axes(model: Model, axes: Mapping[Axis, Sequence[float]]) -> Grid:
    """Return axes that the model has."""
    known = model.structure.dofs
    for axis in axes:
        if isinstance(axis, str) and axis not in known:
            raise ModelError(f"axes: {unknown('dof', axis, known)}")
        if not isinstance(axis, str) and whole_number(axis, "axes: mode") >= len(known):
            raise ModelError(f"axes: mode {axis}; there are {len(known)}, counted from 0")
    return tuple((axis, tuple(values)) for axis, values in axes.items())


def _over_axes(model: Model, axes: Grid, base: State) -> Float:
    (one, first), (other, second) = axes
    size = len(model.structure)
    _require_room(len(first) * len(second), base)
    states = np.tile(base.vector, (len(first), len(second), 1))
    states[..., :size] += np.asarray(first)[:, None, None] * _direction(model, one)
    states[..., :size] += np.asarray(second)[None, :, None] * _direction(model, other)
    return states.reshape(len(first) * len(second), -1)


def _direction(model: Model, axis: Axis) -> Float:
    """Return the displacements per unit along an axis, shape (N,)."""
    structure = model.structure
    if isinstance(axis, str):
        direction: Float = np.eye(len(structure))[structure.index(axis)]
        return direction
    stiffness = held_stiffness(structure.stiffness, structure, model.contacts)
    _, shapes = modes_of(stiffness, structure.mass)
    shape = shapes[:, axis]
    return np.asarray(shape / shape[np.abs(shape).argmax()], dtype=np.float64)


def _listed(model: Model, given: Sequence[object]) -> Float:
    if not given:
        raise ModelError("starts: empty; give at least one")
    states = [state_of(model, one, f"starts[{place}]") for place, one in enumerate(given)]
    _require_room(len(states), states[0])
    return np.stack([state.vector for state in states])


def _require_room(starts: int, one: State) -> None:
    require_numbers(
        starts * (3 * one.vector.size + 10), f"the map of {starts} starts", "give fewer starts"
    )
