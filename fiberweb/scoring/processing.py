"""Total information-processing capacity by degree and delay.

Dambre et al. 2012, "Information processing capacity of dynamical systems", Sci. Rep. 2, 514: the
capacities of a complete set of orthogonal functions of the input's past add up to no more than the
number of linearly independent signals. The functions are products of Legendre polynomials of
delayed inputs, made orthogonal on the training rows one after the other, by degree and then by
delay: each counts for what those before it do not say, whatever the input is (Kubota, Takahashi &
Nakajima 2021, Phys. Rev. Research 3, 043135). That mixes each with what those before it fit by
chance, so that up to q/T of a capacity is lost, of q functions on T rows.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations_with_replacement
from math import comb

import numpy as np
from numpy.polynomial.legendre import legvander
from scipy.linalg import solve_triangular

from fiberweb.scoring.blocks import block_sums
from fiberweb.scoring.regression import estimated

DEGREES = (1, 2, 3)
MOST = 450  # functions ...
ROWS_EACH = 16  # ... or one for so many training rows
ALIKE = 0.5  # correlation of the input with itself at which delays count as different
NEW = 1e-2  # of a function's rms has to be new: a ten-thousandth of its variance
SURROGATES = 99  # by chance, one in a hundred recordings of nothing has any capacity


@dataclass(frozen=True)
class Basis:
    """Orthogonal functions of the input's past.

    Attributes:
        values: (T, q), mean 0 and variance 1 over the training rows.
        degree: (q,) of each.
        delay: (q,) the longest in each, in frames.
    """

    values: np.ndarray
    degree: np.ndarray
    delay: np.ndarray


def apart(u: np.ndarray, longest: int) -> int:
    """Frames after which an input (T,) resembles itself by less than `ALIKE`, at most `longest`."""
    v = u - u.mean()
    power = v @ v
    return next((k for k in range(1, longest) if v[k:] @ v[:-k] < ALIKE * power), max(1, longest))


def basis(u: np.ndarray, fitted: slice, longest: int) -> Basis:
    """The functions that a recording is long enough for.

    Args:
        u: (T,) input, scaled to [-1, 1].
        fitted: training rows; they begin `longest` frames or more after the start.
        longest: delay, frames.
    """
    step = apart(u[fitted], longest)
    allowed = min(MOST, (fitted.stop - fitted.start) // ROWS_EACH) // len(DEGREES)
    powers = legvander(u, max(DEGREES))
    columns, degrees, delays = [], [], []
    for degree in DEGREES:
        for term in _terms(degree, longest // step, allowed):
            product = np.ones(len(u))
            for delay, power in term:
                product[delay * step :] *= powers[: len(u) - delay * step, power]
            columns.append(product)
            degrees.append(degree)
            delays.append(step * max(delay for delay, _ in term))
    values = np.stack(columns, axis=1)
    values -= values[fitted].mean(axis=0)
    norms = np.sqrt((values[fitted] ** 2).mean(axis=0))
    kept = norms > NEW * NEW  # of a binary input, a square is always the same
    values[:, kept] /= norms[kept]
    values, kept = _orthogonal(values[:, kept], fitted, np.flatnonzero(kept))
    return Basis(values, np.array(degrees)[kept], np.array(delays)[kept])


def _orthogonal(values: np.ndarray, fitted: slice, numbers: np.ndarray):
    """Functions (T, q) made orthogonal on the training rows, and the numbers of those that say
    something new."""
    rows = fitted.stop - fitted.start
    corner = np.linalg.qr(values[fitted], mode="r")
    new = np.abs(np.diag(corner)) > NEW * np.sqrt(rows)
    values = np.ascontiguousarray(values[:, new])
    corner = np.linalg.qr(values[fitted], mode="r")
    return solve_triangular(corner, values.T, trans="T").T * np.sqrt(rows), numbers[new]


def processing(
    readouts: np.ndarray, functions: Basis, fitted: slice, alpha: float, block: int
) -> tuple[np.ndarray, float]:
    """What readouts (T, p) have of each function on the test part.

    Args:
        readouts: (T, p), any unit.
        functions: from `basis`.
        fitted: training rows; those after them are tested on.
        alpha: ridge penalty.
        block: frames that are redrawn together, see `fiberweb.scoring.blocks`.

    Returns:
        The sums of `block_sums` over the test part, (4, blocks, q), and the threshold: the largest
        capacity of any function in `SURROGATES` recordings whose readouts belong to another time,
        blocks of them having been put in random order. What is below counts as 0.
    """
    z, tested = functions.values, slice(fitted.stop, None)
    estimate = estimated(readouts, z, fitted, alpha, tested)
    part = np.ones_like(estimate, dtype=bool)
    sums = block_sums(z[tested], estimate, part, block)
    random = np.random.default_rng(0)
    highest, spread = 0.0, ((z[tested] - z[tested].mean(axis=0)) ** 2).sum(axis=0)
    for _ in range(SURROGATES):
        order = _in_blocks(fitted.start, len(readouts), block, random)
        guess = estimated(readouts[order], z, fitted, alpha, tested)
        error = ((guess - z[tested]) ** 2).sum(axis=0)
        highest = max(highest, 1.0 - (error / spread).min())
    return sums, highest


def total(c: np.ndarray, counted: np.ndarray) -> np.ndarray:
    """Total capacity, (...), of c (..., q), of the functions that count, (q,)."""
    return np.where(counted, c, 0.0).sum(axis=-1)


def _terms(degree: int, longest: int, allowed: int) -> Iterator[tuple[tuple[int, int], ...]]:
    """Products of a degree as ((delay, power), ...), over as many delays as are allowed, those of
    short delay first."""
    delays = 0
    while delays < longest and comb(delays + 1 + degree, degree) <= allowed:
        delays += 1
    chosen = combinations_with_replacement(range(delays + 1), degree)
    for term in sorted(chosen, key=lambda term: (max(term), term)):
        yield tuple((delay, term.count(delay)) for delay in sorted(set(term)))


def _in_blocks(start: int, frames: int, block: int, random) -> np.ndarray:
    """All frames, those from `start` on in blocks whose order is random."""
    blocks = [np.arange(at, min(at + block, frames)) for at in range(start, frames, block)]
    return np.concatenate([np.arange(start), *(blocks[i] for i in random.permutation(len(blocks)))])
