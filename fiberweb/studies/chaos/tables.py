"""Perturbed pairs, runs that hardly differ at the start: do they part, or forget the difference?

Two measures of one pair. The rate at which a small separation grows is the largest Lyapunov
exponent of the driven network. Consistency is the correlation of the two responses once the
start is over (Uchida, McAllister and Roy, Consistency of nonlinear system response to complex
drive signals, Phys. Rev. Lett. 93, 244102 (2004)): 1 where the response is a function of the
input, which every capacity presumes, and below 1 where it depends on the start as well.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from fiberweb.meanings import explained
from fiberweb.model.scene import Scene
from fiberweb.scoring import recording, tables
from fiberweb.simulation import dataset
from fiberweb.studies.chaos.round_off import ROUND_OFF

STEP = 0.5  # s: longer than the input is correlated, so that steps count as independent
# of the rms displacement: a separation below it grows as a linear one does; our own choice
SMALL = 0.01
DRAWN_EVERY = 0.1  # s, of the separations that are kept
COLUMNS = {
    "twin": "name of the pair's second run",
    "twin_status": "of the second run: ok or unstable",
    "separation_m": ("how far apart the driven points began", "m"),
    "rate_per_s": ("at which a small separation grows: the largest Lyapunov exponent", "1/s"),
    "rate_se": ("standard error of the rate", "1/s"),
    "rate_steps": f"steps of {STEP:g} s that the rate is the mean of",
    "consistency": "correlation of the two runs over their last half; 1: the start is forgotten",
    "saturation": "separation over the last half against unrelated motions of the same size",
}
SEPARATION_COLUMNS = {
    "setup": tables.SCENE["setup"],
    "buckling_number": tables.SCENE["buckling_number"],
    "run": "name of the pair's first run",
    "time_s": ("from the start", "s"),
    "separation_m": ("distance between the two runs, rms over the readouts", "m"),
    "rms_m": ("rms displacement of the first run", "m"),
}


class Rate(NamedTuple):
    """Growth of a small separation: mean over steps (1/s), its standard error, how many steps."""

    mean: float
    error: float
    steps: int


class Pair(NamedTuple):
    """A perturbed pair: responses of scenes that differ in their disturbance alone."""

    first: xr.Dataset
    second: xr.Dataset


def separation(pair: Pair) -> np.ndarray:
    """Distance between the two runs, rms over the readouts, shape (time,), m; NaN once either is
    unstable."""
    apart = pair.second["displacement"] - pair.first["displacement"]
    return np.sqrt((apart**2).sum("axis", skipna=False).mean("readout", skipna=False)).values


def rms_displacement(response: xr.Dataset) -> float:
    """Over time and readouts (m); NaN for an unstable response."""
    squared = (response["displacement"] ** 2).sum("axis", skipna=False)
    return float(np.sqrt(squared.mean(skipna=False)))


def growth_rate(separation: np.ndarray, sample_rate: float, least: float, most: float) -> Rate:
    """Largest Lyapunov exponent from the separation d(t) of a perturbed pair.

    The mean of ln(d(t + STEP) / d(t)) / STEP over all steps that begin with least <= d <= most:
    while d is small it follows linear equations, so its growth does not depend on its size, and
    every visit to that range counts. Steps are chosen by their beginning alone, which does not
    favour growth or decay. Runs that have become equal to round-off tell nothing until something
    parts them; where that is most of the time the mean is an upper bound.

    Args:
        separation: d, shape (time,), m.
        sample_rate: Hz.
        least: above round-off, by more than d can shrink in a step (m).
        most: the largest separation that still counts as small (m).

    Returns:
        Mean, its standard error with the steps as independent draws, and their number; NaN where
        there is no step, or only one for the error.
    """
    frames = max(1, round(STEP * sample_rate))
    d = separation[::frames]
    chosen = (d[:-1] >= least) & (d[:-1] <= most)
    steps = np.log(d[1:][chosen] / d[:-1][chosen]) * sample_rate / frames
    mean = float(steps.mean()) if len(steps) else math.nan
    error = float(steps.std(ddof=1) / math.sqrt(len(steps))) if len(steps) > 1 else math.nan
    return Rate(mean, error, len(steps))


def consistency(pair: Pair) -> float:
    """Correlation of the two runs over their last half, mean over signals; dimensionless."""
    first, second = _last_half(pair)
    together = (first * second).sum(axis=0)
    return float(np.mean(together / np.sqrt((first**2).sum(axis=0) * (second**2).sum(axis=0))))


def saturation(pair: Pair) -> float:
    """Separation over the last half against that of unrelated motions of the same size: 0 for
    equal runs, 1 for runs without anything in common."""
    first, second = _last_half(pair)
    return float(np.sqrt(((first - second) ** 2).sum() / (first**2 + second**2).sum()))


@explained(
    tables.COLUMNS,
    tables.CHOICE,
    tables.OF_PHYSICS,
    tables.OF_NUMERICS,
    tables.OF_VERDICTS,
    COLUMNS,
)
def rates(table: pd.DataFrame, response_paths: Sequence[str | Path]) -> pd.DataFrame:
    """One row for each perturbed pair.

    Args:
        table: of the study, from `tables.study`; of a pair the first run's row is kept.
        response_paths: runs of a pair next to one another, the less disturbed one first.

    Returns:
        The table's rows of the first runs and `COLUMNS`; rate, consistency and saturation are NaN
        where either run was unstable.

    Raises:
        ValueError: paths that are not of perturbed pairs.
    """
    records = [_measured(pair) for pair in pairs(response_paths)]
    measured = pd.DataFrame(records, columns=["run", *COLUMNS])
    return table.merge(measured, on="run", validate="one_to_one")


@explained(SEPARATION_COLUMNS)
def separations(response_paths: Sequence[str | Path]) -> pd.DataFrame:
    """One row for each perturbed pair and time, every `DRAWN_EVERY` s.

    Arguments and errors as in `rates`.
    """
    frames = []
    for pair in pairs(response_paths):
        scene = Scene.from_json(pair.first.attrs["scene"])
        every = max(1, round(DRAWN_EVERY * scene.sample_rate))
        values = (
            scene.setup, scene.buckling_number, pair.first.attrs["run"],
            pair.first["time"].values[::every], separation(pair)[::every],
            rms_displacement(pair.first),
        )  # fmt: skip
        frames.append(pd.DataFrame(dict(zip(SEPARATION_COLUMNS, values, strict=True))))
    return pd.concat(frames, ignore_index=True)


def pairs(response_paths: Sequence[str | Path]) -> Iterator[Pair]:
    """Each two neighbours of a list of responses; see `rates`."""
    if len(response_paths) % 2:
        raise ValueError(
            f"{len(response_paths)} responses are no perturbed pairs; give an even number"
        )
    for first, second in zip(response_paths[::2], response_paths[1::2]):
        pair = Pair(dataset.load(first), dataset.load(second))
        scenes = [Scene.from_json(run.attrs["scene"]) for run in pair]
        alike = len({replace(scene, disturbance=0.0).to_json() for scene in scenes}) == 1
        if not (alike and 0.0 < scenes[0].disturbance < scenes[1].disturbance):
            raise ValueError(
                f"{first} and {second} are no perturbed pair; give runs of scenes that differ in "
                "nothing but a disturbance above 0, the less disturbed one first"
            )
        yield pair


def _measured(pair: Pair) -> tuple:
    """Values of ``run`` and of `COLUMNS`."""
    scenes = [Scene.from_json(run.attrs["scene"]) for run in pair]
    start = (
        pair.first.attrs["run"], pair.second.attrs["run"], pair.second.attrs["status"],
        scenes[1].disturbance - scenes[0].disturbance,
    )  # fmt: skip
    if any(run.attrs["status"] == "unstable" for run in pair):
        return (*start, math.nan, math.nan, 0, math.nan, math.nan)
    least = ROUND_OFF * scenes[0].network.length
    most = SMALL * rms_displacement(pair.first)
    rate = growth_rate(separation(pair), scenes[0].sample_rate, least, most)
    return (*start, *rate, consistency(pair), saturation(pair))


def _last_half(pair: Pair) -> list[np.ndarray]:
    """Signals (time, p) of the last half of both runs, each without its mean over that time."""
    signals = [recording.signals(run) for run in pair]
    halves = [values[len(values) // 2 :] for values in signals]
    return [values - values.mean(axis=0) for values in halves]
