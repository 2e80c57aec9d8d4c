"""The grid against the paper's four numbers: the misfit, the best point, what it says of the
defaults, and the figure."""

import itertools
import sys

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from fiberweb import Scene, crosshatch
from fiberweb.scoring import tables
from fiberweb.simulation import dataset
from fiberweb.studies.calibration import figure as plotting
from fiberweb.studies.calibration import tables as calibration
from fiberweb.tables import write
from tests.figures.legible import BASELINES, assert_legible, assert_written, marked, said

EXACT = {"c_p4": 0.999, "c_p7": 0.896, "recall_200ms": 0.997, "recall_400ms": 0.713}


def capacity_file(folder, name, n, status="ok", **scene):
    """A capacity file in which c is the paper's at four targets, and 0.5 elsewhere."""
    scene = Scene(crosshatch(n, length=0.5), "compliant", **scene)
    orders, lags = np.arange(1, 11), np.arange(251) / 250
    nonlinear, memory = np.full(10, 0.5), np.full(251, 0.5)
    nonlinear[[3, 6]] = EXACT["c_p4"], EXACT["c_p7"]
    memory[[50, 100]] = EXACT["recall_200ms"], EXACT["recall_400ms"]
    if status == "unstable":
        nonlinear[:], memory[:] = np.nan, np.nan
    scored = xr.Dataset(
        {"nonlinear": ("order", nonlinear), "memory": ("lag", memory)}
        | {scalar: 0.5 for scalar in tables.SCALARS},
        {"order": orders, "lag": lags},
        {
            "status": status, "scene": scene.to_json(), "run": name, "engine": "kirchhoff",
            "elements_per_section": 4, "time_step": 1e-5,
        },
    )  # fmt: skip
    dataset.save(scored, folder / f"{name}.nc")
    return folder / f"{name}.nc"


def grid(**misfits):
    """A table of 8x8 runs with these misfits, by "k_nu_gamma"."""
    rows = []
    for name, value in misfits.items():
        point = map(float, name[1:].split("_"))
        row = dict(zip(calibration.GRID, point, strict=True)) | {"misfit": value, "n": 8}
        rows.append(row | {"setup": "compliant"} | dict.fromkeys(EXACT, 0.9))
    return pd.DataFrame(rows)


def test_the_papers_numbers_are_those_of_the_claims():
    assert {name: value for name, (value, _) in calibration.paper().items()} == EXACT
    assert [tolerance for _, tolerance in calibration.paper().values()] == [0.005, 0.05, 0.01, 0.1]


def test_a_tolerance_off_in_each_number_is_a_misfit_of_four():
    off = [value + tolerance for value, tolerance in calibration.paper().values()]
    assert calibration.misfit(off) == pytest.approx(4.0)
    assert calibration.misfit(list(EXACT.values())) == 0.0


def test_the_table_reads_the_four_targets_and_keeps_the_columns_of_a_study(tmp_path):
    paths = [
        capacity_file(tmp_path, "dense", 8),
        capacity_file(tmp_path, "sparse", 4),
        capacity_file(tmp_path, "wild", 8, status="unstable", damping=20.0),
    ]
    frame = calibration.table(paths)
    generic = tables.study(paths, ["eq3"] * 3)
    assert list(frame.columns) == [*generic.columns, *EXACT, "misfit"]
    pd.testing.assert_frame_equal(frame[generic.columns], generic)
    rows = frame.set_index("run")
    assert rows.loc["dense", list(EXACT)].to_dict() == EXACT
    assert rows.loc["dense", "misfit"] == 0.0
    assert np.isnan(rows.loc["sparse", "misfit"])  # the four are the 8x8's
    assert np.isnan(rows.loc["wild", "misfit"]) and rows.loc["wild", "status"] == "unstable"


def test_best_is_the_least_misfit_of_the_stable_runs():
    frame = grid(p70_3_10=4.0, p40_3_10=2.0, p100_3_10=np.nan)
    assert calibration.best(frame)["crossing_stiffness_N_m"] == 40.0
    with pytest.raises(ValueError, match="no stable run of the 8x8 crosshatch"):
        calibration.best(frame.assign(misfit=np.nan))


@pytest.mark.parametrize(
    ("misfits", "agrees", "words"),
    [
        ({"p70_3_2.5": 2.0, "p40_3_10": 3.0}, True, "are the grid's best: misfit 2.00"),
        ({"p70_3_2.5": 2.004, "p40_3_10": 1.996}, True, "are the grid's best"),  # a tie
        ({"p70_3_2.5": 3.0, "p40_3_10": 2.0}, False, "best, k = 40 N/m, nu = 3 N s/m, gamma = 10"),
        ({"p70_3_2.5": np.nan, "p40_3_10": 2.0}, False, "no stable 8x8 run in this grid"),
        ({"p40_3_10": 2.0}, False, "no stable 8x8 run in this grid"),
    ],
)
def test_the_verdict_on_the_defaults(misfits, agrees, words):
    """The defaults of the compliant setup are k = 70 N/m, nu = 3 N s/m and gamma = 2.5 /s."""
    agreed, sentence = calibration.verdict(calibration.check(grid(**misfits)))
    assert agreed == agrees
    assert words in sentence


def test_a_grid_without_a_stable_run_has_no_best_point():
    check = calibration.check(grid(**{"p70_3_2.5": np.nan}))
    assert list(check["role"]) == ["default", "paper", "tolerance"]
    agrees, sentence = calibration.verdict(check)
    assert not agrees and "no stable run of the 8x8 crosshatch" in sentence


def run_main(monkeypatch, path):
    monkeypatch.setattr(sys, "argv", ["calibration", str(path)])
    calibration.main()


def test_the_command_prints_the_verdict(monkeypatch, tmp_path, capsys):
    write(grid(**{"p70_3_2.5": 2.0}, p40_3_10=3.0), tmp_path / "calibration.csv")
    run_main(monkeypatch, tmp_path / "calibration.csv")
    assert "are the grid's best" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("frame", "words"),
    [
        (grid(**{"p70_3_2.5": 3.0}, p40_3_10=2.0), "but the grid's best"),
        (pd.DataFrame({"setup": ["compliant"]}), "has the column 'crossing_stiffness_N_m'"),
    ],
)
def test_the_command_fails_with_one_sentence(monkeypatch, tmp_path, frame, words):
    write(frame, tmp_path / "calibration.csv")
    with pytest.raises(SystemExit, match=words) as stopped:
        run_main(monkeypatch, tmp_path / "calibration.csv")
    assert "\n" not in stopped.value.code  # text: Python prints it and exits with 1


# --- the figure ---


@pytest.fixture(scope="module")
def points():
    """A grid of the calibration whose best point is not the defaults'; one run unstable."""
    axes = ([40.0, 70.0, 100.0], [2.0, 3.0, 5.0], [1.0, 2.5], [4, 8])
    rows = [
        dict(zip((*calibration.GRID, "n"), point, strict=True))
        | {"setup": "compliant", "status": "ok", "c_nl": 0.8, "c_m": 0.4}
        | {"c_nl_se": 0.01, "c_m_se": 0.02}
        | dict.fromkeys(calibration.TARGETS, 0.9)
        | {"misfit": point[0] + point[1] + point[2] if point[3] == 8 else np.nan}
        for point in itertools.product(*axes)
    ]
    rows[-1] |= dict.fromkeys(("misfit", *calibration.TARGETS, "c_nl", "c_m"), np.nan)
    rows[-1]["status"] = "unstable"
    table = pd.DataFrame(rows)
    return {
        "calibration": table,
        "calibration_check": calibration.check(table),
        "ridge_baselines": BASELINES,
    }


@pytest.fixture(scope="module")
def drawn(points, tmp_path_factory):
    path = tmp_path_factory.mktemp("figures") / "calibration.png"
    return plotting.draw(points, "compliant", path), path


def test_the_figure_is_written_and_legible(drawn):
    assert_written(drawn[1])
    assert_legible(drawn[0])


def test_baselines_of_the_calibration_may_be_missing(points, unsaved):
    tables = {name: table for name, table in points.items() if name != "ridge_baselines"}
    figure = plotting.draw(tables, "compliant", "unsaved")
    assert "readouts made of the input alone" not in said(figure)


def test_best_and_defaults_are_marked_where_they_are(drawn):
    """Best at k = 40, nu = 2, gamma = 1: the first cell of the first map; the defaults, k = 70,
    nu = 3, gamma = 2.5, in the middle of the second."""
    figure = drawn[0]
    first, second = figure.subfigs[0].axes[:2]
    (star,), (box,) = marked(figure, "best"), marked(figure, "default")
    assert star.axes is first and np.round(star.get_xydata()).tolist() == [[0, 0]]
    assert box.axes is second and np.round(box.get_center()).tolist() == [1, 1]
    (cross,) = marked(figure, "unstable")
    assert cross.axes is second and cross.get_xydata().tolist() == [[2, 2]]
    assert "43.0" in said(figure)  # misfit of the best


def test_the_best_points_are_listed_by_misfit(drawn, points):
    ax = drawn[0].subfigs[1].axes[0]
    labels = [label.get_text().split("   ")[0] for label in ax.get_yticklabels()]
    assert labels[0] == "40, 2, 1"
    assert labels[-1] == "70, 3, 2.5"  # the defaults come last where they are not among the best
    first = points["calibration"].dropna(subset="misfit").sort_values("misfit")
    first = first[list(calibration.GRID)][: plotting.SHOWN].to_numpy()
    assert labels[:-1] == ["{:g}, {:g}, {:g}".format(*point) for point in first]


def test_a_grid_of_one_point_is_drawn(points, tmp_path):
    table = points["calibration"]
    one = table[(table["misfit"] == 75.5)]
    tables = {"calibration": one, "calibration_check": calibration.check(one)}
    figure = plotting.draw(tables, "compliant", tmp_path / "one.png")
    assert marked(figure, "best") and marked(figure, "default")


def test_a_grid_without_a_stable_run_is_x_s(points, unsaved):
    lost = dict.fromkeys(("misfit", *calibration.TARGETS, "c_nl", "c_m"), np.nan)
    table = points["calibration"].assign(status="unstable", **lost)
    tables = {"calibration": table, "calibration_check": calibration.check(table)}
    figure = plotting.draw(tables, "compliant", "lost.png")
    assert [len(mark.get_xdata()) for mark in marked(figure, "unstable")] == [9, 9]
    assert not marked(figure, "best")


def test_every_capacity_of_panel_b_has_its_standard_error_as_a_bar(drawn, points):
    figure, _ = drawn
    table = points["calibration"]
    shown = table[table["misfit"].notna()].sort_values("misfit")[: plotting.SHOWN]
    shown = [*shown.index, *table.index[(table["misfit"] == 75.5)]]  # and the defaults
    for ax, name, error in zip(figure.subfigs[1].axes[-2:], ("c_nl", "c_m"), (0.01, 0.02)):
        dense = ax.containers[1]
        bars = np.array(dense.lines[2][0].get_segments())
        np.testing.assert_allclose(bars.mean(axis=1)[:, 0], table.loc[shown, name])
        np.testing.assert_allclose(np.ptp(bars[:, :, 0], axis=1), 2 * error)
