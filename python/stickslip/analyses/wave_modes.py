"""The nonlinear modes of all travelling waves of a tuned disk, each computed once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stickslip.analyses.nonlinear_modes import nonlinear_modes
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.results.nonlinear_modes import NonlinearModes
from stickslip.settings.flutter import FlutterKeys


class WaveModes:
    """The nonlinear modes of all waves of a disk without its flow."""

    def __init__(self, disk: BladedDisk, settings: FlutterKeys) -> None:
        self.disk, self.settings = disk, settings
        self.evaluations = 0
        self.known: dict[object, NonlinearModes] = {}
        blocks = disk.matrices.mass, disk.matrices.damping, disk.matrices.stiffness
        alone = not any(disk.contact_rows(contact)[1].any() for contact in disk.contacts)
        self.mirrored = alone and all(np.array_equal(one.next, one.next.T) for one in blocks)
        """Whether waves of opposite sense meet the same sector."""

    def at(
        self, diameter: int, amplitudes: NDArray[np.float64], harmonics: int | None = None
    ) -> NonlinearModes:
        """Return the mode of a wave at amplitudes; not-a-number where it was not reached."""
        keys = self.settings
        if self.mirrored:
            diameter = min(diameter, self.disk.sectors - diameter)
        asked = diameter, amplitudes.tobytes(), harmonics
        if asked not in self.known:
            found = nonlinear_modes(
                self.disk,
                amplitude=amplitudes.tolist(),
                nodal_diameter=diameter,
                mode=keys.mode,
                harmonics=harmonics or keys.harmonics,
                tolerance=keys.tolerance,
                residual=keys.residual,
                max_harmonics=keys.max_harmonics,
                max_iterations=keys.max_iterations,
            )
            self.evaluations += int(found.counters.get("evaluations", 0))
            self.known[asked] = found
        return self.known[asked]
