"""The run of a study of uncertain parameters: what is computed of a sample, and where."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from functools import partial
from itertools import islice
from typing import Any, NamedTuple

import numpy as np

from stickslip import _core
from stickslip.analyses.arguments import columns_of
from stickslip.analyses.cluster import Client, compute_on
from stickslip.analyses.fit_parameters import FitParameter
from stickslip.analyses.nonlinear_modes import nonlinear_modes
from stickslip.analyses.optimal_damper import optimal_damper
from stickslip.analyses.pattern_store import Row
from stickslip.analyses.run import Progress, Run, refusals
from stickslip.analyses.side_by_side import in_turn
from stickslip.analyses.stores import Sample, SampleStore
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.results.fields import Float
from stickslip.results.status import Status
from stickslip.results.uncertainty import MISTUNING, SampleStatus
from stickslip.settings.balance import HarmonicSettings
from stickslip.settings.peaks import PeakSettings
from stickslip.settings.quantities import Backbone, HighestPeak, Optimum, Quantity

RESIDUAL = "residual"
"""The parameter that is the force which stuck contacts hold."""


class Samples(NamedTuple):
    """Samples of the parameters, of which one task computes the quantity."""

    model: Model
    names: tuple[str, ...]
    """Of the columns; that of `MISTUNING` stands once, before one column per sector."""
    quantity: Quantity
    settings: HarmonicSettings
    parameters: Float
    numbers: list[int]

    def part(self, place: slice) -> Samples:
        """Return some of the samples."""
        return self._replace(parameters=self.parameters[place], numbers=self.numbers[place])


def computed(work: Samples) -> tuple[str, list[tuple[int, Sample]]]:
    """Compute samples one by one; return the version of stickslip, and what was found."""
    pairs = zip(work.numbers, work.parameters, strict=True)
    return _core.__version__, [(number, sampled(work, values)) for number, values in pairs]


def sampled(work: Samples, values: Float, progress: Progress = None) -> Sample:
    """Compute the quantity for one sample of the parameters; what fails has a reason."""
    try:
        model, settings, group = _changed(work, values)
        return _QUANTITIES[type(work.quantity)](work.quantity, model, settings, group, progress)
    except ModelError as error:
        return _failed(len(work.quantity.numbers), str(error))


def _changed(work: Samples, values: Float) -> tuple[Model, HarmonicSettings, list[str]]:
    """Return the model of a sample, its settings, and the DOFs of which the highest counts."""
    model, settings = work.model, work.settings
    group = [getattr(work.quantity, "dof", "")]
    column = iter(values.tolist())
    pattern: list[float] = []
    for name in work.names:
        if name == MISTUNING and isinstance(model, BladedDisk):
            pattern = list(islice(column, model.sectors))
        elif name == RESIDUAL:
            settings = settings.model_copy(update={"residual": next(column)})
        else:
            value = next(column)
            model = FitParameter(name, value, np.inf).apply(model, value)
    if pattern and isinstance(model, BladedDisk):
        group = [f"{blade}.{group[0]}" for blade in range(model.sectors)]
        model = model.mistuned(pattern)
    return model, settings.suited(model), group


def _highest_peak(
    quantity: HighestPeak,
    model: Model,
    settings: HarmonicSettings,
    group: list[str],
    progress: Progress,
) -> Sample:
    keys = PeakSettings.of(**settings.part(HarmonicSettings), measure=quantity.measure)
    columns = [columns_of(group, model).tolist()]
    with refusals(model):
        found = _core.summits(
            model.problem, columns, quantity.measure, quantity.omega, keys, progress=progress
        )
    row = Row(*found[0])
    status = Status.from_code(row.status)
    if not status.solved:
        return _failed(2, f"peak: {status}. {status.advice}")
    if row.at_edge:
        return _failed(2, "peak: the highest point lies at an end of omega; give a wider range")
    return _found((row.amplitude, row.omega), (row.error_estimate, np.nan))


def _optimum(
    quantity: Optimum,
    model: Model,
    settings: HarmonicSettings,
    group: list[str],
    progress: Progress,
) -> Sample:
    found = optimal_damper(
        model,
        dof=quantity.dof,
        parameter=quantity.parameter,
        bounds=quantity.bounds,
        omega=quantity.omega,
        measure=quantity.measure,
        progress=progress,
        **settings.part(HarmonicSettings),
    )
    if found.at_bound:
        return _failed(3, "optimum: it lies at one of the bounds; give wider ones")
    return _found((found.value, found.amplitude, found.omega), (np.nan,) * 3)


def _backbone(
    quantity: Backbone,
    model: Model,
    settings: HarmonicSettings,
    group: list[str],
    progress: Progress,
) -> Sample:
    found = nonlinear_modes(
        model,
        amplitude=list(quantity.amplitude),
        mode=quantity.mode,
        progress=progress,
        **settings.part(HarmonicSettings),
    )
    values = (*found.omega.tolist(), *found.damping_ratio.tolist())
    errors = np.abs(found.relative_error.T).ravel() * np.abs(values)
    ends = [one for one in found.diagnostics if one.code == "mode-not-reached"]
    reason = ends[0].text if ends else "backbone: an amplitude was not reached"
    complete = bool(np.isfinite(values).all())
    status = SampleStatus.COMPUTED if complete else SampleStatus.FAILED
    return Sample(values, tuple(errors.tolist()), status.code, "" if complete else reason)


_QUANTITIES: Mapping[type, Callable[..., Sample]] = {
    HighestPeak: _highest_peak,
    Optimum: _optimum,
    Backbone: _backbone,
}


def _found(values: tuple[float, ...], errors: tuple[float, ...]) -> Sample:
    return Sample(values, errors, SampleStatus.COMPUTED.code, "")


def _failed(count: int, reason: str) -> Sample:
    nothing = (np.nan,) * count
    return Sample(nothing, nothing, SampleStatus.FAILED.code, " ".join(reason.split()))


class SampleRun:
    """What is computed, and what is there already."""

    def __init__(self, work: Samples) -> None:
        self.work = work
        self.known: dict[int, Sample] = {}

    def recall(self, store: SampleStore) -> None:
        """Take over what a store holds of this study."""
        for number, found in store.rows():
            # A sample of which a row was deleted is computed again.
            whole = len(found.values) == len(self.work.quantity.numbers)
            if number < len(self.work.numbers) and whole:
                self.known[number] = found

    def run(
        self,
        threads: int | None,
        part: tuple[int, int],
        run: Run,
        store: SampleStore | None,
        client: Client | None,
    ) -> bool:
        """Compute what is missing of a part; False if Ctrl-C has ended it."""
        missing = [
            number
            for number in self.work.numbers
            if number not in self.known and number % part[1] == part[0]
        ]
        work = self.work._replace(parameters=self.work.parameters[missing], numbers=missing)

        def deliver(number: int, found: Sample) -> None:
            if store is not None:
                try:
                    store.add(number, found)
                except ModelError as error:
                    kept = f"{len(self.known)} of {len(self.work.numbers)} samples are stored"
                    raise ModelError(f"{error}; {kept}, run again to go on from there") from None
            self.known[number] = found
            run.reached(len(self.known) / len(self.work.numbers))

        if client is not None and missing:
            return compute_on(client, computed, work, run, deliver)
        return _compute_here(work, threads, run, deliver)


def _compute_here(
    work: Samples, threads: int | None, run: Run, deliver: Callable[[int, Sample], None]
) -> bool:
    """Compute samples in threads; False if Ctrl-C has ended it."""
    parts = [partial(sampled, work, values) for values in work.parameters]
    try:
        with closing(in_turn(parts, lambda _: run.heed(), threads=threads, ahead=4)) as samples:
            for number, found in zip(work.numbers, samples, strict=True):
                deliver(number, found)
    except KeyboardInterrupt:
        return False
    return True


def sample_columns(found: Mapping[int, Sample], count: int, numbers: int) -> Sequence[Any]:
    """Return values and errors, shape (n, m), statuses, (n,), and reasons of all samples."""
    nothing = (np.nan,) * numbers
    missing = Sample(nothing, nothing, SampleStatus.NOT_COMPUTED.code, "")
    rows = [found.get(number, missing) for number in range(count)]
    return (
        np.array([row.values for row in rows], dtype=np.float64),
        np.array([row.errors for row in rows], dtype=np.float64),
        np.array([row.status for row in rows], dtype=np.uint8),
        tuple(row.reason for row in rows),
    )
