"""Fig. 1 from synthetic tables: what it draws, its files and bytes, the X of an unstable run."""

import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.text import Text
from numpy.polynomial.legendre import legvander

from fiberweb import Scene, crosshatch
from fiberweb.figures import plots
from fiberweb.model.drive import spline
from fiberweb.studies.topology import figure as topology
from tests.figures.legible import BASELINES, assert_legible, assert_written, marked, said

SIZES = {"crosshatch": (2, 4, 6, 8, 10, 12), "polygon": (6, 8, 10, 12)}
SETUPS = ("described", "published")


def networks():
    return [(s, t, n) for s in SETUPS for t, sizes in SIZES.items() for n in sizes]


@pytest.fixture(scope="module")
def data():
    """What the figure is given, with a 10x10 crosshatch that was unstable."""
    rows, curves = [], []
    order, lag = np.arange(1.0, 11.0), np.arange(0, 251, 10) / 250
    for setup, kind, n in networks():
        reach = n if kind == "crosshatch" else 4
        ok = (kind, n) != ("crosshatch", 10)
        c_order = 1 / (1 + np.exp(order - 2 - 0.7 * reach)) * (1 if ok else np.nan)
        c_lag = 1 / (1 + np.exp(15 * lag - 0.8 * reach)) * (1 if ok else np.nan)
        totals = {"c_nl": c_order.mean(), "c_m": c_lag.mean(), "c_nl_se": 0.02, "c_m_se": 0.03}
        totals |= {f"{name}_train": totals[name] + 0.02 for name in ("c_nl", "c_m")}
        key = {"setup": setup, "topology": kind, "n": n}
        rows.append(key | totals | {"status": "ok" if ok else "unstable"})
        for target, places, values in (("order", order, c_order), ("lag", lag, c_lag)):
            points = zip(places, values, strict=True)
            curves += [key | {"target": target, "at": at, "c": c} for at, c in points]
    return {
        "topology": pd.DataFrame(rows),
        "topology_curves": pd.DataFrame(curves),
        "topology_baselines": BASELINES,
        "topology_traces": example_traces(),
    }


def example_traces():
    time = np.arange(15.0, 22.0, 0.02)
    u = spline()
    orders = legvander(np.clip(u(time) / 1.2, -1, 1), 7)[:, 4:].T
    target = np.vstack([orders, u(time - 0.2) / 1.2, u(time - 0.4) / 1.2])
    prediction = target + 0.1 * np.sin(9 * time)
    target[5, :20] = np.nan  # the test part of a late lag begins later
    return xr.Dataset(
        {
            "target": (("trace", "time"), target),
            "prediction": (("trace", "time"), prediction),
            "c": ("trace", [0.999, 0.99, 0.95, 0.9, 0.99, 0.7]),
        },
        {"trace": ["P4", "P5", "P6", "P7", "200 ms", "400 ms"], "time": time},
        {"scene": Scene(crosshatch(8, length=0.5)).to_json()},
    )


def some(data, chosen):
    """The same of those rows alone that are chosen, and without traces, as of an unstable run."""
    tables = {name: data[name][chosen(data[name])] for name in ("topology", "topology_curves")}
    return data | tables | {"topology_traces": data["topology_traces"][[]]}


@pytest.fixture(scope="module")
def drawn(data, tmp_path_factory):
    path = tmp_path_factory.mktemp("figures") / "topology.png"
    return topology.draw(data, "described", path), path


def test_the_figure_is_a_double_column_that_fits_a_page_with_its_caption(drawn):
    assert_written(drawn[1])
    assert 25.4 * drawn[0].get_figheight() < 240


def test_the_same_data_give_the_same_bytes(data, drawn, tmp_path):
    _, path = drawn
    topology.draw(data, "described", tmp_path / "topology.png")
    for suffix in (".png", ".pdf"):
        again = (tmp_path / "topology.png").with_suffix(suffix)
        assert again.read_bytes() == path.with_suffix(suffix).read_bytes()


@pytest.mark.parametrize(("row", "kind"), [(1, "crosshatch"), (2, "polygon")])
def test_curves_and_totals_are_the_tables(data, drawn, row, kind):
    by_order, by_lag, *totals = drawn[0].subfigs[row].axes[:4]
    table, curves = (
        frame[(frame["setup"] == "described") & (frame["topology"] == kind)].dropna()
        for frame in (data["topology"], data["topology_curves"])
    )
    for ax, target in ((by_order, "order"), (by_lag, "lag")):
        expected = [
            frame[["at", "c"]].to_numpy()
            for _, frame in curves[curves["target"] == target].groupby("n")
        ]
        np.testing.assert_array_equal([line.get_xydata() for line in ax.lines], expected)
    for ax, (name, symbol) in zip(totals, plots.TOTALS.items()):
        assert ax.get_ylabel() == symbol
        joined, training = ax.lines[:2]
        np.testing.assert_array_equal(joined.get_xydata(), table[["n", name]])
        np.testing.assert_array_equal(training.get_xydata(), table[["n", f"{name}_train"]])
        bars = [bar.lines[2][0].get_segments()[0][:, 1] for bar in ax.containers]
        c, error = table[name], table[f"{name}_se"]
        np.testing.assert_allclose(bars, np.transpose([c - error, c + error]))


def test_an_unstable_run_is_an_x_in_both_totals(drawn):
    marks = marked(drawn[0])
    assert [(list(mark.get_xdata()), mark.get_marker()) for mark in marks] == [([10], "X")] * 2
    assert "unstable run" in said(drawn[0])


def test_what_a_certificate_found_stands_at_the_foot(data, drawn, unsaved):
    found = {"c_nl_verdict": "filter and rounding", "c_m_verdict": "one realisation of chaos"}
    figure = topology.draw(data | {"topology": data["topology"].assign(**found)}, "described", "x")
    words, before = said(figure), said(drawn[0])
    for cause in ("filter", "rounding", "chaos"):
        assert f"follows {cause}" in words and f"follows {cause}" not in before
    stable = len(SIZES["crosshatch"]) + len(SIZES["polygon"]) - 1
    texts = [text.get_text() for text in figure.findobj(Text)]
    assert (texts.count("fr"), texts.count("c")) == (stable, stable)
    assert "follows mesh" not in words
    assert_legible(figure)


def test_no_text_overlaps_and_none_is_too_small(drawn):
    assert_legible(drawn[0])


def test_panels_are_lettered_in_order_and_name_what_they_show(drawn):
    words = said(drawn[0])
    places = [
        words.index(rf"$\mathbf{{{letter}}}$   {title} (described setup)")
        for letter, title in zip(
            "abcd",
            (
                "Networks",
                "Crosshatch networks",
                "Polygonal networks",
                "Example computations, 8×8 crosshatch",
            ),
        )
    ]
    assert places == sorted(places)
    assert "$c$ = 0.999" in words and "$c$ = 0.700" in words


def test_traces_are_target_and_prediction(data, drawn):
    traces = data["topology_traces"]
    axes = drawn[0].subfigs[-1].axes
    shown = [ax for ax in axes if "P_{7}" in ax.get_title()]
    prediction, target = shown[0].lines
    one = traces.sel(trace="P7", time=target.get_xdata())
    np.testing.assert_array_equal(target.get_ydata(), one["target"])
    np.testing.assert_array_equal(prediction.get_ydata(), one["prediction"])
    known = traces["time"].values[20:]  # where every target begins
    assert target.get_xdata()[0] == known[0]
    assert np.ptp(target.get_xdata()) == pytest.approx(topology.TRACE_SECONDS, abs=0.03)


def test_without_traces_the_last_panel_is_left_out(data, drawn, unsaved):
    traces = data["topology_traces"]
    unknown = traces.assign(prediction=traces["prediction"] * np.nan)
    for nothing in (traces[[]], unknown):
        figure = topology.draw(data | {"topology_traces": nothing}, "described", "unsaved")
        assert "Example computations" not in said(figure)
        assert figure.get_figheight() < drawn[0].get_figheight()


@pytest.mark.parametrize("kind", ["crosshatch", "polygon"])
def test_a_study_of_few_networks_is_drawn(data, unsaved, kind):
    few = some(data, lambda frame: (frame["topology"] == kind) & (frame["n"] <= 6))
    figure = topology.draw(few, "published", "unsaved")
    assert ("Polygonal" in said(figure)) == (kind == "polygon")
    assert ("Crosshatch" in said(figure)) == (kind == "crosshatch")
    assert not marked(figure)


def test_a_study_in_which_nothing_was_stable_is_drawn(data, unsaved):
    lost = some(data, lambda frame: (frame["topology"] == "crosshatch") & (frame["n"] == 10))
    figure = topology.draw(lost, "described", "unsaved")
    assert [list(mark.get_xdata()) for mark in marked(figure)] == [[10], [10]]


def test_a_setup_without_runs_is_refused(data, unsaved):
    described = some(data, lambda frame: frame["setup"] == "described")
    with pytest.raises(ValueError, match="no run of the published setup"):
        topology.draw(described, "published", "unsaved")


def test_drawing_leaves_matplotlib_as_it_was(data, tmp_path):
    before = dict(mpl.rcParams)
    crosshatches = some(data, lambda frame: frame["topology"] == "crosshatch")
    topology.draw(crosshatches, "described", tmp_path / "a.png")
    assert dict(mpl.rcParams) == before
