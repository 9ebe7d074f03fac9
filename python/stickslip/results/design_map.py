"""Peaks over two parameters of a design."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stickslip.drawn import Drawn
from stickslip.errors import ModelError
from stickslip.results.fields import Float
from stickslip.results.status import Status


@dataclass(frozen=True, eq=False, repr=False)
class DesignMap:
    """Peaks over two parameters of a design; rows belong to the first one."""

    names: tuple[str, str]
    """Names of the parameters."""
    values: tuple[Float, ...]
    """Their values, (n,) and (m,)."""
    dof: str
    """The degree of freedom whose peak it is."""
    amplitude: Float
    """(n, m) Amplitude of the peak [m]; nan where none was found."""
    omega: Float
    """(n, m) Angular frequency of the peak [rad/s]."""
    harmonics: NDArray[np.int64]
    """(n, m) Highest harmonic kept."""
    codes: NDArray[np.int64]
    """(n, m) How each search ended, as `Status.code`."""

    plot = Drawn("design_map")

    def __repr__(self) -> str:
        one, other = (
            f"{values.size} values of {name}"
            for name, values in zip(self.names, self.values, strict=True)
        )
        found = int(np.isfinite(self.amplitude).sum())
        return f"DesignMap({one}, {other}, {found} peaks of {self.dof!r} found)"

    @property
    def status(self) -> tuple[tuple[Status, ...], ...]:
        """How each search ended, row by row; ``status[i][j].advice`` says what to do about it.

        A peak with the status "harmonics limit" is that of the most harmonics there may be: more of
        them would still change it by more than the tolerance.
        """
        return tuple(tuple(map(Status.from_code, row)) for row in self.codes.tolist())

    @property
    def interrupted(self) -> bool:
        """Whether the map was stopped before all cells were done."""
        return bool((self.codes == Status.NOT_COMPUTED.code).any())

    @property
    def optimum(self) -> dict[str, float]:
        """The values of the least of the computed peaks.

        Raises ModelError if no peak was found.
        """
        if not np.isfinite(self.amplitude).any():
            raise ModelError("optimum: none of the peaks was found; widen omega, or max_harmonics")
        place = np.unravel_index(int(np.nanargmin(self.amplitude)), self.amplitude.shape)
        return {
            name: float(values[at])
            for name, values, at in zip(self.names, self.values, place, strict=True)
        }
