"""How finely a reproduction is computed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

__all__ = ["COARSE", "FULL", "Float", "Resolution"]

Float: TypeAlias = NDArray[np.float64]
Kind = TypeVar("Kind")


@dataclass(frozen=True)
class Resolution:
    """Tolerance of what is chosen automatically, and how many marks and cases are shown.

    Parameters
    ----------
    tolerance : float
        Relative accuracy of automatic frequencies and harmonics.
    thinning : int
        Of so many marks, frequencies or cases one is computed.
    """

    tolerance: float
    thinning: int

    def marks(self, low: float, high: float, distance: float) -> Float:
        """Return where marks are set, from low to high."""
        return np.arange(low, high + 0.5 * distance, distance * self.thinning)

    def of(self, cases: Sequence[Kind]) -> list[Kind]:
        """Return every case, or some, the first and the last among them."""
        chosen = {*range(0, len(cases), self.thinning), len(cases) - 1}
        return [cases[place] for place in sorted(chosen)]

    def count(self, whole: int) -> int:
        """Return a number of frequencies."""
        return max(whole // self.thinning, 2)

    @property
    def name(self) -> str:
        """How it is called in files."""
        return "full" if self == FULL else "reduced"


FULL = Resolution(tolerance=1e-3, thinning=1)
"""As the dissertation's figures are meant to be read."""

COARSE = Resolution(tolerance=2e-2, thinning=8)
"""For a quick look and for tests: same models and numbers, fewer points."""
