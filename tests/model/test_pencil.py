"""The symmetric eigenproblem of two matrices."""

import signal
import threading

import numpy as np
import pytest
from scipy.linalg import eigh

from stickslip.interruption import beside
from stickslip.model.damping import eigen_pencil


@pytest.mark.parametrize("size", [20, 350])
@pytest.mark.parametrize("hermitian", [False, True])
def test_values_and_vectors_are_those_of_lapack(size, hermitian):
    rng = np.random.default_rng(size)
    part = rng.standard_normal((2, size, size))
    matrix = part[0] + (1j * part[1] if hermitian else 0.0)
    first = matrix + matrix.conj().T
    second = matrix @ matrix.conj().T + size * np.eye(size)
    values, vectors = eigen_pencil(first, second)
    known, _ = eigh(first, second)
    np.testing.assert_allclose(values, known, rtol=0.0, atol=1e-13 * np.abs(known).max())
    unit = vectors.conj().T @ second @ vectors
    np.testing.assert_allclose(unit, np.eye(size), rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(
        first @ vectors, second @ vectors * values, rtol=0.0, atol=1e-11 * np.abs(first).max()
    )


@pytest.mark.parametrize("size", [20, 350])
def test_a_second_matrix_that_is_not_positive(size):
    with pytest.raises(np.linalg.LinAlgError):
        eigen_pencil(np.eye(size), np.diag(np.r_[np.ones(size - 1), -1.0]))


@pytest.mark.skipif(not hasattr(signal, "SIGALRM"), reason="needs a timer that signals")
def test_ctrl_c_is_heard_beside_compiled_code():
    def stop(*_):
        raise KeyboardInterrupt

    gate, ended = threading.Event(), []
    before = signal.signal(signal.SIGALRM, stop)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.1)
        with pytest.raises(KeyboardInterrupt):
            beside(lambda: ended.append(gate.wait(60.0)))
        assert not ended
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
        gate.set()
    assert beside(lambda: 3) == 3
    with pytest.raises(ValueError, match="told"):
        beside(lambda: (_ for _ in ()).throw(ValueError("told")))
