"""The NARMA recursions by hand, the split, the fit against its definition, and the figure."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.collections import PolyCollection

from fiberweb import Scene, crosshatch
from fiberweb.claims import judge as claims
from fiberweb.config import lab, load
from fiberweb.scoring.camera import film
from fiberweb.scoring.recording import signals
from fiberweb.simulation import dataset
from fiberweb.studies import narma as study_of
from fiberweb.studies.narma import figure
from fiberweb.studies.narma import task as narma
from fiberweb.tables import read, write
from tests.figures.legible import assert_legible, assert_written, marked, said
from tests.studies.experiment import asked_for
from tests.studies.experiment import response as filmed

RATE = 50.0


def recording(n, duration=8.0, status="ok", name="run"):
    """A response of a network made of delayed inputs, their squares, and noise: no simulation."""
    scene = Scene(crosshatch(n, length=0.5), duration=duration, sample_rate=RATE)
    time = scene.times
    u = np.sin(1.7 * time) + 0.5 * np.sin(4.1 * time + 1) + 0.3 * np.sin(9.3 * time)
    delayed = np.stack([np.roll(u, 5 * k) for k in range(4 * n)], 1)
    noise = np.random.default_rng(n).standard_normal(delayed.shape)
    moved = 1e-4 * np.stack([delayed, delayed**2 + 0.01 * noise], -1)
    if status == "unstable":
        moved[len(moved) // 2 :] = np.nan
    return xr.Dataset(
        {
            "input": ("time", u),
            "displacement": (("time", "readout", "axis"), moved),
        },
        {"time": time, "axis": ["x", "y"]},
        {
            "status": status, "setup": "described", "sample_rate": RATE, "run": name,
            "scene": scene.to_json(), "engine": "kirchhoff", "elements_per_section": 4,
            "time_step": 1e-5,
        },
    )  # fmt: skip


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """(estimates, table) of a stable and an unstable network, and of the twin in two readings."""
    folder = tmp_path_factory.mktemp("narma")
    twin = asked_for("narma", "published")[0]
    runs = [
        recording(2, name="crosshatch-n02"),
        recording(3, status="unstable", name="crosshatch-n03"),
    ]
    runs.append(filmed(twin.scene, "twin"))
    paths = [folder / f"{number}.nc" for number in range(3)]
    for run, path in zip(runs, paths, strict=True):
        dataset.save(run, path)
    cameras = [None, None, twin.camera]
    estimates = narma.of_runs(paths, cameras, narma.ORDERS, 10.0, 1.0, "clean")
    return estimates, narma.table(estimates)


# --- the recursions -----------------------------------------------------------------------------


def test_narma_2_by_hand():
    u = np.array([0.1, 0.2, 0.0, 0.1])
    # 0.1 + 0.6e-3; 0.4 * 0.1006 + 0.1 + 4.8e-3; ...
    y1 = 0.1006
    y2 = 0.04024 + 0.0 + 0.0048 + 0.1
    y3 = 0.4 * 0.14504 + 0.4 * 0.14504 * 0.1006 + 0.0 + 0.1
    y4 = 0.4 * y3 + 0.4 * y3 * 0.14504 + 0.0006 + 0.1
    np.testing.assert_allclose(narma.series(u, 2), [0.0, y1, y2, y3, y4], rtol=1e-12)
    assert y3 == pytest.approx(0.163852, abs=1e-6) and y4 == pytest.approx(0.175647, abs=1e-6)


def test_narma_5_by_hand():
    u = np.array([0.2, 0.1, 0.0, 0.1, 0.2, 0.1, 0.05])
    expected = [0.0, 0.1, 0.1305]  # 0.03 + 0.05 * 0.1 * 0.1 + 0.1
    expected.append(0.3 * 0.1305 + 0.05 * 0.1305 * 0.2305 + 0.1)
    expected.append(0.3 * expected[3] + 0.05 * expected[3] * sum(expected) + 0.1)
    y4 = expected[4]  # from here on u four samples ago is inside the series: 0.2 * 0.2, ...
    expected.append(0.3 * y4 + 0.05 * y4 * sum(expected) + 1.5 * 0.2 * 0.2 + 0.1)
    y5 = expected[5]
    expected.append(0.3 * y5 + 0.05 * y5 * sum(expected[1:]) + 1.5 * 0.1 * 0.1 + 0.1)
    y6 = expected[6]
    expected.append(0.3 * y6 + 0.05 * y6 * sum(expected[2:]) + 1.5 * 0.0 * 0.05 + 0.1)
    y = narma.series(u, 5)
    np.testing.assert_allclose(y, expected, rtol=1e-12)
    assert y[5] == pytest.approx(0.2071776, abs=1e-7)


@pytest.mark.parametrize("order", narma.ORDERS)
def test_a_constant_input_ends_at_the_fixed_point(order):
    y = narma.series(np.full(400, 0.1), order)[-1]
    if order == 2:
        assert y == pytest.approx(0.4 * y + 0.4 * y**2 + 0.6e-3 + 0.1, abs=1e-12)
    else:
        assert y == pytest.approx(0.3 * y + 0.05 * order * y**2 + 0.015 + 0.1, abs=1e-12)


def test_narma_10_reads_the_input_nine_samples_ago():
    u = np.full(60, 0.1)
    pulse = u.copy()
    pulse[30] = 0.2
    change = narma.series(pulse, 10) - narma.series(u, 10)
    assert np.all(change[:31] == 0.0)
    assert change[31] == pytest.approx(1.5 * 0.1 * 0.1)
    steps = np.diff(change[31:45])
    assert np.argmax(steps) == 8  # from y(39) to y(40), where u(30) u(39) enters


@pytest.mark.parametrize(
    ("u", "order", "words"),
    [
        ([0.1], 3, "order = 3 is no NARMA task of the paper; use 2, 5 or 10"),
        ([0.1, 0.3], 2, "u runs from 0.1 to 0.3; scale it to 0 to 0.2"),
        ([0.1, np.nan], 2, "u runs from nan"),
    ],
)
def test_bad_series_are_named(u, order, words):
    with pytest.raises(ValueError, match=words):
        narma.series(np.array(u), order)


# --- the split and the fit ----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("samples", "first", "tested"), [(1000, 200, 200), (60, 12, 12), (1003, 200, 201)]
)
def test_split_drops_the_first_and_tests_on_the_last_quarter(samples, first, tested):
    train, test = narma.split(samples)
    assert (train[0], len(test), test[-1]) == (first, tested, samples - 1)
    np.testing.assert_array_equal(np.r_[train, test], np.arange(first, samples))


def test_too_short_a_recording_is_named():
    with pytest.raises(ValueError, match=r"has 19 samples .* record at least 20"):
        narma.split(19)


def test_rate_must_divide_the_recordings():
    with pytest.raises(ValueError, match=r"narma.rate = 7 Hz does not divide .* 50 Hz"):
        narma.estimates(recording(2), (2,), 7.0, 1.0)


@pytest.mark.parametrize("scoring", ["clean", "published"])
def test_estimates_are_ridge_on_standardised_readouts(scoring):
    """The normal equations, written out; next is the same series one sample on. The authors
    standardise over the whole run."""
    response = recording(3)
    estimates = narma.estimates(response, (2, 10), 10.0, 1.0, scoring)
    u, x = response["input"].values, signals(response)
    u, x = u[::5], x[::5].astype(float)
    train, test = np.arange(16, 64), np.arange(64, 80)  # 80 samples, a fifth of them dropped
    y = narma.series(0.2 * (u - u.min()) / (u.max() - u.min()), 10)
    fitted = train if scoring == "clean" else slice(None)
    x = (x - x[fitted].mean(axis=0)) / x[fitted].std(axis=0)
    middle = x[train].mean(axis=0)
    for timing, z in (("same", y[:-1]), ("next", y[1:])):
        mean = z[train].mean()
        gram = (x[train] - middle).T @ (x[train] - middle) + np.eye(x.shape[1])
        weights = np.linalg.solve(gram, (x[train] - middle).T @ (z[train] - mean))
        one = estimates.sel(timing=timing, order=10)
        np.testing.assert_allclose(one["target"], z[test], rtol=1e-12)
        estimate = one["estimate"].sel(readout="network")
        np.testing.assert_allclose(estimate, (x[test] - middle) @ weights + mean, rtol=1e-8)
    np.testing.assert_allclose(estimates["time"], test / 10.0)


def test_perturbed_test_rows_change_no_weight_of_the_clean_scoring():
    response = recording(3)
    before = narma.estimates(response, (2,), 10.0, 1.0)["estimate"]
    moved = response["displacement"].copy()
    moved[-1] = 1.0  # not a frame of the task's rate but the last ...
    moved[-5] = 1.0  # ... which is
    after = narma.estimates(response.assign(displacement=moved), (2,), 10.0, 1.0)["estimate"]
    np.testing.assert_array_equal(
        after.sel(readout="network").isel(time=slice(None, -1)),
        before.sel(readout="network").isel(time=slice(None, -1)),
    )


def test_the_twin_is_given_the_task_on_its_film(study):
    """At u of the driven marker, in 0 to 0.2 from rest on, and at both readings of the rate."""
    estimates, table = study
    twin = asked_for("narma", "published")[0]
    run = filmed(twin.scene, "twin")
    for step, case in ((1, "twin"), (2, "twin, every 2")):
        u = film(run, **twin.camera | {"frame_step": step})["input"].values[::6]
        y = narma.series(0.2 * (u - u.min()) / (u.max() - u.min()), 2)[: len(u)]
        of_case = estimates.sel(case=case, order=2, timing="same")
        target = of_case["target"].dropna("time")
        np.testing.assert_allclose(target, y[-len(target) :], atol=1e-5)
    of_twin = table[table["body"] == "twin"]
    assert set(zip(of_twin["frame_step"], of_twin["verdict"])) == {(1, True), (2, False)}
    assert set(of_twin["run"]) == {"twin"} and (of_twin["angle_deg"].round(6) == 50.0).all()
    signals_of = of_twin[of_twin["readout"] == "network"]["n_signals"]
    assert set(signals_of) == {2 * 55}
    assert not table.loc[table["body"] == "network", "verdict"].any()


def test_points_are_networks_and_the_twin_or_the_twin_alone():
    ours, theirs = (asked_for("narma", setup) for setup in ("described", "published"))
    assert [p.scene.network.n for p in ours] == [6, 8, 4]
    assert [p.camera is None for p in ours] == [True, True, False]
    assert [p.scene for p in theirs] == [ours[-1].scene]
    config = load()
    here = lab(config, "described")
    with pytest.raises(ValueError, match=r"narma.rate = 50 Hz does not divide .* 120 Hz"):
        study_of.check(config.narma.model_copy(update={"rate": 50.0}), here)


def test_table_holds_the_measures_of_the_errors(study):
    estimates, table = study
    assert len(table) == 4 * 3 * 5 * 2
    assert list(table.columns[: len(narma.CASE)]) == list(narma.CASE)
    row = table[(table["n"] == 2) & (table["order"] == 5) & (table["timing"] == "same")]
    row = row.set_index("readout").loc["powers"]
    at = {"case": row["case"], "order": 5, "timing": "same"}
    z = estimates["target"].sel(at).dropna("time")
    error = (estimates["estimate"].sel(at | {"readout": "powers"}) - z).values
    assert row["rmse"] == pytest.approx(np.sqrt(np.mean(error**2)))
    assert row["nrmse"] == pytest.approx(np.sqrt(np.mean(error**2)) / z.values.std())
    assert row["bias"] == pytest.approx(np.mean(error))
    assert row["target_mean"] == pytest.approx(z.values.mean())
    low, high = np.percentile(error, [10, 90])
    assert row["interdecile_range"] == pytest.approx(high - low)
    signals = table[table["n"] == 2].groupby("readout")["n_signals"].first().to_dict()
    assert signals == {"network": 16, "echo_state": 16, "u": 1, "derivatives": 4, "powers": 3}
    assert set(table["alpha"]) == {1.0} and set(table["setup"]) == {"described"}


def test_an_unstable_run_has_no_errors_but_its_input_has(study):
    table = study[1].query("status == 'unstable'")
    measured = table.groupby("readout")[["rmse", "nrmse", "interdecile_range", "bias"]].count()
    assert (measured.loc["network"] == 0).all()
    assert (measured.drop("network") == 6).all(axis=None)


# --- the figure ---------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def drawn(study, tmp_path_factory):
    path = tmp_path_factory.mktemp("figures") / "narma.png"
    given = {"narma_errors": study[0], "narma": study[1]}
    return figure.draw(given, "described", path), path


def test_figure_shows_every_readout_and_an_x_for_the_unstable(drawn):
    picture, path = drawn
    assert_written(path)
    assert_legible(picture)
    words = said(picture)
    for word in ("NARMA-10", "2×2", "3×3", "ESN 16", "unstable run", "4×4 twin", "Bias"):
        assert word in words
    # three panels each of violins, RMSE, interdecile range and bias; the 3x3 is the second network
    at = 5 + figure.GAP + 1
    assert [list(mark.get_xdata()) for mark in marked(picture)] == [[at]] * 12
    violins = [body for body in picture.findobj(PolyCollection) if len(body.get_paths())]
    # twin, echo state and three of its input; a network, two echo states and three of their input
    assert len(violins) == 3 * (5 + 6)


def test_bars_are_the_measures_of_the_table_in_thousandths(study, drawn):
    columns = np.reshape(drawn[0].axes, (5, 3)).T
    table = study[1][study[1]["timing"] == "same"]
    for column, order in zip(columns, narma.ORDERS):
        rows = table[(table["order"] == order)].set_index(["case", "readout"])
        alone = ("derivatives", "powers", "u")
        shown = [("twin", name) for name in ("network", "echo_state", *alone)]
        shown += [("crosshatch-n02", "network")]
        shown += [(f"crosshatch-n{n:02d}", "echo_state") for n in (2, 3)]
        shown += [("crosshatch-n02", name) for name in alone]
        for ax, measure in zip(column[1:4], figure.MEASURES):
            heights = [bar.get_height() for bar in ax.patches]
            np.testing.assert_allclose(heights, 1e3 * rows.loc[shown, measure])


def test_the_papers_errors_are_those_of_the_claims():
    listed = {claim["id"]: claim.get("paper") for claim in claims.load()}
    rmse = dict(zip(narma.ORDERS, (listed["N1"], listed["N2"], listed["N3"])))
    for order, decile_range in zip(narma.ORDERS, listed["N4"]):
        assert figure.PAPER[order] == {"rmse": rmse[order], "interdecile_range": decile_range}


def test_figure_of_one_unstable_run_is_drawn(study, unsaved):
    estimates, table = study
    alone = table[(table["status"] == "unstable") & (table["order"] == 2)]
    given = {"narma": alone, "narma_errors": estimates}
    picture = figure.draw(given, "described", "unsaved")
    *bars, trace = marked(picture)
    assert [list(mark.get_xdata()) for mark in bars] == [[0]] * 4
    assert trace.axes.get_xlabel() == "Time (s)"
    with pytest.raises(ValueError, match="no run of the published setup"):
        figure.draw(given, "published", "unsaved")


def test_table_reads_back(study, tmp_path):
    write(study[1], tmp_path / "narma.csv")
    back = read(tmp_path / "narma.csv")
    pd.testing.assert_series_equal(back["rmse"], study[1]["rmse"], rtol=1e-9)
