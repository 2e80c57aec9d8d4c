"""The buckling study's figure and animations, from responses made up."""

import numpy as np
import pytest
from matplotlib.colors import same_color
from matplotlib.lines import Line2D
from matplotlib.text import Text
from PIL import Image

from fiberweb import Scene, crosshatch
from fiberweb.engines.base import Numerics, Recording
from fiberweb.figures import style
from fiberweb.model.buckling import critical_force
from fiberweb.model.mesh import build
from fiberweb.simulation.response import response
from fiberweb.studies.buckling import figure as buckling
from fiberweb.studies.buckling import film
from tests.figures.legible import assert_legible, assert_written, marked

PEAK = 300  # sample at which the columns bulge most


def run(number, bulge, unstable_at=None):
    """2x2 at this buckling number, whose columns bulge by so much (m) about `PEAK`."""
    force = number * critical_force(0.1, 2e-3, 1e8)
    network = crosshatch(2, spacing=0.1)
    scene = Scene(network, force=force, duration=2.0, centre_lines=True)
    mesh = build(scene, 2)
    moved = np.zeros((scene.samples, len(mesh.readouts), 2))
    pulse = np.exp(-(((np.arange(scene.samples) - PEAK) / 20) ** 2))
    for number, readout in enumerate(mesh.readouts):
        height = mesh.position[readout.nodes[0], 1]
        if readout.fibre >= 2 and 0.1 < height < 0.2:
            moved[:, number, 0] = bulge * pulse
    if unstable_at is not None:
        moved[unstable_at:] = np.nan
    recording = Recording(moved, np.zeros((scene.samples, 4)), unstable_at and unstable_at / 250)
    return response(mesh, Numerics("kirchhoff", 2, 1e-4), recording)


@pytest.fixture(scope="module")
def responses():
    return [run(0.9, 0.001), run(1.2, -0.02)]


@pytest.fixture(scope="module")
def drawn(responses, tmp_path_factory):
    path = tmp_path_factory.mktemp("figures") / "buckling.png"
    return buckling.draw({"responses": responses}, "described", path, seconds=1.0), path


@pytest.fixture(scope="module")
def gifs(responses, tmp_path_factory):
    folder = tmp_path_factory.mktemp("gifs")
    paths = [folder / "new" / "below.gif", folder / "new" / "above.gif"]
    buckling.animate(responses, 0.4, 25.0, paths)
    return paths


def words_of(figure):
    return [text.get_text() for text in figure.findobj(Text) if text.get_text().strip()]


def test_the_figure_is_written(drawn):
    assert_written(drawn[1])


def test_snapshots_are_half_knots_around_the_widest_bulge(drawn):
    words = words_of(drawn[0])
    for time in ("1.00", "1.10", "1.20", "1.30", "1.40"):
        assert sum(f"$t$ = {time} s\n$u$" in text for text in words) == 2
    for number in (r"$\mathcal{B}$ = 0.9", r"$\mathcal{B}$ = 1.2"):
        assert any(text.startswith(number) or f" {number} " in text for text in words)
    assert sum(rf"\mathbf{{{letter}}}" in text for letter in "abcd" for text in words) == 4


def test_no_text_overlaps(drawn):
    assert_legible(drawn[0])


def test_the_driven_point_alone_has_its_colour(drawn):
    lines = drawn[0].findobj(Line2D)
    marked = [line for line in lines if same_color(line.get_color(), style.DRIVE)]
    assert len(marked) == 10
    np.testing.assert_allclose(marked[2].get_xydata(), [[150.0, 200.0]], atol=1e-6)


def test_the_fibres_are_where_the_centre_lines_are(responses):
    """At the peak the columns reach 20 mm to the left of where they were."""
    shown = film.film_of(responses[1], np.array([0, PEAK]))
    np.testing.assert_allclose(shown.points[0, 2, :, 0], 100.0, atol=1e-9)
    middle = 3 * film.POINTS // 2
    np.testing.assert_allclose(shown.points[1, 2:, middle], [[80, 150], [180, 150]], atol=1e-4)
    assert film.norm_of([shown]).vmax == pytest.approx(shown.curvature[1, 2:].max())
    low, high = film.limits_of([shown])
    np.testing.assert_allclose([*low, *high], [-16, -16, 316, 316])


def test_snapshots_and_seconds_stay_within_the_run(responses):
    np.testing.assert_array_equal(buckling._snapshots(responses[0], 3), [0, 25, 50, 75, 100])
    np.testing.assert_array_equal(buckling._snapshots(responses[0], 498)[-1], 499)
    assert buckling._span(responses[0], 490, 1.0) == slice(250, 500)
    assert buckling._span(responses[0], 2, 9.0) == slice(0, 500)


def test_an_unstable_run_is_marked(unsaved):
    """In the snapshots that it has not, and where it ended."""
    lost = run(1.5, -0.03, unstable_at=310)
    figure = buckling.draw({"responses": [lost]}, "described", "unsaved", seconds=1.0)
    *snapshots, driven, column = marked(figure)
    assert [mark.axes.get_title().split("\n")[0] for mark in snapshots] == [
        "$t$ = 1.30 s", "$t$ = 1.40 s"
    ]  # fmt: skip
    for mark in (driven, column):
        assert mark.get_xdata()[0] == pytest.approx(310 / 250)


def test_animations_are_in_real_time_and_repeat_to_the_byte(gifs, responses, tmp_path):
    for path in gifs:
        with Image.open(path) as picture:
            assert picture.n_frames == 10
            assert picture.info["duration"] == 40
            assert 380 <= picture.width <= 420
        assert path.stat().st_size < 3e6 / 20
    again = tmp_path / "again.gif"
    buckling.animate(responses[1:], 0.4, 25.0, [again])
    below = tmp_path / "below.gif"
    buckling.animate([*responses], 0.4, 25.0, [below, tmp_path / "above.gif"])
    assert below.read_bytes() == gifs[0].read_bytes()
    assert (tmp_path / "above.gif").read_bytes() == gifs[1].read_bytes()


def test_frames_show_the_drive_and_the_bulge(gifs):
    with Image.open(gifs[1]) as picture:
        frames = []
        for number in (0, 5):
            picture.seek(number)
            frames.append(np.asarray(picture.convert("RGB")).astype(int))
    drive = np.array([0xC8, 0x44, 0x2C])
    assert (np.abs(frames[0] - drive).max(axis=-1) < 8).sum() > 20
    assert (np.abs(frames[1] - frames[0]).max(axis=-1) > 50).sum() > 100
