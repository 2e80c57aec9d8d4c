"""Rates and consistency of made-up twins whose answer is known, and of a real pair at rest."""

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
from tests.figures.legible import assert_legible

RATE = 50.0
SCENE = Scene(crosshatch(2, length=0.5), duration=20.0, sample_rate=RATE, disturbance=1e-9)
TWIN = replace(SCENE, disturbance=2e-9)


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
            "run": f"twin-{scene.disturbance:g}",
        },
    )


def noise(seed):
    return 1e-3 * np.random.default_rng(seed).normal(size=(SCENE.samples, 4))


def twins(apart, status="ok"):
    """A pair whose every signal differs by apart (time,), m."""
    moved = noise(1)
    second = moved + np.asarray(apart)[:, None]
    return chaos.Pair(response(SCENE, moved), response(TWIN, second, status))


@pytest.mark.parametrize("rate", [-1.3, 0.7])
def test_the_rate_of_an_exponential_is_its_exponent(rate):
    time = np.arange(1000) / RATE
    found = chaos.growth_rate(1e-9 * np.exp(rate * time), RATE, 1e-14, 1e-5)
    assert found.mean == pytest.approx(rate)
    assert found.error == pytest.approx(0.0, abs=1e-9)


def test_round_off_and_saturation_count_in_no_rate():
    time = np.arange(1500) / RATE
    shrinking = np.maximum(1e-9 * np.exp(-3.0 * time), 1e-16)
    growing = np.minimum(1e-9 * np.exp(2.0 * time), 1e-2)
    for d, rate in ((shrinking, -3.0), (growing, 2.0)):
        found = chaos.growth_rate(d, RATE, 1e-14, 1e-5)
        assert found.mean == pytest.approx(rate)
        assert 5 < found.steps < 12


def test_the_error_of_the_rate_is_that_of_independent_steps():
    rng = np.random.default_rng(5)
    errors, means = [], []
    for _ in range(200):
        steps = np.repeat(rng.normal(0.0, 2.0, 40), 25) / RATE  # a new rate every 0.5 s
        d = 1e-6 * np.exp(np.concatenate([[0.0], np.cumsum(steps)]))
        found = chaos.growth_rate(d, RATE, 0.0, np.inf)
        errors.append(found.error)
        means.append(found.mean)
    assert np.mean(errors) == pytest.approx(np.std(means), rel=0.15)


def test_twins_that_never_differ_have_no_rate():
    found = chaos.growth_rate(np.full(100, 1e-17), RATE, 1e-14, 1e-5)
    assert found.steps == 0 and np.isnan(found.mean) and np.isnan(found.error)


def test_separation_is_the_rms_distance_of_the_readouts():
    pair = twins(np.full(SCENE.samples, 3e-4))
    np.testing.assert_allclose(chaos.separation(pair), 3e-4 * np.sqrt(2))


def test_equal_twins_are_consistent_and_unrelated_ones_are_not():
    equal = twins(np.zeros(SCENE.samples))
    assert chaos.consistency(equal) == pytest.approx(1.0)
    assert chaos.saturation(equal) == 0.0
    unrelated = chaos.Pair(response(SCENE, noise(1)), response(TWIN, noise(2)))
    assert abs(chaos.consistency(unrelated)) < 0.1
    assert chaos.saturation(unrelated) == pytest.approx(1.0, abs=0.05)


def test_consistency_looks_at_the_last_half_only():
    apart = np.zeros(SCENE.samples)
    apart[: SCENE.samples // 2] = noise(3)[: SCENE.samples // 2, 0]
    assert chaos.consistency(twins(apart)) == pytest.approx(1.0)


def written(pair, folder):
    paths = []
    for twin in pair:
        paths.append(folder / twin.attrs["run"] / "response.nc")
        dataset.save(twin, paths[-1])
    return paths


def study_table(status="ok"):
    rows = [{name: np.nan for name in tables.COLUMNS} for _ in range(2)]
    for row, scene in zip(rows, (SCENE, TWIN)):
        row |= {"setup": "described", "status": "ok", "run": f"twin-{scene.disturbance:g}"}
    rows[1]["status"] = status
    return pd.DataFrame(rows).assign(c_nl=[0.6, 0.7])


def test_rates_joins_each_pair_to_the_row_of_its_first_twin(tmp_path):
    apart = 1e-9 * np.exp(-SCENE.times)
    paths = written(twins(apart), tmp_path)
    row = chaos.rates(study_table(), paths).squeeze()
    assert (row["run"], row["twin"], row["c_nl"]) == ("twin-1e-09", "twin-2e-09", 0.6)
    assert row["rate_per_s"] == pytest.approx(-1.0, abs=1e-3)
    assert row["consistency"] == pytest.approx(1.0)
    assert row["separation_m"] == pytest.approx(1e-9)
    drawn = chaos.separations(paths)
    assert list(drawn.columns) == list(chaos.SEPARATION_COLUMNS)
    np.testing.assert_allclose(drawn["separation_m"], np.sqrt(2) * apart[::5], atol=1e-18)


def test_an_unstable_twin_leaves_a_row_without_numbers(tmp_path):
    apart = np.where(SCENE.times < 5.0, 1e-9, np.nan)
    paths = written(twins(apart, "unstable"), tmp_path)
    row = chaos.rates(study_table("unstable"), paths).squeeze()
    assert row["twin_status"] == "unstable"
    assert row[["rate_per_s", "rate_se", "consistency", "saturation"]].isna().all()
    drawn = chaos.separations(paths)
    np.testing.assert_array_equal(drawn["separation_m"].isna(), drawn["time_s"] >= 5.0)


def test_responses_that_are_no_twins_are_refused(tmp_path):
    first, second = written(twins(np.zeros(SCENE.samples)), tmp_path)
    for wrong in ([second, first], [first, first]):
        with pytest.raises(ValueError, match="are no twins"):
            list(chaos.pairs(wrong))
    with pytest.raises(ValueError, match="1 responses are no pairs"):
        list(chaos.pairs([first]))


def test_the_study_asks_for_pairs_that_differ_by_the_disturbance():
    found = [run.scene for run in runs(Config(), "chaos", "described")]
    assert len(found) == 2 * len(Config().chaos.buckling)
    for first, second in zip(found[::2], found[1::2]):
        assert (
            replace(first, disturbance=0.0).to_json() == replace(second, disturbance=0.0).to_json()
        )
        assert second.disturbance - first.disturbance == pytest.approx(Config().chaos.disturbance)


def test_disturbed_responses_alone_keep_every_digit():
    scene = Scene(crosshatch(2, length=0.5), duration=0.1)
    kept = simulate(replace(scene, disturbance=1e-9), "draft")["displacement"]
    assert kept.dtype == np.float64
    assert simulate(scene, "draft")["displacement"].dtype == np.float32


def test_weakly_driven_twins_forget_at_half_the_rate_of_damping():
    """A linear mode with velocity damping gamma decays as exp(-gamma t / 2)."""
    scene = Scene(
        crosshatch(2, length=0.5), force=1e-6, duration=2.0, damping=10.0, disturbance=1e-9,
        crossing_damping=0.0, crossing_stiffness=1e3,
    )  # fmt: skip
    pair = chaos.Pair(*(simulate(replace(scene, disturbance=d), "draft") for d in (1e-9, 2e-9)))
    least = chaos.ROUND_OFF * scene.network.length
    rate = chaos.growth_rate(chaos.separation(pair), scene.sample_rate, least, 1e-6)
    assert rate.mean == pytest.approx(-5.0, abs=0.5)


def test_the_figure_marks_unstable_pairs_in_every_panel_over_b(tmp_path):
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
    given = {"chaos_rates": table, "chaos_separations": apart, "chaos_baselines": baselines}
    figure = plotting.draw(given, "described", tmp_path / "chaos.png")
    assert (tmp_path / "chaos.pdf").exists()
    assert_legible(figure)
    assert plotting.ROUND_OFF == chaos.ROUND_OFF
    marks = figure.findobj(lambda artist: artist.get_gid() == "unstable")
    assert [list(mark.get_xdata()) for mark in marks] == [[5.0]] * 4
    with pytest.raises(ValueError, match="no run of the published setup"):
        plotting.draw(given, "published", tmp_path / "none.png")
