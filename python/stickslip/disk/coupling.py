"""What ties a sector to the next one: springs, or the blocks of a cyclic matrix."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from stickslip.checks import (
    Matrix,
    MatrixLike,
    brief,
    real_matrix,
    real_number,
    require_finite,
    require_keys,
    require_square,
    set_fields,
    text,
)
from stickslip.errors import ModelError
from stickslip.model.structure import Rayleigh, Structure

__all__ = ["Coupling", "Interface", "coupling_from_spec"]


@dataclass(frozen=True)
class Coupling:
    """A spring, and a dashpot beside it, from each sector to the next, the last to the first.

    Parameters
    ----------
    dof : str
        Degree of freedom of a sector.
    other : str, optional
        Degree of freedom of the next sector at its other end. Default: the same.
    stiffness : float
        Stiffness [N/m].
    damping : float, optional
        Viscous damping [kg/s].

    Raises
    ------
    ModelError
        If stiffness or damping is negative or not a finite number.
    """

    dof: str
    other: str | None = None
    stiffness: float = field(kw_only=True)
    damping: float = field(default=0.0, kw_only=True)

    def __post_init__(self) -> None:
        text(self.dof, "coupling: dof")
        if self.other is not None:
            text(self.other, "coupling: other")
        for name, unit in (("stiffness", "N/m"), ("damping", "kg/s")):
            entry = f"coupling at {brief(self.dof)}: {name}"
            value = real_number(getattr(self, name), entry)
            if value < 0.0:
                raise ModelError(f"{entry} {value:g} is negative; give {unit} above zero")
            object.__setattr__(self, name, value)

    @property
    def ends(self) -> tuple[str, str]:
        """Degrees of freedom of a sector and of the next one."""
        return self.dof, self.dof if self.other is None else self.other

    def blocks(self, structure: Structure) -> tuple[Matrix, Matrix]:
        """Return what a spring of unit stiffness adds to the matrices of a sector, twice (N, N).

        The first is what it adds to the sector itself, its ends at both sides; the second what
        couples the sector, by rows, to the next one, by columns.
        """
        start, end = (structure.index(dof) for dof in self.ends)
        own, following = np.zeros((2, len(structure), len(structure)))
        own[start, start] += 1.0
        own[end, end] += 1.0
        following[start, end] -= 1.0
        return own, following

    def to_spec(self) -> dict[str, object]:
        """Return the coupling in plain values; see `coupling_from_spec`."""
        return asdict(self)


def coupling_from_spec(spec: Mapping[str, Any]) -> Coupling:
    """Build a coupling from the plain values of `Coupling.to_spec`."""
    known = ("dof", "other", "stiffness", "damping")
    require_keys(spec, "coupling", known, ("dof", "stiffness"))
    return Coupling(**spec)


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Interface:
    """Blocks that couple each sector to the next in a cyclic matrix.

    In a wave that runs ahead by the angle delta from sector to sector a matrix with the blocks A0
    (the structure of the sector) and A1 (given here; rows belong to a sector, columns to the next
    one) is A0 + A1 exp(i delta) + A1^T exp(-i delta).

    Parameters
    ----------
    stiffness : array_like or scipy.sparse matrix, shape (N, N)
        K1 [N/m]; it need not be symmetric.
    mass : array_like or scipy.sparse matrix, shape (N, N), optional
        M1 [kg]. Default: none.
    damping : array_like, scipy.sparse matrix or Rayleigh, optional
        C1 [kg/s]; with `Rayleigh` it is made of M1 and K1. Default: none.

    Raises
    ------
    ModelError
        If a matrix is complex, not finite, not square or of another size than K1.
    """

    stiffness: Matrix
    mass: Matrix
    damping: Matrix

    def __init__(
        self,
        stiffness: MatrixLike,
        mass: MatrixLike | None = None,
        damping: MatrixLike | Rayleigh | None = None,
    ) -> None:
        K = _block(stiffness, "stiffness", None)
        M = np.zeros_like(K) if mass is None else _block(mass, "mass", len(K))
        if damping is None:
            C = np.zeros_like(K)
        elif isinstance(damping, Rayleigh):
            C = damping.matrix(M, K)
        else:
            C = _block(damping, "damping", len(K))
        set_fields(self, stiffness=K, mass=M, damping=C)

    def __len__(self) -> int:
        return len(self.stiffness)

    def __repr__(self) -> str:
        return f"Interface({len(self)} dofs)"

    def __reduce__(self) -> tuple[type[Interface], tuple[object, ...]]:
        return Interface, (self.stiffness, self.mass, self.damping)


def _block(matrix: MatrixLike, name: str, size: int | None) -> Matrix:
    block = real_matrix(matrix, f"interface: {name}")
    require_square(block, f"interface: {name}", size, "stiffness")
    require_finite(block, f"interface: {name}")
    return block
