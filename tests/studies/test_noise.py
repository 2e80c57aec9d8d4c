"""Noise is of the size and the draw asked for, and every draw is scored."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from fiberweb import Scene, crosshatch
from fiberweb.scoring import capacity, tables
from fiberweb.simulation import dataset
from fiberweb.studies.noise import figure as plotting
from fiberweb.studies.noise import tables as noise
from tests.figures.legible import assert_legible, assert_written, marked

RATE = 50.0
LEVELS = [1e-6, 1e-4]


def made_up(status="ok"):
    """Readouts that are powers of the input, the strongest some mm."""
    scene = Scene(crosshatch(2, length=0.5), duration=12.0, sample_rate=RATE)
    u = np.sin(1.7 * scene.times) + 0.5 * np.sin(4.1 * scene.times + 1)
    moved = np.stack([np.stack([u, u**2], -1), np.stack([np.roll(u, 5), u**3], -1)], 1)
    if status == "unstable":
        moved[len(moved) // 2 :] = np.nan
    return xr.Dataset(
        {
            "input": ("time", u),
            "displacement": (("time", "readout", "axis"), 1e-3 * moved),
        },
        {"time": scene.times, "axis": ["x", "y"]},
        {
            "status": status,
            "setup": scene.setup,
            "sample_rate": scene.sample_rate,
            "scene": scene.to_json(),
            "run": f"run-{status}",
        },
    )


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    folder = tmp_path_factory.mktemp("noise")
    paths = []
    for status in ("ok", "unstable"):
        paths.append(folder / status / "response.nc")
        dataset.save(made_up(status), paths[-1])
    return noise.table(paths, ["eq3", "eq3"], LEVELS, 2, alpha=0.1)


def test_noise_has_the_deviation_asked_for_and_no_mean():
    response = made_up()
    added = noise.noisy(response, 2e-5, seed=0, level=1)["displacement"] - response["displacement"]
    assert float(added.std()) == pytest.approx(2e-5, rel=0.03)
    assert abs(float(added.mean())) < 2e-6
    correlation = np.corrcoef(added.values.reshape(len(added), -1).T)
    assert np.abs(correlation - np.eye(4)).max() < 0.15  # each signal has a draw of its own


def test_seed_and_level_fix_the_draw():
    response = made_up()
    one, again, other_seed, other_level = (
        noisy["displacement"].values - response["displacement"].values
        for noisy in (noise.noisy(response, 1e-4, *at) for at in ((3, 0), (3, 0), (4, 0), (3, 1)))
    )
    np.testing.assert_array_equal(one, again)
    for other in (other_seed, other_level):
        assert abs(np.corrcoef(one.ravel(), other.ravel())[0, 1]) < 0.1


def test_noise_far_below_the_signal_is_added_whole():
    response = made_up()
    response["displacement"] += 1.0
    added = noise.noisy(response, 1e-9, 0, 0)["displacement"] - response["displacement"]
    assert float(added.std()) == pytest.approx(1e-9, rel=0.05)


def test_a_negative_deviation_is_refused():
    with pytest.raises(ValueError, match=r"noise = -1e-06 .* 0 m or up"):
        noise.noisy(made_up(), -1e-6, 0, 0)


def test_the_table_has_every_draw_and_the_run_without_noise(table):
    stable = table[table["status"] == "ok"]
    expected = [(0.0, 0), *((level, seed) for level in LEVELS for seed in (0, 1))]
    assert list(zip(stable["noise_m"], stable["noise_seed"])) == expected
    assert set(tables.COLUMNS) | {"force_choice"} < set(table.columns)
    scored = capacity.score(made_up(), alpha=0.1)
    # all but what the file rounds
    assert stable["c_nl"].iloc[0] == pytest.approx(float(scored["c_nl"]), abs=1e-6)
    assert stable["c_m_se"].iloc[0] == pytest.approx(float(scored["c_m_se"]), abs=1e-6)
    deviations = made_up()["displacement"].values.reshape(-1, 4).std(axis=0)
    np.testing.assert_allclose(stable["amplitude_m"], np.median(deviations))


def test_noise_costs_capacity_and_draws_differ(table):
    by_level = table[table["status"] == "ok"].groupby("noise_m")["c_m"]
    means = by_level.mean()
    assert means.iloc[0] > means.iloc[1] > means.iloc[2]
    assert by_level.nunique().iloc[2] == 2


def test_an_unstable_run_keeps_its_rows_without_numbers(table):
    unstable = table[table["status"] == "unstable"]
    assert len(unstable) == 5
    assert unstable[["c_nl", "c_m", "amplitude_m"]].isna().all().all()


def test_the_figure_shows_both_totals_and_refuses_a_setup_without_runs(table, tmp_path):
    table = table.assign(n=np.where(table["status"] == "ok", 4, 8))
    baselines = pd.DataFrame({"readout": ["u", "powers"], "c_nl": [0.1, 0.4], "c_m": [0.1, 0.1]})
    given = {"noise": table, "noise_baselines": baselines}
    figure = plotting.draw(given, "described", tmp_path / "noise.png")
    assert_written(tmp_path / "noise.png")
    assert_legible(figure)
    assert [list(mark.get_xdata()) for mark in marked(figure)] == [[0.1], [0.1]]  # where none is
    rows = table[table["status"] == "ok"]
    for ax, name in zip(figure.axes, ("c_nl", "c_m"), strict=True):
        noisy, free = ax.containers
        means = rows[rows["noise_m"] > 0].groupby("noise_m")[name].mean()
        expected = np.transpose([1e6 * np.array(LEVELS), means])
        np.testing.assert_allclose(noisy[0].get_xydata(), expected)
        np.testing.assert_allclose(free[0].get_xydata(), [(0.1, rows[name].iloc[0])])
        errors = rows.groupby("noise_m")[[name, f"{name}_se"]].agg(["mean", "std"])
        spread = np.hypot(errors[f"{name}_se", "mean"], errors[name, "std"])[LEVELS]
        bars = np.array(noisy.lines[2][0].get_segments())[:, :, 1]
        np.testing.assert_allclose(np.ptp(bars, axis=1), 2 * spread)
    with pytest.raises(ValueError, match="no run of the published setup"):
        plotting.draw(given, "published", tmp_path / "none.png")
