"""Natural modes of reduced structures, whose mass matrix may be singular."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import Matrix, unknown
from stickslip.errors import ModelError
from stickslip.model.damping import eigen_pencil
from stickslip.units import physical_number

MASSLESS = 1e-12
"""Inertia below this part of the largest is none."""
RIGID = 1e-3
"""A mode below this part of the first elastic one is a rigid-body mode."""


class Reduced(Protocol):
    """Matrices of the boundary and of fixed-interface modes, and what they are of."""

    mass: Matrix
    stiffness: Matrix
    boundary: tuple[str, ...]
    omega: NDArray[np.float64]


def natural_modes(
    reduction: Reduced, springs: Mapping[str, float] | None = None
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return squared angular frequencies and shapes, (n, modes), of a reduction, ascending.

    The shapes are mass-normalised. Motions of boundary degrees of freedom that move no mass are no
    modes. `springs` to ground at boundary degrees of freedom are added [N/m].
    """
    stiffness, shift = reduction.stiffness.copy(), shift_below(reduction)
    for place, spring in springs_of(reduction, springs):
        stiffness[place, place] += spring
    try:
        # A singular mass matrix has no inverse, the shifted stiffness has one.
        inverses, shapes = eigen_pencil(reduction.mass, stiffness - shift * reduction.mass)
    except np.linalg.LinAlgError:
        raise ModelError(
            "springs: with them the structure is not stable; give none below 0"
            if springs
            else "stiffness: it is not that of a stable structure; look at the matrices"
        ) from None
    inert = np.flatnonzero(inverses > MASSLESS * inverses[-1])[::-1]
    return shift + 1.0 / inverses[inert], shapes[:, inert] / np.sqrt(inverses[inert])


def shift_below(reduction: Reduced) -> float:
    """Return a number below all eigenvalues: a free structure, too, can be factored there."""
    return -0.1 * float(reduction.omega[0]) ** 2


def springs_of(
    reduction: Reduced, springs: Mapping[str, float] | None
) -> Iterator[tuple[int, float]]:
    """Give the place in the boundary and the stiffness [N/m] of springs to ground."""
    for dof, value in (springs or {}).items():
        if dof not in reduction.boundary:
            raise ModelError(f"springs: {unknown('dof', dof, reduction.boundary)}")
        yield reduction.boundary.index(dof), physical_number(value, "N/m", f"springs: {dof}")
