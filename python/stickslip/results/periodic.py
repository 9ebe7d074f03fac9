"""What all results of periodic motions have: harmonics, errors, slip and dissipation."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Hashable
from functools import cached_property
from numbers import Integral
from typing import Any

import numpy as np

from stickslip.errors import ModelError
from stickslip.model import PointRef
from stickslip.results.arrays import Measure, PeriodicArrays
from stickslip.results.fields import Complex, Float
from stickslip.results.result import ColumnResult
from stickslip.results.status import Status

__all__ = ["PeriodicMotions"]


class PeriodicMotions(ColumnResult):
    """Periodic motions, one after the other."""

    arrays: PeriodicArrays

    @cached_property
    def status(self) -> tuple[Status, ...]:
        """How each point ended; ``status[i].advice`` says what to do about it."""
        return tuple(map(Status.from_code, self.arrays.status.tolist()))

    @abstractmethod
    def amplitude(self, dof: str, measure: Measure = "half_range") -> Float:
        """Return the amplitude of a displacement, motion by motion, shape (n,) [m].

        Exact extrema of the harmonic series or of the orbits, not those of samples.
        """

    def coefficients(self, dof: str) -> Complex:
        """Return the harmonics of a displacement, X_k of x(t) = Re sum_k X_k exp(i k omega t).

        Returns
        -------
        ndarray of complex128, shape (n, H+1)
            [m]. At points that did not converge the last iterate, kept for diagnosis.
        """
        return self.arrays.displacement[:, :, self._column(dof)]

    def error_estimate(self, dof: str) -> Float:
        """Return what the discarded harmonics, and more samples, could still change.

        Returns
        -------
        ndarray of float64, shape (n,)
            [m], in a displacement. The discarded harmonics of the contact forces, pushed through
            the compliance; of a marched evaluation with the error of its samples, which alone is
            `arrays.sampling_error`. Of exact orbits what their gap could change, of exact limit
            cycles 0.
        """
        return self.arrays.error_estimate[:, self._column(dof)]

    def slip_fraction(self, contact: PointRef) -> Float:
        """Return the share of the period that each contact point slips, shape (n, points) or (n,).

        From 0, it never slips, to 1.
        """
        return self._select(self.arrays.slip_fraction, contact)

    def dissipation(self, contact: PointRef) -> Float:
        """Return the work that each contact point loses to friction per cycle.

        Returns
        -------
        ndarray of float64, shape (n, points) or (n,)
            [J].
        """
        return self._select(self.arrays.dissipation, contact)

    def position(self, index: int) -> int:
        """Return the position of a motion, counted from 0.

        Returns
        -------
        int
            Position from 0.
        """
        count = self.arrays.omega.size
        if isinstance(index, bool) or not isinstance(index, Integral):
            raise ModelError(f"index: {index!r} is not an integer; see omega for the positions")
        if not -count <= index < count:
            raise ModelError(f"index: {index}; there are {count} points, 0 to {count - 1}")
        return int(index) % count

    def _further_variables(self, *, derived: bool) -> dict[Hashable, Any]:
        if not derived:
            return {}
        meaning = "half peak-to-peak amplitude of the displacement"
        values = np.stack([self.amplitude(dof) for dof in self.dofs], axis=1)
        dims = (self.arrays.along, "dof")
        return {"amplitude": (dims, values, {"units": "m", "long_name": meaning})}
