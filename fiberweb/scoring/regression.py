"""Ridge regression of many targets on the readouts of one run: options, targets and fits.

Penalty alpha |w|^2 against the sum of squares, an intercept that is not penalised: the
semantics of scikit-learn's `Ridge`, which is the oracle in the tests.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import astuple, dataclass

import numpy as np
from numpy.polynomial.legendre import legvander
from scipy.linalg import LinAlgError, blas, cho_factor, cho_solve

from fiberweb.arguments import positive, shown, spelt, true_or_false, whole
from fiberweb.model.authors import SHUFFLE_SEED
from fiberweb.scoring.limits import ALPHA, HORIZON, SPLIT, check_frames
from fiberweb.scoring.limits import training_end as training_end

SCORINGS = ("clean", "published")
BLOCK = 1_000_000  # values of targets that are held at once


@spelt
@dataclass(frozen=True)
class Options:
    """How a run is scored. In both scorings u is scaled to [-1, 1] over the whole run.

    - clean: all targets share the rows t >= horizon and one chronological split; readouts are
      standardised on the training part; c is kept raw.
    - published: as the authors scored. Readouts are standardised over the whole run, so the test
      part leaks into their scale; each lag is split on its own; an estimate outside [-1, 1], or
      beyond `overshoot`, is replaced, with its target, by the target's mean before c is taken;
      c < 0 counts as 0.

    ValueError for an unknown scoring or a value out of range.
    """

    scoring: str = "clean"
    alpha: float = ALPHA  # penalty alpha |w|^2 against the SUM of squares, standardised readouts
    horizon: float = HORIZON  # longest recall lag, s
    split: float = SPLIT  # fraction of the frames trained on
    skip: int = 0  # first frames dropped before anything else
    shuffle: bool = False  # published only: split nonlinear targets at random, which flatters C_nl
    # published only: what estimates of Legendre and of recall targets may reach without being
    # replaced
    overshoot: tuple[float, float] = (1.0, 1.0)

    def __post_init__(self):
        if self.scoring not in list(SCORINGS):
            valid = " or ".join(map(repr, SCORINGS))
            raise ValueError(f"scoring = {shown(self.scoring)} is unknown; use {valid}")
        above = " is not usable; give a finite number above 0"
        fraction = " is not usable; give a fraction, 0 to 1"
        frames = " is negative or no whole number; give a number of frames, 0 or more"
        if not isinstance(self.overshoot, (list, tuple)) or len(self.overshoot) != 2:
            raise ValueError(
                f"overshoot = {shown(self.overshoot)} is no pair; give the largest estimate of "
                "Legendre and the largest of recall targets"
            )
        values = {
            "alpha": positive("alpha", self.alpha, above),
            "horizon": positive("horizon", self.horizon, above),
            "split": positive("split", self.split, fraction),
            "skip": whole("skip", self.skip, 0, frames),
            "shuffle": true_or_false("shuffle", self.shuffle),
            "overshoot": tuple(positive("overshoot", most, above) for most in self.overshoot),
        }
        if not values["split"] < 1:
            raise ValueError(f"split = {shown(self.split)}{fraction}")
        for name, value in values.items():
            object.__setattr__(self, name, value)
        if self.shuffle and self.scoring != "published":
            raise ValueError("shuffle = True needs scoring = 'published'; 'clean' never shuffles")


@dataclass(frozen=True)
class Fit:
    """Targets over T frames, their estimates, and the rows of either part: all (T, b)."""

    target: np.ndarray
    estimate: np.ndarray
    train: np.ndarray
    test: np.ndarray

    def __getitem__(self, index) -> Fit:
        return Fit(*(a[index] for a in (self.target, self.estimate, self.train, self.test)))


def scale_input(u: np.ndarray) -> np.ndarray:
    """u (T,), any unit, scaled to [-1, 1] by its extremes: the Legendre interval.

    ValueError if u is constant or not finite.
    """
    low, high = np.min(u), np.max(u)
    if not np.isfinite(high - low):
        raise ValueError("u holds values that are not finite; every input sample must be a number")
    if low == high:
        raise ValueError(f"u = {low:g} at every frame; capacity needs an input that varies")
    return 2.0 * (u - low) / (high - low) - 1.0


def legendre_targets(u: np.ndarray, orders: Sequence[int]) -> np.ndarray:
    """z_k = P_k(u(t)), (T, n_orders), of u (T,) already scaled to [-1, 1]."""
    return legvander(u, max(orders, default=0))[:, np.asarray(orders, dtype=int)]


def recall_targets(u: np.ndarray, lags: Sequence[int]) -> np.ndarray:
    """z_tau(t) = u(t - tau), (T, n_lags), of u (T,); lags in frames; NaN while t < tau."""
    targets = np.full((len(u), len(lags)), np.nan)
    for column, lag in enumerate(lags):
        targets[lag:, column] = u[: len(u) - lag]
    return targets


def targets(u: np.ndarray, orders: Sequence[int], lags: Sequence[int]) -> np.ndarray:
    """`legendre_targets`, then `recall_targets`: (T, n_orders + n_lags)."""
    return np.hstack([legendre_targets(u, orders), recall_targets(u, lags)])


def checked(u, readouts, sample_rate, options) -> tuple[np.ndarray, np.ndarray]:
    """u (T - skip,) and readouts (T - skip, p) as floats; ValueError says what is wrong."""
    sample_rate = positive("sample_rate", sample_rate, " is not usable; give a rate above 0 Hz")
    u, readouts = _real("u", u), _real("readouts", readouts)
    if u.ndim != 1 or readouts.ndim != 2 or len(u) != len(readouts) or not readouts.shape[1]:
        raise ValueError(
            f"u has shape {u.shape} and readouts {readouts.shape}; "
            "give (T,) and (T, p) with the same number of frames T, and p at least 1"
        )
    skip = options.skip
    check_frames(len(u), sample_rate, options.horizon, options.split, skip)
    u, readouts = u[skip:], readouts[skip:]
    finite = np.isfinite(readouts)
    if not finite.all():
        frame, signal = np.argwhere(~finite)[0]
        raise ValueError(
            f"readouts[{frame + skip}, {signal}] = {readouts[frame, signal]} is not "
            "finite; an unstable run has no capacity, so give a recording that stays finite"
        )
    return u, readouts


def _real(name: str, values) -> np.ndarray:
    """Values as floats; ValueError, one sentence, if they would have to be bent to that."""
    values = values if isinstance(values, np.ndarray) else np.ma.asarray(values)
    if np.ma.is_masked(values):
        raise ValueError(f"{name} has masked values; fill them, or cut out a stretch without")
    if np.iscomplexobj(values):
        raise ValueError(f"{name} is complex; give its real and imaginary part as two signals")
    if values.dtype.kind not in "fiu":
        raise ValueError(f"{name} has values of type {values.dtype}; give an array of numbers")
    return np.asarray(values, dtype=float)


def fit_targets(u, readouts, orders, lags, horizon, options) -> tuple[Iterator[Fit], Iterator[Fit]]:
    """Fits of P_k for the orders and of recall for the lags in blocks; lags, horizon in frames."""
    u, n = scale_input(u), len(orders)
    clean = options.scoring == "clean"
    fitted = slice(horizon, training_end(horizon, len(u), options.split)) if clean else slice(None)
    x = narrowed(standardise(readouts, fitted))
    starts = np.array([0] * n + list(lags))
    if clean:
        starts[:] = horizon

    def wanted(first, last):
        recalled = lags[max(first - n, 0) : max(last - n, 0)]
        return targets(u, orders[first:last], recalled)

    if options.shuffle:
        order = _shuffled(len(u), options)
        polynomials = Fits(x[order], lambda *block: wanted(*block)[order], starts[:n], options)
        recalls = Fits(x, lambda first, last: wanted(first + n, last + n), starts[n:], options)
        back = np.argsort(order)
        return (fit[back] for fit in polynomials.blocks()), recalls.blocks()
    fits = Fits(x, wanted, starts, options)
    return fits.blocks(0, n), fits.blocks(n)


def standardise(readouts: np.ndarray, fitted: slice) -> np.ndarray:
    """Readouts with mean 0 and variance 1 over the fitted rows; a still column becomes 0."""
    mean = readouts[fitted].mean(axis=0)
    x = readouts - mean
    deviation = np.sqrt(np.einsum("ij,ij->j", x[fitted], x[fitted]) / len(x[fitted]))
    # Still: no motion beyond the round-off of its own mean, which dividing would amplify.
    still = deviation <= len(x) * np.finfo(float).eps * np.abs(mean)
    x /= np.where(still, np.inf, deviation)
    return x


def narrowed(x: np.ndarray) -> np.ndarray:
    """Readouts (T, p) as no more than T columns, with the same ridge estimates: these do not change
    when readouts are rotated, and T rows span no more than T directions."""
    return x if x.shape[1] <= len(x) else np.ascontiguousarray(np.linalg.qr(x.T, mode="r").T)


class Fits:
    """Ridge estimates of q targets from x (T, p), made a few targets at a time: of a long recording
    at a high rate, the targets of all lags are many times what was recorded."""

    def __init__(self, x, targets: Callable[[int, int], np.ndarray], starts, options):
        """targets: from one to before another, (T, b); starts: first row of each split, (q,)."""
        self._x, self._targets, self._starts = x, targets, starts
        self._ends = np.array([training_end(start, len(x), options.split) for start in starts])
        cross, means = np.empty((x.shape[1], len(starts))), np.empty(len(starts))
        for first, last in self._bounds(0, len(starts)):
            target, (train, _) = targets(first, last), self._parts(first, last)
            means[first:last] = mean = mean_of(target, train)
            cross[:, first:last] = x.T @ np.where(train, target - mean, 0.0)
        self._weights, offset = solve_windows(x, cross, starts, self._ends, options.alpha)
        self._intercepts = means - offset

    def blocks(self, first: int = 0, last: int | None = None) -> Iterator[Fit]:
        """The fits of the targets from one to before another, all by default."""
        for block in self._bounds(first, len(self._starts) if last is None else last):
            estimate = self._x @ self._weights[:, slice(*block)]
            estimate += self._intercepts[slice(*block)]
            yield Fit(self._targets(*block), estimate, *self._parts(*block))

    def _bounds(self, first: int, last: int) -> list[tuple[int, int]]:
        width = max(1, BLOCK // len(self._x))
        return [(at, min(at + width, last)) for at in range(first, last, width)]

    def _parts(self, first: int, last: int) -> tuple[np.ndarray, np.ndarray]:
        """Rows of the training and of the test part, (T, b) each."""
        row = np.arange(len(self._x))[:, None]
        starts, ends = self._starts[first:last], self._ends[first:last]
        return (row >= starts) & (row < ends), row >= ends


def joined(fits: Iterable[Fit]) -> Fit:
    """Blocks of targets as one."""
    return Fit(*(np.hstack(each) for each in zip(*map(astuple, fits), strict=True)))


def estimated(readouts, targets, fitted: slice, alpha: float, rows=slice(None)) -> np.ndarray:
    """Ridge estimates (n, q) of targets (T, q) from readouts (T, p), in the rows asked for.

    Scale, mean and weights are of the fitted rows alone, as in the clean scoring.
    """
    x = narrowed(standardise(readouts, fitted))
    mean = targets[fitted].mean(axis=0)
    # x^T (z - mean z) without a copy of all targets
    cross = x[fitted].T @ targets[fitted] - np.outer(x[fitted].sum(axis=0), mean)
    same = np.ones(targets.shape[1], dtype=int)
    weights, offset = solve_windows(x, cross, same * fitted.start, same * fitted.stop, alpha)
    return x[rows] @ weights + (mean - offset)


def _shuffled(frames: int, options) -> np.ndarray:
    """The rows in the order in which sklearn's train_test_split would choose them for the authors'
    random_state."""
    order = np.random.RandomState(SHUFFLE_SEED).permutation(frames)
    tested = frames - training_end(0, frames, options.split)
    return np.roll(order, -tested)  # sklearn tests on the first of the permutation, `Fits` last


def solve_windows(x, cross, starts, ends, alpha) -> tuple[np.ndarray, np.ndarray]:
    """Ridge weights (p, q), and (q,) what they make of the mean of x over each training window.

    x (T, p) has a mean near 0; cross (p, q) = x^T (z - mean z) over the window. Windows differ by
    few rows, so the first one's Gram matrix is kept and only the change from it is updated: the
    change is small, and so is the round-off of hundreds of updates, which collinear readouts need.
    """
    weights, offset = np.empty_like(cross), np.empty(cross.shape[1])
    start, end = starts.min(), ends.min()
    gram = blas.dsyrk(1.0, x[start:end].T, lower=1)
    change, system = np.zeros_like(gram), np.empty_like(gram)
    total = x[start:end].sum(axis=0)
    for next_start in np.unique(starts):
        same = starts == next_start
        next_end = ends[same][0]
        for sign, rows in ((-1.0, x[start:next_start]), (1.0, x[end:next_end])):
            if len(rows):
                change = blas.dsyrk(sign, rows.T, beta=1.0, c=change, lower=1, overwrite_c=1)
                total += sign * rows.sum(axis=0)
        start, end = next_start, next_end
        mean = total / (end - start)
        np.add(gram, change, out=system)
        system = blas.dsyr(start - end, mean, a=system, lower=1, overwrite_a=1)
        weights[:, same] = solve_ridge(system, cross[:, same], alpha)
        offset[same] = mean @ weights[:, same]
    return weights, offset


def solve_ridge(system: np.ndarray, cross: np.ndarray, alpha: float) -> np.ndarray:
    """Ridge weights (p, q) from a Gram matrix (p, p), of which the lower half is read and all is
    overwritten, and from cross products (p, q)."""
    np.einsum("ii->i", system)[:] += alpha
    try:
        factor = cho_factor(system, lower=True, overwrite_a=True, check_finite=False)
    except LinAlgError:
        raise ValueError(
            f"alpha = {alpha:g} is lost in the round-off of these readouts; give a larger one"
        ) from None
    return cho_solve(factor, cross, check_finite=False)


def mean_of(values: np.ndarray, part: np.ndarray) -> np.ndarray:
    return np.where(part, values, 0.0).sum(axis=0) / part.sum(axis=0)
