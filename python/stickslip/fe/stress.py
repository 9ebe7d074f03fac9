"""Dynamic stress: what a fatigue assessment asks of a periodic motion."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.checks import whole_number
from stickslip.errors import ModelError

__all__ = ["von_mises", "von_mises_range"]

_BLOCK = 2000
"""Nodes at a time: the differences of all instants of so many fit into memory."""


def von_mises(stress: ArrayLike) -> NDArray[np.float64]:
    """Return the von Mises equivalent of real stresses.

    Parameters
    ----------
    stress : array_like, shape (..., 6)
        xx, yy, zz, yz, xz, xy [Pa].

    Returns
    -------
    ndarray of float64, shape (...)
        [Pa].
    """
    xx, yy, zz, yz, xz, xy = np.moveaxis(np.asarray(stress, dtype=np.float64), -1, 0)
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.asarray(np.sqrt(0.5 * normal + 3.0 * (yz**2 + xz**2 + xy**2)))


def von_mises_range(harmonics: ArrayLike, samples: int = 64) -> NDArray[np.float64]:
    """Return the range of the von Mises stress over a period.

    The largest von Mises equivalent of the difference of the stresses at two instants,
    max over t1, t2 of vM(s(t1) - s(t2)). Unlike the range of vM(s(t)), which has no sign, it is
    twice the amplitude in a motion that goes as far to either side, and static stress adds nothing.

    Parameters
    ----------
    harmonics : array_like of complex, shape (H+1, n, 6)
        S_k of s(t) = Re sum_k S_k exp(i k omega t): xx, yy, zz, yz, xz, xy [Pa].
    samples : int, optional
        Instants per period between which the difference is taken, an even number.

    Returns
    -------
    ndarray of float64, shape (n,)
        [Pa].

    Raises
    ------
    ModelError
        If the shape is another, or `samples` is not an even number from 4.

    References
    ----------
    The equivalent stress range of ASME BPVC VIII-2, 5.5.3 (components of two instants subtracted).
    """
    given = np.asarray(harmonics)
    if given.ndim != 3 or given.shape[2] != 6:
        raise ModelError(f"stress: shape {given.shape}; give (harmonics, nodes, 6)")
    count = whole_number(samples, "samples", smallest=4)
    if count % 2:
        raise ModelError(f"samples: {count} is odd; half periods need an even number")
    phases = np.exp(2j * np.pi * np.outer(np.arange(count) / count, np.arange(len(given))))
    largest = np.zeros(given.shape[1])
    for start in range(0, given.shape[1], _BLOCK):
        nodes = slice(start, start + _BLOCK)
        history = np.real(np.tensordot(phases, given[:, nodes], axes=1))  # (instant, node, 6)
        for lag in range(1, count // 2 + 1):
            difference = von_mises(history - np.roll(history, lag, axis=0)).max(axis=0)
            largest[nodes] = np.maximum(largest[nodes], difference)
    return largest
