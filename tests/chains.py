"""Masses in a row, with springs between them."""

import numpy as np


def in_a_row(springs):
    """Return the stiffness of n masses on n + 1 springs, the first and the last to the ground."""
    k = np.asarray(springs)
    return np.diag(k[:-1] + k[1:]) - np.diag(k[1:-1], 1) - np.diag(k[1:-1], -1)
