"""Nonlinear and memory capacity of a physical reservoir: arrays in, numbers out.

Readouts x(t) estimate a target z[u(t)] linearly, zhat = W x + b, by ridge regression. The capacity
of a target is c[z] = 1 - sum (zhat - z)^2 / sum (z - mean z)^2 over the test part (paper, section
'Quantifying physical reservoir capacity', Eq. c). C_nl is the mean of c over the Legendre
polynomials P_k(u(t)), C_m its mean over the recall targets u(t - tau), tau = 0 .. horizon.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from numbers import Real
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial.legendre import legvander
from scipy.interpolate import CubicSpline
from scipy.linalg import LinAlgError, blas, cho_factor, cho_solve

if TYPE_CHECKING:
    import xarray as xr

SCORINGS = ("clean", "published")
REPLICATES = 400  # of the bootstrap
SHUFFLE_SEED = 42  # the authors' random_state


@dataclass(frozen=True)
class Options:
    """How a run is scored. In both scorings u is scaled to [-1, 1] over the whole run.

    - clean: all targets share the rows t >= horizon and one chronological split; readouts are
      standardised on the training part; c is kept raw.
    - published: as the authors scored. Readouts are standardised over the whole run, so the test
      part leaks into their scale; each lag is split on its own; an estimate outside [-1, 1] is
      replaced, with its target, by the target's mean before c is taken; c < 0 counts as 0.

    ValueError for an unknown scoring or a value out of range.
    """

    scoring: str = "clean"
    alpha: float = 0.01  # penalty alpha |w|^2 against the SUM of squares, standardised readouts
    horizon: float = 1.0  # longest recall lag, s
    split: float = 0.75  # fraction of the frames trained on
    skip: int = 0  # first frames dropped before anything else
    shuffle: bool = False  # published only: split nonlinear targets at random, which flatters C_nl

    def __post_init__(self):
        if self.scoring not in SCORINGS:
            valid = " or ".join(map(repr, SCORINGS))
            raise ValueError(f"scoring = {self.scoring!r} is unknown; use {valid}")
        for key in ("alpha", "horizon"):
            value = getattr(self, key)
            number = isinstance(value, Real) and not isinstance(value, bool)
            if not (number and 0 < value < math.inf):
                raise ValueError(f"{key} = {value!r} is not usable; give a finite number above 0")
        if not 0 < self.split < 1:
            raise ValueError(f"split = {self.split!r} is not usable; give a fraction, 0 to 1")
        if self.skip < 0:
            raise ValueError(
                f"skip = {self.skip!r} is negative; give a number of frames, 0 or more"
            )
        if self.shuffle and self.scoring != "published":
            raise ValueError("shuffle = True needs scoring = 'published'; 'clean' never shuffles")


@dataclass(frozen=True)
class Capacity:
    """Capacities of one run; dimensionless, but for the lags.

    c by the scoring's own rule on the test part and, ``_train``, on the training part; ``_raw``: on
    the test part, nothing replaced or clipped. Totals are means; c < 0 counts as 0 except in
    ``_raw``. ``_se``: standard error of the total, see `score_arrays`.
    """

    orders: np.ndarray  # (n_orders,) of the Legendre polynomials
    lags: np.ndarray  # (n_lags,) s
    nonlinear: np.ndarray  # (n_orders,)
    nonlinear_train: np.ndarray
    nonlinear_raw: np.ndarray
    memory: np.ndarray  # (n_lags,)
    memory_train: np.ndarray
    memory_raw: np.ndarray
    c_nl: float
    c_nl_train: float
    c_nl_raw: float
    c_nl_se: float
    c_m: float
    c_m_train: float
    c_m_raw: float
    c_m_se: float


@dataclass(frozen=True)
class Traces:
    """Targets and raw estimates on the test part; NaN before a target's own test part begins."""

    time: np.ndarray  # (n,) s from the first frame of u
    nonlinear: np.ndarray  # (n, n_orders) estimate
    nonlinear_target: np.ndarray
    memory: np.ndarray  # (n, n_lags) estimate
    memory_target: np.ndarray


@dataclass(frozen=True)
class _Fit:
    """q targets over T frames, their estimates, and the rows of either part: all (T, q)."""

    target: np.ndarray
    estimate: np.ndarray
    train: np.ndarray
    test: np.ndarray

    def __getitem__(self, index) -> _Fit:
        return _Fit(*(a[index] for a in (self.target, self.estimate, self.train, self.test)))


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


def trivial_readouts(u: np.ndarray, sample_rate: float) -> dict[str, np.ndarray]:
    """Readouts made of the input (T,) alone: the floors that a reservoir has to beat.

    ``u`` (T, 1); ``derivatives`` (T, 4): u and its first three time derivatives (sample_rate in
    Hz); ``powers`` (T, 3): u, u^2, u^3. Derivatives are those of the cubic spline through the
    samples: exact for an input that is itself a spline with its knots on frames.
    """
    time = np.arange(len(u)) / sample_rate
    spline = CubicSpline(time, u)
    return {
        "u": np.column_stack([u]),
        "derivatives": np.column_stack([spline(time, order) for order in range(4)]),
        "powers": np.column_stack([u, u**2, u**3]),
    }


def score_arrays(
    u: np.ndarray, readouts: np.ndarray, sample_rate: float, orders: int = 10, **options
) -> Capacity:
    """Capacities of one run and their means, C_nl and C_m.

    u: (T,) input, any unit. readouts: (T, p) displacements, m. sample_rate: Hz. orders: highest
    Legendre order. options: fields of `Options`.

    Standard errors come from resampling blocks of one horizon, counted back from the last frame,
    the same draw for all targets, under the scoring's own replacement and clipping. They cover the
    finite test part, not the finite training part; NaN with fewer than two blocks.

    ValueError for an option out of range, shapes that do not match, values that are not finite, a
    constant u, or a run too short for the horizon.
    """
    options = Options(**options)
    u, readouts = _checked(u, readouts, sample_rate, options)
    if orders < 1:
        raise ValueError(f"orders = {orders} holds no Legendre polynomial; give 1 or more")
    horizon = round(options.horizon * sample_rate)
    orders, lags = np.arange(1, orders + 1), np.arange(horizon + 1)
    nonlinear, memory = _fit_targets(u, readouts, orders, lags, horizon, options)
    return _assemble(
        orders,
        lags / sample_rate,
        _score_fit(nonlinear, options.scoring, horizon),
        _score_fit(memory, options.scoring, horizon),
    )


def predict(
    u: np.ndarray,
    readouts: np.ndarray,
    sample_rate: float,
    orders: Sequence[int] = (4, 5, 6, 7),
    lags: Sequence[float] = (0.2, 0.4),
    **options,
) -> Traces:
    """Target and raw estimate over the test part, fitted as `score_arrays` fits them.

    orders: Legendre orders; lags: s, none above the horizon; the rest, shapes, units and errors as
    in `score_arrays`. The defaults are the traces of Fig. 1d.
    """
    options = Options(**options)
    u, readouts = _checked(u, readouts, sample_rate, options)
    for lag in lags:
        if not 0 <= lag <= options.horizon:
            raise ValueError(f"lag = {lag:g} s is outside 0 to horizon = {options.horizon:g} s")
    frames = [round(lag * sample_rate) for lag in lags]
    fits = _fit_targets(u, readouts, orders, frames, round(options.horizon * sample_rate), options)
    rows = np.hstack([fit.test for fit in fits]).any(axis=1)
    values = [np.where(f.test, v, np.nan)[rows] for f in fits for v in (f.estimate, f.target)]
    return Traces((np.flatnonzero(rows) + options.skip) / sample_rate, *values)


def score(
    response: xr.Dataset, scoring: str | None = None, orders: int = 10, **options
) -> xr.Dataset:
    """The fields of `Capacity` for one response, over coordinates ``order`` and ``lag`` (s).

    response: ``input(time)``; ``displacement(time, readout, axis)`` in m, axis 'x' and 'y'; attrs
    ``status`` ('ok' or 'unstable'), ``setup`` ('described' or 'published'), ``sample_rate`` in Hz.
    Signals: every readout's x, then every readout's y. scoring None: 'published' for that setup,
    else 'clean'. options: fields of `Options`. Errors as in `score_arrays`; but an unstable
    response is a result: all NaN, and the attr ``status`` says so.
    """
    import xarray as xr  # slow to import, and arrays alone do not need it

    if scoring is None:
        scoring = "published" if response.attrs["setup"] == "published" else "clean"
    checked = Options(scoring, **options)
    rate = float(response.attrs["sample_rate"])
    if response.attrs["status"] == "unstable":
        lags = np.arange(round(checked.horizon * rate) + 1) / rate
        nan_orders, nan_lags = np.full(orders, np.nan), np.full(len(lags), np.nan)
        unknown = ((*[c] * 3, math.nan) for c in (nan_orders, nan_lags))
        capacity = _assemble(np.arange(1, orders + 1), lags, *unknown)
    else:
        moved = response["displacement"].transpose("time", "readout", "axis")
        signals = np.hstack([moved.sel(axis=axis).values for axis in ("x", "y")])
        capacity = score_arrays(
            response["input"].values, signals, rate, orders, scoring=scoring, **options
        )
    variables = {
        stem + suffix: (dims, getattr(capacity, stem + suffix), _labels(f"{what}, {part}"))
        for stem, (dims, what) in _VARIABLES.items()
        for suffix, part in _PARTS.items()
        if hasattr(capacity, stem + suffix)
    }
    coords = {
        "order": ("order", capacity.orders, _labels("Legendre order")),
        "lag": ("lag", capacity.lags, _labels("recall lag", "s")),
    }
    attrs = {"status": response.attrs["status"], "n_signals": 2 * response.sizes["readout"]}
    attrs |= asdict(checked) | {"shuffle": int(checked.shuffle)}  # NetCDF has no booleans
    return xr.Dataset(variables, coords, attrs)


_VARIABLES = {
    "nonlinear": ("order", "capacity for Legendre polynomials"),
    "memory": ("lag", "capacity for recall"),
    "c_nl": ((), "nonlinear capacity"),
    "c_m": ((), "memory capacity"),
}
_PARTS = {
    "": "test part",
    "_train": "training part",
    "_raw": "test part, nothing replaced or clipped",
    "_se": "test part, standard error",
}


def _labels(long_name: str, units: str = "1") -> dict[str, str]:
    return {"units": units, "long_name": long_name}


def _assemble(orders, lags, nonlinear: tuple, memory: tuple) -> Capacity:
    """Capacity from (c, c of the training part, raw c, standard error) of either kind."""
    values = {}
    for name, total, kind in (("nonlinear", "c_nl", nonlinear), ("memory", "c_m", memory)):
        c, train, raw, error = kind
        values |= {name: c, f"{name}_train": train, f"{name}_raw": raw}
        values |= {total: _clipped_mean(c), f"{total}_train": _clipped_mean(train)}
        values |= {f"{total}_raw": float(np.mean(raw)), f"{total}_se": error}
    return Capacity(orders, lags, **values)


def _clipped_mean(c: np.ndarray) -> float:
    return float(np.maximum(c, 0.0).mean())  # np.maximum lets the NaN of an unstable run through


def _checked(u, readouts, sample_rate, options) -> tuple[np.ndarray, np.ndarray]:
    """u (T - skip,) and readouts (T - skip, p) as floats; ValueError says what is wrong."""
    if not 0 < sample_rate < math.inf:
        raise ValueError(f"sample_rate = {sample_rate!r} is not usable; give a rate above 0 Hz")
    u, readouts = np.asarray(u, dtype=float), np.asarray(readouts, dtype=float)
    if u.ndim != 1 or readouts.ndim != 2 or len(u) != len(readouts) or not readouts.shape[1]:
        raise ValueError(
            f"u has shape {u.shape} and readouts {readouts.shape}; "
            "give (T,) and (T, p) with the same number of frames T, and p at least 1"
        )
    horizon, skip = options.horizon, options.skip
    if round(horizon * sample_rate) < 1:
        raise ValueError(
            f"horizon = {horizon:g} s is shorter than a frame; give at least {1 / sample_rate:g} s"
        )
    # Two horizons: at the longest lag, as many frames are left to split as the lag took away.
    if len(u) - skip < 2 * horizon * sample_rate:
        raise ValueError(
            f"duration = {len(u) / sample_rate:g} s is too short for a recall horizon of "
            f"{horizon:g} s and a split beyond it; record at least "
            f"{2 * horizon + skip / sample_rate:g} s"
        )
    u, readouts = u[skip:], readouts[skip:]
    finite = np.isfinite(readouts)
    if not finite.all():
        frame, signal = np.argwhere(~finite)[0]
        raise ValueError(
            f"readouts[{frame + skip}, {signal}] = {readouts[frame, signal]} is not "
            "finite; an unstable run has no capacity, so give a recording that stays finite"
        )
    return u, readouts


def _fit_targets(u, readouts, orders, lags, horizon, options) -> tuple[_Fit, _Fit]:
    """Fits of P_k for the orders and of recall for the lags; lags and horizon in frames."""
    u, n = scale_input(u), len(orders)
    target = np.hstack([legendre_targets(u, orders), recall_targets(u, lags)])
    if options.scoring == "clean":
        starts = np.full(target.shape[1], horizon)
        fitted = slice(horizon, _training_end(horizon, len(u), options.split))
    else:
        starts = np.array([0] * n + list(lags))
        fitted = slice(None)
    x = _standardise(readouts, fitted)
    if options.shuffle:
        nonlinear = _fit_shuffled(x, target[:, :n], options)
        return nonlinear, _fit(x, target[:, n:], starts[n:], options)
    fit = _fit(x, target, starts, options)
    return fit[:, :n], fit[:, n:]


def _standardise(readouts: np.ndarray, fitted: slice) -> np.ndarray:
    """Readouts with mean 0 and variance 1 over the fitted rows; a still column becomes 0."""
    mean = readouts[fitted].mean(axis=0)
    x = readouts - mean
    deviation = np.sqrt(np.einsum("ij,ij->j", x[fitted], x[fitted]) / len(x[fitted]))
    # Still: no motion beyond the round-off of its own mean, which dividing would amplify.
    still = deviation <= len(x) * np.finfo(float).eps * np.abs(mean)
    x /= np.where(still, np.inf, deviation)
    return x


def _training_end(start: int, frames: int, split: float) -> int:
    """First test frame of a split of frames [start, frames), whose test part rounds up."""
    return start + math.floor(split * (frames - start) + 1e-9)  # 0.57 * 100 falls short of 57


def _fit(x, target, starts, options) -> _Fit:
    """Ridge estimates of target (T, q) from x (T, p); target j is split from row starts[j] on."""
    row = np.arange(len(x))[:, None]
    ends = np.array([_training_end(start, len(x), options.split) for start in starts])
    train, test = (row >= starts) & (row < ends), row >= ends
    mean = _mean(target, train)
    cross = x.T @ np.where(train, target - mean, 0.0)
    weights, offset = _solve_windows(x, cross, starts, ends, options.alpha)
    estimate = x @ weights
    estimate += mean - offset
    return _Fit(target, estimate, train, test)


def _fit_shuffled(x, target, options) -> _Fit:
    """As `_fit`, on the rows that sklearn's train_test_split(random_state=42) would choose."""
    order = np.random.RandomState(SHUFFLE_SEED).permutation(len(x))
    tested = len(x) - _training_end(0, len(x), options.split)
    order = np.roll(order, -tested)  # sklearn tests on the first of the permutation, `_fit` last
    fit = _fit(x[order], target[order], np.zeros(target.shape[1], dtype=int), options)
    return fit[np.argsort(order)]


def _solve_windows(x, cross, starts, ends, alpha) -> tuple[np.ndarray, np.ndarray]:
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
        np.einsum("ii->i", system)[:] += alpha
        try:
            factor = cho_factor(system, lower=True, overwrite_a=True, check_finite=False)
        except LinAlgError:
            raise ValueError(
                f"alpha = {alpha:g} is lost in the round-off of these readouts; give a larger one"
            ) from None
        weights[:, same] = cho_solve(factor, cross[:, same], check_finite=False)
        offset[same] = mean @ weights[:, same]
    return weights, offset


def _score_fit(fit: _Fit, scoring: str, block: int) -> tuple:
    """(c, c of the training part, raw c), each (q,), and the standard error of the total."""
    test = raw = _block_sums(fit.target, fit.estimate, fit.test, block)
    train = fit.target, fit.estimate
    lowest = -np.inf
    if scoring == "published":
        test = _block_sums(*_replace_overshoot(fit, fit.test), fit.test, block)
        train = _replace_overshoot(fit, fit.train)
        lowest = 0.0
    train = _block_sums(*train, fit.train, block)
    c, c_train, c_raw = (_capacity(sums.sum(axis=1)) for sums in (test, train, raw))
    return np.maximum(c, lowest), np.maximum(c_train, lowest), c_raw, _bootstrap_error(test)


def _replace_overshoot(fit: _Fit, part: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Target and estimate, both the part's target mean wherever the estimate leaves [-1, 1]."""
    outside = np.abs(fit.estimate) > 1.0
    mean = _mean(fit.target, part)
    return np.where(outside, mean, fit.target), np.where(outside, mean, fit.estimate)


def _mean(values: np.ndarray, part: np.ndarray) -> np.ndarray:
    return np.where(part, values, 0.0).sum(axis=0) / part.sum(axis=0)


def _block_sums(target, estimate, part, block) -> np.ndarray:
    """(4, blocks, q): rows, sum z, sum z^2 and sum (zhat - z)^2 of the part, per block of frames.

    Blocks count back from the last frame, where the test parts of all lags end together; the first
    may be short. z is taken from the part's mean, which keeps its digits.
    """
    rows = np.flatnonzero(part.any(axis=1))
    rows = slice(rows[0], rows[-1] + 1)
    target, estimate, part = target[rows], estimate[rows], part[rows]
    z = np.where(part, target - _mean(target, part), 0.0)
    error = np.where(part, estimate - target, 0.0)
    edges = np.arange(len(part), 0, -block)[::-1] - block
    edges[0] = 0
    return np.stack([np.add.reduceat(v, edges) for v in (part * 1.0, z, z * z, error * error)])


def _capacity(sums: np.ndarray) -> np.ndarray:
    """c[z] from sums (4, ...) of `_block_sums`; a target that does not vary has none: 0."""
    n, z, zz, error = sums
    spread = zz - z * z / np.maximum(n, 1.0)
    varies = spread > 1e-12 * n  # targets are of order 1
    return np.where(varies, 1.0 - error / np.where(varies, spread, 1.0), 0.0)


def _bootstrap_error(sums: np.ndarray) -> float:
    """Standard error of the mean of max(c, 0) as the blocks of sums (4, blocks, q) are redrawn."""
    blocks = sums.shape[1]
    if blocks < 2:
        return math.nan
    draws = np.random.default_rng(0).multinomial(blocks, np.full(blocks, 1 / blocks), REPLICATES)
    c = _capacity(draws.astype(float) @ sums)
    return float(np.maximum(c, 0.0).mean(axis=1).std(ddof=1))
