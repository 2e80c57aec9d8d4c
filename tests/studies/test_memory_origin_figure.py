"""Figures of the memory's origin and of the calibration: what is where, and the X's."""

import itertools

import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes
from matplotlib.text import Text

from fiberweb import config
from fiberweb.figures import style
from fiberweb.studies.calibration import figure as calibration
from fiberweb.studies.calibration import tables as grid
from fiberweb.studies.memory_origin import figure as memory_origin
from fiberweb.studies.points import points as studies
from tests.figures.legible import assert_legible

BASELINES = pd.DataFrame(
    {
        "readout": ["u", "derivatives", "powers"],
        "c_nl": [0.14, 0.14, 0.41],
        "c_m": [0.09, 0.28, 0.09],
    }
)
ELEMENTS = {2: 17, 4: 10, 8: 6}


def run(n, k, nu, gamma, order=0, engine="kirchhoff", elements=4, step=7e-5, c_m=0.1, **more):
    return {
        "setup": "described", "n": n, "spacing_m": 0.5 / (n + 1), "crossing_stiffness_N_m": k,
        "crossing_damping_Ns_m": nu, "damping_per_s": gamma, "filter_order": order,
        "elements_per_section": elements, "time_step_s": step, "engine": engine, "c_m": c_m,
        "c_nl": 0.5, "c_m_se": 0.01, "c_nl_se": 0.01, "status": "ok",
    } | more  # fmt: skip


def filtered(n, order, elements, step=5e-6, **more):
    return run(n, 1e6, 0.0, 10.0, order, "cosserat", elements, step, **more)


@pytest.fixture(scope="module")
def origin():
    """A table in which one run of the filter became unstable."""
    rows = []
    for n, elements in ELEMENTS.items():
        rows += [run(n, k, 3.0, 10.0, c_m=0.4) for k in (10.0, 70.0, 1e6)]
        rows += [run(n, 70.0, nu, 10.0, c_m=0.3) for nu in (0.0, 10.0)]
        rows += [run(n, 70.0, 3.0, gamma, c_m=0.3) for gamma in (100.0, 3000.0)]
        rows += [run(n, np.inf, 0.0, gamma, c_m=0.2) for gamma in (10.0, 100.0, 3000.0)]
        rows += [filtered(n, 0, elements), filtered(n, 6, elements, c_m=0.6)]
    rows += [filtered(4, 6, 5), filtered(4, 6, 10, 2.5e-6, c_m=0.7)]
    rows += [filtered(4, 6, 20, status="unstable", c_m=np.nan, c_nl=np.nan)]
    return {"memory_origin": pd.DataFrame(rows), "memory_origin_baselines": BASELINES}


@pytest.fixture(scope="module")
def points():
    """A grid of the calibration whose best point is not the defaults'; one run unstable."""
    axes = ([40.0, 70.0, 100.0], [2.0, 3.0, 5.0], [1.0, 2.5], [4, 8])
    rows = [
        dict(zip((*grid.GRID, "n"), point, strict=True))
        | {"setup": "described", "status": "ok", "c_nl": 0.8, "c_m": 0.4}
        | {"c_nl_se": 0.01, "c_m_se": 0.02}
        | dict.fromkeys(grid.TARGETS, 0.9)
        | {"misfit": point[0] + point[1] + point[2] if point[3] == 8 else np.nan}
        for point in itertools.product(*axes)
    ]
    rows[-1] |= dict.fromkeys(("misfit", *grid.TARGETS, "c_nl", "c_m"), np.nan)
    rows[-1]["status"] = "unstable"
    table = pd.DataFrame(rows)
    return {
        "calibration": table, "calibration_check": grid.check(table), "ridge_baselines": BASELINES
    }  # fmt: skip


@pytest.fixture(scope="module")
def drawn(origin, points, tmp_path_factory):
    folder = tmp_path_factory.mktemp("figures")
    return {
        "memory_origin": memory_origin.draw(origin, "described", folder / "memory_origin.png"),
        "calibration": calibration.draw(points, "described", folder / "calibration.png"),
        "folder": folder,
    }


@pytest.fixture
def unsaved(monkeypatch):
    """Figures are made but not written, which is most of their time."""
    monkeypatch.setattr(style, "save", lambda figure, path: None)


def marked(figure, gid):
    return figure.findobj(lambda artist: artist.get_gid() == gid)


def said(figure):
    return " ".join(text.get_text() for text in figure.findobj(Text) if text.get_visible())


@pytest.mark.parametrize("name", ["memory_origin", "calibration"])
def test_png_and_pdf_are_written(drawn, name):
    assert (drawn["folder"] / f"{name}.png").stat().st_size > 10_000
    assert (drawn["folder"] / f"{name}.pdf").read_bytes().startswith(b"%PDF")


@pytest.mark.parametrize("name", ["memory_origin", "calibration"])
def test_no_text_overlaps(drawn, name):
    assert_legible(drawn[name])


def test_an_unstable_filter_run_is_an_x_at_its_element_length(drawn):
    marks = marked(drawn["memory_origin"], "unstable")
    assert [mark.get_xdata() for mark in marks] == [pytest.approx([5.0])] * 2  # C_nl and C_m
    assert "unstable run" in said(drawn["memory_origin"])


def test_each_carrier_is_a_line_over_n(drawn, origin):
    """The filter's line is of the mesh and step that the run without it has, of every N."""
    ax = drawn["memory_origin"].subfigs[0].axes[1]
    heights = {tuple(bar[0].get_ydata()) for bar in ax.containers}
    assert heights == {(0.2,) * 3, (0.4,) * 3, (0.6,) * 3, (0.1,) * 3}
    assert all(list(bar[0].get_xdata()) == [2, 4, 8] for bar in ax.containers)


@pytest.mark.parametrize("setup", ["described", "published"])
def test_no_series_of_the_papers_config_is_empty(unsaved, setup):
    rows = []
    for point in studies.memory_origin(config.load(), setup, None, False):
        made, numerics = point.scene, point.numerics or {}
        crossings = (made.crossing_stiffness, made.crossing_damping, made.damping)
        engine, elements, step = numerics.values() or ("kirchhoff", 4, 7e-5)
        at = {"setup": setup, "spacing_m": made.network.spacing}
        rows.append(
            run(made.network.n, *crossings, made.filter_order, engine, elements, step, **at)
        )
    tables = {"memory_origin": pd.DataFrame(rows), "memory_origin_baselines": BASELINES}
    figure = memory_origin.draw(tables, setup, "unsaved")
    nonlinear, memory = figure.findobj(
        lambda artist: isinstance(artist, Axes) and "Fibres" in artist.get_xlabel()
    )
    for ax in (nonlinear, memory):
        assert len(ax.containers) == (5 if setup == "described" else 2)
        assert all(set(bar[0].get_xdata()) == {2, 4, 8} for bar in ax.containers)


def test_every_capacity_of_panel_b_has_its_standard_error_as_a_bar(drawn):
    for name, size in (("memory_origin", 0.01), ("calibration", None)):
        bars = [
            segment
            for ax in drawn[name].subfigs[1].axes
            for container in ax.containers
            for segment in container.lines[2][0].get_segments()
        ]
        assert len(bars) > 12
        if size:
            assert all(np.ptp(bar[:, 1]) == pytest.approx(2 * size) for bar in bars)


def test_baselines_of_the_calibration_may_be_missing(points, unsaved):
    tables = {name: table for name, table in points.items() if name != "ridge_baselines"}
    figure = calibration.draw(tables, "described", "unsaved")
    assert "readouts made of the input alone" not in said(figure)


def test_the_published_setup_compares_filter_on_and_off(origin, unsaved):
    table = origin["memory_origin"]
    table = table[(table["engine"] == "cosserat") & (table["time_step_s"] == 5e-6)]
    table = table.drop_duplicates(["n", "filter_order"])
    table = table.assign(setup="published", elements_per_section="authors")
    tables = origin | {"memory_origin": table}
    figure = memory_origin.draw(tables, "published", "published.png")
    heights = [tuple(bar[0].get_ydata()) for bar in figure.axes[1].containers]
    assert heights == [(0.6,) * 3, (0.1,) * 3]
    assert "filter off" in said(figure)
    with pytest.raises(ValueError, match="no run of the described setup"):
        memory_origin.draw(tables, "described", "none.png")


def test_best_and_defaults_are_marked_where_they_are(drawn):
    """Best at k = 40, nu = 2, gamma = 1: the first cell of the first map; the defaults, k = 70,
    nu = 3, gamma = 2.5, in the middle of the second."""
    figure = drawn["calibration"]
    first, second = figure.subfigs[0].axes[:2]
    (star,), (box,) = marked(figure, "best"), marked(figure, "default")
    assert star.axes is first and np.round(star.get_xydata()).tolist() == [[0, 0]]
    assert box.axes is second and np.round(box.get_center()).tolist() == [1, 1]
    (cross,) = marked(figure, "unstable")
    assert cross.axes is second and cross.get_xydata().tolist() == [[2, 2]]
    assert "43.0" in said(figure)  # misfit of the best


def test_the_best_points_are_listed_by_misfit(drawn):
    ax = drawn["calibration"].subfigs[1].axes[0]
    labels = [label.get_text().split("   ")[0] for label in ax.get_yticklabels()]
    assert labels[0] == "40, 2, 1"
    assert labels[-1] == "70, 3, 2.5"  # the defaults come last where they are not among the best
    assert len(labels) == calibration.SHOWN + 1


def test_a_grid_of_one_point_is_drawn(points, tmp_path):
    table = points["calibration"]
    one = table[(table["misfit"] == 75.5)]
    tables = {"calibration": one, "calibration_check": grid.check(one)}
    figure = calibration.draw(tables, "described", tmp_path / "one.png")
    assert marked(figure, "best") and marked(figure, "default")


def test_a_grid_without_a_stable_run_is_x_s(points, unsaved):
    lost = dict.fromkeys(("misfit", *grid.TARGETS, "c_nl", "c_m"), np.nan)
    table = points["calibration"].assign(status="unstable", **lost)
    tables = {"calibration": table, "calibration_check": grid.check(table)}
    figure = calibration.draw(tables, "described", "lost.png")
    assert [len(mark.get_xdata()) for mark in marked(figure, "unstable")] == [9, 9]
    assert not marked(figure, "best")
