"""Up to which frequency a reduced structure moves as the full one."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from stickslip.errors import ModelError
from stickslip.fe.reduced_modes import RIGID, Reduced, natural_modes
from stickslip.fe.sparse import CscArray, Factor

ACCURATE = 0.01
"""Share by which natural frequencies may be too high."""


class Recovered(Reduced, Protocol):
    """A reduced structure with the full one."""

    full_mass: CscArray
    full_stiffness: CscArray
    rows: NDArray[np.int64]
    size: int

    def recover(self, reduced: NDArray[np.float64]) -> NDArray[np.generic]:
        """Displacements of all degrees of freedom."""
        ...


def accurate_to(reduction: Recovered, factor: Factor) -> float:
    """Return the angular frequency up to which natural frequencies are accurate.

    They are those with a free boundary: whatever holds it makes the error smaller. A reduced mode
    x of square s leaves the forces r = (K - s M) x inside, and the static motion y under them is
    what the modes that were left out would add: they lower s by (r y) / |1 - s / t|, t being the
    Rayleigh quotient of y. The error of a shape grows with s. `factor` is that of the stiffness of
    the inside. Infinite where no error is larger.
    """
    stiffness, mass = reduction.full_stiffness, reduction.full_mass
    inner = np.setdiff1d(np.arange(reduction.size), reduction.rows)
    below, added = 0.0, np.zeros(reduction.size)
    try:
        squares, shapes = natural_modes(reduction)
    except ModelError:  # Statically unstable: nothing is known.
        return np.inf
    for square, shape in zip(squares, shapes.T, strict=True):
        if square < (RIGID * reduction.omega[0]) ** 2:
            continue
        motion = reduction.recover(shape).astype(np.float64)
        forces = (stiffness @ motion - square * (mass @ motion))[inner]
        added[inner] = factor.solve(forces)
        work, inertia = float(forces @ added[inner]), float(added @ (mass @ added))
        error = 0.5 * work**2 / (square * abs(work - square * inertia)) if work else 0.0
        if error > ACCURATE:
            return max(below, float(np.sqrt(square * ACCURATE / error)))
        below = float(np.sqrt(square))
    return np.inf
