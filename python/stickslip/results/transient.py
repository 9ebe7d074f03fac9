"""A motion from a start state, period after period."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Literal, get_args

import numpy as np

from stickslip.checks import choice, text, whole_number
from stickslip.errors import ModelError
from stickslip.model import PointRef
from stickslip.model.state import State
from stickslip.results.arrays import Float, Measure, amplitude_in
from stickslip.results.events import Events
from stickslip.results.fields import Shown
from stickslip.results.result import Attributes, ColumnResult
from stickslip.results.spectrum import Spectrum, spectrum_of
from stickslip.results.transient_arrays import TransientArrays
from stickslip.results.transient_status import Settled, TransientStatus
from stickslip.settings.motion import TransientSettings

if TYPE_CHECKING:
    from typing import Unpack

    from matplotlib.axes import Axes

    from stickslip.plot.options import HistoryOptions, PoincareOptions, SpectrumOptions

__all__ = ["Transient"]


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Transient(ColumnResult):
    """Motion under periodic forces from a start state, period after period.

    Degrees of freedom are addressed by name, contacts by position or name, and one contact point as
    (contact, point). Times are in s, displacements in m, forces in N. Arrays are read-only.

    Attributes
    ----------
    settings : TransientSettings
        How it was computed.
    arrays : TransientArrays
        Every number by its name.
    settled : bool
        Whether the change over a period came below the tolerance; False without one.
    unbounded : bool
        Whether the motion overflowed, and was cut there.
    """

    kind: ClassVar[str] = "transient"
    title = "Transient motion of a structure with dry friction"
    columns = TransientArrays
    settings_class = TransientSettings
    attributes: ClassVar[Attributes] = {"interrupted": bool, "settled": bool, "unbounded": bool}

    settings: TransientSettings
    arrays: TransientArrays
    settled: bool
    unbounded: bool

    def __repr__(self) -> str:
        return (
            f"Transient({self.periods} periods at {self.omega:g} rad/s ({self.status}), "
            f"{len(self.dofs)} dofs, scheme={self.settings.scheme!r})"
        )

    @property
    def omega(self) -> float:
        """Angular frequency of the excitation [rad/s]."""
        return self.settings.omega

    @property
    def period(self) -> float:
        """Period of the excitation [s]."""
        return 2.0 * np.pi / self.settings.omega

    @property
    def periods(self) -> int:
        """Number of periods computed."""
        return self.arrays.change.size

    time = Shown[Float]()

    @property
    def change(self) -> Float:
        """Change of the state over each period, relative to the motion in it, shape (P,).

        In the norm of energy: kinetic, elastic and that of the contact springs.
        """
        return self.arrays.change

    @property
    def status(self) -> TransientStatus:
        """How the run ended; ``status.advice`` says what to do about it."""
        if self.unbounded:
            return TransientStatus.UNBOUNDED
        if self.interrupted:
            return TransientStatus.INTERRUPTED
        if self.settled:
            return TransientStatus.SETTLED
        if self.periods < self.settings.periods:
            return TransientStatus.HALTED
        asked = self.settings.tolerance is not None
        return TransientStatus.NOT_SETTLED if asked else TransientStatus.COMPLETED

    @cached_property
    def start(self) -> State:
        """The state at the start."""
        return State.of_vector(self.model, self.arrays.poincare[0])

    @cached_property
    def final(self) -> State:
        """The state after the last period; ``transient(..., start=result.final)`` goes on.

        Raises
        ------
        ModelError
            If the motion is unbounded and has no finite state at its end.
        """
        return State.of_vector(self.model, self.arrays.poincare[-1])

    @cached_property
    def events(self) -> Events:
        """When contact points began to stick and to slip in the part kept; empty for rk4."""
        arrays = self.arrays
        return Events(self.model, arrays.event_time, arrays.event_point, arrays.event_kind)

    def displacement(self, dof: str) -> Float:
        """Return a displacement over `time`.

        Parameters
        ----------
        dof : str
            An observed degree of freedom.

        Returns
        -------
        ndarray of float64, shape (n,)
            [m].

        Raises
        ------
        ModelError
            If there is no such degree of freedom, or it was not observed.
        """
        return self.arrays.displacement[:, self._column(dof)]

    def velocity(self, dof: str) -> Float:
        """Return a velocity over `time`, shape (n,) [m/s]; see `displacement`."""
        return self.arrays.velocity[:, self._column(dof)]

    def contact_force(self, contact: PointRef) -> Float:
        """Return the contact forces over `time`.

        Parameters
        ----------
        contact : int, str or (int or str, int)
            The contact, or one of its points.

        Returns
        -------
        ndarray of float64, shape (n, points) or (n,)
            [N], positive against the relative displacement.

        Raises
        ------
        ModelError
            If there is no such contact or point.
        """
        return self._select(self.arrays.contact_force, contact)

    def contact_displacement(self, contact: PointRef) -> Float:
        """Return the relative displacement at the contacts over `time` [m]; see `contact_force`."""
        return self._select(self.arrays.contact_displacement, contact)

    def poincare(self, dof: str) -> tuple[Float, Float]:
        """Return displacement and velocity at the start and after each period.

        Parameters
        ----------
        dof : str
            Any degree of freedom, observed or not.

        Returns
        -------
        displacement, velocity : ndarray of float64, shape (P+1,)
            [m], [m/s]. A motion of the period of the excitation ends in one point.

        Raises
        ------
        ModelError
            If there is no such degree of freedom.
        """
        structure = self.model.structure
        place = structure.index(text(dof, "dof"))
        states = self.arrays.poincare
        return states[:, place], states[:, len(structure) + place]

    def amplitudes(self, dof: str, measure: Literal["half_range", "max"] = "half_range") -> Float:
        """Return the amplitude of a displacement in each period.

        Parameters
        ----------
        dof : str
            An observed degree of freedom.
        measure : {"half_range", "max"}, optional
            Half the peak-to-peak range over the period, or the largest |x|.

        Returns
        -------
        ndarray of float64, shape (P,)
            [m]. From extrema, not samples.

        Raises
        ------
        ModelError
            If there is no such degree of freedom or measure, or the former was not observed.
        """
        choice(measure, "measure", ("half_range", "max"))
        return amplitude_in(self.arrays.range[:, self._column(dof)], measure)

    def amplitude(self, dof: str, measure: Measure = "half_range") -> float:
        """Return the amplitude of a displacement in the last period.

        Parameters
        ----------
        dof : str
            An observed degree of freedom.
        measure : {"half_range", "max", "fundamental"}, optional
            Half the peak-to-peak range, the largest |x|, both from extrema, or |X_1| from the
            samples of the period.

        Returns
        -------
        float
            [m]; not-a-number if not one period was completed.

        Raises
        ------
        ModelError
            If there is no such degree of freedom or measure, or the former was not observed.
        """
        choice(measure, "measure", get_args(Measure))
        motion = self.displacement(dof)
        if not self.periods:
            return float("nan")
        if measure != "fundamental":
            return float(self.amplitudes(dof, measure)[-1])
        count = self.settings.samples
        turn = np.exp(-2j * np.pi * np.arange(count) / count)
        return float(2.0 / count * np.abs(self._whole(motion, 1) @ turn))

    def spectrum(
        self,
        dof: str,
        *,
        last: int | None = None,
        segment: int | None = None,
        window: str = "boxcar",
    ) -> Spectrum:
        """Return the power spectral density of a displacement, by Welch's method.

        The windows are whole periods: the lines of a periodic motion at multiples of the
        excitation frequency then have no width, and need no taper.

        Parameters
        ----------
        dof : str
            An observed degree of freedom.
        last : int, optional
            How many of the last periods to take. Default: all that are kept.
        segment : int, optional
            Periods per window: the resolution is the excitation frequency over it. Windows overlap
            by half and are averaged. Default: one window.
        window : str, optional
            As `scipy.signal.get_window` names it; "hann" for a motion that has not settled.

        Returns
        -------
        Spectrum
            `frequency` [Hz] and `density` [m^2/Hz]; the mean of the motion is taken out.

        Raises
        ------
        ModelError
            If there is no such degree of freedom or window, or fewer periods are kept.
        """
        motion, kept = self.displacement(dof), self.kept_periods
        if not kept:
            raise ModelError("spectrum: not one whole period is kept; compute more periods")
        taken = kept if last is None else whole_number(last, "last", smallest=1, largest=kept)
        count = (
            taken
            if segment is None
            else whole_number(segment, "segment", smallest=1, largest=taken)
        )
        samples = self.settings.samples
        name = text(window, "window")
        try:
            return spectrum_of(
                self._whole(motion, taken),
                samples=samples,
                rate=samples / self.period,
                segment=count,
                window=name,
            )
        except ValueError:
            raise ModelError(
                f"window: {name!r} is none that its name alone determines; give 'boxcar' or 'hann'"
            ) from None

    @property
    def kept_periods(self) -> int:
        """How many whole periods at the end are kept in the time histories."""
        return min(self.time.size // self.settings.samples, self.periods)

    def summary(self) -> list[Settled]:
        """Return the amplitudes of the last period, one row per observed degree of freedom.

        Returns
        -------
        list of Settled
            Empty if not one period was completed.
        """
        rows = []
        for dof in self.dofs if self.periods else ():
            before, now = self.amplitudes(dof)[[-2, -1] if self.periods > 1 else [-1, -1]]
            known = self.periods > 1 and now > 0.0
            change = abs(now - before) / now if known else np.nan
            rows.append(Settled(dof, float(now), float(change)))
        return rows

    def _further_variables(self, *, derived: bool) -> dict[Hashable, Any]:
        if not derived:
            return {}
        meaning = "half peak-to-peak amplitude in each period"
        values = np.stack([self.amplitudes(dof) for dof in self.dofs], axis=1)
        return {"amplitude": (("period", "dof"), values, {"units": "m", "long_name": meaning})}

    def plot(self, dof: str, **options: Unpack[HistoryOptions]) -> Axes:
        """Draw a displacement over time; see `stickslip.plot.history`."""
        from stickslip import plot

        return plot.history(self, dof, **options)

    def plot_contact_force(
        self, contact: PointRef, *, ax: Axes | None = None, last: int | None = None
    ) -> Axes:
        """Draw contact forces over time; see `stickslip.plot.contact_history`."""
        from stickslip import plot

        return plot.contact_history(self, contact, ax=ax, last=last)

    def plot_phase(self, dof: str, **options: Unpack[HistoryOptions]) -> Axes:
        """Draw velocity over displacement; see `stickslip.plot.phase`."""
        from stickslip import plot

        return plot.phase(self, dof, **options)

    def plot_poincare(self, dof: str, **options: Unpack[PoincareOptions]) -> Axes:
        """Draw the states after each period; see `stickslip.plot.poincare`."""
        from stickslip import plot

        return plot.poincare(self, dof, **options)

    def plot_spectrum(self, dof: str, **options: Unpack[SpectrumOptions]) -> Axes:
        """Draw the power spectral density; see `stickslip.plot.spectrum`."""
        from stickslip import plot

        return plot.spectrum(self, dof, **options)

    def _whole(self, motion: Float, periods: int) -> Float:
        """Return the samples of the last whole periods, without the instant that ends them."""
        samples = self.settings.samples
        end = motion.size - motion.size % samples
        return motion[end - periods * samples : end]
