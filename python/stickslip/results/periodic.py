"""What all results of periodic motions have, and beside that the curves over frequency."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Hashable
from functools import cached_property
from numbers import Integral
from typing import Any, ClassVar, get_args

import numpy as np

from stickslip.checks import brief, choice, constant, text, whole_number
from stickslip.errors import ModelError
from stickslip.model import PointRef
from stickslip.results.arrays import Arrays, Measure, PeriodicArrays, amplitude_of, period_of
from stickslip.results.fields import Bool, Complex, Float, Int, Shown
from stickslip.results.result import Attributes, ColumnResult
from stickslip.results.status import Status
from stickslip.settings.balance import ForcedSettings
from stickslip.settings.orbits import ExactSettings
from stickslip.units import physical_number

_DIGITS = 1e-6
"""Share of a frequency by which one that is printed may lie outside those computed."""


class PeriodicMotions(ColumnResult):
    """Periodic motions, one after the other."""

    headline = "amplitude"

    arrays: PeriodicArrays

    @cached_property
    def status(self) -> tuple[Status, ...]:
        """How each point ended; ``status[i].advice`` says what to do about it."""
        return tuple(map(Status.from_code, self.arrays.status.tolist()))

    @abstractmethod
    def amplitude(self, dof: str, measure: Measure = "half_range") -> Float:
        """Return the amplitude of a displacement, motion by motion, shape (n,) [m].

        Exact extrema of the harmonic series or of the orbits, not those of samples.
        """

    def coefficients(self, dof: str) -> Complex:
        """Return the harmonics of a displacement, shape (n, H+1) [m].

        They are the X_k of x(t) = Re sum_k X_k exp(i k omega t); at points that did not converge
        the last iterate, kept for diagnosis.
        """
        return self.arrays.displacement[:, :, self._column(dof)]

    def error_estimate(self, dof: str) -> Float:
        """Return what could still change in a displacement, shape (n,) [m].

        The discarded harmonics of the contact forces, pushed through the compliance; of a marched
        evaluation with the error of its samples, which alone is `arrays.sampling_error`. Of exact
        orbits what their gap could change, of exact limit cycles 0.
        """
        return self.arrays.error_estimate[:, self._column(dof)]

    def slip_fraction(self, contact: PointRef) -> Float:
        """Return the share of the period that each contact point slips, shape (n, points) or (n,).

        From 0, it never slips, to 1. An open contact does not slip.
        """
        return self._share(contact, 0)

    def open_fraction(self, contact: PointRef) -> Float:
        """Return the share of the period that each contact point is open.

        Returns
        -------
        ndarray of float64, shape (n, points) or (n,)
            0, if the law has no normal force that could vanish.
        """
        number, _ = self.locate(contact)
        if "N" in self.model.contacts[number].components:
            return self._share(contact, -1)
        return constant(0.0 * self._share(contact, 0))

    def _share(self, contact: PointRef, component: int) -> Float:
        """Return the column of a component of each point: see `PeriodicArrays.slip_fraction`."""
        return self._by_node(self.arrays.slip_fraction, contact)[..., component]

    def _by_node(self, values: Float, contact: PointRef) -> Float:
        """Return the components of each point along the last axis."""
        number, point = self.locate(contact)
        own = self.model.contacts[number]
        columns = values[..., self._columns(number, point)]
        nodes = () if point is not None else (own.points,)
        return columns.reshape(*values.shape[:-1], *nodes, own.displacements // own.points)

    def dissipation(self, contact: PointRef) -> Float:
        """Return the work that each contact point loses to friction per cycle [J].

        Of a contact or one of its points, shape (n, points) or (n,).
        """
        return constant(self._by_node(self.arrays.dissipation, contact).sum(axis=-1))

    def position(self, index: int) -> int:
        """Return the position of a motion, counted from 0.

        Position from 0.
        """
        count = self.arrays.omega.size
        if isinstance(index, bool) or not isinstance(index, Integral):
            raise ModelError(
                f"index: {brief(index)} is not an integer; see omega for the positions, or "
                "ask a curve for that of a frequency, index(omega)"
            )
        if not -count <= index < count:
            raise ModelError(f"index: {index}; there are {count} points, 0 to {count - 1}")
        return int(index) % count

    def _further_variables(self, *, derived: bool) -> dict[Hashable, Any]:
        return self._amplitude_variable(self.amplitude) if derived else {}


class Sweep(PeriodicMotions):
    """The points of a result.

    Attributes
    ----------
    half_wave : bool
        Whether only odd harmonics were solved for, because forces and laws are half-wave symmetric.
    """

    settings_class = ForcedSettings
    attributes: ClassVar[Attributes] = {"interrupted": bool, "half_wave": bool}

    settings: ForcedSettings | ExactSettings
    arrays: Arrays
    half_wave: bool

    omega = Shown[Float]()
    harmonics = Shown[Int]()
    samples = Shown[Int]()
    residual = Shown[Float]()
    iterations = Shown[Int]()

    @cached_property
    def converged(self) -> Bool:
        """Whether each point is solved and meets every tolerance, shape (n,)."""
        return constant(self.arrays.status == Status.CONVERGED.code)

    def index(self, omega: float) -> int:
        """Return the position of the computed point nearest to a frequency.

        Position; of several equally near points the first. On a curve that folds the point beside
        a peak is that of `peak_index`.

        Parameters
        ----------
        omega : float
            Angular frequency [rad/s], one of those that the points span.

        Raises
        ------
        ModelError
            If it is no number, or lies outside the computed frequencies.
        """
        return self.nearest(physical_number(omega, "rad/s", "omega"), "omega:")

    def nearest(self, omega: float, entry: str) -> int:
        """Return the same of a frequency [rad/s], which messages call the `entry`."""
        low, high = float(self.omega.min()), float(self.omega.max())
        if not low * (1.0 - _DIGITS) <= omega <= high * (1.0 + _DIGITS):
            raise ModelError(
                f"{entry} {omega:.6g} rad/s lies outside the computed {low:.6g} to {high:.6g} "
                "rad/s; choose a frequency in between"
            )
        return int(np.abs(self.omega - omega).argmin())

    @cached_property
    def _amplitudes(self) -> dict[tuple[str, Measure], Float]:
        return {}

    def amplitude(self, dof: str, measure: Measure = "half_range") -> Float:
        """Return the amplitude of a displacement over frequency, shape (n,) [m].

        Exact extrema of the harmonic series or of the orbits, not those of samples.
        """
        key = key_of(dof, measure)
        if key not in self._amplitudes:
            self._amplitudes[key] = constant(self._amplitude(dof, measure))
        return self._amplitudes[key]

    def _amplitude(self, dof: str, measure: Measure) -> Float:
        values = amplitude_of(np.ascontiguousarray(self.coefficients(dof)), measure)
        return np.where(self.arrays.solved, values, np.nan)

    def phase(self, dof: str) -> Float:
        """Return the phase of the fundamental, x_1(t) = |X_1| cos(omega t + phase), shape (n,).

        Phase lead, between -pi and pi [rad]; not-a-number where there is no fundamental.
        """
        fundamental = self.coefficients(dof)[:, 1]
        known = self.arrays.solved & (fundamental != 0.0)
        return constant(np.where(known, np.angle(fundamental), np.nan))

    def waveform(self, dof: str, index: int, samples: int = 256) -> Float:
        """Return one period of a displacement, shape (samples,) [m]."""
        return self._period(self.coefficients(dof), index, samples)

    def _period(self, series: Complex, index: int, samples: int) -> Float:
        position = self.position(index)
        if not self.arrays.solved[position]:
            count = whole_number(samples, "samples", smallest=1)
            return constant(np.full((count, *series.shape[2:]), np.nan))
        kept = int(self.arrays.harmonics[position]) + 1
        return period_of(series[position, :kept], samples)


def key_of(dof: str, measure: Measure) -> tuple[str, Measure]:
    """Return a degree of freedom and a measure by which amplitudes are kept, or refuse them."""
    choice(measure, "measure", get_args(Measure))
    return text(dof, "dof"), measure
