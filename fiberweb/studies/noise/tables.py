"""Capacities of a network whose readouts are noisy, as a camera's or a sensor's are."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from fiberweb.meanings import explained
from fiberweb.scoring import capacity, tables
from fiberweb.simulation import dataset


def noisy(response: xr.Dataset, noise: float, seed: int, level: int) -> xr.Dataset:
    """The response with white Gaussian noise added to each displacement signal.

    Args:
        response: see `fiberweb.simulation.response.response`.
        noise: standard deviation of the noise (m).
        seed: of the draw.
        level: number of the noise level; seed and level together fix the draw, so that no two
            levels share one.

    Returns:
        A copy with another ``displacement(time, readout, axis)``, m.

    Raises:
        ValueError: the noise is negative.
    """
    if not noise >= 0.0:
        raise ValueError(f"noise = {noise!r} is not usable; give a standard deviation of 0 m or up")
    moved = response["displacement"]
    draw = np.random.default_rng([seed, level]).normal(0.0, noise, moved.shape)
    return response.assign(displacement=moved + draw)


def median_amplitude(response: xr.Dataset) -> float:
    """Standard deviation in time of a displacement signal, the median one (m); NaN if unstable."""
    deviation = response["displacement"].std("time", skipna=False)
    return float(np.median(deviation))


@explained(
    tables.COLUMNS,
    tables.CHOICE,
    {
        "noise_m": ("standard deviation of the noise; 0: without noise", "m"),
        "noise_seed": "number of the draw",
        "amplitude_m": ("standard deviation in time of a signal without noise, the median", "m"),
    },
)
def table(
    response_paths: Sequence[str | Path],
    choices: Sequence[str],
    noise: Sequence[float],
    seeds: int,
    alpha: float,
) -> pd.DataFrame:
    """One row for each run, noise level and draw, the run without noise among them.

    Args:
        response_paths: files with the attr ``run``.
        choices: of each path, see `fiberweb.studies.base.Point`.
        noise: standard deviations (m).
        seeds: draws at each level, numbered from 0.
        alpha: ridge penalty.

    Returns:
        A frame of `tables.COLUMNS`, force_choice, noise_m, noise_seed and amplitude_m.
    """
    frames = [
        tables.rows(
            _scored(dataset.load(path), noise, seeds, alpha),
            force_choice=choice,
            noise_m=lambda _, scored: scored.attrs["noise"],
            noise_seed=lambda _, scored: scored.attrs["noise_seed"],
            amplitude_m=lambda _, scored: scored.attrs["amplitude"],
        )
        for path, choice in zip(response_paths, choices, strict=True)
    ]
    return pd.concat(frames, ignore_index=True)


def _scored(
    response: xr.Dataset, noise: Sequence[float], seeds: int, alpha: float
) -> Iterator[xr.Dataset]:
    """Capacities without noise, then of each level and draw, with attrs that say which."""
    amplitude = median_amplitude(response)
    for given, sigma, seed in _draws(response, noise, seeds):
        scored = capacity.score(given, alpha=alpha)
        attrs = {"noise": sigma, "noise_seed": seed, "amplitude": amplitude}
        yield scored.assign_attrs(attrs)


def _draws(
    response: xr.Dataset, noise: Sequence[float], seeds: int
) -> Iterable[tuple[xr.Dataset, float, int]]:
    yield response, 0.0, 0
    for level, sigma in enumerate(noise):
        for seed in range(seeds):
            yield noisy(response, sigma, seed, level), sigma, seed
