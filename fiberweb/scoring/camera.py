"""A camera that films a simulated experiment: from a response to what a tracker would make of it.

It stands between simulation and scoring, so that one simulation serves several cameras and several
readings of their frame rate.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING
from zlib import crc32

import numpy as np

from fiberweb.model.network import COINCIDENT
from fiberweb.model.scene import Scene
from fiberweb.scoring import recording

if TYPE_CHECKING:
    import xarray as xr

MM = 1e3  # a metre in mm


def films(
    response: xr.Dataset, frame_step: Sequence[int], **camera
) -> Iterator[tuple[int, xr.Dataset]]:
    """(step, `film`) of each reading of the frame rate; arguments as there."""
    for step in frame_step:
        yield step, film(response, frame_step=step, **camera)


def film(
    response: xr.Dataset, pixels_per_mm: float, noise: float, seed: int = 0, frame_step: int = 1
) -> xr.Dataset:
    """What is tracked of a response whose driven point a motor carries.

    Args:
        response: of `fiberweb.simulate` for a scene with a stroke, with the attribute ``run``.
        pixels_per_mm: scale of the film.
        noise: standard deviation of each marker's position along x and along y (pixels),
            independent from frame to frame.
        seed: of the noise, together with the name of the run: no two runs have the same.
        frame_step: every so many frames are read, and then taken for consecutive ones: the time of
            the film is that of the camera's rate, and runs so many times too fast.

    Returns:
        A response to be scored. ``displacement`` (m) of every marker but the driven one, from
        where it was in the first frame, whose noise is in it; ``input`` (m), that of the driven
        marker along the stroke, as the authors take it. An unstable run keeps its own input.

    Raises:
        ValueError: a scene without a stroke, or no marker at its driven point.
    """
    scene = Scene.from_json(response.attrs["scene"])
    driven = _driven(scene, response)
    random = np.random.default_rng([seed, crc32(response.attrs["run"].encode())])
    moved = response["displacement"].transpose("time", "readout", "axis")
    # drawn for every frame, so that a frame has the same noise at any step
    blur = noise / (pixels_per_mm * MM) * random.standard_normal(moved.shape)
    seen = (moved + blur).isel(time=slice(None, None, frame_step))
    seen = seen - seen.isel(time=0)
    rate = recording.sample_rate(response)
    seen = seen.assign_coords(time=("time", np.arange(len(seen)) / rate, {"units": "s"}))
    u = response["input"].values[::frame_step]
    if response.attrs["status"] == "ok":
        u = np.sign(scene.stroke) * (seen.isel(readout=driven).values @ scene.network.across)
    tracked = seen.drop_isel(readout=driven).to_dataset(name="displacement")
    return tracked.assign(input=("time", u)).assign_attrs(response.attrs)


def _driven(scene: Scene, response: xr.Dataset) -> int:
    """Number of the readout at the driven point."""
    if scene.stroke is None:
        raise ValueError(
            f"force = {scene.force:g} N drives this scene: a film takes its input from a point "
            "that a motor carries, so give the scene a stroke"
        )
    x, y = scene.network.driven_point
    away = np.hypot(response["rest_x"].values - x, response["rest_y"].values - y)
    if away.min() > COINCIDENT:
        raise ValueError(f"no readout lies at the driven point, ({x:g} m, {y:g} m)")
    return int(np.argmin(away))
