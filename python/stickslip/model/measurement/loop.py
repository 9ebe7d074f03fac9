"""Hysteresis loops of contacts that tests have measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import brief
from stickslip.errors import ModelError
from stickslip.model.measurement.measured import Measured, real_numbers
from stickslip.model.model import ContactRef, Model

_FEWEST = 8
"""Samples of a loop from which its harmonics are known."""


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
