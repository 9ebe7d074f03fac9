"""What a comparison with exact orbits found: the true error of a curve at some of its points."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import text, unknown
from stickslip.errors import ModelError
from stickslip.results.arrays import Bool, Float, Int, constant
from stickslip.results.status import Status

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Certificate", "WorstPoint"]

ROUNDING = 1e-9
"""Relative difference that two solvers leave: a smaller one is no error of truncation."""

_NUMBERS = {
    "indices": (("certified",), "1", "position in the sweep of a point compared with an orbit"),
    "omega": (("certified",), "rad/s", "angular frequency of that point"),
    "code": (("certified",), "1", "how the computation of the orbit ended"),
    "amplitude": (
        ("certified", "certified_dof"),
        "m",
        "half peak-to-peak amplitude of the exact orbit",
    ),
    "error": (
        ("certified", "certified_dof"),
        "m",
        "true error of the amplitude: that of the curve less that of the orbit",
    ),
    "waveform_error": (
        ("certified", "certified_dof"),
        "m",
        "largest difference between curve and orbit over the period",
    ),
    "estimate": (("certified", "certified_dof"), "m", "error estimate of the curve there"),
}


class WorstPoint(NamedTuple):
    """Where the relative error of the amplitude is largest."""

    position: int
    """Position of the point in the curve."""
    omega: float
    """Angular frequency [rad/s]."""
    dof: str
    """Degree of freedom."""
    error: float
    """Amplitude of the curve less that of the exact orbit [m]."""
    relative: float
    """The same over the amplitude of the exact orbit."""
    estimate: float
    """Error estimate of the curve there [m]."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Certificate:
    """True errors of a response curve at p of its points, for d degrees of freedom.

    Where no orbit was found, the numbers are not-a-number and `status` says why.
    """

    dofs: tuple[str, ...]
    """The degrees of freedom compared."""
    tolerance: float | None
    """What the curve promised, relative to the amplitude; None for fixed harmonics."""
    indices: Int
    """(p,) Positions of the points in the curve, ascending."""
    omega: Float
    """(p,) Their angular frequencies [rad/s]."""
    code: NDArray[np.uint8]
    """(p,) Codes of `Status`, of the orbits."""
    amplitude: Float
    """(p, d) Half peak-to-peak amplitude of the exact orbit [m]."""
    error: Float
    """(p, d) Amplitude of the curve less that of the orbit [m]; 0 where it is rounding only."""
    waveform_error: Float
    """(p, d) Largest difference between the two over the period [m]; not-a-number too where an
    interruption came before it was looked for."""
    estimate: Float
    """(p, d) Error estimate of the curve [m]."""

    def __post_init__(self) -> None:
        for name in _NUMBERS:
            array = np.ascontiguousarray(getattr(self, name))
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    def __reduce__(self) -> tuple[Callable[..., Certificate], tuple[object, ...]]:
        return _rebuilt, tuple(getattr(self, entry.name) for entry in fields(self))

    def __repr__(self) -> str:
        worst = self.worst
        if worst is None:
            return f"Certificate({self.indices.size} points, none with an orbit)"
        return (
            f"Certificate({self.indices.size} points, largest error {worst.relative:+.2g} of "
            f"{worst.dof!r} at {worst.omega:g} rad/s)"
        )

    @cached_property
    def status(self) -> tuple[Status, ...]:
        """How the computation of each orbit ended."""
        return tuple(Status.from_code(int(code)) for code in self.code)

    @cached_property
    def relative(self) -> Float:
        """Error of the amplitude over the exact amplitude, shape (p, d)."""
        known = self.amplitude > 0.0
        ratio = self.error / np.where(known, self.amplitude, 1.0)
        # What does not move has no relative error; what was not solved stays not-a-number.
        return constant(np.where(known | np.isnan(self.amplitude), ratio, 0.0))

    @cached_property
    def within_estimate(self) -> Bool:
        """Whether the error of the amplitude does not exceed the estimate, shape (p, d)."""
        floor = ROUNDING * self.amplitude
        return constant(np.abs(self.error) <= np.maximum(self.estimate, floor))

    @cached_property
    def within_tolerance(self) -> Bool | None:
        """Whether the relative error keeps the tolerance, shape (p, d); None without tolerance."""
        if self.tolerance is None:
            return None
        return constant(np.abs(self.relative) <= self.tolerance)

    @cached_property
    def worst(self) -> WorstPoint | None:
        """Where the relative error is largest; None if no orbit was found."""
        size = np.abs(self.relative)
        if not np.isfinite(size).any():
            return None
        point, dof = np.unravel_index(int(np.nanargmax(size)), size.shape)
        return WorstPoint(
            int(self.indices[point]),
            float(self.omega[point]),
            self.dofs[dof],
            float(self.error[point, dof]),
            float(self.relative[point, dof]),
            float(self.estimate[point, dof]),
        )

    def column(self, dof: str) -> int:
        """Return the column of a degree of freedom.

        Raises
        ------
        ModelError
            If it was not compared.
        """
        if text(dof, "dof") not in self.dofs:
            raise ModelError(f"certificate: {unknown('dof', dof, self.dofs)}; name it in certify")
        return self.dofs.index(dof)

    def variables(self) -> dict[Hashable, object]:
        """Return the variables that the certificate adds to the dataset of its curve."""
        variables: dict[Hashable, object] = {
            f"certified_{name}": (
                dims,
                getattr(self, name).copy(),
                {"units": unit, "long_name": meaning},
            )
            for name, (dims, unit, meaning) in _NUMBERS.items()
        }
        variables["certified_dof"] = (
            "certified_dof",
            np.array(self.dofs, dtype=np.str_),
            {"units": "1", "long_name": "degree of freedom compared with exact orbits"},
        )
        variables["certified_tolerance"] = (
            (),
            np.nan if self.tolerance is None else self.tolerance,
            {"units": "1", "long_name": "relative tolerance of the curve, if it had one"},
        )
        return variables

    @classmethod
    def of_dataset(cls, dataset: xr.Dataset) -> Certificate | None:
        """Return what `variables` added to a dataset; None if nothing was.

        Raises
        ------
        KeyError
            If it is not complete.
        """
        if "certified_dof" not in dataset:
            return None
        tolerance = float(dataset["certified_tolerance"].values)
        return cls(
            dofs=tuple(map(str, dataset["certified_dof"].values)),
            tolerance=None if np.isnan(tolerance) else tolerance,
            **{name: dataset[f"certified_{name}"].values for name in _NUMBERS},
        )


def _rebuilt(*values: object) -> Certificate:
    named = {entry.name: value for entry, value in zip(fields(Certificate), values, strict=True)}
    return Certificate(**named)  # type: ignore[arg-type]
