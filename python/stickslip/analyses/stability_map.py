"""The negative damping that friction bounds, over stiffness or slip force of the contacts."""

from __future__ import annotations

from math import inf

import numpy as np
from numpy.typing import ArrayLike

from stickslip.analyses.arguments import Progress, require_model, require_progress, require_time
from stickslip.analyses.limit_cycles import negative_damping_of, solve, wanted
from stickslip.analyses.variation import Contacts, chosen_contacts
from stickslip.errors import ModelError
from stickslip.interruption import Interruption, stopped
from stickslip.model import Model
from stickslip.model.destabilised import is_proportional
from stickslip.results.diagnostic import Diagnostic, diagnostic
from stickslip.results.limit_cycles import CycleArrays, MapArrays, StabilityMap
from stickslip.results.stability import stability_of
from stickslip.settings.cycles import CycleSettings, MapKeys, MapSettings
from stickslip.settings.settings import configured
from stickslip.settings.variation import Parameter, Variation

__all__ = ["stability_map"]


@configured(MapKeys)
def stability_map(
    model: Model,
    negative_damping: ArrayLike,
    *,
    settings: MapKeys,
    stiffness: ArrayLike | None = None,
    slip_force: ArrayLike | None = None,
    contacts: Contacts | None = None,
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
    stiffness, slip_force : array_like, shape (n,)
        Values of one of them, above 0 [N/m], [N]. Limit ratios depend on slip forces only through
        their proportions, as all displacements grow with them.
    contacts : int, str, (contact, int), or iterable of these, optional
        Which contacts take the value; see `stickslip.damper_curve`.

    Returns
    -------
    StabilityMap
        One entry per value.

    Raises
    ------
    ModelError
        If not exactly one parameter is given, or an argument is of the wrong type or outside its
        range.
    Interrupted
        On Ctrl-C; its `result` holds the values that had been reached.

    References
    ----------
    Guillen (1999), section 5.2.3 for the influence of the stiffness; the dissertation leaves the
    stability of several degrees of freedom open.
    """
    require_model(model)
    require_time(model)
    require_progress(progress)
    matrix = negative_damping_of(negative_damping, model)
    law = is_proportional(negative_damping)
    given: dict[Parameter, ArrayLike | None] = {"stiffness": stiffness, "slip_force": slip_force}
    names = [name for name, values in given.items() if values is not None]
    if len(names) != 1:
        raise ModelError("stiffness, slip_force: give exactly one of them")
    (name,) = names
    values, _ = wanted(np.atleast_1d(np.asarray(given[name])), name, (inf, 0.0))
    assert values is not None
    variation = Variation.of(
        parameter=name,
        contacts=chosen_contacts(contacts, name, model, settings.common),
        common=settings.common,
    )
    branch = settings.part(MapKeys)
    del branch["common"]
    cycles = CycleSettings.of(**branch)
    rows: list[tuple[float, float, float]] = []
    told: list[Diagnostic] = []
    interrupted = False
    with Interruption(progress) as watch:
        try:
            with watch.at_once():
                for place, value in enumerate(values):
                    share = _share(watch, place, len(values))
                    try:
                        changed = variation.apply(model, value)
                        solution = solve(changed, matrix, cycles, share, proportional=law)
                    except ModelError as error:
                        rows.append((np.nan, np.nan, np.nan))
                        told.append(_without_limit(name, value, str(error)))
                        continue
                    if solution.interrupted:
                        interrupted = True
                        break
                    arrays = CycleArrays.of(solution, negative_damping=matrix)
                    ratio, omega = arrays.turn
                    rows.append((ratio, omega, _stable_limit(arrays)))
                    if np.isnan(ratio):
                        told.append(_without_limit(name, value, "the branch does not turn"))
        except KeyboardInterrupt:
            interrupted = True
        done = len(rows)
        limit, omega, stable = np.array(rows, dtype=np.float64).reshape(-1, 3).T
        unknown = int((np.isfinite(limit) & ~np.isfinite(stable)).sum())
        if unknown:
            text = f"The stability of {unknown} values is not decided."
            told.append(diagnostic("stability-unknown", text, count=unknown))
        result = StabilityMap(
            model=model,
            dofs=model.structure.dofs,
            settings=MapSettings.of(variation=variation, **branch),
            arrays=MapArrays(
                value=np.array(values[:done]),
                limit=limit,
                omega=omega,
                stable_limit=stable,
                negative_damping=matrix,
            ),
            interrupted=interrupted,
            timings={},
            counters={"branches": done},
            diagnostics=tuple(told),
        )
        if interrupted:
            raise stopped("stability map", f"{done} of {len(values)} values", result)
        return watch.completed(result, "stability map")


def _without_limit(name: str, value: float, cause: str) -> Diagnostic:
    return diagnostic("no-limit", f"{name} = {value:.6g}: {cause}", value=float(value))


def _share(watch: Interruption, place: int, total: int) -> Progress:
    return lambda part: watch((place + part) / total)


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
    return limit if (states[sticking[sticking <= last]] == "stable").all() else float("nan")
