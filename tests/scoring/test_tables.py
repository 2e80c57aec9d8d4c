"""Tables hold what the capacity files say."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from fiberweb import Scene, crosshatch, polygon
from fiberweb.scoring import capacity, tables
from fiberweb.simulation import dataset

RATE = 50.0


def response(scene, status="ok"):
    """A few made-up readouts of the input: what a run of the scene might have given."""
    u = np.sin(1.7 * scene.times) + 0.5 * np.sin(4.1 * scene.times + 1)
    moved = np.stack([np.stack([u, u**2], -1), np.stack([np.roll(u, 5), u**3], -1)], 1)
    if status == "unstable":
        moved[len(moved) // 2 :] = np.nan
    return xr.Dataset(
        {"input": ("time", u), "displacement": (("time", "readout", "axis"), 1e-3 * moved)},
        {"time": scene.times, "axis": ["x", "y"]},
        {
            "status": status,
            "setup": scene.setup,
            "sample_rate": scene.sample_rate,
            "scene": scene.to_json(),
            "engine": "none",
            "elements_per_section": 4,
            "time_step": 1e-5,
        },
    )


def scored_file(folder, name, network, status="ok", **scene):
    scene = Scene(network, duration=8.0, sample_rate=RATE, **scene)
    scored = capacity.score(response(scene, status))
    scored.attrs |= {"setup": scene.setup, "scene": scene.to_json(), "run": name}
    path = folder / name / "capacity.nc"
    dataset.save(scored, path)
    return path, scored


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs")
    return [
        scored_file(folder, "polygon-n06", polygon(6), setup="published"),
        scored_file(folder, "crosshatch-n04", crosshatch(4, length=0.5), tension=0.1),
        scored_file(folder, "crosshatch-n02", crosshatch(2, length=0.5), status="unstable"),
    ]


def test_a_study_has_one_row_a_run_with_the_scene_and_the_capacities(study):
    table = tables.study([path for path, _ in study], ["eq3"] * 3)
    assert list(table.columns)[: len(tables.COLUMNS) + 1] == [*tables.COLUMNS, "force_choice"]
    assert list(table["force_choice"]) == ["eq3"] * 3
    assert list(table["run"]) == ["crosshatch-n02", "crosshatch-n04", "polygon-n06"]
    row, scored = table.iloc[1], study[1][1]
    scene = Scene.from_json(scored.attrs["scene"])
    assert (row["setup"], row["topology"], row["n"]) == ("described", "crosshatch", 4)
    assert row["spacing_m"] == pytest.approx(0.1)
    assert row["force_N"] == scene.force
    assert row["tension_N"] == 0.1
    assert row["buckling_number"] == scene.buckling_number
    for name in tables.SCALARS:
        assert row[name] == float(scored[name])


def test_an_unstable_run_keeps_its_row_and_has_no_capacity(study):
    row = tables.rows([path for path, _ in study]).iloc[0]
    assert row["status"] == "unstable"
    assert row[list(tables.SCALARS)].isna().all()


def test_rows_takes_columns_of_a_study(study):
    table = tables.rows(
        [study[1][0]], study="ridge", length_m=lambda scene, scored: scene.network.length
    )
    assert list(table.columns) == [*tables.COLUMNS, "study", "length_m"]
    assert table.loc[0, "study"] == "ridge"
    assert table.loc[0, "length_m"] == 0.5


def test_no_run_gives_a_table_without_rows():
    assert list(tables.rows([]).columns) == list(tables.COLUMNS)
    assert list(tables.curves([]).columns) == list(tables.CURVE_COLUMNS)


def test_curves_hold_every_order_and_lag(study):
    path, scored = study[1]
    curves = tables.curves([path])
    assert list(curves.columns) == list(tables.CURVE_COLUMNS)
    orders = curves[curves["target"] == "order"]
    lags = curves[curves["target"] == "lag"]
    np.testing.assert_array_equal(orders["at"], scored["order"])
    np.testing.assert_array_equal(orders["c"], scored["nonlinear"])
    np.testing.assert_array_equal(orders["c_raw"], scored["nonlinear_raw"])
    np.testing.assert_array_equal(lags["at"], scored["lag"])
    np.testing.assert_array_equal(lags["c"], scored["memory"])
    np.testing.assert_array_equal(lags["c_train"], scored["memory_train"])


@pytest.mark.parametrize(("setup", "scoring"), [("described", "clean"), ("published", "published")])
def test_input_baselines_score_the_input_alone_by_the_scoring_of_the_setup(
    tmp_path, setup, scoring
):
    scene = Scene(crosshatch(2, length=0.5), setup=setup, duration=8.0, sample_rate=RATE)
    data = response(scene, status="unstable")  # the input is whole all the same
    dataset.save(data, tmp_path / "response.nc")
    baselines = tables.input_baselines(tmp_path / "response.nc", alpha=0.1).set_index("readout")
    assert list(baselines.columns) == ["c_nl", "c_m"]
    u = data["input"].values
    for name, readouts in capacity.trivial_readouts(u, RATE).items():
        expected = capacity.score_arrays(u, readouts, RATE, scoring=scoring, alpha=0.1)
        assert baselines.loc[name, "c_nl"] == expected.c_nl
        assert baselines.loc[name, "c_m"] == expected.c_m


def test_study_has_a_row_for_each_run_and_choice(study):
    (path, scored), unstable = study[1], study[2][0]
    table = tables.study([path, unstable, path], ["best_c_nl", "eq3", "best_c_m"])
    assert list(table.columns) == [
        *tables.COLUMNS, "force_choice", *tables.PHYSICS, *tables.NUMERICS
    ]  # fmt: skip
    assert list(zip(table["n"], table["force_choice"])) == [
        (2, "eq3"), (4, "best_c_nl"), (4, "best_c_m")
    ]  # fmt: skip
    row, scene = table.iloc[1], Scene.from_json(scored.attrs["scene"])
    assert row["c_nl"] == float(scored["c_nl"])
    assert (row["crossing_stiffness_N_m"], row["seed"]) == (scene.crossing_stiffness, scene.seed)
    assert (row["duration_s"], row["filter_order"]) == (8.0, 0)
    assert (row["engine"], row["elements_per_section"], row["time_step_s"]) == ("none", 4, 1e-5)
    with pytest.raises(ValueError):
        tables.study([path], ["eq3", "best_c_m"])


def test_a_study_carries_the_verdicts_of_certificates(study, tmp_path):
    verdicts = {"c_nl": "mesh", "c_m": "physics"}
    rows = [(name, change, verdicts[name]) for change in ("a", "b") for name in verdicts]
    path = tmp_path / "certificate.csv"
    pd.DataFrame(rows, columns=["capacity", "changed", "verdict"]).to_csv(path, index=False)
    (table,) = tables.study([study[1][0]], ["eq3"], certificate_paths=[path]).itertuples()
    assert (table.c_nl_verdict, table.c_m_verdict) == ("mesh", "physics")
