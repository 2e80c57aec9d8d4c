"""The ridge penalty, chosen on the training rows alone."""

from __future__ import annotations

import numpy as np
from sklearn.model_selection import KFold

from fiberweb.scoring.regression import standardise

PENALTIES = 10.0 ** np.arange(-6, 3)
FOLDS = 5


def best_penalty(readouts: np.ndarray, targets: np.ndarray) -> float:
    """The penalty of `PENALTIES` with the least squared error, relative to each target's variance,
    by cross-validation over `FOLDS` blocks in time.

    Args:
        readouts, targets: (T, p) and (T, q), training rows alone.
    """
    errors = np.zeros(len(PENALTIES))
    variance = np.maximum(targets.var(axis=0), np.finfo(float).tiny)
    for kept, left in KFold(FOLDS).split(readouts):
        x = standardise(readouts[np.concatenate([kept, left])], slice(0, len(kept)))
        mean = targets[kept].mean(axis=0)
        # one decomposition a fold serves all penalties
        left_vectors, values, right = np.linalg.svd(x[: len(kept)], full_matrices=False)
        along, seen = left_vectors.T @ (targets[kept] - mean), x[len(kept) :] @ right.T
        for at, alpha in enumerate(PENALTIES):
            estimate = seen @ ((values / (values**2 + alpha))[:, None] * along) + mean
            errors[at] += (((estimate - targets[left]) ** 2) / variance).mean()
    return float(PENALTIES[np.argmin(errors)])
