"""What models predict of measurements, and how that changes with parameters."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np

from stickslip import _core
from stickslip.analyses.damper_curve import damper_curve
from stickslip.analyses.fit_parameters import LEVEL, LOAD, FitParameter, applied
from stickslip.analyses.forced_response import forced_response
from stickslip.analyses.nonlinear_modes import nonlinear_modes
from stickslip.model import Model
from stickslip.model.measurement import (
    Measured,
    MeasuredBackbone,
    MeasuredLoop,
    MeasuredPeak,
    Measurement,
)
from stickslip.results.fields import Bool, Float
from stickslip.results.nonlinear_modes import NonlinearModes
from stickslip.results.status import Status
from stickslip.settings.balance import HarmonicSettings

_STEP = 1e-4
"""Step of differences, between the bounds of a parameter."""
_SMALL = 1e-3
"""Share of the least displacement at which a mode is as it is at rest."""
_CLOSE = 1e-9
"""Relative distance to a displacement at which its modal amplitude is found."""
_STEPS = 20
"""Most evaluations until then."""


class Prediction:
    """What a model predicts of a measurement, and its derivatives, which are made when asked for.

    The model is that of the measurement, or else `base`, at values of the parameters. Derivatives
    of curves in parameters of contacts and in the level of the forces are exact; those in the
    damping of the structure and in static loads, of peaks, loops and backbones are differences.
    """

    def __init__(
        self,
        measured: Measured,
        base: Model,
        parameters: Sequence[FitParameter],
        values: Float,
        settings: HarmonicSettings,
    ) -> None:
        self._measured, self._parameters, self._at = measured, parameters, values
        self._own = base if measured.model is None else measured.model
        self._settings = settings
        model = applied(self._own, parameters, values)
        self._found = PREDICTIONS[type(measured)](measured, model, settings)
        self.solved: Bool = np.isfinite(self._found.values)
        """(n,) Whether the number was found."""
        self.values: Float = np.where(self.solved, self._found.values, 0.0)
        """(n,) The numbers; 0 where none was found."""

    @cached_property
    def slopes(self) -> Float:
        """(n, k) The derivatives in the parameters; 0 where no number was found."""
        slopes = np.stack([self._slope(place) for place in range(self._at.size)], axis=1)
        slopes[~(np.isfinite(slopes) & self.solved[:, np.newaxis])] = 0.0
        return slopes

    def _slope(self, place: int) -> Float:
        one = self._parameters[place]
        if self._found.slope is None or one.is_damping or one.name == LOAD:
            return self._difference(place)
        return self._found.slope(one) / (self._at[place] if one.name == LEVEL else 1.0)

    def _difference(self, place: int) -> Float:
        """Return the derivatives in one parameter by a central difference within its bounds."""
        one = self._parameters[place]
        middle = one.scaled(float(self._at[place]))
        ends = [one.value(min(max(middle + step, 0.0), 1.0)) for step in (-_STEP, _STEP)]
        # Automatic harmonics may change with a step, which would be no derivative.
        fixed = self._settings.model_copy(update={"harmonics": self._found.orders})
        sides = []
        for end in ends:
            moved = np.array(self._at)
            moved[place] = end
            model = applied(self._own, self._parameters, moved)
            sides.append(PREDICTIONS[type(self._measured)](self._measured, model, fixed).values)
        slope: Float = (sides[1] - sides[0]) / (ends[1] - ends[0])
        return slope


class _Found(NamedTuple):
    values: Float
    """(n,) Numbers; not-a-number where there is none."""
    orders: int
    """The most harmonics kept."""
    slope: Callable[[FitParameter], Float] | None = None
    """Exact derivatives in a parameter that is none of the damping."""


def _curve(
    measured: Measurement,
    model: Model,
    settings: HarmonicSettings,
) -> _Found:
    keys = settings.part(HarmonicSettings)
    result = forced_response(model, measured.omega, observe=[measured.dof], stability=False, **keys)

    def slope(one: FitParameter) -> Float:
        return result.sensitivity(measured.dof, one.owner or None, one.key, measured.measure)

    amplitude = np.where(result.converged, result.amplitude(measured.dof, measured.measure), np.nan)
    return _Found(amplitude, max(int(result.harmonics.max()), 1), slope)


def _peak(
    measured: MeasuredPeak,
    model: Model,
    settings: HarmonicSettings,
) -> _Found:
    curve = damper_curve(
        model,
        level=[1.0],
        dof=measured.dof,
        omega=measured.span,
        measure=measured.measure,
        **settings.part(HarmonicSettings),
    )
    found = np.array([curve.amplitude[0], curve.omega[0]])[: measured.observed.size]
    return _Found(found, max(int(curve.harmonics.max()), 1))


def _loop(
    measured: MeasuredLoop,
    model: Model,
    settings: HarmonicSettings,
) -> _Found:
    number = model.contact_index(measured.contact)
    series = np.ascontiguousarray(measured.series[np.newaxis])
    residual = "centred" if settings.residual is None else settings.residual
    force = _core.contact_force(
        model.problem, model.law_index(number), series, residual, (0, False), measured.force.size
    )
    return _Found(np.ravel(force), measured.harmonics)


def _backbone(
    measured: MeasuredBackbone,
    model: Model,
    settings: HarmonicSettings,
) -> _Found:
    wanted, place = np.unique(measured.amplitude, return_inverse=True)
    modes = _modes_at(measured, model, settings, wanted)
    if modes is None:
        return _Found(np.full(measured.observed.size, np.nan), 1)
    solved = modes.arrays.status == Status.CONVERGED.code
    columns = {"omega": modes.omega, "damping_ratio": modes.damping_ratio}
    found = [np.where(solved, columns[one], np.nan)[place] for one in measured.columns]
    return _Found(np.concatenate(found), max(int(modes.harmonics.max(initial=1)), 1))


def _modes_at(
    measured: MeasuredBackbone, model: Model, settings: HarmonicSettings, wanted: Float
) -> NonlinearModes | None:
    """Return the mode at rising amplitudes of what was measured, None if it has no beginning.

    The modal amplitude of a displacement is found by the secant method, in logarithms: the two are
    proportional but for the change of the shape. An amplitude without a motion stays where it is.
    """
    keys = settings.part(HarmonicSettings)

    def modes(amplitude: Float) -> NonlinearModes:
        return nonlinear_modes(model, amplitude=amplitude, mode=measured.mode, **keys)

    if measured.dof is None:
        return modes(wanted)
    small = modes(_SMALL * wanted[:1])
    share = small.displacement_amplitude(measured.dof, measured.measure) / small.amplitude
    if not np.isfinite(share).all():
        return None
    at, rate = np.log(wanted / share), np.ones(wanted.size)
    before, there = at, np.full(wanted.size, np.nan)
    for _ in range(_STEPS):
        found = modes(np.exp(at))
        here = np.log(found.displacement_amplitude(measured.dof, measured.measure) / wanted)
        off = np.abs(here) > _CLOSE
        if not off.any():
            break
        with np.errstate(invalid="ignore", divide="ignore"):
            secant = (here - there) / (at - before)
        rate = np.where(np.isfinite(secant) & (secant > 0.1), secant, rate)
        before, there = at, here
        at = np.where(off, at - here / rate, at)
    return found


PREDICTIONS: Mapping[type[Measured], Callable[..., _Found]] = {
    Measurement: _curve,
    MeasuredPeak: _peak,
    MeasuredLoop: _loop,
    MeasuredBackbone: _backbone,
}
"""How each kind of measurement is predicted."""
