"""Peaks of response curves that tests have measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import brief, choice, text
from stickslip.errors import ModelError
from stickslip.model.measurement.measured import MEASURES, Measured, above_zero, real_numbers
from stickslip.model.model import Model

_ENDS = 2


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
