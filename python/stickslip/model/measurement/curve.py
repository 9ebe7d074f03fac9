"""Response curves, their peaks and hysteresis loops that tests have measured."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import brief, choice, constant, set_fields, text
from stickslip.errors import ModelError
from stickslip.model.measurement.measured import MEASURES, Measured, above_zero, real_numbers
from stickslip.model.model import ContactRef, Model, require_model
from stickslip.units import physical_number

if TYPE_CHECKING:
    from stickslip.io.frf import Frf

_FEWEST = 8
"""Samples of a loop from which its harmonics are known."""
_ENDS = 2


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Measurement(Measured):
    """A response curve that was measured at one level of the forces.

    Parameters
    ----------
    omega : array_like of float, shape (n,)
        Angular frequencies [rad/s], in the order in which they were swept.
    dof : str
        The degree of freedom that was measured.
    amplitude : array_like of float, shape (n,)
        Amplitudes, above 0 [m].
    measure : {"half_range", "max", "fundamental"}, optional
        What was called amplitude; of a frequency analyser "fundamental".
    relative_noise : float, optional
        Standard deviation of each amplitude over itself, 0.02 for 2 %.
    noise : float, optional
        Instead: standard deviation of all amplitudes [m]. Default: unknown, and estimated by the
        fit as a share of the amplitudes.
    model : Model, optional
        The model of this test, at its own level or preload. Default: that of the fit.
    name : str, optional
        What tables and pictures call it.

    Raises
    ------
    ModelError
        If the lists differ in length, or a number is not finite or not above 0.
    """

    kind: ClassVar[str] = "measurement"

    omega: NDArray[np.float64]
    dof: str
    amplitude: NDArray[np.float64]
    measure: Any

    def __init__(
        self,
        omega: ArrayLike,
        dof: str,
        amplitude: ArrayLike,
        measure: str = "half_range",
        relative_noise: float | None = None,
        noise: float | None = None,
        model: Model | None = None,
        name: str | None = None,
    ) -> None:
        grid = real_numbers(omega, "rad/s", "measurement: omega", above=0.0)
        values = real_numbers(amplitude, "m", "measurement: amplitude", above=0.0)
        if grid.shape != values.shape:
            raise ModelError(
                f"measurement: {grid.size} frequencies for {values.size} amplitudes; give one "
                "amplitude per frequency"
            )
        place = text(dof, "measurement: dof")
        self._keep(
            of=place,
            abscissa=grid,
            observed=values,
            omega=grid,
            dof=place,
            amplitude=values,
            measure=choice(measure, "measurement: measure", MEASURES),
            relative_noise=relative_noise,
            noise=noise,
            model=model,
            name=name,
        )

    @classmethod
    def of_frf(cls, frf: Frf, dof: str, force: float | None = None, **more: Any) -> Measurement:
        """Return the curve of a frequency response function, as `read_frf` reads it.

        Parameters
        ----------
        frf : Frf
            Motion per force, of displacements, velocities or accelerations.
        dof : str
            The degree of freedom of the model that it was measured at.
        force : float, optional
            Amplitude of the force in the test [N]. Default: that of the force of `model`.
        **more
            Noise, model and name.

        Raises
        ------
        ModelError
            If there is neither a force nor a model that has one.
        """
        if force is None and more.get("model") is None:
            raise ModelError(
                "measurement: force: missing; give its amplitude in the test [N], or the model"
            )
        given = only_force(more["model"]) if force is None else force
        level = physical_number(given, "N", "measurement: force")
        kept = frf.omega > 0.0
        omega, amplitude = frf.omega[kept], abs(level) * np.abs(frf.receptance()[kept])
        return cls(omega, dof, amplitude, "fundamental", **more)

    def times(self, factor: float) -> Self:
        """Return the curve with its amplitudes multiplied."""
        made = copy(self)
        amplitude = constant(factor * self.amplitude)
        set_fields(made, amplitude=amplitude, observed=amplitude)
        return made


def only_force(model: Model) -> float:
    """Return the amplitude of the one force of the first harmonic that a model has [N]."""
    require_model(model)
    found = [abs(one.amplitude) for one in model.forces if one.harmonic == 1]
    if len(found) != 1:
        raise ModelError(
            f"measurement: force: missing, and the model has {len(found)} forces of harmonic 1; "
            "give the amplitude of that of the test [N]"
        )
    return found[0]


@dataclass(frozen=True, init=False, eq=False, repr=False)
class MeasuredLoop(Measured):
    """A hysteresis loop: the force of a contact under a displacement that repeats itself.

    Parameters
    ----------
    contact : int or str
        The contact; it has one displacement.
    displacement : array_like of float, shape (n,)
        Relative displacement at equidistant instants of one period [m]. A last sample that
        repeats the first, as of a loop that is drawn closed, is left out.
    force : array_like of float, shape (n,)
        The force against it at these instants [N].
    harmonics : int, optional
        Highest harmonic of the displacement; what lies above is taken for noise.
    relative_noise : float, optional
        Standard deviation of the forces over the largest one.
    noise : float, optional
        Instead: standard deviation of the forces [N].
    model, name
        See `Measurement`.

    Raises
    ------
    ModelError
        If the lists differ in length, have fewer than eight entries, or a number is not finite.
    """

    kind: ClassVar[str] = "measured loop"
    against: ClassVar[str] = "displacement"
    noise_unit: ClassVar[str] = "N"

    contact: ContactRef
    displacement: NDArray[np.float64]
    force: NDArray[np.float64]
    harmonics: int

    def __init__(
        self,
        contact: ContactRef,
        displacement: ArrayLike,
        force: ArrayLike,
        *,
        harmonics: int = 5,
        relative_noise: float | None = None,
        noise: float | None = None,
        model: Model | None = None,
        name: str | None = None,
    ) -> None:
        u = real_numbers(displacement, "m", "measured loop: displacement")
        f = real_numbers(force, "N", "measured loop: force")
        if u.shape == f.shape and u.size > _FEWEST and (u[0], f[0]) == (u[-1], f[-1]):
            u, f = u[:-1], f[:-1]
        if u.shape != f.shape or u.size < _FEWEST:
            raise ModelError(
                f"measured loop: {u.size} displacements for {f.size} forces; give one force per "
                f"displacement, at least {_FEWEST}"
            )
        if not isinstance(harmonics, int) or not 1 <= harmonics < u.size // 2:
            raise ModelError(
                f"measured loop: harmonics: {brief(harmonics)}; give a whole number from 1 to "
                f"{u.size // 2 - 1}, below half of the {u.size} instants"
            )
        self._keep(
            of=brief(contact) if not isinstance(contact, str) else contact,
            abscissa=u,
            observed=f,
            contact=contact,
            displacement=u,
            force=f,
            harmonics=harmonics,
            relative_noise=relative_noise,
            noise=noise,
            model=model,
            name=name,
        )

    @property
    def quantities(self) -> Sequence[str]:
        """Forces."""
        return ("force",) * self.force.size

    @property
    def _size(self) -> NDArray[np.float64]:
        return np.full(self.force.shape, np.abs(self.force).max())

    @property
    def series(self) -> NDArray[np.complex128]:
        """Harmonics of the displacement, u(t) = Re sum_k U_k exp(i k omega t), shape (H+1,) [m]."""
        found = np.fft.rfft(self.displacement)[: self.harmonics + 1] / self.displacement.size
        found[1:] *= 2.0
        return found


@dataclass(frozen=True, init=False, eq=False, repr=False)
class MeasuredPeak(Measured):
    """The peak of a response curve: its height, and where it lies if that is known.

    Parameters
    ----------
    dof : str
        The degree of freedom that was measured.
    amplitude : float
        Height of the peak [m].
    omega : float, optional
        Angular frequency of the peak [rad/s].
    span : tuple of float
        Range of frequencies in which it is the highest point [rad/s].
    frequency_noise : float, optional
        Standard deviation of the frequency over itself, 0.001 for 0.1 %; needed with `omega`.
    measure, relative_noise, noise, model, name
        See `Measurement`. With `omega` the noise of the height has to be known.

    Raises
    ------
    ModelError
        If a number is not finite or not above 0, the range has no two ends, or the noise of a
        frequency is not known.
    """

    kind: ClassVar[str] = "measured peak"

    dof: str
    span: tuple[float, float]
    measure: Any
    frequency_noise: float | None

    def __init__(
        self,
        dof: str,
        amplitude: float,
        omega: float | None = None,
        *,
        span: tuple[float, float],
        measure: str = "half_range",
        relative_noise: float | None = None,
        frequency_noise: float | None = None,
        noise: float | None = None,
        model: Model | None = None,
        name: str | None = None,
    ) -> None:
        ends = real_numbers(span, "rad/s", "measured peak: span", above=0.0)
        if ends.size != _ENDS or ends[0] == ends[1]:
            raise ModelError(f"measured peak: span: {brief(span)}; give (from, to) in rad/s")
        found = [real_numbers([amplitude], "m", "measured peak", above=0.0)]
        if omega is not None:
            found.append(real_numbers([omega], "rad/s", "measured peak: omega", above=0.0))
        values = np.concatenate(found)
        values.flags.writeable = False
        known = noise is not None or relative_noise is not None
        if omega is not None and (frequency_noise is None or not known):
            raise ModelError(
                "measured peak: omega without its noise; give frequency_noise, and relative_noise "
                "or noise of the height, or leave omega out"
            )
        place = text(dof, "measured peak: dof")
        self._keep(
            of=place,
            abscissa=np.full(values.size, values[1] if values.size > 1 else np.nan),
            observed=values,
            dof=place,
            span=(float(ends.min()), float(ends.max())),
            measure=choice(measure, "measured peak: measure", MEASURES),
            frequency_noise=above_zero(frequency_noise, "", "measured peak: frequency_noise"),
            relative_noise=relative_noise,
            noise=noise,
            model=model,
            name=name,
        )

    @property
    def quantities(self) -> Sequence[str]:
        """The height, and behind it the frequency if it is known."""
        return ("amplitude", "omega")[: self.observed.size]

    @property
    def deviation(self) -> NDArray[np.float64]:
        """Standard deviation of height and frequency."""
        found = np.array(super().deviation)
        if self.frequency_noise is not None and found.size > 1:
            found[1] = self.frequency_noise * self.observed[1]
        return found
