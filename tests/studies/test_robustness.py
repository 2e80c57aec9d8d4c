"""Every penalty is scored as it would be alone; the figure compares seeds."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from fiberweb import Scene, crosshatch
from fiberweb.scoring import capacity, tables
from fiberweb.simulation import dataset
from fiberweb.studies.robustness import figure as plotting
from fiberweb.studies.robustness import tables as robustness
from tests.figures.legible import assert_legible, assert_written, marked, said

ALPHAS = [1e-3, 1.0, 100.0]


def made_up():
    scene = Scene(crosshatch(2, length=0.5), duration=12.0, sample_rate=50.0)
    u = np.sin(1.7 * scene.times) + 0.5 * np.sin(4.1 * scene.times + 1)
    noise = np.random.default_rng(0).normal(0.0, 0.05, (len(u), 2, 2))
    moved = np.stack([np.stack([u, u**2], -1), np.stack([np.roll(u, 5), u**3], -1)], 1) + noise
    return xr.Dataset(
        {"input": ("time", u), "displacement": (("time", "readout", "axis"), 1e-3 * moved)},
        {"time": scene.times, "axis": ["x", "y"]},
        {
            "status": "ok",
            "setup": scene.setup,
            "sample_rate": scene.sample_rate,
            "scene": scene.to_json(),
            "run": "run",
        },
    )


@pytest.fixture(scope="module")
def stored(tmp_path_factory):
    """The file of a response, which rounds it."""
    path = tmp_path_factory.mktemp("robustness") / "response.nc"
    dataset.save(made_up(), path)
    return path


@pytest.fixture(scope="module")
def alphas(stored):
    return robustness.alphas([stored], ["eq3"], ALPHAS)


def test_each_penalty_is_scored_as_it_would_be_alone(alphas, stored):
    assert list(alphas["alpha"]) == ALPHAS
    assert set(tables.COLUMNS) | {"force_choice"} < set(alphas.columns)
    for row in alphas.itertuples():
        scored = capacity.score(dataset.load(stored), alpha=row.alpha)
        assert row.c_nl == float(scored["c_nl"])
        assert row.c_m_train == float(scored["c_m_train"])


def test_a_larger_penalty_fits_the_training_part_worse(alphas):
    for name in ("c_nl_train", "c_m_train"):
        assert alphas[name].is_monotonic_decreasing
        assert alphas[name].iloc[0] > alphas[name].iloc[-1] + 1e-4


def test_a_penalty_that_is_not_positive_is_refused(tmp_path):
    dataset.save(made_up(), tmp_path / "response.nc")
    with pytest.raises(ValueError, match="alpha = 0"):
        robustness.alphas([tmp_path / "response.nc"], ["eq3"], [0.0])


def test_the_figure_gives_the_spread_of_seeds_beside_their_errors(alphas, tmp_path):
    c = [0.70, 0.72, 0.74]
    seeds = pd.DataFrame(
        {"setup": "described", "n": 4, "seed": [1, 2, 3], "status": "ok", "c_nl": c, "c_m": c}
    ).assign(c_nl_se=0.013, c_m_se=0.017)
    lost = seeds.assign(n=8, status=["ok", "ok", "unstable"])
    lost.loc[lost["status"] == "unstable", ["c_nl", "c_m", "c_nl_se", "c_m_se"]] = np.nan
    baselines = pd.DataFrame({"readout": ["u"], "c_nl": [0.14], "c_m": [0.09]})
    given = {
        "robustness": pd.concat([seeds, lost]),
        "robustness_alpha": alphas.assign(n=4),
        "robustness_baselines": baselines,
    }
    figure = plotting.draw(given, "described", tmp_path / "robustness.png")
    words = said(figure)
    assert "sd 0.020, se 0.013" in words and "sd 0.020, se 0.017" in words
    assert_written(tmp_path / "robustness.png")
    assert_legible(figure)
    marks = [mark for mark in marked(figure) if mark.get_xdata()]
    assert [list(mark.get_xdata()) for mark in marks] == [[2], [2]]
    for ax, error in zip(figure.subfigs[0].axes, (0.013, 0.017)):
        four = ax.containers[0]
        np.testing.assert_allclose(four[0].get_xydata(), list(enumerate(c)))
        bars = np.array(four.lines[2][0].get_segments())[:, :, 1]
        np.testing.assert_allclose(np.ptp(bars, axis=1), 2 * error)
        means = [tuple(one[0].get_xydata()[0]) for one in ax.containers[2:]]
        assert means == [(3, pytest.approx(0.71)), (3, pytest.approx(0.72))]  # of 8x8, of 4x4
    for ax, name in zip(figure.subfigs[1].axes, ("c_nl", "c_m")):
        training, (test, *_) = ax.lines[0], ax.containers[0]
        np.testing.assert_allclose(training.get_xydata(), alphas[["alpha", f"{name}_train"]])
        np.testing.assert_allclose(test.get_xydata(), alphas[["alpha", name]])
    given["robustness"] = seeds[seeds["seed"] == 2]
    alone = plotting.draw(given, "described", tmp_path / "alone.png")
    words = [text.get_text() for ax in alone.axes for text in ax.texts]
    assert "se 0.013" in words and not any("nan" in text for text in words)
    with pytest.raises(ValueError, match="no run of the published setup"):
        plotting.draw(given, "published", tmp_path / "none.png")
