"""The input: a seeded cubic spline, the same for every run (paper, section "Simulation
experiments": uniform samples at 5 Hz, cubic spline, fixed seed)."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from fiberweb.model.authors import KNOTS, SEED, clock
from fiberweb.model.scene import Scene


def of_scene(scene: Scene) -> CubicSpline:
    """What drives a scene. The authors draw no more knots than a run needs, which shows in the
    last second of a run of theirs that is shorter than 100 s."""
    least = 0 if scene.setup == "published" else KNOTS
    return spline(scene.seed, scene.duration, scene.drive_rate, least)


def scored(scene: Scene) -> CubicSpline:
    """What the authors' scoring takes for the input of a scene: drawn anew, up to the next whole
    second of their `clock`. In their 50 s runs that is one second more than drove them, and the two
    differ from 48.9 s on."""
    if scene.setup != "published":
        return of_scene(scene)
    return spline(scene.seed, np.ceil(clock(scene.duration)), scene.drive_rate, 0)


def spline(
    seed: int = SEED, duration: float = 100.0, rate: float = 5.0, least: int = KNOTS
) -> CubicSpline:
    """The input u(t), dimensionless, for 0 <= t <= duration.

    Args:
        seed: of numpy's legacy generator, as the authors used it.
        duration: length needed (s); beyond 100 s the series goes on.
        rate: knots per second (Hz).
        least: knots that are drawn at least, so that a shorter run sees the beginning of the same
            series.

    Returns:
        A cubic spline (not-a-knot) through uniform values in [-1, 1], the first one 0. It
        overshoots its knots: to 1.18 for the authors' seed.
    """
    knots = max(least, int(np.ceil(duration * rate)) + 1)
    values = np.random.RandomState(seed).uniform(-1.0, 1.0, knots)
    values[0] = 0.0
    return CubicSpline(np.arange(knots) / rate, values)
