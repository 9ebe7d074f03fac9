"""What all results of periodic motions have: harmonics, errors, slip and dissipation."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from stickslip.model import PointRef
from stickslip.results.fields import Complex, Float
from stickslip.results.result import ColumnResult
from stickslip.results.status import Status

__all__ = ["PeriodicMotions"]


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class PeriodicMotions(ColumnResult):
    """Periodic motions, one after the other."""

    arrays: Any

    @cached_property
    def status(self) -> tuple[Status, ...]:
        """How each point ended; ``status[i].advice`` says what to do about it."""
        return tuple(Status.from_code(int(code)) for code in self.arrays.status)

    def coefficients(self, dof: str) -> Complex:
        """Return the harmonics of a displacement, X_k of x(t) = Re sum_k X_k exp(i k omega t).

        Parameters
        ----------
        dof : str
            An observed degree of freedom.

        Returns
        -------
        ndarray of complex128, shape (n, H+1)
            [m]. At points that did not converge the last iterate, kept for diagnosis.

        Raises
        ------
        ModelError
            If there is no such degree of freedom, or it was not observed.
        """
        series: Complex = self.arrays.displacement[:, :, self._column(dof)]
        return series

    def error_estimate(self, dof: str) -> Float:
        """Return what the discarded harmonics, and more samples, could still change.

        Parameters
        ----------
        dof : str
            An observed degree of freedom.

        Returns
        -------
        ndarray of float64, shape (n,)
            [m], in a displacement. The discarded harmonics of the contact forces, pushed through
            the compliance; of a marched evaluation with the error of its samples, which alone is
            `arrays.sampling_error`. Of exact orbits what their gap could change, of exact limit
            cycles 0.

        Raises
        ------
        ModelError
            If there is no such degree of freedom, or it was not observed.
        """
        errors: Float = self.arrays.error_estimate[:, self._column(dof)]
        return errors

    def slip_fraction(self, contact: PointRef) -> Float:
        """Return the share of the period that each contact point slips.

        Parameters
        ----------
        contact : int, str or (int or str, int)
            The contact, or one of its points.

        Returns
        -------
        ndarray of float64, shape (n, points) or (n,)
            From 0, it never slips, to 1.

        Raises
        ------
        ModelError
            If there is no such contact or point.
        """
        return self._select(self.arrays.slip_fraction, contact)

    def dissipation(self, contact: PointRef) -> Float:
        """Return the work that each contact point loses to friction per cycle.

        Parameters and errors are those of `slip_fraction`, with values in J.
        """
        return self._select(self.arrays.dissipation, contact)
