"""The numbers of a mistuning study."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stickslip.results.arrays import Bool, Float, Int, constant
from stickslip.results.variables import Variable

__all__ = ["ALL", "VARIABLES", "MistuningArrays"]


@dataclass(frozen=True, eq=False)
class MistuningArrays:
    """The numbers of a study of d deviations, c couplings, p patterns and q degrees of freedom."""

    deviation: Float
    """(d,) Standard deviation of the sectors' stiffness."""
    coupling: Float
    """(c,) Stiffness of the couplings [N/m]; not-a-number: several, or none."""
    patterns: Float
    """(p, n) Deviations of the sectors in units of the standard deviation."""
    omega: Float
    """(d, c, p, q) Angular frequency of the highest peak of all blades [rad/s]."""
    amplitude: Float
    """(d, c, p, q) Its amplitude [m]."""
    blade: Int
    """(d, c, p, q) Its blade, counted from 0; -1 if it was not found."""
    status: NDArray[np.uint8]
    """(d, c, p, q) Codes of `Status`."""
    harmonics: Int
    """(d, c, p, q) Highest harmonic kept."""
    error_estimate: Float
    """(d, c, p, q) What the discarded harmonics could still change in the amplitude [m]."""
    at_edge: Bool
    """(d, c, p, q) Whether the peak lies at an end of the range of frequencies."""
    tuned_omega: Float
    """(c, q) Angular frequency of the peak of the tuned disk [rad/s]."""
    tuned_amplitude: Float
    """(c, q) Its amplitude [m]."""
    tuned_harmonics: Int
    """(c, q) Highest harmonic kept."""
    tuned_error_estimate: Float
    """(c, q) What the discarded harmonics could still change in it [m]."""
    tuned_at_edge: Bool
    """(c, q) Whether it lies at an end of the range of frequencies."""

    def __post_init__(self) -> None:
        for entry in fields(self):
            array = np.ascontiguousarray(getattr(self, entry.name))
            object.__setattr__(self, entry.name, constant(array))

    def __reduce__(self) -> tuple[type[MistuningArrays], tuple[object, ...]]:
        # Unpickled arrays would be writeable; going through the constructor makes them constant.
        return MistuningArrays, tuple(getattr(self, entry.name) for entry in fields(self))

    @cached_property
    def solved(self) -> Bool:
        """(d, c, p, q) Whether the peak was found."""
        return constant(np.isfinite(self.amplitude))

    @cached_property
    def amplification(self) -> Float:
        """(d, c, p, q) Amplification factor; not-a-number if the peak was not found."""
        return constant(self.amplitude / self.tuned_amplitude[np.newaxis, :, np.newaxis, :])


ALL = ("deviation", "coupling_stiffness", "pattern", "dof")
TUNED = ("coupling_stiffness", "dof")
VARIABLES: Mapping[str, Variable] = {
    "patterns": Variable("patterns", ("pattern", "sector"), "1", "deviation in units of S"),
    "omega": Variable("omega", ALL, "rad/s", "angular frequency of the highest peak"),
    "amplitude": Variable("amplitude", ALL, "m", "amplitude of the highest peak"),
    "blade": Variable("blade", ALL, "1", "blade of the highest peak, -1: not found"),
    "status": Variable("status", ALL, "1", "how the search ended"),
    "harmonics_kept": Variable("harmonics", ALL, "1", "highest harmonic kept"),
    "error_estimate": Variable(
        "error_estimate", ALL, "m", "what the discarded harmonics could still change"
    ),
    "at_edge": Variable("at_edge", ALL, "1", "whether the peak lies at an end of the range"),
    "tuned_omega": Variable("tuned_omega", TUNED, "rad/s", "frequency of the tuned peak"),
    "tuned_amplitude": Variable("tuned_amplitude", TUNED, "m", "amplitude of the tuned peak"),
    "tuned_harmonics_kept": Variable(
        "tuned_harmonics", TUNED, "1", "highest harmonic kept, of the tuned peak"
    ),
    "tuned_error_estimate": Variable(
        "tuned_error_estimate", TUNED, "m", "what the discarded harmonics could still change"
    ),
    "tuned_at_edge": Variable(
        "tuned_at_edge", TUNED, "1", "whether the tuned peak lies at an end of the range"
    ),
}
