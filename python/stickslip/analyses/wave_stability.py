"""The nonlinear modes of travelling waves, and the stability of their limit cycles.

They are stable or not against everything that the sectors of the disk can do.

A ring of all sectors has motions in time of its own; its equations, linearised along the limit
cycle of a wave and integrated over a period, give its Floquet multipliers.
"""

from __future__ import annotations

from threading import Lock
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip import _core
from stickslip.analyses.limit_cycles import limit_cycles
from stickslip.analyses.nonlinear_modes import nonlinear_modes
from stickslip.analyses.run import Progress
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.disk.wave_ring import Rotation, wave_ring
from stickslip.disk.waves import AerodynamicWaves
from stickslip.errors import ModelError
from stickslip.results.limit_cycles import LimitCycles
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


_ACCURATE = 1e-4
"""Accuracy of the largest multiplier."""
_CLEAR = 3.0
"""Distance of multipliers from the unit circle that decides, in that of the trivial one from 1."""


def wave_cycles(
    waves: AerodynamicWaves, diameter: int, harmonics: int, mode: int
) -> LimitCycles | None:
    """Return the limit cycles of a wave by the whole equations, or nothing where none is found.

    Nothing too where phases within a sector leave the aerodynamic stiffness no matrix of one.
    """
    try:
        return limit_cycles(
            waves.disk_of(diameter, ratio=0.0),
            waves.negative_damping(diameter),
            ratio=[1.0],
            mode=mode,
            harmonics=harmonics,
            stability=False,
        )
    except ModelError:
        return None


def wave_multiplier(
    waves: AerodynamicWaves, diameter: int, branch: LimitCycles, index: int
) -> tuple[float, bool | None]:
    """Return the largest multiplier of a limit cycle but the trivial one, and whether it is stable.

    None where its multipliers do not tell.
    """
    disk = waves.disk
    omega = float(branch.omega[index])
    n = disk.sectors
    turn = np.exp(2j * np.pi * diameter / n * np.arange(branch.arrays.displacement.shape[1]))
    own = branch.arrays.contact_displacement[index].T
    series = np.concatenate([own * turn**sector for sector in range(n)])
    stiffness, damping = _ring_forces(waves, diameter, omega)
    ring = wave_ring(disk.replaced(forces=()), Rotation(n, 1, 1.0, 1.0, n), damping)
    found = _core.period_multipliers(
        ring, stiffness, omega, np.ascontiguousarray(series), _ACCURATE
    )
    if found is None:
        return np.nan, None
    values, error = found
    trivial = int(np.argmin(np.abs(values - 1.0)))
    off = max(_CLEAR * abs(values[trivial] - 1.0), 3.0 * error)
    rest = float(np.abs(np.delete(values, trivial)).max(initial=0.0))
    return rest, None if abs(rest - 1.0) <= off else rest < 1.0


def _ring_forces(
    waves: AerodynamicWaves, diameter: int, omega: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return stiffness and damping of the flow on the ring, real and of no symmetry.

    In a wave of nodal diameter d they are K + i omega C = -A(d), A being its complex force per
    displacement, with Im A in proportion to omega as that of a damping.
    """
    n = waves.disk.sectors
    faster = omega / waves.omega[diameter]
    forces = np.array(
        [
            complex(one.real, faster * one.imag) * np.outer(p, p.conj())
            for one, p in zip(waves.forces.coefficients, waves.forces.directions, strict=True)
        ]
    )
    other = forces[-np.arange(n) % n].conj()
    blocks = -0.5 * (forces + other), -0.5 * (forces - other) / (1j * omega)
    return _circulant(blocks[0]), _circulant(blocks[1])


def _circulant(waves: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Return the matrix of a ring from what every wave meets, x of sector j ahead by 2 pi d j/n."""
    n, size, _ = waves.shape
    by_place = np.fft.fft(waves, axis=0).real / n
    whole = np.zeros((n, size, n, size))
    for sector in range(n):
        for place in range(n):
            whole[sector, :, (sector + place) % n] = by_place[place]
    return np.ascontiguousarray(whole.reshape(n * size, n * size))
