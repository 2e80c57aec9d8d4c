"""How many signals of a recording are different, and how many tell inputs apart.

Kernel rank and generalisation rank: Legenstein & Maass 2007, "Edge of chaos and prediction of
computational performance for neural circuit models", Neural Networks 20, 323. They are ranks of the
states after many different inputs, and after as many that are nearly the same. A recording cannot
be repeated, so both are taken from moments of the one input: spread over it, and those whose recent
input is most alike.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from fiberweb.scoring.regression import standardise

RANKS = {
    "n_signals": "signals that move and are no copies of others",
    "rank": "of the standardised signals, to round-off",
    "effective_rank": "equal singular values of the same entropy, from 1 to n_signals",
    "kernel_rank": "of states after inputs that differ (Legenstein and Maass 2007)",
    "generalisation_rank": "of states after inputs that are nearly the same",
}
NOTICED = 0.01  # of the largest singular value: smaller ones do not count in these two ranks


def ranks(readouts: np.ndarray, u: np.ndarray, fitted: slice, memory: int, step: int) -> dict:
    """Ranks of readouts (T, p), of the training rows alone.

    Args:
        readouts: (T, p), any unit.
        u: (T,) input.
        fitted: training rows; they begin `memory` frames or more after the start.
        memory: frames of input that count as recent.
        step: frames after which the input is another one.

    Returns:
        ``n_signals``: p; ``rank``: of the standardised readouts, to round-off;
        ``effective_rank``: see there;
        ``kernel_rank`` and ``generalisation_rank``: see above, NaN of a recording too short for
        them, which has fewer than 2 p moments a step apart.
    """
    x = standardise(readouts, fitted)[fitted]
    values = np.linalg.svd(x, compute_uv=False)
    found = {
        "n_signals": readouts.shape[1],
        "rank": int((values > values[0] * max(x.shape) * np.finfo(float).eps).sum()),
        "effective_rank": _equal(values),
    }
    moments = np.arange(0, len(x), step)
    count = x.shape[1]
    if len(moments) < 2 * count:
        return found | {"kernel_rank": np.nan, "generalisation_rank": np.nan}
    apart = moments[np.linspace(0, len(moments) - 1, count).astype(int)]
    recent = [u[fitted.start - back :][: len(x)] for back in range(0, memory + 1, step)]
    history = np.stack(recent, axis=1)[moments]
    tree = cKDTree(history)
    distance, _ = tree.query(history, k=[count])
    _, alike = tree.query(history[np.argmin(distance[:, 0])], k=count)
    different = np.linalg.svd(x[apart], compute_uv=False)
    same = np.linalg.svd(x[moments[np.atleast_1d(alike)]], compute_uv=False)
    limit = NOTICED * different[0]
    return found | {
        "kernel_rank": int((different > limit).sum()),
        "generalisation_rank": int((same > limit).sum()),
    }


def effective_rank(readouts: np.ndarray) -> float:
    """Effective rank of signals (T, p) after each is standardised; from 1 to p.

    exp(-sum q log q) with q the singular values over their sum: the number of equal singular
    values of the same entropy (Roy & Vetterli, Proc. EUSIPCO 2007, Eqs. 2-3). Standardised, because
    that is what the readout is given. Signals that stand still count for nothing. ValueError if all
    do.
    """
    x = standardise(readouts, slice(None))
    if not x.any():
        raise ValueError("no signal moves; an effective rank needs at least one that does")
    return _equal(np.linalg.svd(x, compute_uv=False))


def _equal(values: np.ndarray) -> float:
    """How many equal singular values have the entropy of these."""
    share = values[values > 0] / values.sum()
    return float(np.exp(-np.sum(share * np.log(share))))


def different(moved: np.ndarray) -> list[int]:
    """The numbers of the signals (T, p) that move and are no copies of one before: a copy tells
    nothing, and would halve the penalty on what it copies. ValueError if none moves."""
    first: dict[bytes, int] = {}
    for number, column in enumerate(moved.T):
        if np.ptp(column) > 0:
            first.setdefault(column.tobytes(), number)
    if not first:
        raise ValueError("no marker moves in the training part; give a recording of a body")
    return sorted(first.values())
