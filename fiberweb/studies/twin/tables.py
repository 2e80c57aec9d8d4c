"""Tables of the twin (Fig. 5): what films of its runs score, by group of readouts and by target."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from fiberweb import tables
from fiberweb.model.scene import Scene
from fiberweb.scoring import capacity, groups, recording
from fiberweb.scoring.camera import films
from fiberweb.scoring.tables import SCALARS
from fiberweb.simulation import dataset

if TYPE_CHECKING:
    import xarray as xr

ALL, REDUCED = groups.ALL, groups.REDUCED
TRIVIAL = ("u", "derivatives", "powers")  # readouts made of the filmed input alone
READOUTS = (ALL, *REDUCED, *TRIVIAL)
RECALL = 0.5  # s; of claim E3
FILM_COLUMNS = ("setup", "topology", "n", "angle_deg", "stroke_m", "frame_step", "verdict")
COLUMNS = (*FILM_COLUMNS, "readouts", "n_signals", *SCALARS, "recall_500ms", "status", "run")
CURVE_COLUMNS = (*FILM_COLUMNS, "readouts", "target", "at", "c", "run")


def by_readouts(
    response_paths: Sequence[str | Path], cameras: Sequence[Mapping], scoring: Mapping
) -> pd.DataFrame:
    """One row for each run, reading of the frame rate and set of readouts.

    Args:
        response_paths: of the runs.
        cameras: of each path, keyword arguments of `fiberweb.scoring.camera.films`.
        scoring: options of `fiberweb.scoring.capacity.score_arrays`.

    Returns:
        Columns `COLUMNS`. setup is "published" for the authors' scoring and "described" for the
        clean one. readouts: the markers of a group, the driven one left out, or `TRIVIAL`.
        verdict: whether claims are judged by this reading, the first. recall_500ms: c of u 0.5 s
        ago. Capacities are NaN for an unstable run.
    """
    records = []
    for film, row in _films(response_paths, cameras, scoring):
        for name, x in _readouts(film).items():
            scored = dict.fromkeys((*SCALARS, "recall_500ms"), math.nan)
            if _known(film, name):
                of_film = _score(film, x, scoring)
                scored = {scalar: getattr(of_film, scalar) for scalar in SCALARS}
                nearest = np.argmin(np.abs(of_film.lags - RECALL))
                scored["recall_500ms"] = float(of_film.memory[nearest])
            records.append(row | {"readouts": name, "n_signals": x.shape[1]} | scored)
    return tables.ordered(pd.DataFrame(records, columns=list(COLUMNS)))


def curves(
    response_paths: Sequence[str | Path], cameras: Sequence[Mapping], scoring: Mapping
) -> pd.DataFrame:
    """Capacity of every single target by the first reading, of all markers and of `TRIVIAL`;
    arguments as for `by_readouts`.

    Returns:
        Columns `CURVE_COLUMNS`: target is "order" (at: Legendre order) or "lag" (at: s).
    """
    frames = []
    for film, row in _films(response_paths, _first(cameras), scoring):
        for name, x in _readouts(film, groups_of=(ALL,)).items():
            if not _known(film, name):
                continue
            c = _score(film, x, scoring)
            for target, at, values in (
                ("order", c.orders, c.nonlinear), ("lag", c.lags, c.memory)
            ):  # fmt: skip
                frame = pd.DataFrame({"at": at.astype(float), "c": values})
                frames.append(frame.assign(**row, readouts=name, target=target))
    made = pd.concat(frames, ignore_index=True)[list(CURVE_COLUMNS)]
    return tables.ordered(made)


def sensitivity(
    response_paths: Sequence[str | Path],
    cameras: Sequence[Mapping],
    choices: Sequence[str],
    scoring: Mapping,
) -> pd.DataFrame:
    """`by_readouts` of the first reading, of runs with one parameter changed and of those with
    none.

    Args:
        choices: of each path, "parameter=value", or another word where nothing is changed.

    Returns:
        Its columns, parameter (empty where nothing is changed) and value (NaN there).
    """
    frames = []
    for path, camera, choice in zip(response_paths, _first(cameras), choices, strict=True):
        parameter, changed, value = choice.partition("=")
        frames.append(
            by_readouts([path], [camera], scoring).assign(
                parameter=parameter if changed else "none",
                value=float(value) if changed else math.nan,
            )
        )
    return tables.ordered(pd.concat(frames, ignore_index=True))


def _first(cameras: Sequence[Mapping]) -> list[dict]:
    """The same with the first reading of the frame rate alone."""
    return [dict(camera) | {"frame_step": camera["frame_step"][:1]} for camera in cameras]


def _films(paths, cameras, scoring) -> Iterator[tuple[xr.Dataset, dict]]:
    """Films of all runs, with the cells that say of what they are."""
    setup = "published" if scoring["scoring"] == "published" else "described"
    for path, camera in zip(paths, cameras, strict=True):
        response = dataset.load(path)
        scene = Scene.from_json(response.attrs["scene"])
        row = {
            "setup": setup, "topology": scene.network.topology, "n": scene.network.n,
            "angle_deg": round(scene.motor_angle, 6), "stroke_m": scene.stroke,
            "status": response.attrs["status"], "run": response.attrs["run"],
        }  # fmt: skip
        for step, film in films(response, **camera):
            first = step == camera["frame_step"][0]
            yield film, row | {"frame_step": step, "verdict": first}


def _readouts(film: xr.Dataset, groups_of: Sequence[str] = (ALL, *REDUCED)) -> dict:
    """(T, p) of each set of readouts."""
    network = Scene.from_json(film.attrs["scene"]).network
    moved = recording.signals(film)
    grouped = {name: moved[:, groups.mask(name, network, film)] for name in groups_of}
    return grouped | capacity.trivial_readouts(film["input"].values, recording.sample_rate(film))


def _known(film: xr.Dataset, readouts: str) -> bool:
    """Whether there is something to score: of an unstable run, only what is made of its input."""
    return film.attrs["status"] == "ok" or readouts in TRIVIAL


def _score(film: xr.Dataset, x: np.ndarray, scoring: Mapping) -> capacity.Capacity:
    u, rate = film["input"].values, recording.sample_rate(film)
    return capacity.score_arrays(u, x, rate, **scoring)
