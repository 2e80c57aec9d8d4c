"""Nonlinear and memory capacity of a physical reservoir: arrays in, numbers out.

Readouts x(t) estimate a target z[u(t)] linearly, zhat = W x + b, by ridge regression. The capacity
of a target is c[z] = 1 - sum (zhat - z)^2 / sum (z - mean z)^2 over the test part (paper, section
'Quantifying physical reservoir capacity', Eq. c). C_nl is the mean of c over the Legendre
polynomials P_k(u(t)), C_m its mean over the recall targets u(t - tau), tau = 0 .. horizon.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from importlib.metadata import version
from typing import TYPE_CHECKING

import numpy as np
from scipy.interpolate import CubicSpline

from fiberweb import timed
from fiberweb.meanings import RUN, explained
from fiberweb.scoring import arguments, recording
from fiberweb.scoring.blocks import block_sums, bootstrap_error, capacity_of
from fiberweb.scoring.regression import (
    Fit,
    Options,
    checked,
    fit_targets,
    joined,
    mean_of,
    scale_input,
)

if TYPE_CHECKING:
    import xarray as xr


_KINDS = {
    "nonlinear": "capacity for a Legendre polynomial",
    "memory": "capacity for recall",
    "c_nl": "nonlinear capacity, mean over the orders",
    "c_m": "memory capacity, mean over the lags",
}
_PARTS = {
    "": "test part",
    "_train": "training part",
    "_raw": "test part, nothing replaced or clipped",
    "_se": "standard error",
}
VARIABLES = {
    f"{kind}{part}": f"{what}: {where}"
    for part, where in _PARTS.items()
    for kind, what in _KINDS.items()
    if part != "_se" or kind.startswith("c_")
}
TOTALS = {name: meaning for name, meaning in VARIABLES.items() if name.startswith("c_")}
COORDINATES = {
    "order": "order of the Legendre polynomial",
    "lag": ("how long ago the recalled input was", "s"),
}
_DIMS = {"nonlinear": "order", "memory": "lag", "c": ()}
ATTRIBUTES = RUN | {
    "scoring_versions": "of the packages that scored",
    "n_signals": "how many there are: x and y of each readout",
    "scoring": "clean, or published: as the authors scored",
    "alpha": "ridge penalty, against the sum of squares",
    "horizon": ("longest lag", "s"),
    "split": "part of the frames that is trained on",
    "skip": "first frames that were left out",
    "shuffle": "1 where targets of C_nl were split at random",
    "overshoot": "estimates of Legendre and of recall targets beyond which they are replaced",
}


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


def trivial_readouts(u: np.ndarray, sample_rate: float) -> dict[str, np.ndarray]:
    """Readouts made of the input (T,) alone: the baselines that a reservoir has to beat.

    ``u`` (T, 1); ``derivatives`` (T, 4): u and its first three time derivatives (sample_rate in
    Hz); ``powers`` (T, 3): u, u^2, u^3. Derivatives are those of the cubic spline through the
    samples: exact for an input that is itself a spline with its knots on frames.
    """
    scale_input(u)  # refuses what has no spline
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
    u, readouts = checked(u, readouts, sample_rate, options)
    orders = arguments.check_orders(orders)
    horizon = round(options.horizon * sample_rate)
    orders, lags = np.arange(1, orders + 1), np.arange(horizon + 1)
    nonlinear, memory = fit_targets(u, readouts, orders, lags, horizon, options)
    return _assemble(
        orders,
        lags / sample_rate,
        _score_fits(nonlinear, options, options.overshoot[0], horizon),
        _score_fits(memory, options, options.overshoot[1], horizon),
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
    u, readouts = checked(u, readouts, sample_rate, options)
    for lag in lags:
        if not 0 <= lag <= options.horizon:
            raise ValueError(f"lag = {lag:g} s is outside 0 to horizon = {options.horizon:g} s")
    frames = [round(lag * sample_rate) for lag in lags]
    both = fit_targets(u, readouts, orders, frames, round(options.horizon * sample_rate), options)
    fits = [joined(each) for each in both]
    rows = np.hstack([fit.test for fit in fits]).any(axis=1)
    values = [np.where(f.test, v, np.nan)[rows] for f in fits for v in (f.estimate, f.target)]
    return Traces((np.flatnonzero(rows) + options.skip) / sample_rate, *values)


TRACES = {
    "trace": "name of the target: P4 is a Legendre polynomial, 200 ms a recall",
    "time": ("time from the first frame", "s"),
    "target": "what is to be computed",
    "prediction": "what the readouts make of it; nothing replaced or clipped",
    "c": "capacity, nothing replaced or clipped",
}


@explained(TRACES, attributes=RUN)
def traces(
    response: xr.Dataset,
    orders: Sequence[int] = (4, 5, 6, 7),
    lags: Sequence[float] = (0.2, 0.4),
    scoring: str | None = None,
    **options,
) -> xr.Dataset:
    """`predict` for a response: ``target(trace, time)``, ``prediction(trace, time)`` and ``c``,
    with traces named like 'P4' and '200 ms'; errors as there."""
    import xarray as xr

    arguments.check(response, scoring, options)
    scoring = scoring or recording.own_scoring(response)
    u, rate = recording.scored_input(response, scoring), recording.sample_rate(response)
    estimates = predict(
        u, recording.signals(response), rate, orders, lags, scoring=scoring, **options
    )
    target = np.hstack([estimates.nonlinear_target, estimates.memory_target]).T
    estimate = np.hstack([estimates.nonlinear, estimates.memory]).T
    known = np.isfinite(target)
    error = np.where(known, estimate - target, 0.0)
    spread = [np.var(row[mask]) * mask.sum() for row, mask in zip(target, known, strict=True)]
    names = [f"P{order}" for order in orders] + [f"{1000 * lag:g} ms" for lag in lags]
    return xr.Dataset(
        {
            "target": (("trace", "time"), target),
            "prediction": (("trace", "time"), estimate),
            "c": ("trace", 1.0 - (error**2).sum(axis=1) / spread),
        },
        {"trace": names, "time": estimates.time},
        {key: response.attrs[key] for key in RUN if key in response.attrs},
    )


@explained(VARIABLES, COORDINATES, attributes=ATTRIBUTES)
def score(
    response: xr.Dataset, scoring: str | None = None, orders: int = 10, **options
) -> xr.Dataset:
    """The fields of `Capacity` for one response, over coordinates ``order`` and ``lag`` (s).

    response: ``input(time)``; ``displacement(time, readout, axis)`` in m, axis 'x' and 'y'; time in
    s, evenly spaced, which says how many frames a lag is; attrs ``status`` ('ok' or 'unstable') and
    ``setup``. Input and signals: see `fiberweb.scoring.recording`. scoring None: 'published' for
    that setup, else 'clean'. options: fields of `Options`. Errors as in `score_arrays`, and for
    uneven time; but an unstable response is a result: all NaN, and the attr ``status`` says so.
    """
    import xarray as xr  # slow to import, and arrays alone do not need it

    arguments.check(response, scoring, options)
    orders = arguments.check_orders(orders)
    scoring = scoring or recording.own_scoring(response)
    chosen = Options(scoring, **options)
    rate = recording.sample_rate(response)
    if response.attrs["status"] == "unstable":
        lags = np.arange(round(chosen.horizon * rate) + 1) / rate
        nan_orders, nan_lags = np.full(orders, np.nan), np.full(len(lags), np.nan)
        unknown = ((*[c] * 3, math.nan) for c in (nan_orders, nan_lags))
        capacity = _assemble(np.arange(1, orders + 1), lags, *unknown)
    else:
        u, moved = recording.scored_input(response, scoring), recording.signals(response)
        with timed.part("solve"):
            capacity = score_arrays(u, moved, rate, orders, scoring=scoring, **options)
    variables = {name: (_DIMS[name.split("_")[0]], getattr(capacity, name)) for name in VARIABLES}
    coords = {"order": capacity.orders, "lag": capacity.lags}
    attrs = {key: response.attrs[key] for key in RUN if key in response.attrs}
    attrs |= {"sample_rate": rate, "n_signals": 2 * response.sizes["readout"]}
    attrs["scoring_versions"] = ", ".join(f"{name} {version(name)}" for name in ("numpy", "scipy"))
    attrs |= asdict(chosen) | {"shuffle": int(chosen.shuffle)}  # NetCDF has no booleans
    return xr.Dataset(variables, coords, attrs)


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


def _score_fits(fits: Iterable[Fit], options: Options, overshoot: float, block: int) -> tuple:
    """(c, c of the training part, raw c), each (q,), and the standard error of the total."""
    replaced = overshoot if options.scoring == "published" else None
    sums = [_sums(fit, replaced, block) for fit in fits]
    test, train, raw = (np.concatenate(each, axis=-1) for each in zip(*sums, strict=True))
    c, c_train, c_raw = (capacity_of(each) for each in (test.sum(axis=1), train, raw))
    lowest = 0.0 if options.scoring == "published" else -np.inf
    return np.maximum(c, lowest), np.maximum(c_train, lowest), c_raw, bootstrap_error(test)


def _sums(fit: Fit, overshoot: float | None, block: int) -> tuple[np.ndarray, ...]:
    """`block_sums` of the test part; of the training part, and of the test part as it is, summed
    over the blocks. What estimates overshoot is replaced, or with None nothing."""
    test = raw = block_sums(fit.target, fit.estimate, fit.test, block)
    train = fit.target, fit.estimate
    if overshoot is not None:
        test = block_sums(*_replace_overshoot(fit, fit.test, overshoot), fit.test, block)
        train = _replace_overshoot(fit, fit.train, overshoot)
    train = block_sums(*train, fit.train, block)
    return test, train.sum(axis=1), raw.sum(axis=1)


def _replace_overshoot(fit: Fit, part: np.ndarray, most: float) -> tuple[np.ndarray, np.ndarray]:
    """Target and estimate, both the part's target mean wherever the estimate exceeds the most."""
    outside = np.abs(fit.estimate) > most
    mean = mean_of(fit.target, part)
    return np.where(outside, mean, fit.target), np.where(outside, mean, fit.estimate)
