"""An echo-state network: the yardstick for a physical reservoir with as many signals.

x(t) = (1 - a) x(t - 1) + a tanh(W x(t - 1) + w u(t) + b), from rest: Jaeger 2001, "The 'echo
state' approach to analysing and training recurrent neural networks", GMD Report 148; with the
leak as in Lukoševičius 2012, "A practical guide to applying echo state networks", Eqs. 2 and 3.
The numbers below are common ones, fitted to no task.
"""

from __future__ import annotations

import numpy as np

SPECTRAL_RADIUS = 0.9  # of W, dense and uniform before it is scaled
LEAK = 0.5  # a
INPUT_SCALING = 0.5  # w is uniform between plus and minus this
BIAS_SCALING = 0.5  # and so is b
SEED = 0


def states(u: np.ndarray, nodes: int) -> np.ndarray:
    """States of every node as the input drives the network; the same for the same arguments.

    Args:
        u: (T,) input, dimensionless, scaled to [-1, 1].
        nodes: how many.

    Returns:
        (T, nodes), dimensionless; row t has seen u up to and including u(t).

    Raises:
        ValueError: fewer than one node.
    """
    if nodes < 1:
        raise ValueError(f"nodes = {nodes} makes no network; give 1 or more")
    random = np.random.default_rng(SEED)
    recurrent = random.uniform(-1.0, 1.0, (nodes, nodes))
    recurrent *= SPECTRAL_RADIUS / np.abs(np.linalg.eigvals(recurrent)).max()
    entry = random.uniform(-INPUT_SCALING, INPUT_SCALING, nodes)
    bias = random.uniform(-BIAS_SCALING, BIAS_SCALING, nodes)
    x = np.zeros((len(u) + 1, nodes))
    for t, value in enumerate(u):
        pull = np.tanh(recurrent @ x[t] + entry * value + bias)
        x[t + 1] = (1.0 - LEAK) * x[t] + LEAK * pull
    return x[1:]
