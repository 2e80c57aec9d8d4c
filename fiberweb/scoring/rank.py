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
        ``n_signals``: p; ``rank``: of the standardised readouts, to round-off; ``effective_rank``:
        exp of the entropy of the shares that the principal components have of the variance, the
        readouts as they are (`selection.effective_rank` standardises them first);
        ``kernel_rank`` and ``generalisation_rank``: see above, NaN of a recording too short for
        them, which has fewer than 2 p moments a step apart.
    """
    x = readouts[fitted] - readouts[fitted].mean(axis=0)
    share = np.linalg.svd(x / max(np.abs(x).max(), 1e-300), compute_uv=False) ** 2
    share = share[share > 0] / max(share.sum(), 1e-300)
    x = standardise(readouts, fitted)[fitted]
    found = {
        "n_signals": readouts.shape[1],
        "rank": int(np.linalg.matrix_rank(x)),
        "effective_rank": float(np.exp(-(share * np.log(share)).sum())),
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
