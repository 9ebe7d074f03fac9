"""Factors of sparse matrices: Cholesky's if they are positive definite, others if they are not."""

import subprocess
import sys

import numpy as np
import pytest
from scipy.sparse import csc_array, diags_array, kron, random_array

from stickslip import _core
from stickslip.fe.sparse import Factor


def plate(side, shift=0.0):
    """A symmetric matrix of a square mesh, its smallest eigenvalue about 20 / side^2 - shift."""
    one = diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(side, side))
    unit = diags_array([np.ones(side)], offsets=[0])
    return csc_array(kron(one, unit) + kron(unit, one) - shift * kron(unit, unit))


@pytest.mark.parametrize(("shift", "positive"), [(0.0, True), (0.3, False)])
def test_solutions_are_those_of_the_matrix(shift, positive):
    matrix = plate(30, shift)
    factor = Factor(matrix)
    assert isinstance(factor._factor, _core.SparseCholesky) == positive
    right = np.random.default_rng(2).standard_normal((900, 3))
    for b in (right, right[:, 0], np.asfortranarray(right), right[:, :0]):
        found = factor.solve(b)
        assert found.shape == b.shape
        np.testing.assert_allclose(matrix @ found, b, atol=1e-10)


def test_random_patterns_have_the_solutions_of_full_matrices():
    rng = np.random.default_rng(4)
    for size in (1, 2, 17, 200):
        half = random_array((size, size), density=0.05, rng=rng)
        matrix = csc_array(half @ half.T + diags_array([np.full(size, 0.1)], offsets=[0]))
        b = rng.standard_normal(size)
        expected = np.linalg.solve(matrix.toarray(), b)
        np.testing.assert_allclose(Factor(matrix).solve(b), expected, rtol=1e-9)


def test_a_singular_matrix_is_refused():
    with pytest.raises(RuntimeError):
        Factor(csc_array(np.diag([1.0, 0.0, 2.0])))


@pytest.mark.skipif(sys.platform != "linux", reason="the address space is limited by Linux alone")
def test_a_factor_that_does_not_fit_is_not_sought_by_another_method():
    """SuperLU would need more memory still, and take minutes to say so."""
    code = """
import resource
import numpy as np
from scipy.sparse import csc_array, diags_array, kron
from stickslip.fe import sparse

one = diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(36, 36))
unit = diags_array([np.ones(36)], offsets=[0])
plane = kron(one, unit) + kron(unit, one)
matrix = csc_array(kron(plane, unit) + kron(kron(unit, unit), one))
sparse.Factor(csc_array(np.eye(3)))
taken = 4096 * int(open("/proc/self/statm").read().split()[0])
resource.setrlimit(resource.RLIMIT_AS, (taken + (ROOM << 20), -1))
sparse._lu = lambda matrix: print("SuperLU")
try:
    sparse.Factor(matrix)
    print("factored")
except MemoryError as error:
    print(error)
"""
    told = []
    for room in (60, 2000):
        run = [sys.executable, "-c", code.replace("ROOM", str(room))]
        told.append(subprocess.run(run, capture_output=True, text=True, timeout=60).stdout.strip())
    assert told == ["matrix: its factor is too large", "factored"]
