"""What every measurement has: numbers, what they are, and how far they are to be trusted."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import constant, real_array, set_fields, text
from stickslip.errors import EntryError, ModelError
from stickslip.model.model import Model, require_model
from stickslip.units import physical_number, without_units

MEASURES = ("half_range", "max", "fundamental")
"""What may be called amplitude."""


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Measured:
    """What every measurement has: numbers, how far they are to be trusted, and its own model.

    A kind of measurement is a subclass here, with a line in `PREDICTIONS` of
    `stickslip.analyses.prediction`.
    """

    kind: ClassVar[str]
    """Name in messages."""
    against: ClassVar[str] = "frequency"
    """What the numbers are measured against."""
    noise_unit: ClassVar[str] = "m"
    """Unit of what is measured."""

    of: str
    """The degree of freedom, the contact or the mode that was measured."""
    abscissa: NDArray[np.float64]
    """What each number belongs to: a frequency [rad/s], a displacement [m] or an amplitude."""
    observed: NDArray[np.float64]
    """The numbers that are compared, shape (n,)."""
    relative_noise: float | None
    noise: float | None
    model: Model | None
    name: str | None

    def _keep(
        self,
        *,
        relative_noise: float | None,
        noise: float | None,
        model: Model | None,
        name: str | None,
        **own: Any,
    ) -> None:
        if relative_noise is not None and noise is not None:
            raise ModelError(f"{self.kind}: relative_noise and noise are given; give one of them")
        if model is not None:
            require_model(model)
        set_fields(
            self,
            relative_noise=above_zero(relative_noise, "", f"{self.kind}: relative_noise"),
            noise=above_zero(noise, self.noise_unit, f"{self.kind}: noise"),
            model=model,
            name=None if name is None else text(name, f"{self.kind}: name"),
            **own,
        )

    def __repr__(self) -> str:
        named = "" if self.name is None else f"{self.name!r}, "
        return f"{type(self).__name__}({named}{self.observed.size} number(s) of {self.of})"

    def on(self, model: Model) -> Self:
        """Return the measurement with a model of its own."""
        made = copy(self)
        set_fields(made, model=model)
        return made

    @property
    def quantities(self) -> Sequence[str]:
        """What each number is: "amplitude", "force", "omega" or "damping_ratio"."""
        return ("amplitude",) * self.observed.size

    @property
    def noise_known(self) -> bool:
        """Whether standard deviations are known; else the fit estimates them from its misfit."""
        return self.noise is not None or self.relative_noise is not None

    @property
    def deviation(self) -> NDArray[np.float64]:
        """Standard deviation of each number; where it is not known, up to a common factor."""
        if self.noise is not None:
            return np.full(self.observed.shape, self.noise)
        return (1.0 if self.relative_noise is None else self.relative_noise) * self._size

    @property
    def _size(self) -> NDArray[np.float64]:
        """What relative noise is relative to."""
        return np.abs(self.observed)


def real_numbers(
    values: ArrayLike | Sequence[float], unit: str, entry: str, above: float = -np.inf
) -> NDArray[np.float64]:
    """Return a list of finite numbers above a limit, or refuse it."""
    found = np.atleast_1d(real_array(without_units(values, unit, entry), entry, "a list"))
    if found.ndim != 1 or not found.size:
        raise ModelError(f"{entry}: shape {found.shape}; give a list of numbers")
    bad = np.flatnonzero(~(np.isfinite(found) & (found > above)))
    if bad.size:
        more = "" if above == -np.inf else f" above {above:g}"
        raise ModelError(f"{entry}[{bad[0]}] is {found[bad[0]]:g}; give finite numbers{more}")
    return constant(found)


def above_zero(value: float | None, unit: str, entry: str) -> float | None:
    """Return a number above 0 or None, or refuse it."""
    if value is None:
        return None
    number = physical_number(value, unit, entry)
    if not number > 0.0:
        raise EntryError(entry, f": {number:g}; give a number above 0")
    return number
