"""What ties a sector to the next one: blocks of cyclic matrices, and rings of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import (
    Matrix,
    MatrixLike,
    brief,
    real_matrix,
    require_finite,
    require_square,
    set_fields,
    unknown,
)
from stickslip.errors import ModelError
from stickslip.model.coupling import Coupling
from stickslip.model.damping import ModalDamping, Rayleigh, makes_blocks
from stickslip.model.matrix_units import MatrixUnits, Units
from stickslip.model.structure import ASYMMETRY, Structure


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
    units : str, optional
        Mass, length and time of the blocks, as of `Structure`. Default: SI.
    dofs : sequence of str, optional
        Names of the degrees of freedom; with `units` they tell which are rotations. Default: none.

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
        *,
        units: Units = None,
        dofs: Sequence[str] | None = None,
    ) -> None:
        K = _block(stiffness, "stiffness", None)
        M = np.zeros_like(K) if mass is None else _block(mass, "mass", len(K))
        if units is not None:
            known = MatrixUnits.of(units)
            names = [""] * len(K) if dofs is None else dofs
            K, M = known.in_si(K, "stiffness", names), known.in_si(M, "mass", names)
            if damping is not None and not isinstance(damping, Rayleigh):
                damping = known.in_si(_block(damping, "damping", len(K)), "damping", names)
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
    require_square(block, f"interface: {name}", size, ", but the stiffness is")
    require_finite(block, f"interface: {name}")
    return block


MATRICES = ("mass", "damping", "stiffness")


class Blocks(NamedTuple):
    """A cyclic matrix by its blocks."""

    own: NDArray[np.float64]
    """(N, N) Block of a sector, or (n, N, N) those of n sectors."""
    next: Matrix
    """(N, N) Block of a sector, by rows, and the next one, by columns."""

    def wave(self, delta: float) -> NDArray[np.complex128]:
        """Return the matrix that a wave meets which runs ahead by `delta` per sector [rad]."""
        ahead = np.exp(1j * delta) * self.next
        return np.asarray(self.own + ahead + ahead.conj().T, dtype=np.complex128)


def assembled(blocks: Blocks, wrap: float = 1.0) -> Matrix:
    """Return the matrix of a ring of n sectors, whose own blocks are (n, N, N).

    The sector after the last one is the first, its motion times `wrap`.
    """
    own, following = blocks
    sectors, size, _ = own.shape
    whole = np.zeros((sectors, size, sectors, size))
    for sector in range(sectors):
        ahead = (sector + 1) % sectors
        between = following if ahead else wrap * following
        # Added, not set: of two sectors each is the next of the other.
        whole[sector, :, sector] += own[sector]
        whole[sector, :, ahead] += between
        whole[ahead, :, sector] += between.T
    return whole.reshape(sectors * size, sectors * size)


@dataclass(frozen=True)
class CyclicMatrices:
    """Mass, damping and stiffness of a sector and of its coupling to the next one."""

    mass: Blocks
    """[kg]"""
    damping: Blocks
    """[kg/s]"""
    stiffness: Blocks
    """[N/m]"""
    proportional: bool
    """Whether a law made all of the damping, one that couples no modes of any nodal diameter."""

    def wave(self, delta: float) -> tuple[NDArray[np.complex128], ...]:
        """Return mass, damping and stiffness as a wave meets them; see `Blocks.wave`."""
        return self.mass.wave(delta), self.damping.wave(delta), self.stiffness.wave(delta)

    @classmethod
    def of(
        cls, structure: Structure, couplings: Sequence[Coupling], interface: Interface | None
    ) -> CyclicMatrices:
        """Add couplings and interface blocks to the matrices of a sector by itself."""
        blocks = {}
        for name in MATRICES:
            own = getattr(structure, name).copy()
            following = np.zeros_like(own) if interface is None else getattr(interface, name).copy()
            for coupling in couplings:
                factor = getattr(coupling, name, 0.0)
                if factor:
                    at_own, at_next = coupling.blocks(structure)
                    own += factor * at_own
                    following += factor * at_next
            blocks[name] = Blocks(own, following)
        if couplings or interface is not None:
            known = makes_blocks(structure.damping_law, zip(*blocks.values(), strict=True))
        else:
            known = structure.proportional
        return cls(**blocks, proportional=known)


def cyclic_sector(structure: Structure, boundary: Mapping[str, str]) -> tuple[Structure, Interface]:
    """Join the right boundary of a sector to the left one of the next.

    Both results are for ``BladedDisk(structure, ..., interface=interface)``: the sector without its
    right boundary, whose parts stand at the left one, K0 = K of the own degrees of freedom with K
    of the right boundary added at the left; and the blocks to the next sector, K1 between the own
    degrees of freedom and the left boundary of the next sector.

    Parameters
    ----------
    structure : Structure
        A sector with the degrees of freedom of both of its cuts, as finite elements give it, in
        cylindrical or sector-fixed coordinates.
    boundary : mapping of str to str
        Degrees of freedom at the right cut, each with the one at the left cut that it is in the
        next sector.

    Raises
    ------
    ModelError
        If the boundary is no mapping or empty, a degree of freedom is unknown, stands at both cuts,
        or is named twice; or if the damping is modal, which is not that of the disk, or skew.
    """
    left = _checked(structure, boundary)
    kept = [dof for dof in structure.dofs if dof not in left]
    own = np.array([[float(dof == name) for name in kept] for dof in structure.dofs])
    ahead = [left.get(dof) for dof in structure.dofs]
    following = np.array([[float(dof == name) for name in kept] for dof in ahead])
    if isinstance(structure.damping_law, ModalDamping):
        reason = (
            "structure: modal damping of a sector that is cut free is not that of the disk, which "
            "would join every sector to all others; for a ratio at a frequency omega give"
        )
        raise ModelError(
            f"{reason} ss.Rayleigh(stiffness=2 * ratio / omega)",
            study=f"{reason} damping = {{ rayleigh = {{ stiffness = ... }} }}, 2 ratio / omega",
        )
    # The blocks of a skew part change sign across the cut, which one block per cut cannot say.
    damping = structure.damping
    if np.abs(damping - damping.T).max() > ASYMMETRY * np.abs(damping).max():
        reason = "structure: its damping is not symmetric; give the blocks yourself,"
        raise ModelError(f"{reason} ss.Interface(...)", study=f"{reason} interface of [disk]")
    symmetric = 0.5 * (damping + damping.T)
    matrices = {"mass": structure.mass, "damping": symmetric, "stiffness": structure.stiffness}
    blocks = {
        name: own.T @ matrix @ own + following.T @ matrix @ following
        for name, matrix in matrices.items()
    }
    interface = Interface(**{name: own.T @ matrix @ following for name, matrix in matrices.items()})
    law = structure.damping_law if isinstance(structure.damping_law, Rayleigh) else None
    return Structure.of_law(**blocks, dofs=kept, law=law).made_of(structure), interface


def _checked(structure: Structure, boundary: object) -> dict[str, str]:
    if not isinstance(structure, Structure):
        raise ModelError(f"structure: {brief(structure)} is no Structure; give ss.Structure(...)")
    if not isinstance(boundary, Mapping) or not boundary:
        raise ModelError(
            f'boundary: {brief(boundary)} names no pairs; write {{"right dof": "left dof"}}'
        )
    for right, left in boundary.items():
        for dof in (right, left):
            if dof not in structure.dofs:
                raise ModelError(f"boundary: {unknown('dof', dof, structure.dofs)}")
        if left in boundary:
            raise ModelError(f"boundary: {brief(left)} stands at both cuts; name it at one")
    lefts = list(boundary.values())
    twice = next((dof for dof in lefts if lefts.count(dof) > 1), None)
    if twice is not None:
        raise ModelError(f"boundary: {brief(twice)} is given twice at the left; name it once")
    return dict(boundary)
