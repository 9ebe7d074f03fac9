"""One analysis along a parameter of the model."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from operator import methodcaller
from typing import TypeAlias, cast

import numpy as np

from stickslip.analyses.campbell import model_at, require_models
from stickslip.analyses.run import Progress, Run
from stickslip.analyses.side_by_side import at_once, in_turn, whole
from stickslip.analyses.variation import variation_of
from stickslip.checks import brief
from stickslip.disk import BladedDisk, MistunedDisk
from stickslip.errors import Interrupted, ModelError
from stickslip.memory import one_of
from stickslip.model import Model
from stickslip.results.result import Result
from stickslip.results.sweep import Sweep
from stickslip.settings.settings import configured
from stickslip.settings.sweep import ENGINE_ORDER, SweepKeys, SweepSettings

_NO_CONTACTS = "contacts: {} is no parameter of contacts; leave them out"
Compute: TypeAlias = Callable[[Model, Progress], Result]
"""What is computed of a model."""


@configured(SweepKeys)
def sweep(
    models: Model | Callable[[float], Model],
    analysis: Callable[[Model], Result],
    *,
    settings: SweepKeys,
    progress: Progress = None,
) -> Sweep:
    """Compute one analysis along a parameter: slip force, preload, level, engine order, speed.

    Parameters
    ----------
    models : Model or callable
        The model whose parameter is varied; for a `speed` what makes the model of one [rad/s].
    analysis : callable
        Makes the result of a model: ``lambda model: ss.forced_response(model, omega)``.

    Returns
    -------
    Sweep
        The results, with the parameter as a dimension of their dataset.

    Raises
    ------
    ModelError
        If a value makes no model, or the analysis returns no result.
    """
    if not callable(analysis):
        raise ModelError(
            f"analysis: {brief(analysis)} cannot be called; give a function of a model"
        )

    def compute(model: Model, _: Progress) -> Result:
        result = analysis(model)
        if not isinstance(result, Result):
            raise ModelError(f"analysis: it returned {brief(result)}, no result; return one")
        return result

    # What a caller gives need not bear several threads.
    return swept(models, settings, compute, progress, alone=True)


def swept(
    models: Model | Callable[[float], Model],
    keys: SweepKeys,
    compute: Compute,
    progress: Progress,
    *,
    alone: bool,
) -> Sweep:
    """Return the results along the parameter of some keys, `alone` one after the other."""
    kept, at = _family(models, keys)
    results: list[Result] = []
    count = len(kept.values)
    threads = at_once(count, alone=alone)

    def result_at(value: float, part: Progress) -> Result:
        try:
            with one_of(count, threads, together=True):
                return whole(lambda: compute(at(value), part))
        except ModelError as error:
            where = f"{kept.parameter} = {value:.6g}"
            raise ModelError(f"{where}: {error}", study=f"{where}: {error.study}") from None

    parts = [partial(result_at, value) for value in kept.values]
    with Run("sweep", progress) as run:
        try:
            results.extend(in_turn(parts, run, alone=alone, within=run.at_once))
        except KeyboardInterrupt as stop:
            late = [stop] if isinstance(stop, Interrupted) and stop.complete else []
            count = len(results) + len(late)
            if not count:
                # What its first value has come to is no sweep.
                raise KeyboardInterrupt("sweep interrupted before a value was complete") from None

            def done() -> Sweep:
                found = (*results, *(cast("Result", one.result) for one in late))
                return Sweep.of(kept, found, found[0].model, interrupted=True)

            message = f"sweep interrupted: {count} of {len(parts)} values are complete"
            raise Interrupted.later(message, done, complete=False) from stop
        base = models if isinstance(models, Model) else results[0].model
        return run.completed(Sweep.of(kept, tuple(results), base), "sweep")


def _family(
    models: Model | Callable[[float], Model], keys: SweepKeys
) -> tuple[SweepSettings, Callable[[float], Model]]:
    """Return what is varied, and what makes the model of a value."""
    parameter = keys.varied
    values = tuple(np.asarray(getattr(keys, parameter)).tolist())
    if (str(parameter) == "speed") == isinstance(models, Model):
        needed = "a function of the speed" if isinstance(models, Model) else "a Model"
        raise ModelError(f"models: {brief(models)} along {parameter}; give {needed}")
    if isinstance(models, Model) and str(parameter) == ENGINE_ORDER:
        kept = SweepSettings.of(parameter=ENGINE_ORDER, unit="1", values=values)
        return kept, _at_order(models, keys)
    if isinstance(models, Model):
        variation = variation_of(models, parameter, keys, methodcaller("variable"))
        base = models
        settings = SweepSettings.of(
            parameter=parameter, unit=variation.unit, values=values, variation=variation
        )
        return settings, lambda value: variation.apply(base, value)
    require_models(models)
    if keys.contacts is not None:
        raise ModelError(_NO_CONTACTS.format("a speed"))
    kept = SweepSettings.of(parameter="speed", unit="rad/s", values=values)
    return kept, partial(model_at, models)


def _at_order(model: Model, keys: SweepKeys) -> Callable[[float], Model]:
    """Return what makes the disk of an engine order."""
    if keys.contacts is not None:
        raise ModelError(_NO_CONTACTS.format("an engine order"))
    if not isinstance(model, BladedDisk | MistunedDisk):
        raise ModelError(
            f"models: {brief(model)} is no bladed disk, so that it has no engine order; give "
            "ss.BladedDisk(...)",
            study="engine_order: that of a bladed disk; add the table [disk]",
        )
    disk = model
    return lambda order: disk.at_order(int(order))
