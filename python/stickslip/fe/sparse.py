"""Large sparse matrices: checked at the door, factored once, their lowest modes by shift-invert."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip import _core
from stickslip.checks import brief
from stickslip.errors import ModelError
from stickslip.interruption import beside
from stickslip.model.damping import eigen_pencil

if TYPE_CHECKING:
    from scipy.sparse import csc_array

CscArray: TypeAlias = "csc_array"
"""Of SciPy, which takes long to load."""
_ASYMMETRY = 1e-8
DENSE = 400
"""Rows up to which a dense eigenproblem is faster and surer than Lanczos' method."""


def asymmetry(matrix: CscArray) -> float:
    """Return the largest |a_ij - a_ji| as a part of the largest |a_ij|."""
    largest = float(abs(matrix).max()) if matrix.nnz else 0.0
    return float(abs(matrix - matrix.T).max()) / largest if largest else 0.0


def symmetric_sparse(value: object, entry: str) -> tuple[CscArray, float]:
    """Return a matrix as sparse, real, finite and exactly symmetric, and how symmetric it was.

    Up to 1e-8 of the largest entry are rounded digits.
    """
    from scipy.sparse import csc_array

    given: Any = value
    try:
        matrix = csc_array(given)
    except (TypeError, ValueError):
        raise ModelError(f"{entry}: {brief(value)} is not a matrix; give a sparse one") from None
    if matrix.dtype.kind not in "fiu":
        raise ModelError(f"{entry}: entries of type {matrix.dtype}; give real numbers")
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1] or not matrix.shape[0]:
        raise ModelError(f"{entry}: shape {matrix.shape}; give a square matrix")
    matrix = matrix.astype(np.float64)
    matrix.sum_duplicates()
    if not np.isfinite(matrix.data).all():
        raise ModelError(f"{entry}: an entry is not finite; every entry must be")
    skew = asymmetry(matrix)
    if skew > _ASYMMETRY:
        raise ModelError(
            f"{entry}: not symmetric, by {skew:.2g} of its largest entry; mirror the triangle that "
            "is filled, or put skew terms into the damping of the reduced structure"
        )
    return (csc_array(0.5 * (matrix + matrix.T)) if skew else matrix), skew


class Factor:
    """A symmetric sparse matrix, factored: by Cholesky's method, or by SuperLU if it is indefinite.

    Raises RuntimeError if it is singular to the last digit, MemoryError if its factors do not fit.
    """

    def __init__(self, matrix: CscArray) -> None:
        self.size = matrix.shape[0]
        self._factor: Any = _cholesky(matrix) or _lu(matrix)

    def solve(self, right: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the solution of one or more right-hand sides, shape (N,) or (N, columns)."""
        solution: NDArray[np.float64] = self._factor.solve(right.reshape(self.size, -1))
        return solution.reshape(right.shape)


def _cholesky(matrix: CscArray) -> _core.SparseCholesky | None:
    matrix.sum_duplicates()
    begins, rows = matrix.indptr.astype(np.int64), matrix.indices.astype(np.int32, copy=False)
    try:
        return _core.SparseCholesky(begins, rows, matrix.data)
    except ValueError:
        return None


def _lu(matrix: CscArray) -> Any:
    from scipy.sparse.linalg import splu

    # Pivots on the diagonal keep the symmetric order, which fills in least.
    options = {"SymmetricMode": True}
    return beside(
        lambda: splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
    )


def lowest_modes(
    stiffness: CscArray, mass: CscArray, count: int, factor: Factor, shift: float = 0.0
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the modes of K x = lambda M x nearest above a shift, which is below every eigenvalue.

    `factor` is that of K - shift M. Squared angular frequencies ascend; shapes, (N, count), are
    mass-normalised, the largest entry of each positive. `numpy.linalg.LinAlgError` says that K -
    shift M is not positive definite, as far as that is noticed.
    """
    from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh

    size = stiffness.shape[0]
    # For half of the modes the basis of Lanczos' method is as large as the matrix, and the highest
    # mode is missing.
    if size <= DENSE or 2 * count >= size:
        # 1 / (lambda - shift): the stiffness has an inverse, the mass of massless dofs has none.
        shifted = (stiffness - shift * mass).toarray()
        inverses, modes = eigen_pencil(mass.toarray(), shifted)
        squares, modes = shift + 1.0 / inverses[-count:], modes[:, -count:]
    else:
        inverse = LinearOperator(stiffness.shape, matvec=factor.solve, dtype=np.float64)
        # A fixed start makes two runs agree to the last digit.
        start = np.random.default_rng(0).standard_normal(size)
        try:
            squares, modes = eigsh(stiffness, count, mass, shift, OPinv=inverse, v0=start)
        except ArpackError as error:
            raise ModelError(
                f"modes: Lanczos' method failed ({brief(str(error))}); ask for fewer or more modes"
            ) from None
    order = np.argsort(squares)
    squares, modes = squares[order], modes[:, order]
    modes = modes / np.sqrt(np.einsum("ij,ij->j", modes, mass @ modes))
    largest = modes[np.abs(modes).argmax(axis=0), np.arange(count)]
    return np.asarray(squares), np.asarray(modes * np.sign(largest))
