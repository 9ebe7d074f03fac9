"""The numbers of a result, and the measures taken of harmonic series."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING, Literal, Self, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from stickslip.results.status import Status

if TYPE_CHECKING:
    from stickslip import _core

__all__ = [
    "Arrays",
    "Bool",
    "Complex",
    "Float",
    "Int",
    "Measure",
    "amplitude_of",
    "constant",
    "mean_forces",
]

Bool: TypeAlias = NDArray[np.bool_]
Complex: TypeAlias = NDArray[np.complex128]
Float: TypeAlias = NDArray[np.float64]
Int: TypeAlias = NDArray[np.int64]
Kind = TypeVar("Kind", bound=np.generic)

Measure: TypeAlias = Literal["half_range", "max", "fundamental"]
"""Half the peak-to-peak range over a period, the largest |x|, or |X_1|."""


@dataclass(frozen=True, eq=False)
class Arrays:
    """The numbers of a forced response: n points, n_o observed dofs, n_p contact points.

    Coefficients are those of x(t) = Re sum_k X_k exp(i k omega t), padded with zeros above the
    harmonics of their own point. At points without any solution they are not-a-number; at points
    that stalled they are the last iterate, and the last three arrays not-a-number.
    """

    omega: Float
    """(n,) Angular frequency [rad/s]."""
    harmonics: Int
    """(n,) Highest harmonic kept."""
    samples: Int
    """(n,) Samples per period of marched friction laws; 0 where they are not marched."""
    status: NDArray[np.uint8]
    """(n,) Codes of `Status`."""
    residual: Float
    """(n,) Residual of the balance equations, relative."""
    iterations: Int
    """(n,) Iterations used."""
    displacement: Complex
    """(n, H+1, n_o) Displacement of the observed dofs [m]."""
    contact_displacement: Complex
    """(n, H+1, n_p) Relative displacement at the contact points [m]."""
    contact_force: Complex
    """(n, H+1, n_p) Contact force [N]."""
    error_estimate: Float
    """(n, n_o) What the discarded harmonics, and more samples, could still change [m]."""
    slip_fraction: Float
    """(n, n_p) Share of the period that the point slips."""
    dissipation: Float
    """(n, n_p) Work lost to friction per cycle [J]."""

    def __post_init__(self) -> None:
        for entry in fields(self):
            array = np.ascontiguousarray(getattr(self, entry.name))
            array.flags.writeable = False
            object.__setattr__(self, entry.name, array)

    def __reduce__(self) -> tuple[type[Self], tuple[object, ...]]:
        # Unpickled arrays would be writeable; going through the constructor makes them constant.
        return type(self), tuple(getattr(self, entry.name) for entry in fields(self))

    @classmethod
    def of(cls, solution: _core.Solution) -> Arrays:
        """Take over what the core returns, blanking the numbers that mean nothing.

        Parameters
        ----------
        solution : _core.Solution
            What the core returns.

        Returns
        -------
        Arrays
            Copies.
        """
        values = {entry.name: getattr(solution, entry.name) for entry in fields(cls)}
        # Where nothing was solved the core keeps no harmonic, and zeros would look like motion.
        missing = values["harmonics"] == 0
        for name in ("displacement", "contact_displacement", "contact_force"):
            series = values[name]
            if series.shape[1] == 1:
                series = np.pad(series, ((0, 0), (0, 1), (0, 0)))
            series[missing] = complex(np.nan, np.nan)
            values[name] = series
        for name in ("error_estimate", "slip_fraction", "dissipation"):
            values[name][~_solved(values["status"])] = np.nan
        return cls(**values)

    @cached_property
    def solved(self) -> Bool:
        """(n,) Whether the balance equations hold at the point."""
        return _solved(self.status)


def amplitude_of(coefficients: Complex, measure: Measure) -> Float:
    """Return the amplitudes of harmonic series.

    Parameters
    ----------
    coefficients : ndarray of complex128, shape (n, H+1)
        X_k of x(t) = Re sum_k X_k exp(i k omega t).
    measure : {"half_range", "max", "fundamental"}
        See `ForcedResponse.amplitude`.

    Returns
    -------
    ndarray of float64, shape (n,)
        Not-a-number where a coefficient is.
    """
    from stickslip import _core

    finite = np.isfinite(coefficients).all(axis=1)
    values = np.full(len(coefficients), np.nan)
    if finite.any():
        values[finite] = _core.amplitude(np.ascontiguousarray(coefficients[finite]), measure)
    return values


def mean_forces(series: Complex, stiffness: float, slip_force: float) -> Float:
    """Return the mean forces that a contact point could hold without changing the vibration.

    Parameters
    ----------
    series : ndarray of complex128, shape (n, H+1)
        Harmonics of its relative displacement [m].
    stiffness : float
        Contact stiffness k_d [N/m].
    slip_force : float
        Slip limit F_d [N].

    Returns
    -------
    ndarray of float64, shape (n, 2)
        Lower and upper bound [N]; 0 where the point slips.
    """
    half = amplitude_of(series, "half_range")
    # Lifted above zero the largest |u| is the maximum of u, which gives the mid-range.
    lift = np.abs(series).sum(axis=1)
    lifted = series.copy()
    lifted[:, 0] += lift
    middle = amplitude_of(lifted, "max") - lift - half
    room = slip_force - stiffness * half
    centre = stiffness * (series[:, 0].real - middle)
    bounds = np.stack([centre - room, centre + room], axis=1)
    bounds[room < 0.0] = 0.0
    return bounds


def _solved(status: NDArray[np.uint8]) -> Bool:
    codes = [one.code for one in Status if one.solved]
    return constant(np.isin(status, codes))


def constant(array: NDArray[Kind]) -> NDArray[Kind]:
    """Make an array read-only, in place, and return it."""
    array.flags.writeable = False
    return array
