"""Peaks over two parameters of a design, and structures that change with the speed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from inspect import signature

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _core
from stickslip.analyses.run import Progress, Run, refusals
from stickslip.analyses.side_by_side import processors
from stickslip.checks import (
    brief,
    members,
    real_matrix,
    real_number,
    set_fields,
    text,
    whole_number,
)
from stickslip.errors import ModelError
from stickslip.interruption import stopped
from stickslip.model import Model, Structure
from stickslip.results.damper_curve import DesignMap
from stickslip.results.status import Status
from stickslip.settings.peaks import PeakSettings
from stickslip.units import physical_number

_MOST_POINTS = 1_000_000
"""Frequencies of a coarse grid that nobody needs."""


def design_map(
    build: Callable[..., Model],
    parameters: Mapping[str, ArrayLike],
    *,
    dof: str,
    omega: tuple[float, float],
    points: int = 24,
    tolerance: float = 1e-2,
    max_harmonics: int = 127,
    threads: int | None = None,
    progress: Progress = None,
) -> DesignMap:
    """Find the peak of a response for all pairs of values of two parameters of a design.

    Unlike with `damper_curve` whatever `build` makes may vary: mass, angle, speed, geometry. Where
    the motion of a model is unique its peak is found as that of a damper curve. Where contacts open
    or laws are not monotone for other reasons, resonances are located on a coarse grid with seven
    harmonics; the highest ones are then solved on ever narrower grids with twice the harmonics
    each, until the peak stays the same within a quarter of the tolerance, and its error estimate is
    below half of it. Where the response jumps on the way the peak is found as that of a damper
    curve, too.

    Parameters
    ----------
    build : callable
        Makes the model of the two values, which it takes by their names.
    parameters : mapping of str to array_like
        The values of the two parameters. One that has a single value stays: the map is a curve.
    dof : str
        The degree of freedom whose peak is sought.
    omega : (float, float)
        Range of frequencies in which the peak is the highest point [rad/s].
    points : int, optional
        Frequencies of the coarse grid, where there is one. A resonance much narrower than their
        distance may be missed then.
    tolerance : float, optional
        Accuracy of the peaks, relative to them.
    max_harmonics : int, optional
        Harmonics at which a peak is given up: it counts as not found.
    threads : int, optional
        Threads. Default: as many as there are processors.
    progress : callable, optional
        Called with the share of the cells that are done, 0 to 1.

    Returns
    -------
    DesignMap
        Amplitude and frequency of every peak; nan where none was found, and `status` says why:
        "singular" where neither damping nor friction bounds the response.

    Raises
    ------
    ModelError
        If there are not two parameters with values, or a value makes no model.
    Interrupted
        At Ctrl-C, with the cells that are done in `result`.
    """
    names, values = _two(parameters)
    _require_callable(build, names)
    points = whole_number(points, "points", smallest=3, largest=_MOST_POINTS)
    if threads is not None:
        threads = whole_number(threads, "threads", smallest=1)
    ends = members(omega, "omega", "(95.0, 120.0)")
    numbers = sorted(physical_number(one, "rad/s", "omega") for one in ends)
    if len(numbers) != 2 or not 0.0 < numbers[0] < numbers[1]:
        raise ModelError(f"omega: {brief(omega)}; give 0 < from < to")
    span = np.linspace(numbers[0], numbers[1], points)
    cells = [(one, other) for one in values[0] for other in values[1]]
    models = []
    for cell in cells:
        model = build(**dict(zip(names, cell, strict=True)))
        if not isinstance(model, Model):
            raise ModelError(f"build: {brief(model)} is no Model; return one")
        models.append(model)
    settings = PeakSettings.of(tolerance=tolerance, max_harmonics=max_harmonics)
    problems = [
        (model.problem, settings.suited(model), model.structure.index(dof)) for model in models
    ]
    with Run("design map", progress) as run:
        with refusals(*models):
            found = np.array(_core.peak_map(problems, span, threads or processors(), run))
        shape = tuple(map(len, values))
        columns = [column.reshape(shape) for column in found.T]
        harmonics, status = (column.astype(np.int64) for column in columns[2:])
        own = DesignMap(names, values, dof, columns[0], columns[1], harmonics, status)
        set_fields(own, **vars(own))
        if own.interrupted:
            done = int((own.codes != Status.NOT_COMPUTED.code).sum())
            raise stopped("design map", f"{done} of {len(cells)} cells", own)
        return run.completed(own, "design map")


def _two(parameters: object) -> tuple[tuple[str, str], tuple[NDArray[np.float64], ...]]:
    if not isinstance(parameters, Mapping) or len(parameters) != 2:
        raise ModelError(
            f'parameters: {brief(parameters)}; give two, {{"mass": [...], "angle": [...]}}, one '
            "value for a parameter that stays"
        )
    first, second = (text(name, "parameters") for name in parameters)
    found = tuple(
        np.array([real_number(one, name) for one in members(values, name, "[0.05, 0.1]")])
        for name, values in parameters.items()
    )
    for name, values in zip((first, second), found, strict=True):
        if not values.size:
            raise ModelError(f"parameters: {name!r} has no values; give at least one")
    return (first, second), found


def _require_callable(build: object, names: tuple[str, str]) -> None:
    first, second = names
    remedy = f"give a function of {first!r} and {second!r} that returns a Model"
    if not callable(build):
        raise ModelError(f"build: {brief(build)} cannot be called; {remedy}")
    try:
        signature(build).bind(**dict.fromkeys(names))
    except TypeError as error:
        raise ModelError(f"build: {error}; {remedy}") from None


def spinning(
    structure: Structure, stiffening: ArrayLike, softening: ArrayLike | None = None
) -> Callable[[float], Structure]:
    """Return the structure as a function of the speed of rotation W, K(W) = K + W^2 (K2 - S).

    Parameters
    ----------
    structure : Structure
        At rest. Its damping stays what it is at rest.
    stiffening : array_like, shape (N, N)
        K2, what the stress of the centrifugal load adds [N s2/m].
    softening : array_like, shape (N, N), optional
        S, what the change of the load with the displacement takes away [kg]. Default: none.

    Raises
    ------
    ModelError
        If a matrix is of another size.
    """
    added = real_matrix(stiffening, "stiffening")
    if softening is not None:
        taken = real_matrix(softening, "softening")
        if taken.shape != added.shape:
            raise ModelError(
                f"softening: {taken.shape}, but stiffening is {added.shape}; give as many"
            )
        added = added - taken
    if added.shape != structure.stiffness.shape:
        raise ModelError(
            f"stiffening: {added.shape} for a structure of {len(structure)} dofs; give as many"
        )

    def at(speed: float) -> Structure:
        stiffness = structure.stiffness + speed**2 * added
        stiffened = Structure(structure.mass, stiffness, structure.damping, structure.dofs)
        return stiffened.made_of(structure)

    return at
