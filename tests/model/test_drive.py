"""The input: the paper's series, and the same for every run."""

from dataclasses import replace

import numpy as np
import pytest

from fiberweb import Scene, crosshatch
from fiberweb.model.authors import clock
from fiberweb.model.drive import of_scene, scored, spline


def test_input_starts_at_zero_and_overshoots():
    """The paper's series: knots in [-1, 1] at 5 Hz, the first 0; the spline reaches 1.18."""
    u = spline()
    knots = u(np.arange(501) / 5)
    assert knots[0] == 0.0
    assert np.abs(knots).max() <= 1.0 + 1e-12
    assert np.abs(u(np.linspace(0, 100, 100_001))).max() == pytest.approx(1.18, abs=0.005)


def test_a_shorter_run_sees_the_same_input():
    time = np.linspace(0, 3, 1001)
    np.testing.assert_array_equal(spline(duration=3.0)(time), spline(duration=100.0)(time))
    np.testing.assert_allclose(spline(duration=150.0)(time), spline()(time), atol=1e-12)
    assert spline(duration=150.0).x[-1] >= 150.0


def test_seeds_give_different_inputs_and_the_same_again():
    time = np.linspace(0, 10, 101)
    assert np.abs(spline(1)(time) - spline(2)(time)).max() > 0.5
    np.testing.assert_array_equal(spline(7)(time), spline(7)(time))


def test_the_authors_50_s_runs_are_scored_against_another_input():
    """physics.md: their clock shows 50.0000000131 s, so 256 knots are drawn where 251 drove; the
    two part at 48.9 s, by up to .87. At 100 s it stays below 100 s."""
    assert clock(50.0) == pytest.approx(50.0000000131, abs=1e-10)
    assert 99.9 < clock(100.0) < 100.0
    scene = Scene(crosshatch(2, length=0.5), setup="published", duration=50.0)
    driven, target = of_scene(scene), scored(scene)
    assert len(driven.x) == 251 and len(target.x) == 256
    off = np.abs(driven(scene.times) - target(scene.times))
    assert off[scene.times < 48.9].max() < 2e-3 < off[(scene.times > 48.9)].max()
    assert off.max() == pytest.approx(0.87, abs=0.01)
    for other in (replace(scene, duration=100.0), replace(scene, setup="described")):
        np.testing.assert_array_equal(of_scene(other).c, scored(other).c)
