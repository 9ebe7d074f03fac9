"""The nonlinear modes of all travelling waves of a tuned disk, each computed once."""

from __future__ import annotations

from threading import Lock
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip.analyses.nonlinear_modes import nonlinear_modes
from stickslip.analyses.run import Progress
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.results.nonlinear_modes import NonlinearModes
from stickslip.settings.flutter import FlutterKeys

_Asked: TypeAlias = tuple[int, bytes, int | None]
"""Nodal diameter, amplitudes and harmonics."""


class WaveModes:
    """The nonlinear modes of all waves of a disk without its flow."""

    def __init__(self, disk: BladedDisk, settings: FlutterKeys) -> None:
        self.disk, self.settings = disk, settings
        self.known: dict[_Asked, NonlinearModes] = {}
        self._at_work = [Lock() for _ in range(disk.sectors)]
        blocks = disk.matrices.mass, disk.matrices.damping, disk.matrices.stiffness
        alone = not any(disk.contact_rows(contact)[1].any() for contact in disk.contacts)
        self.mirrored = alone and all(np.array_equal(one.next, one.next.T) for one in blocks)
        """Whether waves of opposite sense meet the same sector."""

    @property
    def evaluations(self) -> int:
        """Evaluations of the contacts for all modes so far."""
        return sum(int(one.counters.get("evaluations", 0)) for one in self.known.values())

    def at(
        self,
        diameter: int,
        amplitudes: NDArray[np.float64],
        harmonics: int | None = None,
        progress: Progress = None,
    ) -> NonlinearModes:
        """Return the mode of a wave at amplitudes; not-a-number where it was not reached."""
        if self.mirrored:
            diameter = min(diameter, self.disk.sectors - diameter)
        asked = diameter, amplitudes.tobytes(), harmonics
        # Two waves that meet the same sector may be followed at the same time.
        with self._at_work[diameter]:
            if asked not in self.known:
                self.known[asked] = self._computed(asked, amplitudes, progress)
            return self.known[asked]

    def _computed(
        self, asked: _Asked, amplitudes: NDArray[np.float64], progress: Progress
    ) -> NonlinearModes:
        diameter, _, harmonics = asked
        keys = self.settings
        return nonlinear_modes(
            self.disk,
            amplitude=amplitudes.tolist(),
            nodal_diameter=diameter,
            mode=keys.mode,
            harmonics=harmonics or keys.harmonics,
            tolerance=keys.tolerance,
            residual=keys.residual,
            max_harmonics=keys.max_harmonics,
            max_iterations=keys.max_iterations,
            progress=progress,
        )
