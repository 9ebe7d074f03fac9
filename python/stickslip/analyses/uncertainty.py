"""Peaks, optima and backbones of models whose parameters are uncertain."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping
from typing import Any

import numpy as np

from stickslip import _core
from stickslip.analyses.arguments import known_dofs, require_forced, require_held
from stickslip.analyses.cluster import Client
from stickslip.analyses.fit_parameters import FitParameter, require_distinct, require_unit
from stickslip.analyses.pattern_store import Identity, digest
from stickslip.analyses.run import Progress, Run
from stickslip.analyses.sample_run import RESIDUAL, SampleRun, Samples, sample_columns
from stickslip.analyses.stores import SampleStore
from stickslip.analyses.texts import told
from stickslip.checks import brief
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.errors import ModelError
from stickslip.memory import require_numbers
from stickslip.model import Model
from stickslip.results.diagnostic import Diagnostic, present
from stickslip.results.expansion import drawn_shares
from stickslip.results.uncertainty import (
    MISTUNING,
    Uncertainty,
    UncertaintyArrays,
    distributions,
    reasons_in_words,
)
from stickslip.settings.balance import HarmonicSettings
from stickslip.settings.quantities import Backbone, HighestPeak, Optimum
from stickslip.settings.settings import configured
from stickslip.settings.uncertainty import SampledSettings, UncertaintyKeys, distribution


@configured(UncertaintyKeys, "parameters", "quantity")
def uncertainty(
    model: Model,
    *,
    settings: UncertaintyKeys,
    client: Client | None = None,
    progress: Progress = None,
) -> Uncertainty:
    """Sample uncertain parameters, and find a peak, an optimum or a backbone for each sample.

    Percentiles follow from the samples themselves, or from a polynomial surrogate of them, which
    gives the share of every parameter in the variance as well. What is asked follows the
    resonance; amplitudes at a fixed frequency are refused, for the resonance moves across it. What
    is found of a sample depends on nothing but its own parameters, so that numbers are the same bit
    by bit with any number of threads, in one run or in several.

    Parameters
    ----------
    model : Model
        The model, of which the uncertain parameters take other values.
    client : distributed.Client, optional
        A Dask cluster that computes the samples, in batches; the numbers are the same as without.

    Returns
    -------
    Uncertainty
        The quantity of every sample; those that failed with their reason.

    Raises
    ------
    ModelError
        If the model lacks a parameter, or the store holds another study.

    References
    ----------
    Sobol (1967), Owen (1998): the samples. Blatman and Sudret (2011): the surrogate.

    Examples
    --------
    >>> from scipy import stats
    >>> import stickslip as ss
    >>> study = ss.uncertainty(
    ...     ss.reference.snecma_beam(),
    ...     {"slip_force": stats.uniform(200, 100)},
    ...     ss.HighestPeak("tip", omega=(100, 300)),
    ...     samples=4,
    ...     harmonics=3,
    ... )
    >>> study.values("amplitude").shape
    (4,)
    """
    kept = SampledSettings.of(**settings.part(SampledSettings))
    work = _work_of(model, kept, settings.parameters)
    start = time.perf_counter()
    with Run("uncertainty", progress) as run:
        whole = SampleRun(work)
        if settings.store is None:
            complete = whole.run(settings.threads, settings.portion, run, None, client)
        else:
            with SampleStore(settings.store, _identity_of(model, kept), run.heed) as store:
                whole.recall(store)
                complete = whole.run(settings.threads, settings.portion, run, store, client)
        result = _result(model, kept, whole, time.perf_counter() - start, interrupted=not complete)
        rest = "" if settings.store is None else f"; {os.fspath(settings.store)} goes on from there"
        return run.ended(result, f"{len(whole.known)} of {kept.samples} samples", rest)


def _work_of(
    model: Model, settings: SampledSettings, given: Mapping[str, Mapping[str, Any]]
) -> Samples:
    """Return what is computed of a model, or refuse it."""
    quantity, names = settings.quantity, tuple(settings.parameters)
    sectors = 1
    if MISTUNING in names:
        if not isinstance(model, BladedDisk) or not isinstance(quantity, HighestPeak):
            raise ModelError(
                f"parameters: {MISTUNING!r} of {brief(model)} for a {quantity.kind}; it is for the "
                "highest peak of a tuned BladedDisk"
            )
        sectors = model.sectors
    inputs = len(names) - 1 + sectors
    require_numbers(
        settings.samples * (inputs + 2 * len(quantity.numbers)),
        f"samples: {settings.samples} of {inputs} parameters",
        "give fewer samples",
    )
    laws = distributions(settings, inputs)
    shares = drawn_shares(settings.sampling, inputs, settings.samples, settings.seed)
    columns = [law.ppf(share) for law, share in zip(laws, shares.T, strict=True)]
    of_model = [name for name in names if name not in (MISTUNING, RESIDUAL)]
    for name in of_model:
        middle = float(distribution(settings.parameters[name]).median())
        FitParameter(name, middle, np.inf).apply(model, middle)
        require_unit(model, name, [given[name]["loc"], given[name]["scale"]])
    require_distinct(model, of_model)
    if isinstance(quantity, HighestPeak | Optimum):
        known_dofs([quantity.dof], f"{quantity.kind}: dof", "dof", model)
        require_forced(model, settings)
        require_held(model, settings.suited(model).residual)
    return Samples(
        model=model,
        names=names,
        quantity=quantity,
        settings=HarmonicSettings.of(**settings.part(HarmonicSettings)),
        parameters=np.ascontiguousarray(np.stack(columns, axis=1), dtype=np.float64),
        numbers=list(range(settings.samples)),
    )


def _result(
    model: Model, settings: SampledSettings, whole: SampleRun, seconds: float, *, interrupted: bool
) -> Uncertainty:
    """Return what is there."""
    quantity = settings.quantity
    values, errors, status, reasons = sample_columns(
        whole.known, settings.samples, len(quantity.numbers)
    )
    arrays = UncertaintyArrays(
        parameter=whole.work.parameters, value=values, error_estimate=errors, status=status
    )
    return Uncertainty(
        model=model,
        dofs=() if isinstance(quantity, Backbone) else (quantity.dof,),
        settings=settings,
        arrays=arrays,
        reasons=reasons,
        interrupted=interrupted,
        timings={"total": seconds},
        counters={"samples": len(whole.known), "failed": int(arrays.failed.sum())},
        diagnostics=_assumptions(settings, arrays, reasons),
    )


def _assumptions(
    settings: SampledSettings, arrays: UncertaintyArrays, reasons: tuple[str, ...]
) -> tuple[Diagnostic, ...]:
    """Say what the study took for granted."""
    failed = int(arrays.failed.sum())
    common = next(iter(reasons_in_words(reasons)), "")
    with np.errstate(invalid="ignore", divide="ignore"):
        share = float(np.nan_to_num(arrays.error_estimate / np.abs(arrays.value)).max(initial=0.0))
    return present(
        (
            told(f"samples-drawn/{settings.sampling}", count=settings.samples, seed=settings.seed),
            told("independent", parameters=len(settings.parameters)),
            failed > 0
            and told(
                "samples-failed",
                count=failed,
                total=int((arrays.status != 2).sum()),
                _common=common,
            ),
            share > 0.05 and told("truncation/samples", share=share),
        )
    )


def _identity_of(model: Model, settings: SampledSettings) -> Identity:
    """Return what makes a study, but for how many samples."""
    structure, law = model.structure, model.structure.damping_law
    parts: dict[str, object] = {}
    if isinstance(model, BladedDisk):
        blocks = model.interface
        # Stores of disks without any do not name them.
        orders = {str(k): order for k, order in model.engine_orders.items()}
        parts = {
            "sectors": model.sectors,
            "engine_order": model.engine_order,
            **({"engine_orders": orders} if orders else {}),
            "couplings": [one.to_spec() for one in model.couplings],
            "interface": ""
            if blocks is None
            else digest(blocks.mass, blocks.damping, blocks.stiffness),
        }
    first = drawn_shares(settings.sampling, len(settings.parameters), 1, settings.seed)
    given = settings.model_dump()
    return {
        "version": _core.__version__,
        "model": type(model).__name__,
        "structure": digest(structure.mass, structure.damping, structure.stiffness),
        "damping": None if law is None else law.to_spec(),
        "dofs": list(structure.dofs),
        **parts,
        "contacts": [one.to_spec() for one in model.contacts],
        "forces": [one.to_spec() for one in model.forces],
        "first_sample": digest(first),
        **{name: value for name, value in given.items() if name != "samples"},
    }
