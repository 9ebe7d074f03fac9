"""Parameters of contacts and damping that measurements ask for, with intervals."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence

import numpy as np

from stickslip.analyses.arguments import known_dofs, require_forced, require_held
from stickslip.analyses.fit_assumptions import fit_assumptions
from stickslip.analyses.fit_parameters import (
    FitParameter,
    applied,
    require_distinct,
    require_unit,
)
from stickslip.analyses.misfit import Misfit, robust
from stickslip.analyses.profile import covariance, covariance_ends, profile_ends
from stickslip.analyses.run import Progress, Run, share
from stickslip.checks import brief, members
from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.model.measurement import (
    Measured,
    MeasuredBackbone,
    MeasuredLoop,
    MeasuredPeak,
    Measurement,
)
from stickslip.results.fields import Float
from stickslip.results.fit import AGAINST, KINDS, QUANTITIES, Fit, FitArrays
from stickslip.settings.fit import FitKeys, FitSettings
from stickslip.settings.settings import configured

_FOLLOWED = 8
"""Most starts that are followed to their ends, the best first."""
_AGREED = 3
"""How many of them have to lead to the least misfit."""
_COARSE = 3
"""Harmonics with which starts are compared: errors of some percent do not matter there."""
_SAME = 1e-3
"""Distance between two minima, in scaled parameters, within which they are one."""
_SEARCH = 0.6
"""Share of the progress that the best fit is given."""


@configured(FitKeys)
def fit(
    model: Model,
    measured: Iterable[Measured],
    *,
    settings: FitSettings,
    progress: Progress = None,
) -> Fit:
    """Fit parameters to measured response curves, peaks, hysteresis loops and backbones.

    The sum of the squared differences between prediction and measurement, each over its standard
    deviation, is made least, at several levels and tests at once. Its derivatives are those of the
    balance itself: exact in parameters of contacts and in the level. Several starts between the
    bounds keep the fit from a local minimum beside a resonance.

    Parameters
    ----------
    model : Model
        What the parameters belong to, and of which measurements without a model of their own are.
    measured : iterable of Measurement, MeasuredPeak, MeasuredLoop or MeasuredBackbone
        The tests. A parameter is applied to the model of each of them.

    Returns
    -------
    Fit
        The values, their intervals, and which of them the data do not determine.

    Raises
    ------
    ModelError
        If a model lacks a parameter, there are fewer numbers than parameters, or nothing could be
        solved from any start.
    Interrupted
        Its `result` holds the best values so far, with intervals by the covariance there. Before
        all starts have been compared there are none: it is a KeyboardInterrupt then.

    References
    ----------
    Venzon and Moolgavkar (1988): intervals by profiles of the likelihood.
    """
    given = settings.parameters
    settings = FitSettings.of(**settings.part(FitSettings))
    tests = _tests(measured)
    parameters = [FitParameter(name, *ends) for name, ends in settings.parameters.items()]
    for test in tests:
        own = model if test.model is None else test.model
        _require(test, own, parameters, settings)
        for name, ends in given.items():
            require_unit(own, name, ends)
    numbers = sum(test.observed.size for test in tests)
    if numbers < len(parameters):
        raise ModelError(
            f"measured: {numbers} numbers for {len(parameters)} parameters; measure more, or fit "
            "fewer parameters"
        )
    start = time.perf_counter()
    with Run("fit", progress) as run:
        misfit = Misfit(tests, model, parameters, settings, run.heed)
        search = _Search(misfit, settings)
        interrupted = False
        try:
            with run.at_once():
                search.run(share(run, 0.0, _SEARCH))
                result = _result(search, settings, start, share(run, _SEARCH, 1.0))
        except KeyboardInterrupt:
            if search.best is None:
                # What the curve that is compared has come to is no fit.
                raise KeyboardInterrupt("fit interrupted before a first evaluation") from None
            interrupted = True
            result = _result(search, settings, start, None, interrupted=True)
        if interrupted:
            return run.ended(result, f"{search.evaluations} evaluations")
        return run.completed(result, "fit")


class _Search:
    """The least misfit, from several starts."""

    def __init__(self, misfit: Misfit, settings: FitSettings) -> None:
        self.misfit, self._starts = misfit, _starts(len(misfit.parameters), settings.starts)
        self._coarse = misfit.coarse(_COARSE)
        self.best: Float | None = None
        self.minima: list[tuple[float, Float]] = []
        """Misfit and place of the minima that were found, the least first."""

    @property
    def evaluations(self) -> int:
        """How often all measurements were predicted."""
        return self._coarse.evaluations + self.misfit.evaluations

    def run(self, progress: Progress) -> None:
        """Look from all starts with few harmonics, and follow the best with all.

        A resonance that passes from frequency to frequency of a curve makes the sum of the squares
        a row of valleys. The robust sum has few, and the deepest beside that of the squares. Where
        the model does not fit, its least squares may lie elsewhere: without a known noise they are
        looked for at once, and with it where nothing lies within the noise.
        """
        tell = progress if progress is not None else lambda _: None
        order, scale = self._compared(tell)
        self.best = order[0]
        ends: list[tuple[float, Float]] = []
        for one in (scale, None) if self.misfit.noise_known else (None, scale):
            agreed = self._follow(order, one, ends)
            if (agreed or self.misfit.noise_known) and self._is_enough(ends[0][0]):
                break
        tell(0.6)
        distinct = [
            end
            for place, (_, end) in enumerate(ends)
            if all(np.abs(end - other).max() > _SAME for _, other in ends[:place])
        ][:_FOLLOWED]
        # Few harmonics may have no minimum where all have one: starts are followed with all, too.
        for number, end in enumerate([*distinct, *order], 1):
            self.minima.append(self.misfit.least(end))
            least = min(one for one, _ in self.minima)
            if number >= min(_AGREED, len(distinct)) and self._is_enough(least):
                break
        self.minima.sort(key=lambda one: one[0])
        self.best = self.minima[0][1]
        tell(1.0)

    def _follow(
        self, starts: Iterable[Float], scale: float | None, ends: list[tuple[float, Float]]
    ) -> bool:
        """Follow starts until some lead to the same minimum; return whether they did.

        The minima join the `ends`, the least first.
        """
        own: list[tuple[float, Float]] = []
        for start in starts:
            own.append(self._coarse.least(start, scale=scale))
            ends.append(own[-1])
            ends.sort(key=lambda one: one[0])
            self.best = ends[0][1]
            least = min(own, key=lambda one: one[0])[1]
            if sum(np.abs(end - least).max() < _SAME for _, end in own) >= _AGREED:
                return True
        return False

    def _compared(self, tell: Callable[[float], None]) -> tuple[list[Float], float]:
        """Return the best starts, the best first, and the size of a usual residual of them all."""
        residuals, found = [], []
        for number, start in enumerate(self._starts, 1):
            here = self._coarse.at(start)
            residuals.append(here.residuals)
            found.append(any(test.solved.any() for test in here.predictions))
            tell(0.3 * number / len(self._starts))
        if not any(found):
            raise ModelError(
                "fit: no prediction could be solved from any start; narrow the bounds of the "
                "parameters, or look at the forced response of the model"
            )
        scale = float(np.median(np.abs(residuals))) or 1.0
        heights = [
            robust(one, scale) if known else np.inf
            for one, known in zip(residuals, found, strict=True)
        ]
        return [self._starts[at] for at in np.argsort(heights)[:_FOLLOWED]], scale

    def _is_enough(self, least: float) -> bool:
        """Whether no better minimum need be there: with a known noise, the model fits within it."""
        return not self.misfit.noise_known or least <= self.misfit.expected


def _starts(count: int, number: int) -> list[Float]:
    """Return places between the bounds: the middle, and a low-discrepancy sequence.

    Multiples of the powers of 1/g modulo 1, with g^(k+1) = g + 1, which fill k dimensions evenly
    (Roberts 2018).
    """
    g = 2.0
    for _ in range(40):
        g = (1.0 + g) ** (1.0 / (count + 1))
    steps = g ** -np.arange(1.0, count + 1.0)
    return [(0.5 + place * steps) % 1.0 for place in range(number)]


def _result(
    search: _Search,
    settings: FitSettings,
    start: float,
    progress: Progress,
    *,
    interrupted: bool = False,
) -> Fit:
    """Return what the best fit says."""
    from scipy.special import ndtri, stdtrit

    misfit, best = search.misfit, np.array(search.best)
    here = misfit.at(best)
    freedom = here.residuals.size - best.size
    known = misfit.measured[0].noise_known
    tail = 0.5 * (1.0 + settings.confidence)
    variance, quantile = 1.0, float(ndtri(tail))
    if not known:
        variance = here.misfit / freedom if freedom else np.nan
        quantile = float(stdtrit(freedom, tail)) if freedom else np.nan
    spread = covariance(here.jacobian, variance)
    ends = covariance_ends(best, spread, quantile)
    if not interrupted and settings.intervals == "profile" and np.isfinite(variance * quantile):
        tell = progress if progress is not None else lambda _: None
        ends = profile_ends(misfit, best, variance, quantile, tell)
    values = misfit.values(best)
    predicted = [one.values for one in here.predictions]
    arrays = FitArrays(
        value=values,
        interval=np.stack([misfit.values(ends.low), misfit.values(ends.high)], axis=1),
        open_end=~ends.found,
        correlation=_correlation(spread),
        abscissa=np.concatenate([one.abscissa for one in misfit.measured]),
        observed=np.concatenate([one.observed for one in misfit.measured]),
        deviation=np.concatenate([one.deviation for one in misfit.measured]),
        predicted=np.concatenate(predicted),
        solved=np.concatenate([one.solved for one in here.predictions]),
        test_kind=np.array([KINDS.index(one.kind) for one in misfit.measured], np.uint8),
        quantity=np.array(
            [QUANTITIES.index(what) for one in misfit.measured for what in one.quantities], np.uint8
        ),
        against=np.array([AGAINST.index(one.against) for one in misfit.measured], np.uint8),
        test=np.repeat(np.arange(len(predicted)), [one.size for one in predicted]),
        minimum=np.array([least for least, _ in search.minima]),
        minimum_value=np.stack([misfit.values(place) for _, place in search.minima])
        if search.minima
        else np.zeros((0, best.size)),
    )
    return Fit(
        model=applied(misfit.model, misfit.parameters, values),
        dofs=tuple(
            dict.fromkeys(
                one.of for one in misfit.measured if one.against in ("frequency", "amplitude")
            )
        ),
        settings=settings,
        arrays=arrays,
        noise_known=known,
        names=_names(misfit.measured),
        interrupted=interrupted,
        timings={"total": time.perf_counter() - start},
        counters={"evaluations": search.evaluations},
        diagnostics=fit_assumptions(arrays, settings, noise_known=known, freedom=freedom),
    )


def _correlation(spread: Float) -> Float:
    scale = np.sqrt(np.diag(spread))
    scale[scale == 0.0] = 1.0
    found: Float = np.clip(spread / np.outer(scale, scale), -1.0, 1.0)
    return found


def _names(tests: Sequence[Measured]) -> tuple[str, ...]:
    """Return a name for each test; numbers tell apart those of one name, and those without."""
    given = [test.name for test in tests]
    return tuple(
        f"{number}: {test.of if test.name is None else test.name}"
        if test.name is None or given.count(test.name) > 1
        else test.name
        for number, test in enumerate(tests, 1)
    )


def _tests(measured: Iterable[Measured]) -> tuple[Measured, ...]:
    tests = (
        (measured,)
        if isinstance(measured, Measured)
        else members(measured, "measured", "[ss.Measurement(...), ...]")
    )
    if not tests:
        raise ModelError("measured: empty; give at least one measurement")
    for number, one in enumerate(tests, 1):
        if not isinstance(one, Measured):
            raise ModelError(
                f"measured: entry {number}: {brief(one)} is no measurement; give ss.Measurement, "
                "ss.MeasuredPeak, ss.MeasuredLoop or ss.MeasuredBackbone"
            )
    if len({one.noise_known for one in tests}) > 1:
        unknown = next(n for n, one in enumerate(tests, 1) if not one.noise_known)
        raise ModelError(
            f"measured: entry {unknown}: its noise is not known and that of others is; give the "
            "noise of all, or of none"
        )
    return tests


def _require(
    test: Measured, model: Model, parameters: Iterable[FitParameter], settings: FitSettings
) -> None:
    """Refuse a test that the model does not fit."""
    for one in parameters:
        one.require(model)
    require_distinct(model, settings.parameters)
    if isinstance(test, Measurement | MeasuredPeak):
        known_dofs([test.dof], f"{test.kind}: dof", "dof", model)
        require_forced(model, settings)
        require_held(model, settings.residual)
    elif isinstance(test, MeasuredBackbone):
        if test.dof is not None:
            known_dofs([test.dof], f"{test.kind}: dof", "dof", model)
        require_held(model, settings.residual)
    elif isinstance(test, MeasuredLoop):
        contact = model.contacts[model.contact_index(test.contact)]
        if contact.displacements != 1:
            raise ModelError(
                f"measured loop: contact {contact.name!r} has {contact.displacements} "
                "displacements; loops are fitted of contacts with one"
            )
