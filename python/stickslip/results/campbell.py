"""Natural frequencies over speed and nodal diameter: Campbell and SAFE diagrams."""

from __future__ import annotations

from typing import ClassVar, NamedTuple

import numpy as np

from stickslip.checks import whole_number
from stickslip.disk import BladedDisk, MistunedDisk, NodalDiameters
from stickslip.drawn import Drawn
from stickslip.results.fields import Columns, Float, Int, Shown, column
from stickslip.results.result import ColumnResult
from stickslip.settings.speed import CampbellSettings


class Crossing(NamedTuple):
    """A resonance: an engine order meets a natural frequency."""

    order: int
    """Engine order."""
    diameter: int
    """Nodal diameter that it excites; 0 of a structure that is no disk."""
    mode: int
    """Number of the mode at that diameter, counted from 0."""
    speed: float
    """Speed of rotation [rad/s]."""
    omega: float
    """Natural frequency there [rad/s]."""


class CampbellArrays(Columns):
    """Natural frequencies, ascending at each speed and nodal diameter."""

    speed: Float = column("speed", "rad/s", "speed of rotation", least=0.0)
    diameter: Int = column("diameter", "1", "nodal diameter; 0 of no disk", least=0)
    stuck: Float = column(
        "speed diameter mode", "rad/s", "natural frequency, all contacts stuck", least=0.0
    )
    slipping: Float = column(
        "speed diameter mode", "rad/s", "natural frequency, all contacts slipping", least=0.0
    )


class Campbell(ColumnResult):
    """Natural frequencies over speed and nodal diameter, stuck and slipping."""

    kind: ClassVar[str] = "campbell"
    title = "Natural frequencies over the speed of rotation"

    settings: CampbellSettings
    arrays: CampbellArrays

    def __repr__(self) -> str:
        speeds, diameters, modes = self.stuck.shape
        return f"Campbell({speeds} speeds, {diameters} nodal diameters, {modes} modes)"

    speed = Shown[Float]()
    diameter = Shown[Int]()
    stuck = Shown[Float]()
    slipping = Shown[Float]()

    plot = Drawn("campbell")

    @property
    def orders(self) -> tuple[int, ...]:
        """Engine orders: those chosen, or those of the forces."""
        if self.settings.orders is not None:
            return self.settings.orders
        harmonics = sorted({force.harmonic for force in self.model.forces if force.harmonic} or {1})
        disk = self.model.disk if isinstance(self.model, MistunedDisk) else self.model
        if isinstance(disk, BladedDisk):
            return tuple(disk.order_of(harmonic) for harmonic in harmonics)
        return tuple(harmonics)

    def place(self, order: int) -> int:
        """Return the position among the diameters of that which an engine order excites."""
        if not isinstance(self.model, BladedDisk):
            return 0
        rest = order % self.model.sectors
        return min(rest, self.model.sectors - rest)

    def crossings(self, *, slipping: bool = False) -> list[Crossing]:
        """Return the resonances within the speeds, in their order, between the computed speeds.

        With all contacts stuck, or `slipping`.
        """
        found = []
        rising = np.argsort(self.speed)
        speeds, own = self.speed[rising], (self.slipping if slipping else self.stuck)[rising]
        for order in self.orders:
            place = self.place(order)
            for mode, omega in enumerate(own[:, place].T):
                apart = omega - order * speeds
                for at in np.flatnonzero(apart[:-1] * apart[1:] <= 0.0):
                    ends = at + np.argsort(apart[at : at + 2])
                    # That at a computed speed is found from both sides, to the last digit.
                    speed = np.interp(0.0, apart[ends], speeds[ends])
                    where = order, int(self.diameter[place]), mode
                    found.append(Crossing(*where, float(speed), order * float(speed)))
        return sorted(set(found), key=lambda one: one.speed)

    def at(self, index: int) -> NodalDiameters:
        """Return the natural frequencies of a disk over its nodal diameters at a speed.

        The speeds are counted from 0.
        """
        index = whole_number(index, "index", largest=len(self.speed) - 1)
        disk: BladedDisk = self.model  # type: ignore[assignment]
        return NodalDiameters(disk, self.diameter, self.stuck[index], self.slipping[index])
