"""How wide the authors' dead band is, how it grows, and how far neighbouring elements turn.

Directors are not part of a response, so the run is repeated and looked at now and then.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from fiberweb.engines import load
from fiberweb.engines.base import Numerics
from fiberweb.meanings import RUN, explained
from fiberweb.model.mesh import Mesh, build
from fiberweb.model.scene import Scene
from fiberweb.simulation import dataset

SHARES = (0.1, 0.5, 0.9)  # quantiles over the inner nodes
BINS = np.arange(-9.0, -0.95, 0.1)  # log10 of an angle in rad
LOOK_VARIABLES = {
    "time": ("time from the start", "s"),
    "turn": ("angle between the elements beside an inner node", "rad"),
    "band": ("half the width of the dead band there", "rad"),
}
SETUP = {"setup": RUN["setup"]}
BAND_COLUMNS = (
    SETUP
    | {"time_s": ("of the look", "s")}
    | {f"turn_{share:g}_rad": (f"quantile {share:g} of turn", "rad") for share in SHARES}
    | {f"band_{share:g}_rad": (f"quantile {share:g} of band", "rad") for share in SHARES}
    | {
        "share_inside": "of the nodes: those that bend freely, their turn being within the band",
        "curvature_per_m": ("that the median band hides", "1/m"),
        "surface_strain": "that goes with this curvature",
        "moment_Nm": ("that goes with this curvature", "N m"),
        "bow_m": ("of one section, that goes with this curvature", "m"),
    }
)
HISTOGRAM_COLUMNS = SETUP | {
    "from_rad": ("lower end of the bin", "rad"),
    "to_rad": ("upper end of the bin", "rad"),
    "turn": "share of all nodes and looks with a turn in the bin",
    "band": "the same of the dead band's half width",
}


@explained(
    LOOK_VARIABLES,
    attributes=SETUP | {"scene": RUN["scene"], "element": ("length of an element", "m")},
)
def looks(response_path: str | Path, every: float) -> xr.Dataset:
    """A run looked at every so many seconds, at each inner node of a fibre: ``turn(time, node)``
    and ``band(time, node)``."""
    attrs = dataset.load(response_path).attrs
    scene = Scene.from_json(attrs["scene"])
    mesh = build(scene)
    inner = np.flatnonzero(_inner(mesh))
    times, turns, bands = [], [], []

    def watch(sample: int, angle: np.ndarray, length2: np.ndarray) -> None:
        time = sample / scene.sample_rate
        if time < len(times) * every - 1e-9:
            return
        times.append(time)
        turns.append(abs(angle[inner] - angle[inner - 1]))
        # the couple is zero while the squared turn is below the sum of what both have grown by
        bands.append(np.sqrt(np.maximum(length2[inner] + length2[inner - 1] - 2.0, 0.0)))

    load(attrs["engine"]).integrate(
        mesh, Numerics(attrs["engine"], None, attrs["time_step"]), watch
    )
    angles = ("time", "node")
    return xr.Dataset(
        {"turn": (angles, np.array(turns)), "band": (angles, np.array(bands))},
        {"time": times},
        {"setup": scene.setup, "scene": attrs["scene"], "element": mesh.edges(0)[0]},
    )


@explained(BAND_COLUMNS)
def growth(seen: xr.Dataset) -> pd.DataFrame:
    """One row for each look: quantiles of turns and of the band's half width, and what the median
    band hides."""
    scene = Scene.from_json(seen.attrs["scene"])
    rows = []
    for time, turn, band in zip(seen["time"].values, seen["turn"].values, seen["band"].values):
        curvature = np.median(band) / seen.attrs["element"]
        rows.append(
            (
                scene.setup, time, *np.quantile(turn, SHARES), *np.quantile(band, SHARES),
                np.mean(turn < band), curvature, 0.5 * scene.diameter * curvature,
                scene.bending_stiffness * curvature, curvature * scene.network.spacing**2 / 8,
            )
        )  # fmt: skip
    return pd.DataFrame(rows, columns=list(BAND_COLUMNS))


@explained(HISTOGRAM_COLUMNS)
def histogram(seen: xr.Dataset) -> pd.DataFrame:
    """One row for each bin of the logarithm of an angle: share of turns and of bands in it."""
    counts = {}
    for name in ("turn", "band"):
        values = seen[name].values[1:].ravel()  # all are 0 at first
        logs = np.clip(np.log10(np.maximum(values, 1e-30)), BINS[0], BINS[-1])
        counts[name] = np.histogram(logs, BINS)[0] / len(values)
    edges = 10.0**BINS
    return pd.DataFrame(
        {"setup": seen.attrs["setup"], "from_rad": edges[:-1], "to_rad": edges[1:], **counts}
    )


def _inner(mesh: Mesh) -> np.ndarray:
    """Whether each element, of all fibres in a row, follows another of its fibre."""
    inner = np.ones(mesh.elements, dtype=bool)
    inner[mesh.first[:-1] - np.arange(len(mesh.first) - 1)] = False
    return inner
