"""The input: a seeded cubic spline, the same for every run (paper, section "Simulation
experiments": uniform samples at 5 Hz, cubic spline, fixed seed)."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from fiberweb.model.authors import KNOTS, SEED


def spline(seed: int = SEED, duration: float = 100.0, rate: float = 5.0) -> CubicSpline:
    """The input u(t), dimensionless, for 0 <= t <= duration.

    Args:
        seed: of numpy's legacy generator, as the authors used it.
        duration: length needed (s); beyond 100 s the series goes on.
        rate: knots per second (Hz).

    Returns:
        A cubic spline (not-a-knot) through uniform values in [-1, 1], the first one 0. It
        overshoots its knots: to 1.18 for the authors' seed.
    """
    # a shorter run sees the beginning of the same series
    knots = max(KNOTS, int(np.ceil(duration * rate)) + 1)
    values = np.random.RandomState(seed).uniform(-1.0, 1.0, knots)
    values[0] = 0.0
    return CubicSpline(np.arange(knots) / rate, values)
