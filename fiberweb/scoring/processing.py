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

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations_with_replacement
from math import comb

import numpy as np
from numpy.polynomial.legendre import legvander
from scipy.linalg import blas, solve_triangular

from fiberweb.scoring.blocks import block_sums
from fiberweb.scoring.regression import estimated, solve_ridge, standardise

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
    """The functions of the score card: those of `DEGREES` that a recording is long enough for.

    Args:
        u: (T,) input, scaled to [-1, 1].
        fitted: training rows; they begin `longest` frames or more after the start.
        longest: delay, frames.
    """
    step = apart(u[fitted], longest)
    allowed = min(MOST, _rows(fitted) // ROWS_EACH) // len(DEGREES)
    return products(u, fitted, step, {d: _reach(d, longest // step, allowed) for d in DEGREES})


def products(u: np.ndarray, fitted: slice, step: int, delays: Mapping[int, int]) -> Basis:
    """All products of Legendre polynomials of delayed inputs, made orthogonal.

    Args:
        u: (T,) input, scaled to [-1, 1].
        fitted: training rows, more than functions; they begin as late as the longest delay.
        step: frames from one delay to the next.
        delays: of each degree, in rising order, the longest delay in steps.
    """
    powers = legvander(u, max(delays))
    columns, degrees, longest = [], [], []
    for degree, reach in delays.items():
        for term in _terms(degree, reach):
            product = np.ones(len(u))
            for delay, power in term:
                product[delay * step :] *= powers[: len(u) - delay * step, power]
            columns.append(product)
            degrees.append(degree)
            longest.append(step * max(delay for delay, _ in term))
    values = np.stack(columns, axis=1)
    values -= values[fitted].mean(axis=0)
    norms = np.sqrt((values[fitted] ** 2).mean(axis=0))
    kept = norms > NEW * NEW  # of a binary input, a square is always the same
    values[:, kept] /= norms[kept]
    values, kept = _orthogonal(values[:, kept], fitted, np.flatnonzero(kept))
    return Basis(values, np.array(degrees)[kept], np.array(longest)[kept])


def _orthogonal(values: np.ndarray, fitted: slice, numbers: np.ndarray):
    """Functions (T, q) made orthogonal on the training rows, and the numbers of those that say
    something new."""
    rows = _rows(fitted)
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
    return sums, _threshold(readouts, z, fitted, alpha, block)


def _threshold(readouts, z, fitted: slice, alpha: float, block: int) -> float:
    """The largest capacity that chance gives, see `processing`.

    Each surrogate is a fit of its own, with the scale, mean and penalty of its own training rows.
    But all share the rows from the first training row on, so the Gram matrix of these is made once,
    and from it that of the surrogate's test rows is taken, which are the fewer.
    """
    x, start, rows = standardise(readouts, fitted)[fitted.start :], fitted.start, _rows(fitted)
    whole, added = blas.dsyrk(1.0, x.T, lower=1), x.sum(axis=0)
    mean_z, unseen = z[fitted].mean(axis=0), z[fitted.stop :]
    spread = ((unseen - unseen.mean(axis=0)) ** 2).sum(axis=0)
    random, paired, highest = np.random.default_rng(0), np.zeros((len(x), z.shape[1])), 0.0
    for _ in range(SURROGATES):
        order = _in_blocks(start, len(readouts), block, random)[start:] - start
        left = x[order[rows:]]
        mean = (added - left.sum(axis=0)) / rows
        gram = blas.dsyrk(-1.0, left.T, beta=1.0, c=whole, lower=1)
        gram = blas.dsyr(-rows, mean, a=gram, lower=1, overwrite_a=1)
        scale = np.sqrt(np.maximum(np.diag(gram) / rows, 0.0))
        # what moves in the test rows alone leaves the round-off of the difference here
        scale[scale**2 <= len(x) * np.finfo(float).eps * np.diag(whole) / rows] = np.inf
        gram /= scale[:, None] * scale
        paired[order[:rows]], paired[order[rows:]] = z[fitted] - mean_z, 0.0
        weights = solve_ridge(gram, (x.T @ paired) / scale[:, None], alpha) / scale[:, None]
        guess = left @ weights + (mean_z - mean @ weights)
        error = ((guess - unseen) ** 2).sum(axis=0)
        highest = max(highest, 1.0 - (error / spread).min())
    return highest


def total(c: np.ndarray, counted: np.ndarray) -> np.ndarray:
    """Total capacity, (...), of c (..., q), of the functions that count, (q,)."""
    return np.where(counted, c, 0.0).sum(axis=-1)


def by_degree_and_delay(functions: Basis, c: np.ndarray) -> dict[tuple[int, int], float]:
    """Capacities (q,) of the functions added up by (degree, longest delay in frames)."""
    found: dict[tuple[int, int], float] = {}
    for degree, delay, value in zip(functions.degree, functions.delay, c, strict=True):
        where = int(degree), int(delay)
        found[where] = found.get(where, 0.0) + float(value)
    return found


def _reach(degree: int, longest: int, allowed: int) -> int:
    """Steps of delay, at most `longest`, of which a degree has no more than the functions allowed;
    at least 0."""
    reach = 0
    while reach < longest and comb(reach + 1 + degree, degree) <= allowed:
        reach += 1
    return reach


def _terms(degree: int, longest: int) -> Iterator[tuple[tuple[int, int], ...]]:
    """Products of a degree as ((delay, power), ...), short delays first; delays in steps."""
    chosen = combinations_with_replacement(range(longest + 1), degree)
    for term in sorted(chosen, key=lambda term: (max(term), term)):
        yield tuple((delay, term.count(delay)) for delay in sorted(set(term)))


def _rows(part: slice) -> int:
    return part.stop - part.start


def _in_blocks(start: int, frames: int, block: int, random) -> np.ndarray:
    """All frames, those from `start` on in blocks whose order is random."""
    blocks = [np.arange(at, min(at + block, frames)) for at in range(start, frames, block)]
    return np.concatenate([np.arange(start), *(blocks[i] for i in random.permutation(len(blocks)))])
