"""The parameter of a damper that makes a peak least."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from stickslip.errors import ModelError
from stickslip.model import Model
from stickslip.results.damper_curve import DamperCurve, LeastPeak

if TYPE_CHECKING:
    from typing import Unpack

    from matplotlib.axes import Axes

    from stickslip.plot.damper import DamperOptions

__all__ = ["OptimalDamper"]


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class OptimalDamper:
    """The least peak over a parameter, and how it was found.

    Attributes
    ----------
    minima : tuple of LeastPeak
        Every local minimum of the peak, the least first; of levels, of the peak per unit of level.
    bounds : (float, float)
        Between which values it was looked for.
    curve : DamperCurve
        All peaks computed, by value: the coarse curve and what closed in on the minima.
    assumptions : tuple of str
        What was taken for granted, and what to look at before the numbers are used.
    """

    minima: tuple[LeastPeak, ...]
    bounds: tuple[float, float]
    curve: DamperCurve
    assumptions: tuple[str, ...]

    def __repr__(self) -> str:
        count = len(self.minima)
        return (
            f"OptimalDamper({self.parameter} = {self.value:.6g} "
            f"{self.curve.settings.variation.unit}: peak {self.amplitude:.6g} m at "
            f"{self.omega:.6g} rad/s, {count} local {'minimum' if count == 1 else 'minima'})"
        )

    @property
    def parameter(self) -> str:
        """What was varied: "slip_force", "stiffness" or "level"."""
        return self.curve.parameter

    @property
    def value(self) -> float:
        """The best value of the parameter, or the best factor."""
        return self.minima[0].value

    @property
    def omega(self) -> float:
        """Angular frequency of the least peak [rad/s]."""
        return self.minima[0].omega

    @property
    def amplitude(self) -> float:
        """Amplitude of the least peak [m]."""
        return self.minima[0].amplitude

    @property
    def slip_force(self) -> float:
        """The best slip force of the contacts that were varied [N].

        Raises
        ------
        ModelError
            If something else was varied, or the contacts have several slip forces.
        """
        if self.parameter != "slip_force":
            raise ModelError(f"slip_force: the {self.parameter} was varied; see value")
        contacts = [one for one in self.model.contacts if one.name in self._contacts]
        forces = {one.parameters()["slip_force"] for one in contacts}
        if len(forces) > 1:
            raise ModelError("slip_force: the contacts have several; see model.contacts")
        return forces.pop()

    @property
    def model(self) -> Model:
        """The model at the best value, for any other analysis."""
        return self.curve.model_at(self.value)

    @property
    def at_bound(self) -> bool:
        """Whether the best value is one of the bounds: there may be a better one outside."""
        return self.value in self.bounds

    @property
    def evaluations(self) -> int:
        """Number of peaks computed; `curve.counters` tells of how many solutions each."""
        return int(self.curve.values.size)

    @property
    def _contacts(self) -> tuple[str, ...]:
        return self.curve.settings.variation.contacts

    def plot(self, **options: Unpack[DamperOptions]) -> Axes:
        """Draw the damper performance curve with its least peak.

        Parameters
        ----------
        **options
            See `stickslip.plot.damper`.

        Returns
        -------
        matplotlib.axes.Axes
            The axes of the amplitude.
        """
        return self.curve.plot(**options)
