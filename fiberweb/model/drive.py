"""The input: a seeded cubic spline, the same for every run (paper, section "Simulation
experiments": uniform samples at 5 Hz, cubic spline, fixed seed)."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from fiberweb.model.authors import KNOTS, SEED, clock
from fiberweb.model.scene import Scene

TABLE_RATE = 100.0  # Hz, at which the experiment's motor is given its angles


def of_scene(scene: Scene) -> CubicSpline:
    """What force or stroke are multiplied with: the input, or what a lever makes of it."""
    u = _drawn(scene)
    if scene.lever is None:
        return u
    most = np.arcsin(scene.stroke / scene.lever)
    times = np.arange(np.floor(u.x[-1] * TABLE_RATE) + 1) / TABLE_RATE
    return CubicSpline(times, np.sin(most * u(times)) / np.sin(most))


def rate(scene: Scene) -> float:
    """Intervals of `of_scene` per second (Hz)."""
    return scene.drive_rate if scene.lever is None else TABLE_RATE


def _drawn(scene: Scene) -> CubicSpline:
    """The input. The authors draw no more knots than a run needs, which shows in the
    last second of a run of theirs that is shorter than 100 s."""
    least = 0 if scene.setup == "published" else KNOTS
    return spline(scene.seed, scene.duration, scene.drive_rate, least, scene.lowest_knot)


def scored(scene: Scene) -> CubicSpline:
    """What the authors' scoring takes for the input of a scene: drawn anew, up to the next whole
    second of their `clock`. In their 50 s runs that is one second more than drove them, and the two
    differ from 48.9 s on."""
    if scene.setup != "published":
        return of_scene(scene)
    length = np.ceil(clock(scene.duration))
    return spline(scene.seed, length, scene.drive_rate, 0, scene.lowest_knot)


def spline(
    seed: int = SEED, duration: float = 100.0, rate: float = 5.0, least: int = KNOTS,
    lowest: float = -1.0,
) -> CubicSpline:  # fmt: skip
    """The input u(t), dimensionless, for 0 <= t <= duration.

    Args:
        seed: of numpy's legacy generator, as the authors used it.
        duration: length needed (s); beyond 100 s the series goes on.
        rate: knots per second (Hz).
        least: knots that are drawn at least, so that a shorter run sees the beginning of the same
            series.
        lowest: the knots' values lie between this and 1.

    Returns:
        A cubic spline (not-a-knot) through uniform values in [lowest, 1], the first one 0. It
        overshoots its knots: to 1.18 for the authors' seed.
    """
    knots = max(least, int(np.ceil(duration * rate)) + 1)
    values = np.random.RandomState(seed).uniform(lowest, 1.0, knots)
    values[0] = 0.0
    return CubicSpline(np.arange(knots) / rate, values)
