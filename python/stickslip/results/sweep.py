"""What every curve over frequency has: its points, the motion at each of them, and its peak."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from typing import ClassVar, get_args

import numpy as np

from stickslip.checks import choice, real_number, text, whole_number
from stickslip.results.arrays import (
    Arrays,
    Bool,
    Complex,
    Float,
    Int,
    Measure,
    amplitude_of,
    constant,
)
from stickslip.results.fields import Shown
from stickslip.results.peaks import Peak, Summary, rows, summits
from stickslip.results.periodic import PeriodicMotions
from stickslip.results.result import Attributes
from stickslip.results.status import Status
from stickslip.settings.balance import ForcedSettings
from stickslip.settings.orbits import ExactSettings

__all__ = ["Sweep", "key_of"]


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

        Parameters
        ----------
        omega : float
            Angular frequency [rad/s].

        Returns
        -------
        int
            Position; of several equally near points the first.
        """
        return int(np.abs(self.omega - real_number(omega, "omega")).argmin())

    @cached_property
    def _amplitudes(self) -> dict[tuple[str, Measure], Float]:
        return {}

    @cached_property
    def _peaks(self) -> dict[tuple[str, Measure], Peak]:
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

    def peak(self, dof: str, measure: Measure = "half_range") -> Peak:
        """Return the highest point of the response curve, between the computed points.

        The balance equations are solved anew over the range of the computed points: at every
        resonance that may be the highest, in whatever state of the contacts, and wherever the curve
        between two points may be higher.

        Returns
        -------
        Peak
            `omega`, `amplitude` (not below any computed point, infinite where neither damping nor
            friction bounds it), `at_edge` and `beside_gap`.

        Raises
        ------
        ModelError
            If no point is solved.

        Warns
        -----
        UserWarning
            If a point beside the maximum is not solved, or nothing bounds the response.
        """
        key_of(dof, measure)
        return self._peaks_of([dof], measure)[0]

    def _peaks_of(self, dofs: Sequence[str], measure: Measure) -> list[Peak]:
        """Return the peaks of several degrees of freedom, found together."""
        groups = [[dof] for dof in dofs if (dof, measure) not in self._peaks]
        found = summits(self, groups, measure) if groups else []
        for (dof,), (_, peak) in zip(groups, found, strict=True):
            self._peaks[dof, measure] = peak
        return [self._peaks[dof, measure] for dof in dofs]

    def _highest_of(self, dofs: Sequence[str], measure: Measure) -> tuple[int, Peak]:
        """Return which of some degrees of freedom has the highest peak, and the peak."""
        return summits(self, [dofs], measure)[0]

    def summary(self, dofs: Iterable[str] | str | None = None) -> list[Summary]:
        """Return the peaks of degrees of freedom, one row each.

        Parameters
        ----------
        dofs : iterable of str, optional
            Observed degrees of freedom. Default: all.

        Returns
        -------
        list of Summary
            Empty if no point is solved.

        Raises
        ------
        ModelError
            If there is no such degree of freedom, or it was not observed.
        """
        return rows(self, self.dofs if dofs is None else dofs)

    def _period(self, series: Complex, index: int, samples: int) -> Float:
        position = self.position(index)
        count = whole_number(samples, "samples", smallest=1)
        if not self.arrays.solved[position]:
            return constant(np.full((count, *series.shape[2:]), np.nan))
        # Whole turns are dropped before the angle is formed: high harmonics keep all digits.
        kept = int(self.arrays.harmonics[position]) + 1
        turns = np.outer(np.arange(count), np.arange(kept)) % count
        turn = np.exp(2j * np.pi / count * turns)
        return constant(np.ascontiguousarray((turn @ series[position, :kept]).real))


def key_of(dof: str, measure: Measure) -> tuple[str, Measure]:
    """Return a degree of freedom and a measure by which amplitudes are kept, or refuse them."""
    choice(measure, "measure", get_args(Measure))
    return text(dof, "dof"), measure
