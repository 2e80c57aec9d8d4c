"""How few signals keep the capacity: forward selection."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fiberweb.scoring.limits import ALPHA
from fiberweb.scoring.regression import (
    Options,
    checked,
    scale_input,
    standardise,
    targets,
    training_end,
)

TARGETS = ("c_nl", "c_m")
ORDERS = np.arange(1, 11)  # Legendre polynomials of C_nl


@dataclass(frozen=True)
class Selection:
    """Signals in the order in which they were chosen, and what the first k of them score.

    Totals are means of max(c, 0) as in `fiberweb.scoring.capacity`, each of shape (k,).
    """

    signal: np.ndarray  # (k,) column of the readouts
    c_nl: np.ndarray
    c_m: np.ndarray
    c_nl_train: np.ndarray
    c_m_train: np.ndarray


def forward(
    u: np.ndarray, readouts: np.ndarray, sample_rate: float, target: str, alpha: float = ALPHA
) -> Selection:
    """Choose signals one by one for C_nl or for C_m, on the training part alone.

    Each step adds the signal that lowers most the penalised square error of the ridge fit, each
    target's error being taken over its spread, and the mean over the targets of C_nl or C_m:
    orthogonal least squares (Chen, Billings & Luo, Int. J. Control 50, 1873, 1989) with the
    penalty in the Gram matrix. The sets so found are nested, and need not be the best of their
    size. Rows, split and standardising are those of the clean scoring.

    Args:
        u: (T,) input, any unit.
        readouts: (T, p), m.
        sample_rate: Hz.
        target: "c_nl" or "c_m".
        alpha: ridge penalty.

    Returns:
        A `Selection` of all signals that move.

    Raises:
        ValueError: another target, or as `fiberweb.scoring.capacity.score_arrays`.
    """
    if target not in TARGETS:
        raise ValueError(f"target = {target!r} is unknown; use 'c_nl' or 'c_m'")
    train, test, nonlinear = _parts(u, readouts, sample_rate, Options(alpha=alpha))
    wanted = nonlinear if target == "c_nl" else ~nonlinear
    order, c_train, c_test = _pursue(train, test, wanted, alpha)
    return Selection(order, *_means(c_test, nonlinear), *_means(c_train, nonlinear))


def needed(c: np.ndarray, share: float) -> int:
    """Least number of signals from which on c (k,) of the first k stays at share c[-1] or above."""
    below = np.flatnonzero(c < share * c[-1])
    return int(below[-1]) + 2 if len(below) else 1


class _Part(NamedTuple):
    """Moments of the rows of one part about the training part's means."""

    gram: np.ndarray  # (p, p) x^T x
    cross: np.ndarray  # (p, q) x^T z
    square: np.ndarray  # (q,) z^T z
    spread: np.ndarray  # (q,) of z about the mean of this part itself


def _parts(u, readouts, sample_rate, options) -> tuple[_Part, _Part, np.ndarray]:
    """Training part, test part, and which of the targets are Legendre polynomials."""
    u, readouts = checked(u, readouts, sample_rate, options)
    horizon = round(options.horizon * sample_rate)
    end = training_end(horizon, len(u), options.split)
    train, test = slice(horizon, end), slice(end, None)
    x = standardise(readouts, train)
    z = targets(scale_input(u), ORDERS, np.arange(horizon + 1))
    z -= z[train].mean(axis=0)
    nonlinear = np.arange(z.shape[1]) < len(ORDERS)
    return _moments(x[train], z[train]), _moments(x[test], z[test]), nonlinear


def _moments(x: np.ndarray, z: np.ndarray) -> _Part:
    square = np.einsum("ij,ij->j", z, z)
    return _Part(x.T @ x, x.T @ z, square, square - len(z) * z.mean(axis=0) ** 2)


def _pursue(train: _Part, test: _Part, wanted: np.ndarray, alpha: float):
    """Forward selection for the wanted targets.

    Returns:
        Signals in their order (k,), and c of every target (k, q) with the first of them, on the
        training and on the test part.
    """
    # Gram-Schmidt in the Gram matrix: ``left`` and ``cross`` are what the chosen signals leave of
    # it and of its product with the targets; column i of ``makers`` makes signal i's remainder.
    left = train.gram + alpha * np.eye(len(train.gram))
    cross = train.cross
    makers = np.eye(len(left))
    residuals = [_Residual(train), _Residual(test)]
    free = np.diag(train.gram) > 0
    scale = np.where(wanted, 1.0 / train.spread, 0.0)
    chosen, c = [], []
    while free.any():
        gain = np.where(free, cross**2 @ scale / np.diag(left), -1.0)
        best = int(np.argmax(gain))
        share = left[best] / left[best, best]
        weight = cross[best] / left[best, best]
        c.append([residual.add(makers[:, best], weight) for residual in residuals])
        chosen.append(best)
        share[~free] = 0.0
        share[best] = 0.0
        cross = cross - np.outer(share, cross[best])
        left = left - np.outer(share, left[best])
        makers = makers - np.outer(makers[:, best], share)
        free[best] = False
    c = np.array(c).reshape(len(chosen), 2, len(scale))
    return np.array(chosen, dtype=int), c[:, 0], c[:, 1]


class _Residual:
    """Square error of every target on one part while combinations of signals are added."""

    def __init__(self, part: _Part):
        self.part, self.cross, self.square = part, part.cross, part.square

    def add(self, combination: np.ndarray, weight: np.ndarray) -> np.ndarray:
        """c of every target (q,) with weight (q,) times the combination (p,) added."""
        moved = self.part.gram @ combination
        self.square = self.square - weight * (
            2.0 * combination @ self.cross - weight * (combination @ moved)
        )
        self.cross = self.cross - np.outer(moved, weight)
        return 1.0 - self.square / self.part.spread


def _means(c: np.ndarray, nonlinear: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """C_nl and C_m, (k,) each, of c (k, q)."""
    c = np.maximum(c, 0.0)
    return c[:, nonlinear].mean(axis=1), c[:, ~nonlinear].mean(axis=1)
