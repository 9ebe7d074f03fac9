"""What becomes of free motions from many starts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from stickslip.analyses.arguments import columns_of, observed_dofs, real_list, state_of
from stickslip.analyses.classify import fate_assumptions, fates_of, free
from stickslip.analyses.memory import require_numbers
from stickslip.analyses.run import Progress, Run
from stickslip.checks import brief, members, unknown, whole_number
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.model.state import State
from stickslip.results.arrays import Float
from stickslip.results.basin_map import BasinMap
from stickslip.results.fate_arrays import FateArrays
from stickslip.settings.motion import Axis, BasinKeys, BasinSettings, ClassifySettings
from stickslip.settings.settings import configured

__all__ = ["basin_map"]


@configured(BasinKeys)
def basin_map(
    model: Model,
    axes: Mapping[Axis, ArrayLike] | None = None,
    *,
    settings: BasinKeys,
    starts: Iterable[State | Mapping[str, float]] | None = None,
    base: State | Mapping[str, float] | None = None,
    observe: Iterable[str] | str | None = None,
    progress: Progress = None,
) -> BasinMap:
    """Find out what becomes of free motions from many starts, on all processors.

    Parameters
    ----------
    model : Model
        Structure and contacts; its forces play no part. See `classify`.
    axes : mapping of str or int to array_like, optional
        Two axes of a map with their values [m], the first drawn upwards, the second to the right:
        the displacement of a degree of freedom by its name, or the amplitude of a stuck mode by its
        number, counted from 0; a mode of amplitude a moves its largest displacement by a.
    starts : iterable of State or mapping, optional
        Instead of axes: the starts, each as `classify` takes it.
    base : State or mapping, optional
        What the axes are added to. Default: rest.

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
    dofs = observed_dofs(observe, alone)
    if (axes is None) == (starts is None):
        given = "neither is" if axes is None else "both are"
        raise ModelError(f"axes, starts: {given} given; give one of them")
    grid = () if axes is None else _axes(alone, axes)
    kept = BasinSettings.of(**settings.part(ClassifySettings), axes=grid)
    if starts is None:
        states = _over_axes(alone, grid, state_of(alone, {} if base is None else base, "base"))
    else:
        if base is not None:
            raise ModelError("base: given beside starts; put it into them")
        states = _listed(alone, starts)
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
            diagnostics=fate_assumptions(model, kept),
        )
        done = sum(reason != "interrupted" for reason in result.reason)
        return run.ended(result, f"{done} of {len(result)} starts")


def _axes(model: Model, axes: object) -> tuple[tuple[Axis, tuple[float, ...]], ...]:
    if not isinstance(axes, Mapping) or len(axes) != 2:
        shown = f"{len(axes)} axes" if isinstance(axes, Mapping) else brief(axes)
        raise ModelError(f'axes: {shown}; give two, {{"tip": [...], "damper": [...]}}')
    known = model.structure.dofs
    checked = []
    for axis, values in axes.items():
        if isinstance(axis, str) and axis not in known:
            raise ModelError(f"axes: {unknown('dof', axis, known)}")
        if not isinstance(axis, str) and whole_number(axis, "axes: mode") >= len(known):
            raise ModelError(f"axes: mode {axis}; there are {len(known)}, counted from 0")
        numbers = real_list(values, f"axes: {axis!r}", "finite numbers in m")
        checked.append((axis, tuple(map(float, numbers))))
    return tuple(checked)


def _over_axes(
    model: Model, axes: tuple[tuple[Axis, tuple[float, ...]], ...], base: State
) -> Float:
    (one, first), (other, second) = axes
    size = len(model.structure)
    _require_room(len(first) * len(second), base)
    states = np.tile(base.vector, (len(first), len(second), 1))
    states[..., :size] += np.asarray(first)[:, None, None] * _direction(model, one)
    states[..., :size] += np.asarray(second)[None, :, None] * _direction(model, other)
    return states.reshape(len(first) * len(second), -1)


def _direction(model: Model, axis: Axis) -> Float:
    """Return the displacements per unit along an axis, shape (N,)."""
    from scipy.linalg import eigh

    from stickslip.model.damping import held_stiffness

    structure = model.structure
    if isinstance(axis, str):
        direction: Float = np.eye(len(structure))[structure.index(axis)]
        return direction
    stiffness = held_stiffness(structure, model.contacts)
    _, shapes = eigh(stiffness, structure.mass)
    shape = shapes[:, axis]
    return np.asarray(shape / shape[np.abs(shape).argmax()], dtype=np.float64)


def _listed(model: Model, starts: Iterable[State | Mapping[str, float]]) -> Float:
    given: Sequence[object] = members(starts, "starts", "starts=[...]")
    if not given:
        raise ModelError("starts: empty; give at least one")
    states = [state_of(model, one, f"starts[{place}]") for place, one in enumerate(given)]
    _require_room(len(states), states[0])
    return np.stack([state.vector for state in states])


def _require_room(starts: int, one: State) -> None:
    require_numbers(
        starts * (3 * one.vector.size + 10), f"the map of {starts} starts", "give fewer starts"
    )
