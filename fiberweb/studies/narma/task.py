"""The NARMA-n task on the readouts of a network or of the experiment's twin (paper, Fig. 6).

The recursions are those of `fiberweb.scoring.tasks`, with u scaled to [0, 0.2]. One sample is one
frame of the task's rate, 10 Hz in the paper; of a recording, every k-th frame is taken.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from sklearn.linear_model import Ridge
from sklearn.model_selection import train_test_split
from sklearn.preprocessing import StandardScaler

from fiberweb import tables
from fiberweb.model.scene import Scene
from fiberweb.scoring import esn, recording
from fiberweb.scoring.camera import films
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
CASE = (
    "setup", "topology", "n", "spacing_m", "force_N", "angle_deg", "body", "frame_step", "verdict",
    "status", "run",
)  # fmt: skip


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


def estimates(
    response: xr.Dataset, orders: Sequence[int], rate: float, alpha: float, scoring: str = "clean"
) -> xr.Dataset:
    """What ridge regression makes of the task, on the readouts of a run and on others.

    `TIMINGS` says which y the readouts estimate: that of the same sample (the authors' script) or
    of the next (the caption of Fig. 6).

    Args:
        response: of `fiberweb.simulate` or a film of it. Of an unstable run, the network's
            estimates are NaN, and the others, made of the input, are not.
        orders: of `ORDERS`.
        rate: of the task (Hz); divides the recording's.
        alpha: ridge penalty against the sum of squares.
        scoring: readouts are standardised on the training part ("clean") or over the whole run
            ("published", the authors' script, which also replaces estimates beyond 2, where none
            come).

    Returns:
        Dimensionless ``target(timing, order, time)`` and ``estimate(readout, timing, order, time)``
        on the test part, ``n_signals(readout)``, and attributes rate and alpha. readout is
        "network", "echo_state" (`esn.states`, a node for each signal of the network) or one of
        `capacity.trivial_readouts`; time (s) is that of the readouts.

    Raises:
        ValueError: a rate that does not divide the recording's, or too few samples.
    """
    step = frames_a_sample(recording.sample_rate(response), rate)
    readouts = _readouts(response, step)
    scaled = scale_input(response["input"].values[::step])
    train, test = split(len(scaled))
    fitted = train if scoring == "clean" else slice(None)
    y = np.column_stack([series(AMPLITUDE * (1.0 + scaled) / 2.0, order) for order in orders])
    targets = np.stack([y[ahead : len(scaled) + ahead] for ahead in TIMINGS.values()], axis=1)
    flat = targets.reshape(len(scaled), -1)
    of_each = [_estimate(x, flat, fitted, train, test, alpha) for x in readouts.values()]
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
    )


def of_runs(
    response_paths: Sequence[str | Path],
    cameras: Sequence[Mapping | None],
    orders: Sequence[int],
    rate: float,
    alpha: float,
    scoring: str,
) -> xr.Dataset:
    """Targets of the NARMA tasks and their estimates, over the test part of each run and film
    (`estimates` along ``case``; errors as there).

    Args:
        cameras: of each path, keyword arguments of `fiberweb.scoring.camera.films`; None for a
            simulated network, which nothing films.

    Returns:
        With coordinates over case: those of `CASE`. body is "twin" or "network"; verdict says
        whether it is the twin's first reading of the frame rate, by which claims are judged; setup
        is "published" for that scoring. Cases have test parts of their own, NaN beyond them.
    """
    of_each = []
    for path, camera in zip(response_paths, cameras, strict=True):
        response = dataset.load(path)
        read = films(response, **camera) if camera else [(1, response)]
        for step, film in read:
            case = estimates(film, orders, rate, alpha, scoring).expand_dims(
                case=[film.attrs["run"] if step == 1 else f"{film.attrs['run']}, every {step}"]
            )
            scene = Scene.from_json(film.attrs["scene"])
            first = bool(camera) and step == camera["frame_step"][0]
            values = (
                "published" if scoring == "published" else "described",
                scene.network.topology, scene.network.n, scene.network.spacing,
                math.nan if scene.force is None else scene.force, scene.motor_angle,
                "twin" if camera else "network", step, int(first), film.attrs["status"],
                film.attrs["run"],
            )  # fmt: skip
            known = {name: ("case", [value]) for name, value in zip(CASE, values, strict=True)}
            of_each.append(case.assign_coords(known))
    return xr.concat(of_each, "case", join="outer", combine_attrs="identical")


def table(errors: xr.Dataset) -> pd.DataFrame:
    """How far the estimates are off, on the test part.

    Args:
        errors: of `of_runs`.

    Returns:
        One row for each case, order, readout and timing: `CASE`, rmse, nrmse (over the standard
        deviation of the target), interdecile_range (between the 10th and the 90th percentile of the
        error, estimate - target), bias (the mean error), target_mean, n_signals and alpha.
    """
    rows = pd.concat([_measures(errors.isel(case=[at])) for at in range(errors.sizes["case"])])
    rows = rows.assign(alpha=errors.attrs["alpha"], verdict=rows["verdict"].astype(bool))
    first = [*CASE, "case", "order", "readout", "timing"]
    return tables.ordered(rows[[*first, *(name for name in rows if name not in first)]])


def _measures(errors: xr.Dataset) -> pd.DataFrame:
    """The rows of one case."""
    errors = errors.dropna("time", subset=["target"])  # what others have beyond its test part
    error, target = errors["estimate"] - errors["target"], errors["target"]
    rmse = np.sqrt((error**2).mean("time", skipna=False))
    low, high = (error.quantile(q, "time", skipna=False).drop_vars("quantile") for q in (0.1, 0.9))
    columns = xr.Dataset(
        {
            "rmse": rmse,
            "nrmse": rmse / target.std("time"),
            "interdecile_range": high - low,
            "bias": error.mean("time", skipna=False),
            "target_mean": target.mean("time"),
            "n_signals": errors["n_signals"],
        }
    )
    return columns.to_dataframe(dim_order=["case", "order", "readout", "timing"]).reset_index()


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


def _estimate(x, targets, fitted, train, test, alpha) -> np.ndarray:
    """(test samples, q) of targets (T, q) from readouts (T, p), standardised on the fitted rows;
    NaN from readouts that have any."""
    if not np.isfinite(x).all():
        return np.full((len(test), targets.shape[1]), np.nan)
    x = StandardScaler().fit(x[fitted]).transform(x)
    return Ridge(alpha=alpha).fit(x[train], targets[train]).predict(x[test])
