"""NARMA-n, nonlinear autoregressive moving averages of the input, as targets.

The recursions, with y and u zero before the start and u scaled to [0, amplitude]:

- n = 2: y(t+1) = 0.4 y(t) + 0.4 y(t) y(t-1) + 0.6 u(t)^3 + 0.1
- n = 5, 10: y(t+1) = 0.3 y(t) + 0.05 y(t) sum_{i=0}^{n-1} y(t-i) + 1.5 u(t-n+1) u(t) + 0.1

They are written out here because public implementations differ by an index.
"""

from __future__ import annotations

import math

import numpy as np

ORDERS = (2, 5, 10)  # of the paper
DIVERGED = 10.0  # far above the 1.24 beyond which nothing holds NARMA-10 back


def narma(u: np.ndarray, order: int) -> np.ndarray:
    """The NARMA series of an input.

    Args:
        u: (T,) input, dimensionless, at least 0.
        order: n, one of `ORDERS`.

    Returns:
        (T + 1,) y(0) = 0 up to y(T), dimensionless; y(t) depends on u before t alone.

    Raises:
        ValueError: another order, or a series that diverges: the sentence has the safe range.
    """
    if order not in ORDERS:
        raise ValueError(f"order = {order} is no NARMA task of the paper; use 2, 5 or 10")
    past = np.zeros(order)  # zero start: what the recursion reads before t = 0
    y, given = np.concatenate([past, np.zeros(len(u))]), np.concatenate([past, u])
    y = np.append(y, 0.0)
    for t in range(order, len(given)):
        if order == 2:
            y[t + 1] = 0.4 * y[t] + 0.4 * y[t] * y[t - 1] + 0.6 * given[t] ** 3 + 0.1
        else:
            recent = y[t - order + 1 : t + 1].sum()
            drive = 1.5 * given[t - order + 1] * given[t]
            y[t + 1] = 0.3 * y[t] + 0.05 * y[t] * recent + drive + 0.1
        if y[t + 1] > DIVERGED:
            raise ValueError(
                f"NARMA-{order} diverges for this input scaled to 0 to {np.max(u):.3g}; it is safe "
                f"for any input from 0 to {safe_amplitude(order):.3g}"
            )
    return y[order:]


def safe_amplitude(order: int) -> float:
    """The largest amplitude a for which no input in [0, a] makes the series diverge.

    All terms are positive, so that y stays below the smaller fixed point Y of the recursion at
    u = a while there is one: Y = 0.4 Y + 0.4 Y^2 + 0.6 a^3 + 0.1 for n = 2, and
    Y = 0.3 Y + 0.05 n Y^2 + 1.5 a^2 + 0.1 otherwise; a constant input of a little more diverges.
    """
    if order == 2:
        return math.cbrt((0.6**2 / 1.6 - 0.1) / 0.6)
    return math.sqrt((0.7**2 / (0.2 * order) - 0.1) / 1.5)
