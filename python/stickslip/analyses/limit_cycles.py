"""Limit cycles of structures with negative damping, and their stability."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.analyses.arguments import (
    Progress,
    prepare,
    require_model,
    require_progress,
    require_time,
)
from stickslip.analyses.cycle_assumptions import cycle_assumptions
from stickslip.analyses.variation import Contacts, chosen_contacts
from stickslip.checks import brief, real_number
from stickslip.errors import ModelError
from stickslip.interruption import Interruption, stopped
from stickslip.model import Model
from stickslip.model.damping import DampingLaw
from stickslip.model.destabilised import is_proportional, negative_matrix
from stickslip.model.model import refusal
from stickslip.results.limit_cycles import CycleArrays, LimitCycles
from stickslip.settings.cycles import LOWEST_RATIO, BranchSettings, CycleKeys, CycleSettings
from stickslip.settings.entries import Span
from stickslip.settings.settings import configured
from stickslip.settings.variation import Parameter, Variation

if TYPE_CHECKING:
    from stickslip import _core

__all__ = ["limit_cycles", "negative_damping_of", "solve", "wanted"]

AROUND = 1e3
"""Factor beyond the values of a parameter of contacts within which the branch is followed."""


@configured(CycleKeys)
def limit_cycles(
    model: Model,
    negative_damping: ArrayLike | DampingLaw,
    *,
    settings: CycleKeys,
    ratio: ArrayLike | Span | None = None,
    stiffness: ArrayLike | Span | None = None,
    slip_force: ArrayLike | Span | None = None,
    contacts: Contacts | None = None,
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
    ratio : array_like, (float, float) or float, optional
        A list: exactly these ratios r, on both sides of the branch. A tuple: the branch from its
        sticking side on, until it leaves this range. Default: the whole branch from r = 0.01 on.
        If another parameter is followed: the one r, by default 1.
    stiffness, slip_force : array_like or (float, float), optional
        Follow this parameter of contacts [N/m], [N] instead of r, at exactly these values, or in
        a range.
    contacts : int, str, (contact, int), or iterable of these, optional
        Which contacts take the value; see `stickslip.damper_curve`.

    Returns
    -------
    LimitCycles
        Along the branch, from its sticking to its slipping side.

    Raises
    ------
    ModelError
        If an argument is of the wrong type or outside its range, the mode is not excited or moves
        no contact that can slip, or there is no limit cycle at the ratio.
    Interrupted
        On Ctrl-C; its `result` holds the cycles that had been computed.

    References
    ----------
    Guillen (1999), chapter V, there by Broyden's method without condensation and without
    stability. Sinha and Griffin (1983), J. Engng Gas Turb. Power 105, 684: limit cycles of one
    blade.
    """
    require_model(model)
    require_progress(progress)
    matrix = negative_damping_of(negative_damping, model)
    kept = _settings(
        model, {"stiffness": stiffness, "slip_force": slip_force}, ratio, contacts, settings
    )
    if settings.method == "exact":
        require_time(model)
    law = is_proportional(negative_damping)
    prepare(model)
    with Interruption(progress) as watch:
        solution = solve(model, matrix, kept, watch, proportional=law)
        arrays = CycleArrays.of(solution, negative_damping=matrix)
        result = LimitCycles.of(
            solution,
            model=model,
            dofs=model.structure.dofs,
            settings=kept,
            arrays=arrays,
            counters={**solution.counters, "jumps": solution.jumps},
            diagnostics=cycle_assumptions(model, kept, arrays, solution),
        )
        if result.interrupted:
            raise stopped("limit cycles", f"{result.ratio.size} points", result)
        return watch.completed(result, "limit cycles")


def negative_damping_of(given: ArrayLike | DampingLaw, model: Model) -> NDArray[Any]:
    """Return a matrix of negative damping that fits a model, checked and read-only.

    Parameters
    ----------
    given : array_like, Rayleigh or ModalDamping
        Shape (N, N); of a tuned disk also complex of shape (n, N, N).
    model : Model
        The model.

    Raises
    ------
    ModelError
        If it is of another shape, or holds numbers that are not finite.
    """
    size = len(model.structure)
    if not model.travels or isinstance(given, DampingLaw):
        given = negative_matrix(given, model.structure)
    matrix: NDArray[Any] = np.array(given) if not model.travels else np.empty(0)
    if model.travels:
        sectors = model.sectors  # type: ignore[attr-defined]
        try:
            values = np.asarray(given)
        except ValueError:
            raise ModelError("negative_damping: a ragged list; give matrices") from None
        if values.dtype.kind not in "fiuc" or values.shape not in {
            (size, size),
            (sectors, size, size),
        }:
            raise ModelError(
                f"negative_damping: {brief(given)}; give numbers of shape ({size}, {size}) or "
                f"({sectors}, {size}, {size}), a matrix per nodal diameter"
            )
        matrix = np.array(np.broadcast_to(values, (sectors, size, size)), dtype=np.complex128)
        if not np.isfinite(matrix).all():
            raise ModelError("negative_damping: every entry must be finite")
    if not matrix.any():
        raise ModelError("negative_damping: all zero; without it nothing excites a limit cycle")
    matrix.flags.writeable = False
    return matrix


def solve(
    model: Model,
    matrix: NDArray[Any],
    settings: CycleSettings,
    progress: Progress,
    *,
    proportional: bool,
) -> _core.LimitCycles:
    """Return what the core makes of checked settings; a law may have made the matrix."""
    from stickslip import _core

    variation = settings.variation
    try:
        return _core.limit_cycles(
            model.problem,
            matrix,
            proportional,
            None if variation is None else variation.varied(model),
            settings,
            progress,
        )
    except ModelError:
        raise
    except ValueError as error:
        raise refusal(error, model) from error


def _settings(
    model: Model,
    parameters: dict[Parameter, ArrayLike | Span | None],
    ratio: ArrayLike | Span | None,
    contacts: Contacts | None,
    settings: CycleKeys,
) -> CycleSettings:
    """Return checked settings."""
    rest = settings.part(BranchSettings)
    given = [name for name, values in parameters.items() if values is not None]
    if len(given) > 1:
        raise ModelError("stiffness, slip_force: both are given; follow one of them")
    if not given:
        if contacts is not None:
            raise ModelError("contacts: the ratio is no parameter of contacts; leave them out")
        values, span = wanted(ratio, "ratio", (LOWEST_RATIO, inf))
        return CycleSettings.of(values=values, span=span, **rest)
    (name,) = given
    variation = Variation.of(
        parameter=name,
        contacts=chosen_contacts(contacts, name, model, settings.common),
        common=settings.common,
    )
    values, span = wanted(parameters[name], name, (inf, 0.0))
    if values is not None:
        # The other side of the branch is reached around a fold that may lie far outside.
        span = (values[0] / AROUND, values[-1] * AROUND)
    one = 1.0 if ratio is None else real_number(ratio, f"ratio, with {name} followed,")
    return CycleSettings.of(variation=variation, ratio=one, values=values, span=span, **rest)


def wanted(
    given: ArrayLike | Span | None, entry: str, span: Span
) -> tuple[tuple[float, ...] | None, Span]:
    """Return the values at which cycles are wanted, or none, and the range.

    Parameters
    ----------
    given : array_like, (float, float) or None
        Values; a tuple of two numbers is a range.
    entry : str
        Its name.
    span : (float, float)
        The range where nothing is given.

    Raises
    ------
    ModelError
        If a value is not a finite number above 0, or a range has no two different ends.
    """
    if given is None:
        return None, span
    if isinstance(given, tuple) and len(given) == 2:
        low, high = sorted(
            real_number(end, f"{entry}: end of the range", finite=False) for end in given
        )
        if not 0.0 < low < high:
            raise ModelError(f"{entry}: the range ({low:g}, {high:g}) must have two ends above 0")
        return None, (low, high)
    try:
        values = np.atleast_1d(np.asarray(given))
    except ValueError:
        raise ModelError(f"{entry}: a ragged list; give one list of values") from None
    if values.dtype.kind not in "fiu" or values.ndim != 1 or not values.size:
        raise ModelError(f"{entry}: {brief(given)}; give a list of numbers above 0, or (from, to)")
    numbers = np.array(values, dtype=np.float64)
    bad = np.flatnonzero(~(np.isfinite(numbers) & (numbers > 0.0)))
    if bad.size:
        raise ModelError(f"{entry}[{bad[0]}] is {numbers[bad[0]]:g}; give finite values above 0")
    return tuple(map(float, np.unique(numbers))), (min(span[0], float(numbers.min())), span[1])
