"""The origin of the published capacities: its runs, what is seen of the band, and the figure."""

from collections import Counter

import numpy as np
import pandas as pd
import pytest

from fiberweb import Scene, crosshatch, score, simulate
from fiberweb.config import Config
from fiberweb.model.authors import ELEMENT, LISTED_AT_100MM, LISTED_AT_500MM
from fiberweb.runs import runs
from fiberweb.simulation import dataset
from fiberweb.studies.capacity_origin import band, tables, watched
from fiberweb.studies.capacity_origin import figure as plotting
from tests.figures.legible import BASELINES, assert_legible, assert_written, marked, said

EVERY = 1.0  # s


@pytest.fixture(scope="module")
def seen(tmp_path_factory):
    """A short published run, what is seen of its band, and its histogram."""
    path = tmp_path_factory.mktemp("origin") / "response.nc"
    response = simulate(Scene(crosshatch(2, length=0.5), "published", duration=3.0))
    dataset.save(response.assign_attrs(run="published"), path)
    looks = band.looks(path, EVERY)
    return path, band.growth(looks), band.histogram(looks)


def test_the_band_grows_from_nothing(seen):
    """By round-off alone: within 3 s to some 1e-6 rad."""
    _, growth, _ = seen
    np.testing.assert_allclose(growth["time_s"], EVERY * np.arange(3), atol=0.1)
    middle = growth["band_0.5_rad"]
    assert middle[0] == 0.0 and (np.diff(middle) > 0).all()
    assert 1e-7 < middle.iloc[-1] < 1e-5
    assert growth["share_inside"].between(0.0, 1.0).all() and growth["share_inside"].iloc[-1] > 0


def test_the_band_in_other_terms(seen):
    _, growth, _ = seen
    last = growth.iloc[-1]
    scene = Scene(crosshatch(2, length=0.5), "published")
    curvature = last["band_0.5_rad"] / ELEMENT
    assert last["curvature_per_m"] == pytest.approx(curvature, rel=0.05)  # of elements near 10 mm
    assert last["moment_Nm"] == pytest.approx(scene.bending_stiffness * last["curvature_per_m"])
    assert last["surface_strain"] == pytest.approx(1e-3 * last["curvature_per_m"])
    assert last["bow_m"] == pytest.approx(last["curvature_per_m"] * scene.network.spacing**2 / 8)


def test_the_histogram_counts_every_node_once_a_look(seen):
    _, _, histogram = seen
    assert histogram["turn"].sum() == pytest.approx(1.0)
    assert histogram["band"].sum() == pytest.approx(1.0)
    np.testing.assert_allclose(histogram["to_rad"][:-1], histogram["from_rad"][1:])


def test_all_are_scored_as_the_authors_score(seen, tmp_path):
    described = simulate(Scene(crosshatch(2, length=0.5), duration=3.0), "draft")
    dataset.save(described.assign_attrs(run="described"), tmp_path / "response.nc")
    table = tables.table([seen[0], tmp_path / "response.nc"], ["eq3", "eq3"], alpha=0.01)
    assert table[["setup", "filter_order", "dead_band"]].to_numpy().tolist() == [
        ["published", 6, 1], ["described", 0, 0],
    ]  # fmt: skip
    theirs = score(dataset.load(tmp_path / "response.nc"), scoring="published")
    assert table["c_nl"][1] == float(theirs["c_nl"])


def origin_table():
    """The paper's config, each run with made-up capacities; one mesh is unstable."""
    rows = []
    for each in runs(Config(), "capacity_origin", "published"):
        scene = each.scene
        row = {"setup": scene.setup, "n": scene.network.n, "spacing_m": scene.network.spacing}
        row |= {"force_N": scene.force, "force_choice": each.choice}
        row |= {
            "layout": scene.layout,
            "filter_order": scene.filter_order,
            "dead_band": int(scene.dead_band),
        }
        row |= {"elements_per_section": 10, "time_step_s": 5e-6} | {
            {"time_step": "time_step_s"}.get(key, key): value
            for key, value in each.numerics.items()
        }
        c_m = 0.1 + 0.3 * bool(scene.filter_order)
        rows.append(
            row | {"c_nl": 0.6, "c_m": c_m, "c_nl_se": 0.01, "c_m_se": 0.01, "status": "ok"}
        )
    table = pd.DataFrame(rows)
    finest = (table["force_choice"] == "mesh") & (table["elements_per_section"] == 20)
    table.loc[finest, ["c_nl", "c_m", "status"]] = [np.nan, np.nan, "unstable"]
    return table


def test_the_runs_of_the_papers_config():
    table = runs(Config(), "capacity_origin", "published")
    counted = Counter(run.choice for run in table)
    points = len(LISTED_AT_500MM), len(list(LISTED_AT_100MM)[::3])
    assert counted == {"eq3": 6 * points[0], "grid": 6 * points[1], "mesh": 2 * 4}
    described = [run.scene for run in table if run.scene.setup == "described"]
    layouts = Counter(scene.layout for scene in described)
    assert layouts == {"authors": sum(points), "exact": sum(points)}
    assert all(scene.damping == 10.0 and np.isinf(scene.crossing_stiffness) for scene in described)
    (one,) = watched(table, Config().capacity_origin)
    assert (one.scene.network.n, one.scene.dead_band, one.scene.filter_order) == (4, True, 6)


def test_the_figure(seen, tmp_path):
    given = {
        "capacity_origin": origin_table(), "capacity_origin_baselines": BASELINES,
        "dead_band": seen[1], "dead_band_histogram": seen[2],
    }  # fmt: skip
    figure = plotting.draw(given, "published", tmp_path / "figure.png")
    assert_written(tmp_path / "figure.png")
    assert_legible(figure)
    assert len(marked(figure, "unstable")) == 2  # C_nl and C_m of the finest mesh
    words = said(figure)
    assert "dead band alone" in words and "the authors' tables" in words
    theirs = [
        line for axes in figure.subfigs[0].axes for line in axes.lines
        if list(line.get_xdata()) == list(LISTED_AT_500MM) and line.get_marker() == "x"
    ]  # fmt: skip
    assert [list(line.get_ydata()) for line in theirs] == [
        [values[column] for values in LISTED_AT_500MM.values()] for column in (0, 1)
    ]
