"""A ring of sectors that may differ, sector by sector and as one structure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import Matrix
from stickslip.disk.cyclic import assembled
from stickslip.model.structure import Structure

__all__ = ["Ring", "SectorContact"]


class SectorContact(NamedTuple):
    """A contact of one sector in numbers."""

    sector: int
    """Sector it belongs to."""
    law: str
    """Name of the law, as the compiled core knows it."""
    own: Matrix
    """(points, N) Part of B on the sector itself."""
    next: Matrix
    """(points, N) Part of B on the next sector."""
    parameters: Mapping[str, float | list[float]]
    """Parameters of the law."""


@dataclass(frozen=True, eq=False)
class Ring:
    """A mistuned disk in numbers, n sectors of N degrees of freedom each.

    In the whole matrices sector i takes the rows i N to (i + 1) N - 1. Sector i is tied to sector
    i + 1, the last to the first, by the same block everywhere: rows belong to sector i, columns to
    sector i + 1.
    """

    mass: NDArray[np.float64]
    """(n, N, N) Blocks of the sectors themselves [kg]."""
    damping: NDArray[np.float64]
    """(n, N, N) [kg/s]."""
    stiffness: NDArray[np.float64]
    """(n, N, N) [N/m]."""
    mass_next: Matrix
    """(N, N) Block between a sector and the next one [kg]."""
    damping_next: Matrix
    """(N, N) [kg/s]."""
    stiffness_next: Matrix
    """(N, N) [N/m]."""
    contacts: tuple[SectorContact, ...]
    """All contacts, those of sector 0 first."""
    loads: tuple[tuple[int, NDArray[np.complex128]], ...]
    """Harmonics in ascending order, each with the forces on all sectors, (n, N) [N]."""
    proportional: bool
    """Whether laws made all of the damping, so that it couples no modes of the whole."""

    def loads_by_sector(self) -> list[list[tuple[int, NDArray[np.complex128]]]]:
        """Return the loads on each sector, by harmonics."""
        return [[(k, load[sector]) for k, load in self.loads] for sector in range(len(self.mass))]

    def assembled(self, dofs: Sequence[str]) -> Structure:
        """Return the whole as one structure of n N degrees of freedom.

        Those of a sector are given; "tip" of sector 3 is named "3.tip".

        Raises
        ------
        ModelError
            If the whole mass is not positive definite.
        """
        return Structure.of_law(
            mass=assembled(self.mass, self.mass_next),
            stiffness=assembled(self.stiffness, self.stiffness_next),
            damping=assembled(self.damping, self.damping_next),
            dofs=[f"{sector}.{dof}" for sector in range(len(self.mass)) for dof in dofs],
            law=None,
            proportional=self.proportional,
        )
