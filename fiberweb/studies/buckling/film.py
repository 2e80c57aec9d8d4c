"""A crosshatch of fibres at a few instants, at true scale and coloured by how it bends."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap, Normalize, PowerNorm
from matplotlib.figure import FigureBase

from fiberweb.figures import style
from fiberweb.model.centre_lines import along
from fiberweb.model.scene import Scene

POINTS = 12  # drawn on each section
CURVATURE = ListedColormap(style.colours(256))  # dark enough to show on white as a line
MARGIN = 16.0  # mm, around the network, and length of the bar that marks a held end
MM = 1e3  # of a metre


class Film(NamedTuple):
    """What is seen of a run at a few instants; lengths in mm."""

    title: str
    time: np.ndarray  # (frames,), s
    u: np.ndarray  # (frames,)
    rest: np.ndarray  # (fibres, 2, 2)
    points: np.ndarray  # (frames, fibres, points, 2)
    curvature: np.ndarray  # (frames, fibres, points), 1/m
    driven: np.ndarray  # (frames, 2)

    def caption(self, frame: int) -> str:
        """Time and input of a frame."""
        return f"$t$ = {self.time[frame]:.2f} s\n$u$ = {self.u[frame]:+.2f}".replace("-", "−")


def film_of(data: xr.Dataset, instants: np.ndarray) -> Film:
    """The film of a response with `centre_line`; instants are numbers of samples."""
    scene, seen = scene_of(data), data.isel(time=instants)
    network = scene.network
    shapes = [
        along(seen, fibre, np.linspace(0.0, length, POINTS * (network.n + 1) + 1))
        for fibre, length in enumerate(network.fibre_lengths)
    ]
    points, curvature = (np.stack(part, axis=1) for part in zip(*shapes))
    size = f"{network.n}×{network.n}, spacing {MM * network.spacing:g} mm, true scale"
    return Film(
        f"{force_of(scene)} ({size})",
        seen["time"].values,
        seen["input"].values,
        MM * network.fibres,
        MM * points,
        np.abs(curvature),
        MM * driven_point(seen),
    )


def driven_point(data: xr.Dataset) -> np.ndarray:
    """Where the driven point is, shape (time, 2), m."""
    network = scene_of(data).network
    return along(data, network.driven_fibre, np.array([network.driven_distance]))[0][:, 0]


def scene_of(data: xr.Dataset) -> Scene:
    """The scene of a response."""
    return Scene.from_json(data.attrs["scene"])


def force_of(scene: Scene) -> str:
    """The force as its buckling number, a label."""
    return rf"$\mathcal{{B}}$ = {scene.buckling_number:.3g}"


def norm_of(films: Sequence[Film]) -> Normalize:
    """Of the colours, the same for all films. A square root, or the driven point would leave no
    colour for the columns; up to 1 for networks at rest."""
    most = max(np.nan_to_num(film.curvature).max() for film in films)
    return PowerNorm(0.5, 0.0, most or 1.0)


def limits_of(films: Sequence[Film]) -> np.ndarray:
    """Least and largest (x, y) in any film, with a margin, shape (2, 2)."""
    places = [part.reshape(-1, 2) for film in films for part in (film.points, film.rest)]
    everything = np.concatenate(places)
    return np.array([
        np.nanmin(everything, axis=0) - MARGIN, np.nanmax(everything, axis=0) + MARGIN
    ])  # fmt: skip


class Frame:
    """A network in an axes, at true scale, to be set to one frame after the other."""

    def __init__(self, ax: Axes, film: Film, limits: np.ndarray, norm: Normalize):
        self.film = film
        near, far = film.rest[:, 0], film.rest[:, 1]
        across = (far - near)[:, ::-1]
        across *= 0.5 * MARGIN / np.linalg.norm(across, axis=1, keepdims=True)
        walls = np.stack([near - across, near + across], axis=1)
        ax.add_collection(LineCollection(film.rest, colors=style.FAINT, linewidths=0.5))
        ax.add_collection(LineCollection(walls, colors=style.INK, linewidths=1.2))
        self.fibres = LineCollection([], cmap=CURVATURE, norm=norm, linewidths=1.3, snap=False)
        ax.add_collection(self.fibres)
        (self.driven,) = ax.plot([], [], "o", color=style.DRIVE, ms=3.5, zorder=4)
        ax.set(aspect="equal", xlim=limits[:, 0], ylim=limits[:, 1])
        ax.axis("off")

    def show(self, frame: int) -> None:
        """Draw this frame of the film."""
        points, curvature = self.film.points[frame], self.film.curvature[frame]
        # pieces of two steps, each half over the next: laid end to end, their smoothed edges
        # would show as beads
        pieces = np.stack([points[:, :-2], points[:, 1:-1], points[:, 2:]], axis=2)
        self.fibres.set_segments(pieces.reshape(-1, 3, 2))
        self.fibres.set_array(curvature[:, 1:-1].ravel())
        self.driven.set_data(*self.film.driven[frame][:, None])


def colour_bar(part: FigureBase, axes, norm: Normalize) -> None:
    """Key of the fibres' colours beside one axes, or several."""
    bar = part.colorbar(ScalarMappable(norm, CURVATURE), ax=axes, pad=0.01, aspect=18)
    bar.set_label("|Curvature| (1/m),\nsquare-root scale")
    bar.outline.set_visible(False)
