"""Shapes of fibres between their nodes, and the columns that the drive compresses."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline

from fiberweb.model.network import Network
from fiberweb.model.scene import Scene


def along(data: xr.Dataset, fibre: int, distance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where points of a fibre are, and how it bends there.

    A cubic spline goes through the nodes, as a beam does that is loaded at its nodes alone; at
    a clamp it keeps the direction of rest, at other ends it is straight.

    Args:
        data: a response with `centre_line`, see `fiberweb.simulation.response.response`.
        fibre: number of the fibre.
        distance: of the points from the near end at rest, shape (points,), m.

    Returns:
        Position, shape (time, points, 2), m, and curvature, shape (time, points), 1/m, positive
        to the left seen from the near end; NaN once the run is unstable.
    """
    of_fibre = data.isel(node=np.flatnonzero(data["node_fibre"].values == fibre))
    rest = np.column_stack([of_fibre["node_rest_x"], of_fibre["node_rest_y"]])
    moved = of_fibre["centre_line"].transpose("node", "time", "axis").values.astype(float)
    stable = np.isfinite(moved).all(axis=(0, 2))
    place = rest[:, None] + moved[:, stable]
    nodes = np.linalg.norm(rest - rest[0], axis=1)
    nothing = np.zeros(place.shape[1:])
    near = (2, nothing)
    if Scene.from_json(data.attrs["scene"]).ends == "clamped":
        near = (1, nothing + (rest[-1] - rest[0]) / nodes[-1])
    spline = CubicSpline(nodes, place, bc_type=(near, (2, nothing)))
    slope, bend = spline(distance, 1), spline(distance, 2)
    turn = slope[..., 0] * bend[..., 1] - slope[..., 1] * bend[..., 0]
    position = np.full((len(stable), len(distance), 2), np.nan)
    curvature = np.full(position.shape[:2], np.nan)
    position[stable] = spline(distance).swapaxes(0, 1)
    curvature[stable] = (turn / np.linalg.norm(slope, axis=-1) ** 3).T
    return position, curvature


def columns(network: Network) -> list[tuple[int, int]]:
    """(fibre, section) of each column of Eq. 4: the sections that reach from the ends of the
    driven section towards the held ends of the fibres across. Those on the other side end in
    fibres free to move away, and are not compressed."""
    return [
        (fibre, number)
        for crossing, distance in network.stations[network.driven_fibre]
        if abs(distance - network.driven_distance) < 0.5 * network.spacing * (1 + 1e-9)
        for fibre, stations in enumerate(network.stations)
        for number, (other, _) in enumerate(stations)
        if other == crossing and fibre != network.driven_fibre
    ]


def bulge(data: xr.Dataset, fibre: int, section: int) -> np.ndarray:
    """How far the middle of a section is from the chord between its ends.

    Args:
        data: a response with `centre_line`.
        fibre, section: numbers of both.

    Returns:
        Shape (time,), m, positive to the right seen from the near end; NaN once unstable.
    """
    ends = Scene.from_json(data.attrs["scene"]).network.sections(fibre)[section : section + 2]
    points, _ = along(data, fibre, np.array([ends[0], ends.mean(), ends[1]]))
    chord, arm = points[:, 2] - points[:, 0], points[:, 1] - points[:, 0]
    across = chord[:, 1] * arm[:, 0] - chord[:, 0] * arm[:, 1]
    return across / np.linalg.norm(chord, axis=1)


def bulges(data: xr.Dataset) -> np.ndarray:
    """`bulge` of every column, shape (time, columns), m."""
    network = Scene.from_json(data.attrs["scene"]).network
    return np.column_stack([bulge(data, *column) for column in columns(network)])


def widest(bulged: Sequence[np.ndarray]) -> int:
    """Number of the sample in which a column of any run bulges most.

    Args:
        bulged: `bulges` of each run, in which all have the same instants.
    """
    return int(np.argmax(np.max([np.nan_to_num(abs(b)).max(axis=1) for b in bulged], axis=0)))
