"""What every curve over frequency has: its points, and how each of them ended."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from numbers import Integral
from typing import ClassVar

import numpy as np

from stickslip.checks import real_number
from stickslip.errors import ModelError
from stickslip.results.arrays import Arrays, Bool, Float, Int, constant
from stickslip.results.fields import Columns, Shown
from stickslip.results.periodic import PeriodicMotions
from stickslip.results.result import Attributes
from stickslip.results.status import Status
from stickslip.settings.balance import ForcedSettings
from stickslip.settings.orbits import ExactSettings
from stickslip.settings.settings import Settings

__all__ = ["Sweep"]


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Sweep(PeriodicMotions):
    """The points of a result.

    Attributes
    ----------
    settings : ForcedSettings or ExactSettings
        How.
    arrays : Arrays
        Every number by its name.
    """

    columns: ClassVar[type[Columns]] = Arrays
    settings_class: ClassVar[type[Settings]] = ForcedSettings
    attributes: ClassVar[Attributes] = {"interrupted": bool, "half_wave": bool}

    settings: ForcedSettings | ExactSettings
    arrays: Arrays

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

    def position(self, index: int) -> int:
        """Return the position of a point of the sweep, negative ones counted from the end.

        Parameters
        ----------
        index : int
            Position.

        Returns
        -------
        int
            Position from 0.

        Raises
        ------
        ModelError
            If there is no such point.
        """
        count = self.arrays.omega.size
        if isinstance(index, bool) or not isinstance(index, Integral):
            raise ModelError(
                f"index: {index!r} is not an integer; see index(omega) for the nearest"
            )
        if not -count <= index < count:
            raise ModelError(f"index: {index}; there are {count} points, 0 to {count - 1}")
        return int(index) % count
