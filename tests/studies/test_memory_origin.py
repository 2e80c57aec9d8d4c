"""The figure of the memory's origin: what is where, and the X's."""

import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes

from fiberweb.config import Config, load
from fiberweb.runs import runs
from fiberweb.studies.memory_origin import figure as plotting
from tests.figures.legible import BASELINES, assert_legible, assert_written, marked, said

ELEMENTS = {2: 17, 4: 10, 8: 6}


def run(n, k, nu, gamma, order=0, engine="kirchhoff", elements=4, step=7e-5, c_m=0.1, **more):
    return {
        "setup": "compliant", "n": n, "spacing_m": 0.5 / (n + 1), "crossing_stiffness_N_m": k,
        "crossing_damping_Ns_m": nu, "damping_per_s": gamma, "loss_factor": 0.0,
        "filter_order": order,
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
        rows += [run(n, np.inf, 0.0, 10.0, loss_factor=loss, c_m=0.25) for loss in (0.1, 0.3, 1.0)]
        rows += [filtered(n, 0, elements), filtered(n, 6, elements, c_m=0.6)]
    rows += [filtered(4, 6, 5), filtered(4, 6, 10, 2.5e-6, c_m=0.7)]
    rows += [filtered(4, 6, 20, status="unstable", c_m=np.nan, c_nl=np.nan)]
    return {"memory_origin": pd.DataFrame(rows), "memory_origin_baselines": BASELINES}


@pytest.fixture(scope="module")
def drawn(origin, tmp_path_factory):
    path = tmp_path_factory.mktemp("figures") / "memory_origin.png"
    return plotting.draw(origin, "compliant", path), path


def test_the_figure_is_written_and_legible(drawn):
    assert_written(drawn[1])
    assert_legible(drawn[0])


def test_an_unstable_filter_run_is_an_x_at_its_element_length(drawn):
    marks = marked(drawn[0], "unstable")
    assert [mark.get_xdata() for mark in marks] == [pytest.approx([5.0])] * 2  # C_nl and C_m
    assert "unstable run" in said(drawn[0])


def test_each_carrier_is_a_line_over_n(drawn, origin):
    """The filter's line is of the mesh and step that the run without it has, of every N."""
    ax = drawn[0].subfigs[0].axes[1]
    heights = {tuple(bar[0].get_ydata()) for bar in ax.containers}
    assert heights == {(0.2,) * 3, (0.25,) * 3, (0.4,) * 3, (0.6,) * 3, (0.1,) * 3}
    assert all(list(bar[0].get_xdata()) == [2, 4, 8] for bar in ax.containers)


@pytest.mark.parametrize("setup", ["compliant", "published"])
def test_no_series_of_the_papers_config_is_empty(unsaved, setup):
    rows = []
    for each in runs(Config(), "memory_origin", setup):
        scene = each.scene
        crossings = (scene.crossing_stiffness, scene.crossing_damping, scene.damping)
        own = {"engine": "kirchhoff", "elements_per_section": 4, "time_step": 7e-5} | each.numerics
        numerics = (own[name] for name in ("engine", "elements_per_section", "time_step"))
        at = {"setup": setup, "spacing_m": scene.network.spacing, "loss_factor": scene.loss_factor}
        rows.append(run(scene.network.n, *crossings, scene.filter_order, *numerics, **at))
    tables = {"memory_origin": pd.DataFrame(rows), "memory_origin_baselines": BASELINES}
    figure = plotting.draw(tables, setup, "unsaved")
    nonlinear, memory = figure.findobj(
        lambda artist: isinstance(artist, Axes) and "Fibres" in artist.get_xlabel()
    )
    for ax in (nonlinear, memory):
        assert len(ax.containers) == (6 if setup == "compliant" else 2)
        assert all(set(bar[0].get_xdata()) == {2, 4, 8} for bar in ax.containers)


def test_the_loss_of_a_config_is_not_added_to_other_carriers():
    own = {"loss_factor": 0.3, "loss_frequency": 50.0}
    lossy = load({"setups": {"compliant": own, "published": own}})
    for setup in ("compliant", "published"):
        names, plain = (
            [each.name for each in runs(config, "memory_origin", setup)]
            for config in (lossy, load())
        )
        assert names == plain


def test_the_published_setup_compares_filter_on_and_off(origin, unsaved):
    table = origin["memory_origin"]
    table = table[(table["engine"] == "cosserat") & (table["time_step_s"] == 5e-6)]
    table = table.drop_duplicates(["n", "filter_order"])
    table = table.assign(setup="published", elements_per_section="authors")
    tables = origin | {"memory_origin": table}
    figure = plotting.draw(tables, "published", "published.png")
    heights = [tuple(bar[0].get_ydata()) for bar in figure.axes[1].containers]
    assert heights == [(0.6,) * 3, (0.1,) * 3]
    assert "filter off" in said(figure)
    with pytest.raises(ValueError, match="no run of the compliant setup"):
        plotting.draw(tables, "compliant", "none.png")


def test_every_capacity_of_panel_b_has_its_standard_error_as_a_bar(drawn):
    for ax in drawn[0].subfigs[1].axes:
        ends = {tuple(end) for line in ax.containers for end in line[0].get_xydata()}
        bars = [bar for line in ax.containers for bar in line.lines[2][0].get_segments()]
        assert {tuple(bar.mean(axis=0).round(9)) for bar in bars} == {
            tuple(np.round(end, 9)) for end in ends
        }
        assert all(np.ptp(bar[:, 1]) == pytest.approx(2 * 0.01) for bar in bars)
