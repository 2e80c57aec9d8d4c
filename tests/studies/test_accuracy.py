"""The figures about accuracy draw what their tables hold."""

import numpy as np
import pandas as pd
import pytest

from fiberweb.studies.accuracy import figure as plotting
from fiberweb.validation import accuracy, limits
from tests.figures.legible import assert_legible, assert_written, said

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
    return pd.DataFrame(rows, columns=list(limits.COLUMNS))


def test_stability_draws_every_point_and_the_drift(box, tmp_path):
    drift = pd.DataFrame(
        [(engine, "2x2", 24, 1e-5, 10_000_000, 1e-6, -3e-7, 1e-5)
         for engine in ("kirchhoff", "cosserat")],
        columns=list(limits.DRIFT_COLUMNS),
    )  # fmt: skip
    given = {"stability": box, "energy_drift": drift}
    figure = plotting.draw_stability(given, "described", tmp_path / "stability.png")
    assert_written(tmp_path / "stability.png")
    assert_legible(figure)
    points = [line.get_xydata() for line in figure.axes[0].lines if line.get_marker() != "None"]
    expected = 1e6 * box[["predicted_s", "found_s"]].to_numpy()
    np.testing.assert_allclose(np.concatenate(points)[: len(box)], expected)
    assert "Drift -3e-07 in 1e+07 steps" in said(figure)
    for ax in figure.axes[1:7]:
        heights = np.concatenate([line.get_ydata() for line in ax.lines])
        loaded = ax.get_xlabel() == "Force (N)"
        assert np.isclose(heights, 1e6 * (LOADED if loaded else FOUND)).any()
        assert not np.isclose(heights, 1e6 * (FOUND if loaded else LOADED)).any()


def test_the_middle_of_the_box_is_that_of_the_limits():
    point = limits.Point()
    assert {
        "spacing_m": point.spacing, "diameter_m": point.diameter, "tension_N": point.tension,
        "crossing_stiffness": point.stiffness, "crossing_damping": point.damping,
        "elements_per_section": point.elements, "network": f"{point.n}x{point.n}",
    } == plotting.MIDDLE  # fmt: skip


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
    table = pd.DataFrame(rows, columns=list(accuracy.COLUMNS))
    path = tmp_path / "speed_accuracy.png"
    figure = plotting.draw_speed_accuracy({"speed_accuracy": table}, "described", path)
    assert_written(path)
    assert_legible(figure)
    for ax, share in zip(figure.axes, (1.0, 0.1, 0.05) * 2, strict=True):
        assert ax.get_xscale() == ax.get_yscale() == "log"
        front, *points = ax.lines
        drawn = sorted(tuple(point.get_xydata()[0]) for point in points if len(point.get_xdata()))
        expected = [(1.0, 0.1), (2.0, 0.02), (9.0, 0.2), (4e3, 0.05)]
        np.testing.assert_allclose(drawn, [(cost, share * error) for cost, error in expected])
        np.testing.assert_allclose(front.get_xydata(), [(1.0, share * 0.1), (2.0, share * 0.02)])
    assert [ax.get_ylabel() for ax in figure.axes] == [*plotting.ERRORS.values()] * 2


def test_the_ladder_draws_every_change_its_cost_and_growth_out_of_the_plane(tmp_path):
    rungs = ["3D to 2D", "no shear", "coarser mesh", "stiff springs", "springs"]
    ladder = pd.DataFrame(
        {
            "change": rungs,
            "trajectory_change": [1e-9, 1e-3, 1e-2, np.nan, 0.1],
            "c_nl_change": [1e-8, 2e-3, 2e-2, np.nan, 0.2],
            "c_m_change": [1e-7, 3e-3, 3e-2, np.nan, 0.3],
            "seconds_per_run": [4e3, 900.0, 30.0, 5.0, 2.0],
        }
    )
    plane = pd.DataFrame(
        {
            "buckling_number": np.repeat([0.5, 1.5], 3),
            "time": np.tile([0.1, 0.2, 0.3], 2),
            "out_of_plane_m": [1e-12, 2e-12, 3e-12, 1e-12, 1e-8, 1e-4],
            "in_plane_m": 1e-2,
        }
    )
    given = {"model_ladder": ladder, "out_of_plane": plane}
    figure = plotting.draw_model_ladder(given, "described", tmp_path / "model_ladder.png")
    assert_written(tmp_path / "model_ladder.png")
    assert_legible(figure)
    top, bottom = figure.subfigs
    changes, cost = top.axes
    for line, name in zip(changes.lines, ("trajectory_change", "c_nl_change", "c_m_change")):
        np.testing.assert_array_equal(line.get_xdata(), ladder[name].dropna())
    assert [label.get_text() for label in changes.get_yticklabels()] == rungs
    assert [bar.get_width() for bar in cost.patches] == list(ladder["seconds_per_run"])
    heights, shares = ([line.get_ydata() for line in ax.lines] for ax in bottom.axes)
    np.testing.assert_allclose(heights, 1e3 * plane["out_of_plane_m"].to_numpy().reshape(2, 3))
    np.testing.assert_allclose(shares, 1e2 * plane["out_of_plane_m"].to_numpy().reshape(2, 3))
