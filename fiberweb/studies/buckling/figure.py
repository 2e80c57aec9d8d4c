"""Networks just below and just above B = 1: snapshots, time series and animations.

Drawing only: the shapes come from `fiberweb.model.centre_lines`.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.colors import Normalize, to_rgb
from matplotlib.figure import Figure, FigureBase
from PIL import Image

from fiberweb.figures import style
from fiberweb.model.centre_lines import bulges, widest
from fiberweb.studies.buckling.film import (
    CURVATURE,
    MM,
    Film,
    Frame,
    colour_bar,
    driven_point,
    film_of,
    force_of,
    limits_of,
    norm_of,
    scene_of,
)

SNAPSHOTS = np.arange(-2, 3)  # half knot intervals of the input from the widest bulge
GIF_DPI = 115
GIF_SHADES = 5  # between a colour and white, for smooth edges
THINNED = 5  # samples to a point where whole runs are shown


@style.drawing
def draw(given: dict, setup: str, seconds: float) -> Figure:
    """Snapshots of each run around the widest bulge of a column in any of them, how driven point
    and column move then, and the bulge against the momentary load; see `fiberweb.figures`.

    Args:
        given: "responses", with `centre_line`, of one crosshatch and one input, by rising force.
        seconds: length of the time series.
    """
    responses = given["responses"]
    bulged = [bulges(data) for data in responses]
    middle = widest(bulged)
    instants = _snapshots(responses[0], middle)
    films = [film_of(data, instants) for data in responses]
    heights = [45.0] * len(films) + [56.0]
    figure = style.figure(style.DOUBLE, sum(heights))
    rows = list(figure.subfigures(len(heights), 1, height_ratios=heights))
    letters = iter("abcdefghijklmnopqrstuvwxyz")
    for row, film in zip(rows, films):
        style.letter(row, next(letters), film.title)
        _row(row, film, limits_of(films), norm_of(films))
    left, right = rows[-1].subfigures(1, 2, width_ratios=[3, 2])
    style.letter(left, next(letters), "Around the widest bulge (dots: the snapshots)")
    _motion(left, responses, bulged, _span(responses[0], middle, seconds), instants)
    style.letter(right, next(letters), "Columns against their momentary load")
    _onset(right, responses, bulged)
    return figure


def animate(
    responses: Sequence[xr.Dataset], seconds: float, frame_rate: float, paths: Sequence[str | Path]
) -> None:
    """One GIF a run, in real time, all over the same seconds around the widest bulge.

    Args:
        responses: as "responses" for `draw`.
        seconds: length; the whole run if that is shorter.
        frame_rate: Hz, rounded so that a frame lasts whole hundredths of a second, as a GIF's
            must.
        paths: of each run's GIF.
    """
    span = _span(responses[0], widest([bulges(data) for data in responses]), seconds)
    hundredths = max(1, round(100 / frame_rate))
    every = float(responses[0].attrs["sample_rate"]) * hundredths / 100
    instants = np.arange(span.start, span.stop, every).astype(int)
    films = [film_of(data, instants) for data in responses]
    for film, path in zip(films, paths, strict=True):
        _gif(film, limits_of(films), norm_of(films), 10 * hundredths, path)


def _snapshots(data: xr.Dataset, middle: int) -> np.ndarray:
    """Samples of the snapshots; around another middle where the run is not long enough."""
    scene, last = scene_of(data), data.sizes["time"] - 1
    half = round(0.5 * scene.sample_rate / scene.drive_rate)
    reach = half * SNAPSHOTS.max()
    middle = int(np.clip(middle, reach, max(reach, last - reach)))
    return np.clip(middle + half * SNAPSHOTS, 0, last)


def _span(data: xr.Dataset, middle: int, seconds: float) -> slice:
    """Samples of so many seconds around the middle, within the run."""
    samples = data.sizes["time"]
    count = min(max(1, round(seconds * float(data.attrs["sample_rate"]))), samples)
    start = int(np.clip(middle - count // 2, 0, samples - count))
    return slice(start, start + count)


def _row(part: FigureBase, film: Film, limits: np.ndarray, norm: Normalize) -> None:
    """Every frame of a film side by side."""
    axes = part.subplots(1, len(film.time), squeeze=False)[0]
    for frame, ax in enumerate(axes):
        Frame(ax, film, limits, norm).show(frame)
        ax.set_title(film.caption(frame))
        if np.isnan(film.driven[frame]).any():
            ax.plot(0.5, 0.5, transform=ax.transAxes, gid="unstable", **style.UNSTABLE)
    colour_bar(part, list(axes), norm)


def _motion(
    part: FigureBase,
    responses: Sequence[xr.Dataset],
    bulged: Sequence[np.ndarray],
    span: slice,
    instants: np.ndarray,
) -> None:
    """Driven point and the column that bulges most over some seconds, every run."""
    driven, column = part.subplots(2, 1, sharex=True)
    time = responses[0]["time"].values
    widest_column = int(np.argmax(np.nan_to_num(np.abs(bulged[-1])).max(axis=0)))
    for data, b, colour in zip(responses, bulged, style.colours(len(bulged))):
        at_rest = MM * scene_of(data).network.fibres[scene_of(data).network.driven_fibre, 0, 1]
        series = (
            (driven, MM * driven_point(data)[:, 1] - at_rest),
            (column, MM * b[:, widest_column]),
        )
        for ax, values in series:
            ax.plot(time[span], values[span], color=colour, label=force_of(scene_of(data)), lw=0.8)
            seen = instants[(instants >= span.start) & (instants < span.stop)]
            ax.plot(time[seen], values[seen], "o", color=colour, ms=2.2)
            gone = float(data.attrs.get("unstable_at", np.inf))
            style.mark_unstable(ax, [max(gone, time[span][0])] if gone < time[span][-1] else [])
    driven.legend(loc="upper right", bbox_to_anchor=(1.0, 1.25), ncols=len(bulged))
    driven.set(ylabel="Driven point\n$y$ (mm)")
    column.set(xlabel="Time (s)", ylabel="Column\nbulge (mm)", xlim=time[span][[0, -1]])
    part.align_ylabels()


def _onset(part: FigureBase, responses: Sequence[xr.Dataset], bulged: Sequence[np.ndarray]) -> None:
    """Widest bulge of any column against the momentary buckling number -B u."""
    ax = part.subplots()
    for data, b, colour in zip(responses, bulged, style.colours(len(bulged))):
        load = -scene_of(data).buckling_number * data["input"].values
        ax.plot(
            load[::THINNED], MM * np.abs(b).max(axis=1)[::THINNED], "o", color=colour, ms=1.0,
            mew=0, label=force_of(scene_of(data)), rasterized=True, zorder=-len(ax.lines),
        )  # fmt: skip
    ax.axvline(1.0, color=style.GREY, lw=0.7, ls=(0, (4, 2)), zorder=-9)
    ax.set(xlabel="Momentary load of the columns, $-\\mathcal{B}u$", ylabel="Widest bulge (mm)")
    ax.legend(loc="upper left", markerscale=4)


def _gif(film: Film, limits: np.ndarray, norm: Normalize, duration: int, path: str | Path) -> None:
    """Write a film as a GIF, so many milliseconds a frame."""
    with style.applied():
        figure = style.figure(style.SINGLE, 94.0)
        figure.set_dpi(GIF_DPI)
        figure.suptitle(film.title)
        upper, lower = figure.subplots(2, 1, height_ratios=[5, 1])
        network = Frame(upper, film, limits, norm)
        colour_bar(figure, upper, norm)
        lower.plot(film.time, film.u, color=style.GREY)
        lower.set(xlabel="Time (s)", ylabel="Input $u$", xlim=film.time[[0, -1]])
        (now,) = lower.plot([], [], "o", color=style.DRIVE, ms=3.5, clip_on=False)
        clock = upper.set_title(film.caption(0))
        moving = (network.fibres, network.driven, now, clock)
        for artist in moving:
            artist.set_animated(True)
        figure.canvas.draw()
        still = figure.canvas.copy_from_bbox(figure.bbox)
        pictures = []
        for frame in range(len(film.time)):
            figure.canvas.restore_region(still)
            network.show(frame)
            now.set_data([film.time[frame]], [film.u[frame]])
            clock.set_text(film.caption(frame))
            for artist in moving:
                figure.draw_artist(artist)
            seen = Image.fromarray(np.asarray(figure.canvas.buffer_rgba())[..., :3])
            pictures.append(seen.quantize(palette=_palette(), dither=Image.Dither.NONE))
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    pictures[0].save(
        path, format="GIF", save_all=True, append_images=pictures[1:], duration=duration, loop=0
    )


def _palette() -> Image.Image:
    """Every colour of the animation and its shades on white; one for all frames, or they would
    flicker."""
    plain = [*CURVATURE(np.linspace(0.0, 1.0, 32))[:, :3], style.DRIVE, style.INK, style.GREY]
    colours = np.array([to_rgb(colour) for colour in plain])
    white = np.linspace(0.0, 1.0, GIF_SHADES)[:, None, None]
    shades = 255 * (white + (1 - white) * colours)
    palette = Image.new("P", (1, 1))
    palette.putpalette(np.round(shades).astype(int).ravel().tolist())
    return palette
