"""The symmetric eigenproblem of two matrices; Ctrl-C is heard meanwhile."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.checks import Matrix
from stickslip.interruption import beside

_SMALL = 300
"""Rows up to which it is solved at once: some hundredths of a second."""


def eigen_pencil(first: NDArray[Any], second: NDArray[Any]) -> tuple[Matrix, NDArray[Any]]:
    """Return values, rising, and vectors of A x = value B x, with x^H B x = 1.

    A is Hermitian, B positive definite too; `numpy.linalg.LinAlgError` says that B is not. It is
    LAPACK's way, Cholesky's method and divide and conquer, step by step: SciPy's own lets no other
    thread run until it ends, and so hears no Ctrl-C.
    """
    from scipy.linalg import eigh, solve_triangular

    if len(first) <= _SMALL:
        values, vectors = eigh(first, second)
        return values, vectors

    def work() -> tuple[Matrix, NDArray[Any]]:
        lower = np.linalg.cholesky(second)
        half = solve_triangular(lower, first, lower=True)
        standard = solve_triangular(lower, half.conj().T, lower=True)
        values, turned = np.linalg.eigh(0.5 * (standard + standard.conj().T))
        return values, solve_triangular(lower, turned, lower=True, trans="C")

    return beside(work)
