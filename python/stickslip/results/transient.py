"""A motion from a start state, period after period."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from functools import cached_property
from typing import Any, ClassVar, Literal, get_args

import numpy as np

from stickslip.checks import brief, choice, text, whole_number
from stickslip.drawn import Drawn
from stickslip.errors import ModelError
from stickslip.model import PointRef
from stickslip.model.state import State
from stickslip.results.arrays import Measure, amplitude_in
from stickslip.results.events import KINDS, Events
from stickslip.results.fields import Code, Columns, Float, Int, Shown, column
from stickslip.results.result import Attributes, ColumnResult
from stickslip.results.spectrum import Spectrum, spectrum_of
from stickslip.results.status import Settled, TransientStatus
from stickslip.settings.motion import TransientSettings


class TransientArrays(Columns):
    """The numbers of a transient; a state is (x, v, f) of all dofs and contact points."""

    labels: ClassVar[Mapping[str, Sequence[str]]] = {"side": ("lowest", "highest")}

    time: Float = column("time", "s", "time since the start", least=0.0)
    displacement: Float = column("time dof", "m", "displacement")
    velocity: Float = column("time dof", "m/s", "velocity")
    contact_force: Float = column(
        "time point", "N", "contact force against the relative displacement"
    )
    contact_displacement: Float = column("time point", "m", "relative displacement at the contacts")
    poincare: Float = column(
        "section state_entry",
        "1",
        "state at the start and after each period (x in m, v in m/s, f in N)",
    )
    range: Float = column("period dof side", "m", "lowest and highest displacement in each period")
    change: Float = column(
        "period",
        "1",
        "change of the state over the period, relative to the motion in it, in the norm of energy: "
        "kinetic, elastic and that of the contact springs",
    )
    event_time: Float = column("event", "s", "time of the event since the start", least=0.0)
    event_point: Int = column(
        "event", "1", "contact point, over all contacts", least=0, most="point"
    )
    event_kind: Code = column("event", "1", "what happens", codes=KINDS)


class Transient(ColumnResult):
    """Motion under periodic forces from a start state, period after period.

    Degrees of freedom are addressed by name, contacts by position or name, and one contact point as
    (contact, point). Times are in s, displacements in m, forces in N. Arrays are read-only.

    Attributes
    ----------
    settled : bool
        Whether the change over a period came below the tolerance; False without one.
    unbounded : bool
        Whether the motion overflowed, and was cut there.
    """

    kind: ClassVar[str] = "transient"
    title = "Transient motion of a structure with dry friction"
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
    change = Shown[Float]()

    plot = Drawn("history")
    plot_contact_force = Drawn("contact_history")
    plot_phase = Drawn("phase")
    plot_poincare = Drawn("poincare")
    plot_spectrum = Drawn("spectrum")

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

        Raises ModelError if the motion is unbounded and has no finite state at its end.
        """
        return State.of_vector(self.model, self.arrays.poincare[-1])

    @cached_property
    def events(self) -> Events:
        """When contact points began to stick and to slip in the part kept; empty for rk4."""
        arrays = self.arrays
        return Events.of(self.model, arrays.event_time, arrays.event_point, arrays.event_kind)

    def displacement(self, dof: str) -> Float:
        """Return a displacement over `time`, shape (n,) [m]."""
        return self.arrays.displacement[:, self._column(dof)]

    def velocity(self, dof: str) -> Float:
        """Return a velocity over `time`, shape (n,) [m/s]; see `displacement`."""
        return self.arrays.velocity[:, self._column(dof)]

    def contact_force(self, contact: PointRef) -> Float:
        """Return the contact forces over `time`, shape (n, points) or (n,) [N].

        Positive against the relative displacement.
        """
        return self._with_balanced(self._select(self.arrays.contact_force, contact), contact)

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
        """
        structure = self.model.structure
        place = structure.index(text(dof, "dof"))
        states = self.arrays.poincare
        return states[:, place], states[:, len(structure) + place]

    def amplitudes(self, dof: str, measure: Literal["half_range", "max"] = "half_range") -> Float:
        """Return the amplitude of a displacement in each period, shape (P,) [m].

        From extrema, not samples.

        Parameters
        ----------
        measure : {"half_range", "max"}, optional
            Half the peak-to-peak range over the period, or the largest |x|.
        """
        choice(measure, "measure", ("half_range", "max"))
        return amplitude_in(self.arrays.range[:, self._column(dof)], measure)

    def amplitude(self, dof: str, measure: Measure = "half_range") -> float:
        """Return the amplitude of a displacement in the last period.

        [m]; not-a-number if not one period was completed. The fundamental is that of the samples of
        the period.
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

        `frequency` [Hz] and `density` [m^2/Hz]; the mean of the motion is taken out.

        Raises ModelError if there is no such window, or fewer periods are kept.

        Parameters
        ----------
        last : int, optional
            How many of the last periods to take. Default: all that are kept.
        segment : int, optional
            Periods per window: the resolution is the excitation frequency over it. Windows overlap
            by half and are averaged. Default: one window.
        window : str, optional
            As `scipy.signal.get_window` names it; "hann" for a motion that has not settled.
        """
        motion, kept = self.displacement(dof), self.kept_periods
        if not kept:
            raise ModelError("spectrum: not one whole period is kept; compute more periods")
        taken = whole_number(kept if last is None else last, "last", smallest=1, largest=kept)
        count = taken if segment is None else segment
        count = whole_number(count, "segment", smallest=1, largest=taken)
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
                f"window: {brief(name)} is none that its name alone determines; "
                "give 'boxcar' or 'hann'"
            ) from None

    @property
    def kept_periods(self) -> int:
        """How many whole periods at the end are kept in the time histories."""
        return min(self.time.size // self.settings.samples, self.periods)

    def summary(self) -> list[Settled]:
        """Return the amplitudes of the last period, one row per observed degree of freedom.

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
        return self._amplitude_variable(self.amplitudes, "period", "in each period")

    def _whole(self, motion: Float, periods: int) -> Float:
        """Return the samples of the last whole periods, without the instant that ends them."""
        samples = self.settings.samples
        end = motion.size - motion.size % samples
        return motion[end - periods * samples : end]
