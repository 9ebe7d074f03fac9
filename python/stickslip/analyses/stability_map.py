"""The negative damping that friction bounds, over stiffness or slip force of the contacts."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from stickslip.analyses.arguments import require_lowest, require_time
from stickslip.analyses.limit_cycles import NegativeDamping
from stickslip.analyses.run import Progress, Run
from stickslip.analyses.side_by_side import has_own_laws, in_turn
from stickslip.analyses.texts import told
from stickslip.analyses.variation import variation_of
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.results.diagnostic import Diagnostic
from stickslip.results.limit_cycles import CycleArrays, MapArrays, StabilityMap
from stickslip.results.stability import stability_of
from stickslip.settings.cycles import CycleSettings, LimitSettings, MapKeys, MapSettings
from stickslip.settings.settings import configured
from stickslip.settings.variation import one_of

# Ratios this close are one.
_ROUNDING = 1e-8


@configured(MapKeys)
def stability_map(
    model: Model,
    negative_damping: ArrayLike,
    *,
    settings: MapKeys,
    progress: Progress = None,
) -> StabilityMap:
    """Largest negative damping with limit cycles, and with stable ones, over a contact parameter.

    For every value the whole branch of the mode is followed. `limit` is the ratio at which it
    turns for good: beyond it friction cannot dissipate what flutter feeds. `stable_limit` is the
    largest ratio up to which its sticking side is stable without a gap, which is where vibration
    begins to leave this mode; not-a-number where a cycle below it is not decided.

    Parameters
    ----------
    model : Model
        Structure and contacts; not a sector of a travelling wave.
    negative_damping : array_like, shape (N, N)
        C_neg of the damping C + r C_neg [kg/s].

    Returns
    -------
    StabilityMap
        One entry per value.

    Raises
    ------
    ModelError
        If all values are refused for one reason.

    References
    ----------
    Guillen (1999), section 5.2.3 for the influence of the stiffness; the dissertation leaves the
    stability of several degrees of freedom open.
    """
    require_time(model)
    negative = NegativeDamping.of(negative_damping, model)
    name = one_of(settings, "stiffness", "slip_force")
    values = np.unique(getattr(settings, name))
    total = len(values)
    variation = variation_of(model, name, settings)
    given = settings.part(LimitSettings)
    cycles = CycleSettings.of(**given)
    require_lowest(model, cycles.mode)
    rows: list[tuple[float, float, float]] = []
    notes: list[Diagnostic] = []
    refused: list[str | None] = []
    interrupted = False

    def limit_of(value: float, progress: Progress) -> tuple[float, float, float] | str | None:
        """Return ratio, frequency and stable ratio, why there are none, or None if interrupted."""
        try:
            branch = negative.cycles(variation.apply(model, value), cycles, progress)
        except ModelError as error:
            return str(error)
        if branch.interrupted:
            return None
        arrays = CycleArrays.of(branch.solution(progress), negative_damping=negative.matrix)
        return (*arrays.turn, _stable_limit(arrays))

    with Run("stability map", progress) as run:
        try:
            parts = [partial(limit_of, value) for value in values]
            limits = in_turn(parts, run, alone=has_own_laws(model), within=run.at_once)
            for value, found in zip(values, limits, strict=True):
                if found is None:
                    interrupted = True
                    break
                refused.append(found if isinstance(found, str) else None)
                rows.append(found if isinstance(found, tuple) else (np.nan, np.nan, np.nan))
                if isinstance(found, str):
                    notes.append(_without_limit(name, value, found))
                elif np.isnan(found[0]):
                    notes.append(_without_limit(name, value, "the branch does not turn"))
        except KeyboardInterrupt:
            interrupted = True
        done = len(rows)
        if refused and refused[0] and refused.count(refused[0]) == total:
            raise ModelError(refused[0])
        limit, omega, stable = np.array(rows, dtype=np.float64).reshape(-1, 3).T
        unknown = int((np.isfinite(limit) & ~np.isfinite(stable)).sum())
        if unknown:
            notes.append(told("stability-unknown", count=unknown))
        result = StabilityMap(
            model=model,
            dofs=model.structure.dofs,
            settings=MapSettings.of(variation=variation, **given),
            arrays=MapArrays(
                value=values[:done],
                limit=limit,
                omega=omega,
                stable_limit=stable,
                negative_damping=negative.matrix,
            ),
            interrupted=interrupted,
            timings={},
            counters={"branches": done},
            diagnostics=tuple(notes),
        )
        return run.ended(result, f"{done} of {total} values")


def _without_limit(name: str, value: float, cause: str) -> Diagnostic:
    return told("no-limit", value=float(value), _name=name, _cause=cause)


def _stable_limit(arrays: CycleArrays) -> float:
    """Return the ratio at which the sticking side first loses stability; 0 if it never has it.

    Not-a-number if a cycle below it is not decided.
    """
    sticking = np.flatnonzero(~arrays.slipping)
    if not sticking.size:
        return float("nan")
    limit, last = float(arrays.ratio[sticking].max()), int(sticking[-1])
    for (value, _), after, unstable in zip(
        arrays.change, arrays.change_after, arrays.change_unstable, strict=True
    ):
        if unstable[1] > 0:
            limit, last = float(value), int(after)
            break
    states = stability_of(arrays.multipliers, arrays.neutral, arrays.known)
    if states[sticking[0]] == "unstable":
        return 0.0
    # The cycle where the branch turns lies on neither side.
    below = sticking[(sticking <= last) & (arrays.ratio[sticking] < limit * (1.0 - _ROUNDING))]
    return limit if (states[below] == "stable").all() else float("nan")
