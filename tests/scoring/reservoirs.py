"""Inputs, and a random network driven by them."""

import numpy as np

from fiberweb.model.drive import spline

RATE = 50.0


def drive(seconds, rate=RATE):
    return spline(duration=seconds)(np.arange(round(seconds * rate)) / rate)


def reservoir(u, signals, rng, leak=0.1):
    """A leaky random network: something with memory and nonlinearity, in metres."""
    x = np.zeros((len(u), signals))
    coupling = rng.standard_normal((signals, signals)) / np.sqrt(signals)
    entry, bias = rng.standard_normal((2, signals))
    for t in range(1, len(u)):
        pull = np.tanh(coupling @ x[t - 1] + entry * u[t] + bias)
        x[t] = (1 - leak) * x[t - 1] + leak * pull
    return 1e-3 * x
