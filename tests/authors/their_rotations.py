"""PyElastica 0.3.2 with the authors' logarithm of a rotation in the place of its own.

Facts, and none of their code: they clip the trace at 3, take no offset off the argument of arccos,
and divide by sin(theta + 1e-14).
"""

import numpy as np
from elastica.rod import cosserat_rod
from numba import njit


@njit
def inv_rotate(directors):
    """Rotation vectors between neighbouring directors (3, 3, n), shape (3, n - 1)."""
    count = directors.shape[2] - 1
    vectors = np.empty((3, count))
    for k in range(count):
        trace = 0.0
        for i in range(3):
            row = 0.0
            for j in range(3):
                row += directors[i, j, k + 1] * directors[i, j, k]
            trace += row
        trace = min(trace, 3.0)
        theta = np.arccos(0.5 * trace - 0.5)
        for i in range(3):
            a, b = (i + 2) % 3, (i + 1) % 3
            skew = 0.0
            for j in range(3):
                skew += directors[a, j, k + 1] * directors[b, j, k]
                skew -= directors[b, j, k + 1] * directors[a, j, k]
            vectors[i, k] = skew * (-0.5 * theta / np.sin(theta + 1e-14))
    return vectors


def install() -> None:
    """Before PyElastica compiles anything; its cache on disk must be empty."""
    cosserat_rod._inv_rotate = inv_rotate
