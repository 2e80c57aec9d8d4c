"""The figures about accuracy draw what their tables hold."""

import numpy as np
import pandas as pd
import pytest

from fiberweb.studies.accuracy import figure as plotting
from fiberweb.validation import accuracy, limits

BOX = {
    "spacing": [0.05], "diameter": [1e-3], "tension": [0.0], "stiffness": [1e4],
    "buckling": [10.0], "elements": [3],
}  # fmt: skip
PREDICTED, LOADED, FOUND = 1e-5, 0.9e-5, 1.02e-5  # s


@pytest.fixture(scope="module")
def box():
    """The rows of a small box, with the same limits everywhere."""
    rows = [
        (p.engine, f"{p.n}x{p.n}", p.spacing, p.diameter, p.tension, p.scene().force, p.stiffness,
         p.damping, p.elements, PREDICTED, LOADED, FOUND, PREDICTED / FOUND, "ok")
        for p in limits.points(BOX)
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=limits.COLUMNS)


def text_of(figure):
    return [text.get_text() for ax in figure.axes for text in (ax.title, *ax.texts)] + [
        ax.get_title(loc="left") for ax in figure.axes
    ]


def test_stability_draws_every_point_and_the_drift(box, tmp_path):
    drift = pd.DataFrame(
        [(engine, "2x2", 24, 1e-5, 10_000_000, 1e-6, -3e-7, 1e-5)
         for engine in ("kirchhoff", "cosserat")],
        columns=limits.DRIFT_COLUMNS,
    )  # fmt: skip
    figure = plotting.draw_stability(box, drift, tmp_path / "stability.png")
    everything = figure.axes[0]
    drawn = sum(len(line.get_xdata()) for line in everything.lines if line.get_marker() != "None")
    assert drawn >= len(box)
    assert any("Energy drift -3e-07 in 1e+07 steps" in text for text in text_of(figure))
    for ax in figure.axes[1:7]:
        heights = np.concatenate([line.get_ydata() for line in ax.lines])
        loaded = ax.get_xlabel() == "Force (N)"
        assert np.isclose(heights, 1e6 * (LOADED if loaded else FOUND)).any()
        assert not np.isclose(heights, 1e6 * (FOUND if loaded else LOADED)).any()


def test_speed_draws_a_panel_for_each_error_and_network(tmp_path):
    rows = [
        (engine, setup, network, elements, 1e-5, cost, 3.0, error, error / 10, error / 20, 1.0, "")
        for network in ("4x4", "8x8")
        for engine, setup, elements, cost, error in (
            ("kirchhoff", "described", 2, 1.0, 0.1),
            ("kirchhoff", "described", 4, 2.0, 0.02),
            ("cosserat", "described", 4, 9.0, 0.2),
            ("elastica", "described", "authors", 4e3, 0.05),
            ("cosserat", "published", "authors", 30.0, 1e-9),
        )
    ]
    table = pd.DataFrame(rows, columns=accuracy.COLUMNS)
    figure = plotting.draw_speed(table, tmp_path / "speed.png")
    assert len(figure.axes) == 6
    assert all(ax.get_xscale() == ax.get_yscale() == "log" for ax in figure.axes)
    costs = [x for line in figure.axes[0].lines for x in line.get_xdata()]
    assert {1.0, 2.0, 9.0, 4e3} <= set(costs) and 30.0 not in costs
