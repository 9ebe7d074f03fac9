"""The matrices of a sector with what couples it to the next one, and of a ring of such sectors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import Matrix
from stickslip.disk.coupling import Coupling, Interface
from stickslip.model.damping import makes_blocks
from stickslip.model.structure import Structure

__all__ = ["MATRICES", "Blocks", "CyclicMatrices", "assembled"]

MATRICES = ("mass", "damping", "stiffness")


class Blocks(NamedTuple):
    """A cyclic matrix by its blocks."""

    own: Matrix
    """(N, N) Block of a sector."""
    next: Matrix
    """(N, N) Block of a sector, by rows, and the next one, by columns."""

    def wave(self, delta: float) -> NDArray[np.complex128]:
        """Return the matrix that a wave meets which runs ahead by `delta` per sector [rad]."""
        ahead = np.exp(1j * delta) * self.next
        return np.asarray(self.own + ahead + ahead.conj().T, dtype=np.complex128)


def assembled(own: NDArray[np.float64], following: Matrix, wrap: float = 1.0) -> Matrix:
    """Return the matrix of a ring, of the blocks of n sectors, (n, N, N), and that between two.

    The sector after the last one is the first, its motion times `wrap`.
    """
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
