"""What a comparison with exact orbits found: the true error of a curve at some of its points."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from functools import cached_property
from types import MappingProxyType
from typing import Any, ClassVar, NamedTuple

import numpy as np

from stickslip.checks import constant, text, unknown
from stickslip.errors import ModelError
from stickslip.results.dataset import Stored, labels
from stickslip.results.fields import Bool, Code, Columns, Float, Int, column
from stickslip.results.status import Status

ROUNDING = 1e-9
"""Relative difference that two solvers leave: a smaller one is no error of truncation."""


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


class Certificate(Columns):
    """True errors of a response curve at some of its points, for the degrees of freedom `dofs`.

    Where no orbit was found, the numbers are not-a-number and `status` says why. `tolerance` is
    what the curve promised, relative to the amplitude; None for fixed harmonics.
    """

    prefix: ClassVar[str] = "certified_"

    dofs: tuple[str, ...]
    tolerance: float | None
    indices: Int = column(
        "certified", "1", "position in the sweep of a point compared", least=0, most="omega"
    )
    omega: Float = column("certified", "rad/s", "angular frequency of that point", least=0.0)
    code: Code = column("certified", "1", "how the orbit ended", codes=Status)
    amplitude: Float = column(
        "certified certified_dof", "m", "half peak-to-peak amplitude of the exact orbit", least=0.0
    )
    error: Float = column(
        "certified certified_dof",
        "m",
        "amplitude of the curve less that of the orbit, 0 where it is rounding only",
    )
    waveform_error: Float = column(
        "certified certified_dof",
        "m",
        "largest difference between curve and orbit over the period, where it was looked for",
        least=0.0,
    )
    estimate: Float = column(
        "certified certified_dof", "m", "error estimate of the curve there", least=0.0
    )

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
        return tuple(map(Status.from_code, self.code.tolist()))

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
        """Return the column of a degree of freedom; one that was not compared is refused."""
        if text(dof, "dof") not in self.dofs:
            raise ModelError(f"certificate: {unknown('dof', dof, self.dofs)}; name it in certify")
        return self.dofs.index(dof)

    def variables(self, words: Mapping[str, str] = MappingProxyType({})) -> dict[Hashable, Any]:
        """Return the variables that the certificate adds to the dataset of its curve."""
        variables = super().variables(words)
        meaning = "degree of freedom compared with exact orbits"
        variables["certified_dof"] = labels("certified_dof", self.dofs, meaning)
        variables["certified_tolerance"] = (
            (),
            np.nan if self.tolerance is None else self.tolerance,
            {"units": "1", "long_name": "relative tolerance of the curve, if it had one"},
        )
        return variables

    @classmethod
    def of_dataset(cls, dataset: Stored) -> Certificate | None:
        """Return what `variables` added to a dataset; None if nothing was."""
        if "certified_dof" not in dataset:
            return None
        tolerance = float(dataset["certified_tolerance"].values)
        dofs = tuple(map(str, dataset["certified_dof"].values))
        return cls.read(dataset, dofs=dofs, tolerance=None if np.isnan(tolerance) else tolerance)
