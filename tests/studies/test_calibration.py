"""The grid against the paper's four numbers: the misfit, the best point, and what it says of the
defaults."""

import sys

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from fiberweb import Scene, crosshatch
from fiberweb.scoring import tables
from fiberweb.simulation import dataset
from fiberweb.studies.calibration import tables as calibration
from fiberweb.tables import write

EXACT = {"c_p4": 0.999, "c_p7": 0.896, "recall_200ms": 0.997, "recall_400ms": 0.713}


def capacity_file(folder, name, n, status="ok", **scene):
    """A capacity file in which c is the paper's at four targets, and 0.5 elsewhere."""
    scene = Scene(crosshatch(n, length=0.5), **scene)
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
        rows.append(row | {"setup": "described"} | dict.fromkeys(EXACT, 0.9))
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
    """The defaults of the described setup are k = 70 N/m, nu = 3 N s/m and gamma = 2.5 /s."""
    found, sentence = calibration.verdict(calibration.check(grid(**misfits)))
    assert found == agrees
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
        (pd.DataFrame({"setup": ["described"]}), "has the column 'crossing_stiffness_N_m'"),
    ],
)
def test_the_command_fails_with_one_sentence(monkeypatch, tmp_path, frame, words):
    write(frame, tmp_path / "calibration.csv")
    with pytest.raises(SystemExit, match=words) as stopped:
        run_main(monkeypatch, tmp_path / "calibration.csv")
    assert "\n" not in stopped.value.code  # text: Python prints it and exits with 1
