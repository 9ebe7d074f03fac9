"""Response curves that tests have measured."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import choice, constant, set_fields, text
from stickslip.errors import ModelError
from stickslip.model.measurement.measured import MEASURES, Measured, real_numbers
from stickslip.model.model import Model, require_model
from stickslip.units import physical_number

if TYPE_CHECKING:
    from stickslip.io.frf import Frf


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
