"""What an analysis returns: immutable, with status, error and assumptions beside the numbers."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Literal, get_args

import numpy as np

from stickslip.checks import choice, text
from stickslip.model import PointRef
from stickslip.results.arrays import Float, Measure, amplitude_of, constant
from stickslip.results.blades import BladeMotion
from stickslip.results.certificate import Certificate
from stickslip.results.energy import Energy, energy_of
from stickslip.results.peaks import Peak, Summary, rows, summits
from stickslip.results.sensitivities import Sensitivities

if TYPE_CHECKING:
    from typing import Unpack

    import xarray as xr
    from matplotlib.axes import Axes

    from stickslip.plot.options import CurveOptions, Frame, LoopOptions

__all__ = ["ForcedResponse", "Measure", "Peak", "Summary", "key_of"]


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class ForcedResponse(BladeMotion, Sensitivities):
    """Steady response to periodic forces over the excitation frequency.

    Amplitudes and all that derives from them are not-a-number at points that were not solved;
    `status` says why. Degrees of freedom are addressed by name, contacts by position or name, and
    one contact point as (contact, point). Angular frequencies are in rad/s, displacements in m,
    forces in N. Arrays are read-only.

    Attributes
    ----------
    model : Model
        What was computed.
    settings : Settings
        How.
    arrays : Arrays
        Every number by its name, for all dofs and contact points at once.
    dofs : tuple of str
        The observed degrees of freedom.
    half_wave : bool
        Whether only odd harmonics were solved for, because forces and laws are half-wave symmetric.
    interrupted : bool
        Whether the run was stopped before its end.
    timings : mapping of float
        Seconds by stage.
    counters : mapping of int
        Evaluations by kind.
    diagnostics : tuple of Diagnostic
        What was taken for granted, what puts the numbers in doubt, and what is missing.
    certificate : Certificate or None
        The comparison with exact orbits that `stickslip.certify` made.
    """

    kind: ClassVar[str] = "forced_response"
    title = "Forced response of a structure with dry friction, by harmonic balance"

    half_wave: bool
    certificate: Certificate | None = None
    _amplitudes: dict[tuple[str, Measure], Float] = field(default_factory=dict, init=False)
    _peaks: dict[tuple[str, Measure], Peak] = field(default_factory=dict, init=False)

    def __repr__(self) -> str:
        omega = self.omega
        solved = "all solved" if self.arrays.solved.all() else f"{self.arrays.solved.sum()} solved"
        return (
            f"{type(self).__name__}({omega.size} points from {omega.min():g} to {omega.max():g} "
            f"rad/s ({solved}), {len(self.dofs)} dofs, harmonics={self.settings.harmonics!r})"
        )

    def amplitude(self, dof: str, measure: Measure = "half_range") -> Float:
        """Return the amplitude of a displacement over frequency.

        Parameters
        ----------
        dof : str
            An observed degree of freedom.
        measure : {"half_range", "max", "fundamental"}, optional
            Half the peak-to-peak range over a period, the largest |x|, or |X_1|.

        Returns
        -------
        ndarray of float64, shape (n,)
            [m]. Exact extrema of the harmonic series, not those of samples.

        Raises
        ------
        ModelError
            If there is no such degree of freedom or measure, or the former was not observed.
        """
        key = key_of(dof, measure)
        if key not in self._amplitudes:
            values = amplitude_of(np.ascontiguousarray(self.coefficients(dof)), measure)
            self._amplitudes[key] = constant(np.where(self.arrays.solved, values, np.nan))
        return self._amplitudes[key]

    def phase(self, dof: str) -> Float:
        """Return the phase of the fundamental, x_1(t) = |X_1| cos(omega t + phase).

        Parameters
        ----------
        dof : str
            An observed degree of freedom.

        Returns
        -------
        ndarray of float64, shape (n,)
            Phase lead, between -pi and pi [rad]; not-a-number where there is no fundamental.

        Raises
        ------
        ModelError
            If there is no such degree of freedom, or it was not observed.
        """
        fundamental = self.coefficients(dof)[:, 1]
        known = self.arrays.solved & (fundamental != 0.0)
        return constant(np.where(known, np.angle(fundamental), np.nan))

    def waveform(self, dof: str, index: int, samples: int = 256) -> Float:
        """Return one period of a displacement.

        Parameters
        ----------
        dof : str
            An observed degree of freedom.
        index : int
            Position of the point; negative ones count from the end.
        samples : int, optional
            Number of instants t = j T / samples, j = 0, 1, ...

        Returns
        -------
        ndarray of float64, shape (samples,)
            [m].

        Raises
        ------
        ModelError
            If there is no such degree of freedom or point, or the former was not observed.
        """
        return self._period(self.coefficients(dof), index, samples)

    def peak(self, dof: str, measure: Measure = "half_range") -> Peak:
        """Return the highest point of the response curve, between the computed points.

        The balance equations are solved anew over the range of the computed points: at every
        resonance that may be the highest, in whatever state of the contacts, and wherever the curve
        between two points may be higher.

        Parameters
        ----------
        dof : str
            An observed degree of freedom.
        measure : {"half_range", "max", "fundamental"}, optional
            See `amplitude`.

        Returns
        -------
        Peak
            `omega`, `amplitude` (not below any computed point, infinite where neither damping nor
            friction bounds it), `at_edge` and `beside_gap`.

        Raises
        ------
        ModelError
            If there is no such degree of freedom or measure, the former was not observed, or no
            point is solved.

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

    @cached_property
    def energy(self) -> Energy:
        """Work of the forces and energy lost, per period.

        Raises
        ------
        ModelError
            If a degree of freedom was not observed: all of them take part.
        """
        return energy_of(self)

    def _further_variables(self, *, derived: bool) -> dict[Hashable, Any]:
        made = {} if self.certificate is None else self.certificate.variables()
        if derived:
            meaning = "half peak-to-peak amplitude of the displacement"
            values = np.stack([self.amplitude(dof) for dof in self.dofs], axis=1)
            made["amplitude"] = (("omega", "dof"), values, {"units": "m", "long_name": meaning})
        return made

    @classmethod
    def _further_arguments(cls, dataset: xr.Dataset) -> dict[str, Any]:
        return {"certificate": Certificate.of_dataset(dataset)}

    def plot(self, dof: str, **options: Unpack[CurveOptions]) -> Axes:
        """Draw the response curve between its stuck and free limits.

        Parameters
        ----------
        dof : str
            An observed degree of freedom.
        **options
            See `stickslip.plot.curves`.

        Returns
        -------
        matplotlib.axes.Axes
            The axes.
        """
        from stickslip import plot

        return plot.curves(self, dof, **options)

    def plot_waveform(
        self,
        dof: str | Sequence[str],
        index: int,
        *,
        samples: int = 512,
        **options: Unpack[Frame],
    ) -> Axes:
        """Draw one period of one or several displacements.

        Parameters
        ----------
        dof : str or sequence of str
            Observed degrees of freedom.
        index : int
            Position of the point; negative ones count from the end.
        samples : int, optional
            Instants per period.
        **options
            See `stickslip.plot.waveform`.

        Returns
        -------
        matplotlib.axes.Axes
            The axes.
        """
        from stickslip import plot

        return plot.waveform(self, dof, index, samples=samples, **options)

    def plot_hysteresis(
        self, contact: PointRef, index: int | Sequence[int], **options: Unpack[LoopOptions]
    ) -> Axes:
        """Draw the contact force against the relative displacement.

        Parameters
        ----------
        contact : int, str or (int or str, int)
            The contact, or one of its points.
        index : int or sequence of int
            Positions of points, one loop each.
        **options
            See `stickslip.plot.hysteresis`.

        Returns
        -------
        matplotlib.axes.Axes
            The axes.
        """
        from stickslip import plot

        return plot.hysteresis(self, contact, index, **options)

    def plot_slip(
        self,
        contact: PointRef | None = None,
        *,
        ax: Axes | None = None,
        omega_unit: Literal["rad/s", "Hz"] = "rad/s",
    ) -> Axes:
        """Draw the share of the period that contacts slip.

        Parameters
        ----------
        contact : int, str or (int or str, int), optional
            The contact, or one of its points. Default: all.
        ax, omega_unit
            See `stickslip.plot.slip`.

        Returns
        -------
        matplotlib.axes.Axes
            The axes.
        """
        from stickslip import plot

        return plot.slip(self, contact, ax=ax, omega_unit=omega_unit)


def key_of(dof: str, measure: Measure) -> tuple[str, Measure]:
    """Return a degree of freedom and a measure by which amplitudes are kept, or refuse them."""
    choice(measure, "measure", get_args(Measure))
    return text(dof, "dof"), measure
