"""Natural frequencies of a bladed disk over its nodal diameters."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import members
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.model.model import PointRef, natural_frequencies

if TYPE_CHECKING:
    from typing import Unpack

    from matplotlib.axes import Axes

    from stickslip.plot.options import DiameterOptions, SafeOptions

__all__ = ["NodalDiameters", "nodal_diameters"]


@dataclass(frozen=True, eq=False)
class NodalDiameters:
    """Natural frequencies at the nodal diameters 0 to n/2, rounded down.

    A wave of nodal diameter d that runs the other way round, n - d, has the same frequencies unless
    gyroscopic terms part them; those belong to the damping, which plays no part here.
    """

    disk: BladedDisk
    """The disk."""
    diameters: NDArray[np.int64]
    """(D,) Nodal diameters."""
    stuck: NDArray[np.float64]
    """(D, N) With all contacts stuck [rad/s], ascending at each diameter."""
    slipping: NDArray[np.float64]
    """(D, N) With the chosen contact points slipping [rad/s]."""

    def plot(self, **options: Unpack[DiameterOptions]) -> Axes:
        """Draw the frequencies over the nodal diameters; see `stickslip.plot.nodal_diameters`."""
        from stickslip import plot

        return plot.nodal_diameters(self, **options)

    def plot_safe(self, speed: float, **options: Unpack[SafeOptions]) -> Axes:
        """Draw them with the excitation at a rotor speed [rad/s]; see `stickslip.plot.safe`."""
        from stickslip import plot

        return plot.safe(self, speed, **options)


def nodal_diameters(disk: BladedDisk, slipping: Iterable[PointRef] | None) -> NodalDiameters:
    """Return the natural frequencies at all nodal diameters; see `BladedDisk.nodal_diameters`."""
    every = [
        (contact, point) for contact, one in enumerate(disk.contacts) for point in range(one.points)
    ]
    slips = every if slipping is None else list(members(slipping, "slipping", "slipping=[...]"))
    diameters = np.arange(disk.sectors // 2 + 1)
    stuck, free = (
        np.stack([natural_frequencies(disk, points, nodal_diameter=int(d)) for d in diameters])
        for points in ([], slips)
    )
    for array in (diameters, stuck, free):
        array.flags.writeable = False
    return NodalDiameters(disk, diameters, stuck, free)
