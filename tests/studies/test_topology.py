"""Fig. 1 from synthetic tables: what it draws, its files and bytes, the X of an unstable run."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from numpy.polynomial.legendre import legvander

from fiberweb import Scene, crosshatch
from fiberweb.figures import panels, plots
from fiberweb.model.drive import spline
from fiberweb.studies.topology import figure as topology
from tests.figures.legible import BASELINES, assert_legible, assert_written, marked, said

SIZES = {"crosshatch": (2, 4, 6, 8, 10, 12), "polygon": (6, 8, 10, 12)}
SETUPS = ("described", "published")


def networks():
    return [(s, t, n) for s in SETUPS for t, sizes in SIZES.items() for n in sizes]


@pytest.fixture(scope="module")
def data():
    """(table, curves, baselines, traces) with a 10x10 crosshatch that was unstable."""
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
    baselines = pd.DataFrame(
        {
            "readout": ["u", "derivatives", "powers"],
            "c_nl": [0.14, 0.14, 0.41],
            "c_m": [0.09, 0.28, 0.09],
        }
    )
    return pd.DataFrame(rows), pd.DataFrame(curves), baselines, example_traces()


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


def png_size(path):
    """Width and height in pixels, from the file's header."""
    header = path.read_bytes()[:24]
    assert header[:8] == b"\x89PNG\r\n\x1a\n"
    return int.from_bytes(header[16:20]), int.from_bytes(header[20:24])


@pytest.fixture(scope="module")
def drawn(data, tmp_path_factory):
    path = tmp_path_factory.mktemp("figures") / "topology.png"
    return topology.draw(*data, "described", path), path


def test_the_figure_is_a_double_column_at_300_dpi(drawn):
    _, path = drawn
    width, height = png_size(path)
    assert width == pytest.approx(180 / 25.4 * 300, abs=1)
    assert height < 240 / 25.4 * 300  # fits a page with its caption
    assert path.with_suffix(".pdf").read_bytes().startswith(b"%PDF")


def test_the_same_data_give_the_same_bytes(data, drawn, tmp_path):
    _, path = drawn
    topology.draw(*data, "described", tmp_path / "topology.png")
    for suffix in (".png", ".pdf"):
        again = (tmp_path / "topology.png").with_suffix(suffix)
        assert again.read_bytes() == path.with_suffix(suffix).read_bytes()


def test_an_unstable_run_is_an_x_in_both_totals(drawn):
    figure, _ = drawn
    marks = figure.findobj(lambda artist: artist.get_gid() == "unstable")
    assert [(list(mark.get_xdata()), mark.get_marker()) for mark in marks] == [([10], "X")] * 2
    assert "unstable run" in said(figure)


def test_no_text_overlaps_and_none_is_too_small(drawn):
    assert_legible(drawn[0])


def test_panels_are_lettered_in_order_and_name_what_they_show(drawn):
    said = said(drawn[0])
    for words in (
        "Networks (described",
        "Polygonal networks (described",
        "8×8 crosshatch (described",
    ):
        assert words in said
    for letter in "abcd":
        assert rf"$\mathbf{{{letter}}}$" in said
    assert "$c$ = 0.999" in said and "$c$ = 0.700" in said


def test_without_traces_the_last_panel_is_left_out(data, drawn, tmp_path):
    table, curves, baselines, traces = data
    unknown = traces.assign(prediction=traces["prediction"] * np.nan)
    for number, nothing in enumerate((None, unknown)):
        path = tmp_path / f"{number}.png"
        figure = topology.draw(table, curves, baselines, nothing, "described", path)
        assert "Example computations" not in said(figure)
        assert png_size(path)[1] < png_size(drawn[1])[1]


@pytest.mark.parametrize("kind", ["crosshatch", "polygon"])
def test_a_study_of_few_networks_is_drawn(data, tmp_path, kind):
    table, curves, _, _ = data
    few = [frame[(frame["topology"] == kind) & (frame["n"] <= 6)] for frame in (table, curves)]
    figure = topology.draw(*few, None, None, "published", tmp_path / "few.png")
    assert ("Polygonal" in said(figure)) == (kind == "polygon")
    assert not figure.findobj(lambda artist: artist.get_gid() == "unstable")


def test_a_study_in_which_nothing_was_stable_is_drawn(data, tmp_path):
    table, curves, baselines, _ = data
    table, curves = (frame[frame["n"] == 10] for frame in (table, curves))
    table, curves = (frame[frame["topology"] == "crosshatch"] for frame in (table, curves))
    figure = topology.draw(table, curves, baselines, None, "described", tmp_path / "x.png")
    assert len(figure.findobj(lambda artist: artist.get_gid() == "unstable")) == 2


def test_a_setup_without_runs_is_refused(data, tmp_path):
    table, curves, baselines, _ = data
    table = table[table["setup"] == "described"]
    with pytest.raises(ValueError, match="no run of the published setup"):
        topology.draw(table, curves, baselines, None, "published", tmp_path / "none.png")


def test_drawing_leaves_matplotlib_as_it_was(data, tmp_path):
    import matplotlib as mpl

    before = dict(mpl.rcParams)
    topology.draw(*data[:3], None, "described", tmp_path / "a.png")
    assert dict(mpl.rcParams) == before
