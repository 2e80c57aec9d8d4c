"""Sums over blocks of frames, and what redrawing the blocks says of a capacity's error."""

from __future__ import annotations

import math

import numpy as np

from fiberweb.scoring.regression import mean_of

REPLICATES = 400  # of the bootstrap
INTERVAL = (2.5, 97.5)  # percentiles


def block_sums(target, estimate, part, block) -> np.ndarray:
    """(4, blocks, b): rows, sum z, sum z^2 and sum (zhat - z)^2 of the part, per block of frames.

    Blocks count back from the last frame of the part, where the test parts of all lags end
    together; the first may be short, and those before the part are empty. z is taken from the
    part's mean, which keeps its digits.
    """
    end = np.flatnonzero(part.any(axis=1))[-1] + 1
    target, estimate, part = target[:end], estimate[:end], part[:end]
    z = np.where(part, target - mean_of(target, part), 0.0)
    error = np.where(part, estimate - target, 0.0)
    edges = np.arange(len(part), 0, -block)[::-1] - block
    edges[0] = 0
    return np.stack([np.add.reduceat(v, edges) for v in (part * 1.0, z, z * z, error * error)])


def capacity_of(sums: np.ndarray) -> np.ndarray:
    """c[z] from sums (4, ...) of `block_sums`; a target that does not vary has none: 0."""
    n, z, zz, error = sums
    spread = zz - z * z / np.maximum(n, 1.0)
    varies = spread > 1e-12 * n  # targets are of order 1
    return np.where(varies, 1.0 - error / np.where(varies, spread, 1.0), 0.0)


def redrawn(sums: np.ndarray) -> np.ndarray | None:
    """Sums (4, REPLICATES, q) of blocks drawn with replacement from those of sums (4, blocks, q)
    that are not empty: the same draws whenever there are as many; None of fewer than two."""
    sums = sums[:, sums[0].any(axis=1)]
    blocks = sums.shape[1]
    if blocks < 2:
        return None
    draws = np.random.default_rng(0).multinomial(blocks, np.full(blocks, 1 / blocks), REPLICATES)
    return draws.astype(float) @ sums


def interval(draws: np.ndarray | None) -> tuple[float, float]:
    """The ends between which 95 % of redrawn values (REPLICATES,) lie; NaN of None."""
    return (
        (math.nan, math.nan) if draws is None else tuple(map(float, np.percentile(draws, INTERVAL)))
    )


def bootstrap_error(sums: np.ndarray) -> float:
    """Standard error of the mean of max(c, 0) as the blocks of sums (4, blocks, q) are redrawn."""
    if (draws := redrawn(sums)) is None:
        return math.nan
    c = capacity_of(draws)
    return float(np.maximum(c, 0.0).mean(axis=1).std(ddof=1))
