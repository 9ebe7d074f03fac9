"""Amplification factors of mistuned disks and their distribution."""

from __future__ import annotations

from collections.abc import Hashable
from functools import cached_property
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import choice, constant, real_number, unknown
from stickslip.drawn import Axes, Drawn, plots
from stickslip.errors import ModelError
from stickslip.results.blades import SectorDof
from stickslip.results.fields import Bool, Code, Columns, Float, Int, Shown, column
from stickslip.results.result import ColumnResult
from stickslip.results.status import Status
from stickslip.results.weibull import Percentile, WeibullFit, empirical_percentile, fit_weibull
from stickslip.settings.peaks import MistuningSettings

ALL = "deviation coupling_stiffness pattern dof"
_TUNED = "coupling_stiffness dof"
_ESTIMATE = "what the discarded harmonics could still change"


class MistuningArrays(Columns):
    """The numbers of a mistuning study."""

    deviation: Float = column("deviation", "1", "standard deviation of the sectors' stiffness")
    coupling: Float = column(
        "coupling_stiffness",
        "N/m",
        "stiffness of the couplings; not-a-number: several, or none",
        least=0.0,
        file_name="coupling_stiffness",
    )
    patterns: Float = column(
        "pattern sector",
        "1",
        "deviation of the sectors in units of the standard deviation: "
        "``disk.mistuned(deviation * patterns[i])`` is a disk",
    )
    omega: Float = column(ALL, "rad/s", "angular frequency of the highest peak", least=0.0)
    amplitude: Float = column(ALL, "m", "amplitude of the highest peak", least=0.0)
    blade: Int = column(
        ALL, "1", "blade of the highest peak, -1: not found", least=-1, most="sector"
    )
    status: Code = column(ALL, "1", "how the search ended", codes=Status)
    harmonics: Int = column(ALL, "1", "highest harmonic kept", least=0, file_name="harmonics_kept")
    error_estimate: Float = column(ALL, "m", _ESTIMATE, least=0.0)
    at_edge: Bool = column(ALL, "1", "whether the peak lies at an end of the range")
    tuned_omega: Float = column(_TUNED, "rad/s", "frequency of the tuned peak", least=0.0)
    tuned_amplitude: Float = column(_TUNED, "m", "amplitude of the tuned peak", least=0.0)
    tuned_harmonics: Int = column(
        _TUNED,
        "1",
        "highest harmonic kept, of the tuned peak",
        least=0,
        file_name="tuned_harmonics_kept",
    )
    tuned_error_estimate: Float = column(_TUNED, "m", _ESTIMATE, least=0.0)
    tuned_at_edge: Bool = column(_TUNED, "1", "whether the tuned peak lies at an end of the range")

    @cached_property
    def solved(self) -> Bool:
        """(d, c, p, q) Whether the peak was found."""
        return constant(np.isfinite(self.amplitude))

    @cached_property
    def amplification(self) -> Float:
        """(d, c, p, q) Amplification factor; not-a-number if the peak was not found."""
        return constant(self.amplitude / self.tuned_amplitude[np.newaxis, :, np.newaxis, :])


class MistuningStudy(ColumnResult):
    """Amplification factors of many mistuned disks.

    The amplification factor of a disk is the highest peak of any blade over that of the tuned disk,
    both over the range of frequencies. Arrays of d deviations, c couplings and p patterns; where
    one is to be chosen, it is given by its value and may be left out if there is only one.

    Attributes
    ----------
    model : BladedDisk
        The tuned disk.
    """

    kind: ClassVar[str] = "mistuning_study"
    title = "Amplification factors of mistuned disks"
    headline = "amplitude"

    settings: MistuningSettings
    arrays: MistuningArrays

    def __repr__(self) -> str:
        d, c, p, _ = self.arrays.amplitude.shape
        done = int(self.arrays.solved.all(axis=-1).sum())
        return (
            f"MistuningStudy({d} deviation(s), {c} coupling(s), {p} pattern(s): {done} of "
            f"{d * c * p} disks found, {', '.join(self.dofs)})"
        )

    deviation = Shown[Float]()
    coupling_stiffness = Shown[Float]("coupling")
    patterns = Shown[Float]()

    plot = plot_distribution = Drawn("distribution")

    @cached_property
    def status(self) -> NDArray[np.object_]:
        """How each search ended, shape (d, c, p, q); `Status`, with its advice."""
        return Status.array(self.arrays.status)

    def amplification(self, dof: SectorDof) -> Float:
        """Return amplification factors, shape (d, c, p); not-a-number if not found."""
        return self.arrays.amplification[..., self._dof(dof)]

    def error(self, dof: SectorDof) -> Float:
        """Return what the discarded harmonics could change in the factors, shape (d, c, p).

        Of the mistuned and of the tuned peak together.
        """
        at, arrays = self._dof(dof), self.arrays
        tuned = arrays.tuned_error_estimate[:, at] / arrays.tuned_amplitude[:, at]
        own = arrays.error_estimate[..., at] / arrays.amplitude[..., at]
        return constant(self.amplification(dof) * (own + tuned[np.newaxis, :, np.newaxis]))

    def blade(self, dof: SectorDof) -> Int:
        """Return the blades of the highest peaks, shape (d, c, p); -1 if not found."""
        return self.arrays.blade[..., self._dof(dof)]

    def omega(self, dof: SectorDof) -> Float:
        """Return the frequencies of the highest peaks, shape (d, c, p) [rad/s]."""
        return self.arrays.omega[..., self._dof(dof)]

    def amplitude(self, dof: SectorDof) -> Float:
        """Return the amplitudes of the highest peaks, shape (d, c, p) [m]."""
        return self.arrays.amplitude[..., self._dof(dof)]

    def tuned(self, dof: SectorDof) -> Float:
        """Return the amplitudes of the peaks of the tuned disk, shape (c,) [m]."""
        return self.arrays.tuned_amplitude[:, self._dof(dof)]

    def factors(
        self, dof: SectorDof, *, deviation: float | None = None, coupling: float | None = None
    ) -> Float:
        """Return the amplification factors found for one deviation and one coupling.

        In the order of the patterns, those that were not found left out, shape (found,).
        """
        row = self.amplification(dof)[self._chosen(deviation, coupling)]
        return constant(row[np.isfinite(row)])

    def _chosen(self, deviation: float | None, coupling: float | None) -> tuple[int, int]:
        """Return the positions of one deviation and one coupling."""
        return (
            _one(deviation, self.deviation, "deviation"),
            _one(coupling, self.coupling_stiffness, "coupling"),
        )

    def weibull(
        self,
        dof: SectorDof,
        *,
        deviation: float | None = None,
        coupling: float | None = None,
        confidence: float = 0.95,
    ) -> WeibullFit:
        """Return the three-parameter Weibull distribution of the factors.

        Shape, scale and location with their intervals, its distance from the factors.

        Raises ModelError if there are fewer than 30 factors, or all are equal.
        """
        return fit_weibull(self.factors(dof, deviation=deviation, coupling=coupling), confidence)

    def percentile(
        self,
        dof: SectorDof,
        q: float,
        *,
        method: Literal["weibull", "empirical"] = "weibull",
        deviation: float | None = None,
        coupling: float | None = None,
        confidence: float = 0.95,
    ) -> Percentile:
        """Return the factor that q percent of all disks do not exceed, with its confidence.

        Value, low and high end.

        Raises ModelError as `weibull`; if q or the method is unknown.

        Parameters
        ----------
        q : float
            From 0 to 100, exclusive: 99.9.
        method : {"weibull", "empirical"}, optional
            From the fitted distribution, also beyond the data; or from the factors themselves.
            Those of disks whose peak was not found may have been any: they make its interval wider.
        """
        chosen = choice(method, "method", ("weibull", "empirical"))
        if chosen == "empirical":
            place = self._chosen(deviation, coupling)
            row = self.amplification(dof)[place]
            sought = self.arrays.status[place][:, self._dof(dof)] != Status.NOT_COMPUTED.code
            missing = int((sought & ~np.isfinite(row)).sum())
            return empirical_percentile(row, q, confidence, missing)
        fit = self.weibull(dof, deviation=deviation, coupling=coupling, confidence=confidence)
        return fit.percentile(q)

    def plot_deviation(self, dof: SectorDof, **options: Any) -> Axes:
        """Draw factors against the deviation; see `stickslip.plot.amplification`."""
        return plots.amplification(self, dof, "deviation", **options)

    def plot_coupling(self, dof: SectorDof, **options: Any) -> Axes:
        """Draw factors against the stiffness of couplings; see `stickslip.plot.amplification`."""
        return plots.amplification(self, dof, "coupling", **options)

    def _further_variables(self, *, derived: bool) -> dict[Hashable, Any]:
        said = {"units": "1", "long_name": "amplification factor"}
        factors = (ALL.split(), self.arrays.amplification.copy(), said)
        return {"amplification": factors} if derived else {}

    def _dof(self, dof: SectorDof) -> int:
        if dof not in self.dofs:
            raise ModelError(unknown("dof of the study", dof, self.dofs))
        return self.dofs.index(dof)


def _one(value: float | None, known: Float, entry: str) -> int:
    """Return the position of a value of the study."""
    shown = ", ".join(f"{one:g}" for one in known)
    if value is None:
        if known.size > 1:
            raise ModelError(f"{entry}: there are {known.size}; give one of {shown}")
        return 0
    number = real_number(value, entry)
    at = np.flatnonzero(np.isclose(known, number, rtol=1e-12, atol=0.0))
    if not at.size:
        raise ModelError(f"{entry}: {number:g} was not studied; give one of {shown}")
    return int(at[0])
