"""Bounds of a response over the tractions that the past may have left in its contacts."""

from __future__ import annotations

from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import constant
from stickslip.errors import ModelError
from stickslip.results.arrays import UNIQUE
from stickslip.results.contact_motion import ContactMotion
from stickslip.results.fields import Bool, Float
from stickslip.results.peaks import Peak, highest_of


class ResidualBounds:
    """What is known of a result over all residual tractions, point by point."""

    arrays: Any
    bounded_by: ClassVar[str]
    """What computes the bounds."""

    @property
    def bounded(self) -> bool:
        """Whether bounds over the residual tractions are known at some point."""
        return bool((self.arrays.unique != UNIQUE.index("not asked")).any())

    @cached_property
    def unique(self) -> NDArray[np.str_]:
        """Whether each vibration is the same for all residual tractions, of the observed dofs.

        "yes" (the bounds coincide: no other vibration was found, and where `guaranteed` is true
        there is none), "no" (it depends on them), "shakedown" (it does, and the motion itself has
        pushed a contact in one sense until it slips no more), "not decided" (no other vibration was
        found before the effort that a curve may cost was spent; ask for the frequency by itself),
        "not found" (of an exact orbit: one of those that bound it was not found) or "not asked".
        """
        return constant(np.array(UNIQUE)[self.arrays.unique])

    @property
    def guaranteed(self) -> Bool:
        """Whether theory excludes amplitudes outside of the bounds, point by point.

        It does where there is one vibration alone: monotone laws on a damped structure. Elsewhere
        the bounds are inner ones: the amplitudes between were found, others could lie outside.
        """
        found: Bool = self.arrays.guaranteed
        return found

    def _require_bounded(self) -> None:
        if not self.bounded:
            raise ModelError(
                'residual: its bounds were not computed; give residual="bounds" to '
                f"{self.bounded_by}"
            )


class Bounded(ResidualBounds, ContactMotion):
    """The part of a forced response that `residual="bounds"` adds."""

    bounded_by = "forced_response"

    def lower(self, dof: str) -> Float:
        """Return the least amplitude over all residual tractions, shape (n,) [m].

        Half the range over a period, as of ``amplitude(dof)``. It is attained: see `guaranteed`.
        Not-a-number where nothing was solved.

        Raises ModelError if the bounds were not asked for.
        """
        return self._bound(self.arrays.lower, dof)

    def upper(self, dof: str) -> Float:
        """Return the largest amplitude over all residual tractions, shape (n,) [m].

        See `lower`.
        """
        return self._bound(self.arrays.upper, dof)

    def peak_bounds(self, dof: str) -> tuple[Peak, Peak]:
        """Return between which amplitudes the peak lies, and where they are reached.

        The highest point of `lower` and of `upper`, each by the parabola through its three highest
        points, as `peak` of a branch: a residual traction that stays the same over the sweep has a
        peak not below the first. Where the vibration is the same for all of them, twice the peak.

        Raises ModelError if the bounds were not asked for.
        """
        lower, upper = self.lower(dof), self.upper(dof)
        if np.array_equal(lower, upper, equal_nan=True):
            peak = self.peak(dof)
            return peak, peak
        least, highest = highest_of(self, dof, lower), highest_of(self, dof, upper)
        # A parabola across a jump of the bound leads above it.
        amplitude = min(least.amplitude, self.peak(dof).amplitude)
        return least._replace(amplitude=amplitude), highest

    def _bound(self, values: Float, dof: str) -> Float:
        self._require_bounded()
        return constant(values[:, self._column(dof)].copy())
