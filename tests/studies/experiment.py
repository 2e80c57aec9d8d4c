"""Made-up responses of the experiment's twin: no simulation."""

import numpy as np
import xarray as xr

from fiberweb import studies
from fiberweb.config import lab, load
from fiberweb.model import drive
from fiberweb.scoring import groups

SMALL = {"experiment": {"duration": 8.0, "sample_rate": 60.0, "skip": 30}, "narma": {"twin_n": 4}}


def laboratory(setup="described", **values):
    """(config, what studies are given)."""
    config = load(SMALL, values)
    return config, lab(config, setup)


def asked_for(study, setup="described", **values):
    """Points of a study by choice."""
    config, here = laboratory(setup, **values)
    return list(studies.load(study).points(getattr(config, study), here))


def response(scene, name, status="ok", quiet=0.0):
    """Markers that follow powers and delays of the input; the driven one follows the motor."""
    points = groups.readouts(scene.network)
    random = np.random.default_rng(3)
    u = drive.of_scene(scene)(scene.times)
    basis = np.column_stack([u, u**2, u**3, np.roll(u, 4), np.roll(u, 9)])
    basis[0] = 0.0
    moved = 5e-3 * basis @ random.normal(size=(5, 2 * len(points)))
    moved = moved.reshape(len(u), 2, -1).transpose(0, 2, 1)
    at = np.hypot(
        points["x"] - scene.network.driven_point[0], points["y"] - scene.network.driven_point[1]
    )
    moved[:, at.argmin()] = np.column_stack([quiet * u, scene.stroke * u])
    if status == "unstable":
        moved[len(u) // 2 :] = np.nan
    return xr.Dataset(
        {"input": ("time", u), "displacement": (("time", "readout", "axis"), moved)},
        {"axis": ["x", "y"], "time": ("time", scene.times, {"units": "s"})}
        | {c: ("readout", points[c]) for c in ("kind", "fibre", "section")}
        | {f"rest_{c}": ("readout", points[c]) for c in "xy"},
        {
            "status": status, "setup": "described", "sample_rate": scene.sample_rate,
            "scene": scene.to_json(), "run": name, "engine": "none", "elements_per_section": 1,
            "time_step": 1e-3,
        },
    )  # fmt: skip
