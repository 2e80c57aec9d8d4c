"""Rates and consistency of made-up pairs whose answer is known and of a real one; the figure."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from fiberweb import Scene, crosshatch, simulate
from fiberweb.config import Config
from fiberweb.runs import runs
from fiberweb.scoring import tables
from fiberweb.simulation import dataset
from fiberweb.studies.chaos import figure as plotting
from fiberweb.studies.chaos import tables as chaos
from tests.figures.legible import assert_legible, assert_written, marked

RATE = 50.0
SCENE = Scene(crosshatch(2, length=0.5), duration=20.0, sample_rate=RATE, disturbance=1e-9)
SECOND = replace(SCENE, disturbance=2e-9)


def response(scene, moved, status="ok"):
    """Two readouts; moved has shape (time, 4), m."""
    return xr.Dataset(
        {
            "input": ("time", np.sin(scene.times)),
            "displacement": (("time", "readout", "axis"), moved.reshape(-1, 2, 2)),
        },
        {"time": scene.times, "axis": ["x", "y"]},
        {
            "status": status,
            "setup": scene.setup,
            "sample_rate": scene.sample_rate,
            "scene": scene.to_json(),
            "run": f"run-{scene.disturbance:g}",
        },
    )


def noise(seed):
    return 1e-3 * np.random.default_rng(seed).normal(size=(SCENE.samples, 4))


def perturbed(apart, status="ok"):
    """A pair whose every signal differs by apart (time,), m."""
    moved = noise(1)
    second = moved + np.asarray(apart)[:, None]
    return chaos.Pair(response(SCENE, moved), response(SECOND, second, status))


@pytest.mark.parametrize("rate", [-1.3, 0.7])
def test_the_rate_of_an_exponential_is_its_exponent(rate):
    time = np.arange(1000) / RATE
    growth = chaos.growth_rate(1e-9 * np.exp(rate * time), RATE, 1e-14, 1e-5)
    assert growth.mean == pytest.approx(rate)
    assert growth.error == pytest.approx(0.0, abs=1e-9)


def test_round_off_and_saturation_count_in_no_rate():
    time = np.arange(1500) / RATE
    shrinking = np.maximum(1e-9 * np.exp(-3.0 * time), 1e-16)
    growing = np.minimum(1e-9 * np.exp(2.0 * time), 1e-2)
    for d, rate in ((shrinking, -3.0), (growing, 2.0)):
        growth = chaos.growth_rate(d, RATE, 1e-14, 1e-5)
        assert growth.mean == pytest.approx(rate)
        assert 5 < growth.steps < 12


def test_the_error_of_the_rate_is_that_of_independent_steps():
    rng = np.random.default_rng(5)
    errors, means = [], []
    for _ in range(200):
        steps = np.repeat(rng.normal(0.0, 2.0, 40), 25) / RATE  # a new rate every 0.5 s
        d = 1e-6 * np.exp(np.concatenate([[0.0], np.cumsum(steps)]))
        growth = chaos.growth_rate(d, RATE, 0.0, np.inf)
        errors.append(growth.error)
        means.append(growth.mean)
    assert np.mean(errors) == pytest.approx(np.std(means), rel=0.15)


def test_runs_that_never_differ_have_no_rate():
    growth = chaos.growth_rate(np.full(100, 1e-17), RATE, 1e-14, 1e-5)
    assert growth.steps == 0 and np.isnan(growth.mean) and np.isnan(growth.error)


def test_separation_is_the_rms_distance_of_the_readouts():
    pair = perturbed(np.full(SCENE.samples, 3e-4))
    np.testing.assert_allclose(chaos.separation(pair), 3e-4 * np.sqrt(2))


def test_equal_runs_are_consistent_and_unrelated_ones_are_not():
    equal = perturbed(np.zeros(SCENE.samples))
    assert chaos.consistency(equal) == pytest.approx(1.0)
    assert chaos.saturation(equal) == 0.0
    unrelated = chaos.Pair(response(SCENE, noise(1)), response(SECOND, noise(2)))
    assert abs(chaos.consistency(unrelated)) < 0.1
    assert chaos.saturation(unrelated) == pytest.approx(1.0, abs=0.05)


def test_consistency_looks_at_the_last_half_only():
    apart = np.zeros(SCENE.samples)
    apart[: SCENE.samples // 2] = noise(3)[: SCENE.samples // 2, 0]
    assert chaos.consistency(perturbed(apart)) == pytest.approx(1.0)


def written(pair, folder):
    paths = []
    for run in pair:
        paths.append(folder / run.attrs["run"] / "response.nc")
        dataset.save(run, paths[-1])
    return paths


def study_table(status="ok"):
    rows = [{name: np.nan for name in tables.COLUMNS} for _ in range(2)]
    for row, scene in zip(rows, (SCENE, SECOND)):
        row |= {"setup": "described", "status": "ok", "run": f"run-{scene.disturbance:g}"}
    rows[1]["status"] = status
    return pd.DataFrame(rows).assign(c_nl=[0.6, 0.7])


def test_rates_joins_each_pair_to_the_row_of_its_first_run(tmp_path):
    apart = 1e-9 * np.exp(-SCENE.times)
    paths = written(perturbed(apart), tmp_path)
    row = chaos.rates(study_table(), paths).squeeze()
    assert (row["run"], row["twin"], row["c_nl"]) == ("run-1e-09", "run-2e-09", 0.6)
    assert row["rate_per_s"] == pytest.approx(-1.0, abs=1e-3)
    assert row["consistency"] == pytest.approx(1.0)
    assert row["separation_m"] == pytest.approx(1e-9)
    drawn = chaos.separations(paths)
    assert list(drawn.columns) == list(chaos.SEPARATION_COLUMNS)
    np.testing.assert_allclose(drawn["separation_m"], np.sqrt(2) * apart[::5], atol=1e-18)


def test_an_unstable_run_leaves_a_row_without_numbers(tmp_path):
    apart = np.where(SCENE.times < 5.0, 1e-9, np.nan)
    paths = written(perturbed(apart, "unstable"), tmp_path)
    row = chaos.rates(study_table("unstable"), paths).squeeze()
    assert row["twin_status"] == "unstable"
    assert row[["rate_per_s", "rate_se", "consistency", "saturation"]].isna().all()
    drawn = chaos.separations(paths)
    np.testing.assert_array_equal(drawn["separation_m"].isna(), drawn["time_s"] >= 5.0)


def test_responses_that_are_no_perturbed_pair_are_refused(tmp_path):
    first, second = written(perturbed(np.zeros(SCENE.samples)), tmp_path)
    for wrong in ([second, first], [first, first]):
        with pytest.raises(ValueError, match="are no perturbed pair"):
            list(chaos.pairs(wrong))
    with pytest.raises(ValueError, match="1 responses are no perturbed pairs"):
        list(chaos.pairs([first]))


def test_the_study_asks_for_pairs_that_differ_by_the_disturbance():
    scenes = [run.scene for run in runs(Config(), "chaos", "described")]
    assert len(scenes) == 2 * len(Config().chaos.buckling)
    for first, second in zip(scenes[::2], scenes[1::2]):
        assert (
            replace(first, disturbance=0.0).to_json() == replace(second, disturbance=0.0).to_json()
        )
        assert second.disturbance - first.disturbance == pytest.approx(Config().chaos.disturbance)


def test_files_of_disturbed_responses_keep_every_digit(tmp_path):
    scene = Scene(crosshatch(2, length=0.5), duration=0.1, disturbance=1e-9)
    response = simulate(scene, "draft")
    dataset.save(response, tmp_path / "response.nc")
    assert dataset.load(tmp_path / "response.nc").identical(response)


def test_runs_of_a_pair_that_forgets_end_far_below_what_counts_as_round_off():
    scene = Scene(crosshatch(2, length=0.5), force=1e-6, duration=4.0, damping=10.0)
    pair = chaos.Pair(*(simulate(replace(scene, disturbance=d), "draft") for d in (1e-9, 2e-9)))
    rest = chaos.separation(pair)[-50:]
    assert rest.max() < chaos.ROUND_OFF * scene.network.length / 5


def test_weakly_driven_pairs_forget_at_half_the_rate_of_damping():
    """A linear mode with velocity damping gamma decays as exp(-gamma t / 2)."""
    scene = Scene(
        crosshatch(2, length=0.5), force=1e-6, duration=2.0, damping=10.0, disturbance=1e-9,
        crossing_damping=0.0, crossing_stiffness=1e3,
    )  # fmt: skip
    pair = chaos.Pair(*(simulate(replace(scene, disturbance=d), "draft") for d in (1e-9, 2e-9)))
    least = chaos.ROUND_OFF * scene.network.length
    rate = chaos.growth_rate(chaos.separation(pair), scene.sample_rate, least, 1e-6)
    assert rate.mean == pytest.approx(-5.0, abs=0.5)


@pytest.fixture(scope="module")
def given():
    """What the figure is given; the last pair is unstable."""
    numbers = np.array([0.2, 1.0, 2.0, 5.0])
    table = pd.DataFrame({"setup": "described", "buckling_number": numbers}).assign(
        n=4, spacing_m=0.1, status="ok", twin_status=["ok", "ok", "ok", "unstable"],
        rate_per_s=[-5, -5, -1, np.nan], rate_se=0.1, consistency=[1, 1, 1, np.nan],
        saturation=[0, 0, 0.1, np.nan], c_nl=0.5, c_m=0.4, c_nl_se=0.02, c_m_se=0.02,
    )  # fmt: skip
    apart = pd.DataFrame({"buckling_number": np.repeat(numbers, 3), "setup": "described"}).assign(
        time_s=np.tile([0.0, 1.0, 2.0], 4), separation_m=np.tile([1e-9, 1e-10, 1e-11], 4)
    )
    baselines = pd.DataFrame({"readout": ["u"], "c_nl": [0.14], "c_m": [0.09]})
    return {"chaos_rates": table, "chaos_separations": apart, "chaos_baselines": baselines}


@pytest.fixture(scope="module")
def drawn(given, tmp_path_factory):
    path = tmp_path_factory.mktemp("figures") / "chaos.png"
    return plotting.draw(given, "described", path), path


def test_the_figure_is_written_and_legible(drawn):
    assert_written(drawn[1])
    assert_legible(drawn[0])


def test_the_figure_shows_each_separation_and_the_band_of_round_off(given, drawn):
    (ax,) = drawn[0].subfigs[0].axes
    apart = given["chaos_separations"].groupby("buckling_number")[["time_s", "separation_m"]]
    curves = [line.get_xydata() for line in ax.lines]
    np.testing.assert_array_equal(curves, [frame for _, frame in apart])
    (band,) = ax.patches
    assert band.get_y() + band.get_height() == pytest.approx(chaos.ROUND_OFF * 0.5)


def test_the_figure_shows_the_measures_over_b(given, drawn):
    table = given["chaos_rates"]
    rate, pair, c_nl, c_m = drawn[0].subfigs[1].axes
    for ax, name, error in ((rate, "rate_per_s", 0.1), (c_nl, "c_nl", 0.02), (c_m, "c_m", 0.02)):
        (container,) = ax.containers
        points = container[0].get_xydata()
        np.testing.assert_array_equal(points, table[["buckling_number", name]].astype(float))
        bars = np.array([bar[:, 1] for bar in container.lines[2][0].get_segments() if len(bar)])
        np.testing.assert_allclose(np.ptp(bars, axis=1), 2 * error)
    for line, name in zip([pair.lines[1], pair.lines[2]], ("consistency", "saturation")):
        np.testing.assert_array_equal(line.get_ydata(), table[name].astype(float))


def test_the_figure_marks_unstable_pairs_in_every_panel_over_b(given, drawn, tmp_path):
    assert [list(mark.get_xdata()) for mark in marked(drawn[0])] == [[5.0]] * 4
    with pytest.raises(ValueError, match="no run of the published setup"):
        plotting.draw(given, "published", tmp_path / "none.png")
