"""The NARMA-n task on the readouts of a network (paper, Fig. 6, there on the experiment).

The recursions are those of `fiberweb.scoring.tasks`, with u scaled to [0, 0.2]. One sample is one
frame of the task's rate, 10 Hz in the paper; of a recording, every k-th frame is taken.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from sklearn.linear_model import Ridge
from sklearn.model_selection import train_test_split
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

from fiberweb.scoring import esn, recording, tables
from fiberweb.scoring.capacity import trivial_readouts
from fiberweb.scoring.regression import scale_input
from fiberweb.scoring.tasks import ORDERS as ORDERS
from fiberweb.scoring.tasks import narma
from fiberweb.simulation import dataset
from fiberweb.studies.narma import check_samples, frames_a_sample

TIMINGS = {"same": 0, "next": 1}  # samples from the readouts to the y that they estimate
AMPLITUDE = 0.2  # largest u of the task
DROPPED = 200  # first samples left out of training and test ...
DROPPED_PART = 0.2  # ... or this part of a recording too short for that
TESTED = 0.25  # last part of the rest


def series(u: np.ndarray, order: int) -> np.ndarray:
    """The NARMA series of an input.

    Args:
        u: (T,) input, dimensionless, in [0, 0.2].
        order: n, one of `ORDERS`.

    Returns:
        (T + 1,) y(0) = 0 up to y(T), dimensionless; y(t) depends on u before t alone.

    Raises:
        ValueError: another order, or an input outside [0, 0.2], where the series may diverge.
    """
    if not (np.min(u) >= 0.0 and np.max(u) <= AMPLITUDE):
        raise ValueError(
            f"u runs from {np.min(u):g} to {np.max(u):g}; scale it to 0 to {AMPLITUDE}"
        )
    return narma(u, order)


def split(samples: int) -> tuple[np.ndarray, np.ndarray]:
    """Samples to train on and to test on, in order.

    The first `DROPPED` are left out, or a fifth of them all where that is less; of the rest, the
    first three quarters are trained on.

    Raises:
        ValueError: too few, see `check_samples`.
    """
    check_samples(samples)
    kept = np.arange(min(DROPPED, int(DROPPED_PART * samples)), samples)
    return tuple(train_test_split(kept, test_size=TESTED, shuffle=False))


def estimates(response: xr.Dataset, orders: Sequence[int], rate: float, alpha: float) -> xr.Dataset:
    """What ridge regression makes of the task, on the readouts of a run and on others.

    Readouts are standardised on the training part; `TIMINGS` says which y they estimate: that of
    the same sample (the authors' script) or of the next (the caption of Fig. 6).

    Args:
        response: of `fiberweb.simulate`, with the attribute ``run``. Of an unstable run, the
            network's estimates are NaN, and the others, made of the input, are not.
        orders: of `ORDERS`.
        rate: of the task (Hz); divides the recording's.
        alpha: ridge penalty against the sum of squares.

    Returns:
        Dimensionless ``target(run, timing, order, time)`` and ``estimate(run, readout, timing,
        order, time)`` on the test part, ``n_signals(run, readout)``, and attributes rate and
        alpha. One run; readout is "network", "echo_state" (`esn.states`, a node for each signal
        of the network) or one of `capacity.trivial_readouts`; time (s) is that of the readouts.

    Raises:
        ValueError: a rate that does not divide the recording's, or too few samples.
    """
    step = frames_a_sample(recording.sample_rate(response), rate)
    readouts = _readouts(response, step)
    scaled = scale_input(response["input"].values[::step])
    train, test = split(len(scaled))
    y = np.column_stack([series(AMPLITUDE * (1.0 + scaled) / 2.0, order) for order in orders])
    targets = np.stack([y[ahead : len(scaled) + ahead] for ahead in TIMINGS.values()], axis=1)
    flat = targets.reshape(len(scaled), -1)
    of_each = [_estimate(x, flat, train, test, alpha) for x in readouts.values()]
    shape = (len(readouts), len(test), len(TIMINGS), len(orders))
    estimate = np.reshape(of_each, shape).transpose(0, 2, 3, 1)
    return xr.Dataset(
        {
            "target": (("timing", "order", "time"), targets[test].transpose(1, 2, 0)),
            "estimate": (("readout", "timing", "order", "time"), estimate),
            "n_signals": ("readout", [x.shape[1] for x in readouts.values()]),
        },
        {
            "readout": list(readouts),
            "timing": list(TIMINGS),
            "order": list(orders),
            "time": ("time", test / rate, {"units": "s"}),
        },
        {"rate": rate, "alpha": alpha},
    ).expand_dims(run=[response.attrs["run"]])


def of_runs(
    response_paths: Sequence[str | Path], orders: Sequence[int], rate: float, alpha: float
) -> xr.Dataset:
    """`estimates` of each response along ``run``; errors as there."""
    of_each = [estimates(dataset.load(path), orders, rate, alpha) for path in response_paths]
    return xr.concat(of_each, "run", join="exact", combine_attrs="identical")


def measures(errors: xr.Dataset) -> pd.DataFrame:
    """How far the estimates are off, on the test part.

    Args:
        errors: from `estimates`, of one run or several along ``run``.

    Returns:
        One row for each run, order, readout and timing, in the dataset's order: rmse, nrmse (over
        the standard deviation of the target), interdecile_range (between the 10th and the 90th
        percentile of the error, estimate - target), bias (the mean error), n_signals and alpha.
    """
    error = errors["estimate"] - errors["target"]
    rmse = np.sqrt((error**2).mean("time", skipna=False))
    low, high = (error.quantile(q, "time", skipna=False).drop_vars("quantile") for q in (0.1, 0.9))
    columns = xr.Dataset(
        {
            "rmse": rmse,
            "nrmse": rmse / errors["target"].std("time"),
            "interdecile_range": high - low,
            "bias": error.mean("time", skipna=False),
            "n_signals": errors["n_signals"],
        }
    )
    rows = columns.to_dataframe(dim_order=["run", "order", "readout", "timing"]).reset_index()
    return rows.assign(alpha=errors.attrs["alpha"])


def table(
    errors: xr.Dataset, capacity_paths: Sequence[str | Path], choices: Sequence[str]
) -> pd.DataFrame:
    """`tables.study` of the runs with the columns of `measures` after it: one row for each run,
    order, readout and timing. status, c_nl and the like are those of the run's own network."""
    return tables.study(capacity_paths, choices).merge(
        measures(errors), on="run", validate="one_to_many"
    )


def _readouts(response: xr.Dataset, step: int) -> Mapping[str, np.ndarray]:
    """(samples, signals) of each kind of readout, every step-th frame."""
    u, moved = response["input"].values, recording.signals(response)
    sampled = scale_input(u[::step])
    # Derivatives are taken at the recording's rate, where its spline is the drive's own.
    trivial = trivial_readouts(u, recording.sample_rate(response))
    return {
        "network": moved[::step],
        "echo_state": esn.states(sampled, moved.shape[1]),
    } | {name: x[::step] for name, x in trivial.items()}


def _estimate(x, targets, train, test, alpha) -> np.ndarray:
    """(test samples, q) of targets (T, q) from readouts (T, p); NaN from readouts that have any."""
    if not np.isfinite(x).all():
        return np.full((len(test), targets.shape[1]), np.nan)
    model = make_pipeline(StandardScaler(), Ridge(alpha=alpha))
    return model.fit(x[train], targets[train]).predict(x[test])
