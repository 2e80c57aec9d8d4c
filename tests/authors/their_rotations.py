"""PyElastica 0.3.2 as the authors ran it: with their logarithm of a rotation, and its own stepper.

Facts, and none of their code: they clip the trace at 3, take no offset off the argument of arccos,
and divide by sin(theta + 1e-14).
"""

import numpy as np
from elastica.rod import cosserat_rod
from elastica.timestepper import extend_stepper_interface
from numba import njit

from fiberweb.engines import cosserat, elastica


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


def run_steps(simulator, stepper, time, step, count):
    """`fiberweb.engines.elastica.run_steps` in the words of 0.3.2."""
    do_step, stages = extend_stepper_interface(stepper, simulator)
    for _ in range(count):
        time = do_step(stepper, stages, simulator, time, step)
    return time


def install(patch, banded: bool) -> None:
    """Make the elastica engine run on 0.3.2, with their function or with its own; PyElastica must
    not have compiled anything yet, nor have a cache on disk."""
    patch.setattr(elastica, "run_steps", run_steps)
    patch.setattr(elastica, "DampedFirst", elastica.Simulator)  # the order of 0.3.2 itself
    if banded:
        patch.setattr(cosserat_rod, "_inv_rotate", inv_rotate)
        patch.setattr(elastica, "refuse", cosserat.refuse)
