"""A structure reduced to component modes, and the way back to all its degrees of freedom."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csc_array

from stickslip.checks import Matrix, MatrixLike, real_number, unknown
from stickslip.errors import ModelError
from stickslip.fe.report import ReductionReport, reported
from stickslip.model import Force
from stickslip.model.damping import DampingLaw
from stickslip.model.structure import Structure

__all__ = ["Reduction"]


class Reduction:
    """What `craig_bampton` makes of a structure; x = T q.

    Attributes
    ----------
    mass, stiffness : ndarray of float64, shape (n, n)
        Reduced matrices: boundary degrees of freedom first, fixed-interface modes behind.
    dofs : tuple of str
        Names of the n reduced degrees of freedom: those of the boundary, then "mode-1", ...
    boundary : tuple of str
        Names of the boundary degrees of freedom.
    rows : ndarray of int64, shape (boundary,)
        Where they stand in the full matrices.
    omega : ndarray of float64, shape (modes,)
        Natural frequencies of the fixed-interface modes [rad/s].
    size : int
        N, degrees of freedom of the full structure.
    """

    def __init__(
        self,
        mass: csc_array,
        stiffness: csc_array,
        row_names: tuple[str, ...] | None,
        boundary: tuple[str, ...],
        rows: NDArray[np.int64],
        constraint: NDArray[np.float64],
        shapes: NDArray[np.float64],
        squares: NDArray[np.float64],
        asymmetry: tuple[float, float],
    ) -> None:
        self.full_mass, self.full_stiffness = mass, stiffness
        self.row_names, self.asymmetry = row_names, asymmetry
        self.boundary, self.rows, self.size = boundary, rows, mass.shape[0]
        self.omega = np.sqrt(squares)
        self.dofs = (*boundary, *(f"mode-{mode}" for mode in range(1, len(squares) + 1)))
        self._basis = np.zeros((self.size, len(self.dofs)))
        inner = np.setdiff1d(np.arange(self.size), rows)
        kept = len(rows)
        self._basis[rows, np.arange(kept)] = 1.0
        self._basis[inner, :kept] = constraint
        self._basis[inner, kept:] = shapes
        M = self._basis.T @ (mass @ self._basis)
        K = self._basis.T @ (stiffness @ self._basis)
        # Constraint and fixed-interface modes are orthogonal in the stiffness: rounding otherwise.
        self.decoupling = float(np.abs(K[:kept, kept:]).max(initial=0.0) / np.abs(K).max())
        K[:kept, kept:] = K[kept:, :kept] = 0.0
        K[kept:, kept:] = np.diag(squares)
        M[kept:, kept:] = np.eye(len(squares))
        self.mass: Matrix = 0.5 * (M + M.T)
        self.stiffness: Matrix = 0.5 * (K + K.T)
        for array in (self.mass, self.stiffness, self.rows, self.omega, self._basis):
            array.flags.writeable = False

    def __repr__(self) -> str:
        return (
            f"Reduction({self.size} dofs to {len(self.boundary)} of the boundary and "
            f"{self.omega.size} modes)"
        )

    def structure(self, damping: MatrixLike | DampingLaw | None = None) -> Structure:
        """Return the reduced structure.

        Parameters
        ----------
        damping : array_like, Rayleigh, ModalDamping or None, optional
            Viscous damping of the reduced structure, as of `Structure`.

        Returns
        -------
        Structure
            With the degrees of freedom `dofs`.

        Raises
        ------
        ModelError
            If the damping does not fit.
        """
        return Structure(self.mass, self.stiffness, damping, self.dofs)

    def recover(self, reduced: ArrayLike) -> NDArray[np.generic]:
        """Return the motion of all degrees of freedom, x = T q.

        Parameters
        ----------
        reduced : array_like, shape (..., n)
            Motion of the reduced structure, real or complex: a harmonic, an instant, many of them.

        Returns
        -------
        ndarray, shape (..., N)
            In the order of the full matrices.

        Raises
        ------
        ModelError
            If the last dimension is not n.
        """
        q = np.asarray(reduced)
        if not q.ndim or q.shape[-1] != len(self.dofs):
            raise ModelError(
                f"recover: shape {q.shape}; the last dimension must be {len(self.dofs)}, one per "
                "reduced dof"
            )
        return np.asarray(q @ self._basis.T)

    def forces(self, load: ArrayLike, harmonic: int = 1) -> list[Force]:
        """Return what a distributed load does to the reduced structure, T^T f.

        Parameters
        ----------
        load : array_like, shape (N,)
            Forces on all degrees of freedom [N]; complex ones have phases, as those of a travelling
            wave: f(t) = Re(load exp(i k omega t)).
        harmonic : int, optional
            k.

        Returns
        -------
        list of Force
            One per reduced degree of freedom that the load moves.

        Raises
        ------
        ModelError
            If the shape is another, or a number not finite.
        """
        given = np.asarray(load)
        if given.shape != (self.size,) or not np.isfinite(given).all():
            raise ModelError(f"load: shape {given.shape}; give {self.size} finite numbers")
        if harmonic == 0 and np.iscomplexobj(given):
            raise ModelError("load: complex numbers, but a static load has no phases")
        work = self._basis.T @ given
        return [
            Force(dof, float(np.real(value)), harmonic=harmonic)
            if np.isreal(value)
            else Force(dof, abs(value), float(np.angle(value)), harmonic)
            for dof, value in zip(self.dofs, work.tolist(), strict=True)
            if value != 0.0
        ]

    def report(
        self, frequencies: int = 10, springs: Mapping[str, float] | None = None
    ) -> ReductionReport:
        """Check the reduction against the full structure.

        Parameters
        ----------
        frequencies : int, optional
            How many natural frequencies to compare. The full structure is factored once more.
        springs : mapping of str to float, optional
            Springs to ground at boundary degrees of freedom [N/m], on both structures: stuck
            dampers.

        Returns
        -------
        ReductionReport
            Symmetry, rigid-body modes, grounding, masses, frequencies; `print` it.

        Raises
        ------
        ModelError
            If a spring is not at the boundary, or the modes of the full structure are not found.
        """
        added = {}
        for dof, value in (springs or {}).items():
            if dof not in self.boundary:
                raise ModelError(f"springs: {unknown('dof', dof, self.boundary)}")
            added[self.boundary.index(dof)] = real_number(value, f"springs: {dof}")
        return reported(self, frequencies, added)
