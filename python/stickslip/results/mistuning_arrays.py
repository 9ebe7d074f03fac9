"""The numbers of a mistuning study."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from stickslip.results.arrays import Bool, Code, Float, Int, constant
from stickslip.results.fields import Columns, column
from stickslip.results.status import Status

__all__ = ["ALL", "MistuningArrays"]

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
        "pattern sector", "1", "deviation of the sectors in units of the standard deviation"
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
