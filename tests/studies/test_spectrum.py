"""Bodies whose capacity is known have it, whatever the smooth input; tables and figure hold it."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from fiberweb import Scene, crosshatch
from fiberweb.config import load
from fiberweb.runs import runs
from fiberweb.scoring import capacity
from fiberweb.scoring.regression import scale_input
from fiberweb.simulation import dataset
from fiberweb.studies.spectrum import figure as plotting
from fiberweb.studies.spectrum import tables as spectrum
from tests.figures.legible import assert_legible, assert_written, marked, said
from tests.scoring.reservoirs import drive

RATE, STEP = 50.0, 10  # Hz; frames between knots
SIGNALS = 4  # of `made_up`


@pytest.fixture(scope="module")
def u():
    return drive(100.0)


def lagged(u, frames):
    return np.stack([np.r_[np.zeros(k), u[: len(u) - k]] for k in frames], axis=1)


def scored(u, signals, degree=10):
    found = spectrum.spectrum(u, RATE, STEP, signals, 0.01, degree)
    by = {name: found.groupby(name)["capacity"].sum().to_dict() for name in ("degree", "delay_s")}
    return found.iloc[0], by["degree"], by["delay_s"]


def test_a_delay_line_with_a_tap_each_knot_has_as_many_as_taps(u):
    total, degree, delay = scored(u, lagged(u, range(0, 4 * STEP, STEP)))
    assert total["ipc_low"] - 1e-5 <= 4.0 <= total["ipc_high"] + 1e-5
    assert degree == pytest.approx({1: 4.0} | dict.fromkeys(range(2, 11), 0.0), abs=1e-4)
    assert [round(at, 6) for at, c in delay.items() if c > 0.99] == [0.0, 0.2, 0.4, 0.6]


def test_taps_between_two_knots_say_little_that_is_new(u):
    total, _, _ = scored(u, lagged(u, range(STEP)))
    assert total["n_signals"] == STEP and 1.0 < total["ipc"] < 3.0


def test_powers_of_the_input_have_one_of_each_degree_and_remember_nothing(u):
    v = scale_input(u)
    total, degree, delay = scored(u, np.stack([v**power for power in range(1, 7)], axis=1))
    for each in range(1, 7):  # one in `VALUES_EACH` may be lost
        assert 1.0 - 1 / spectrum.VALUES_EACH < degree[each] < 1.05
    assert delay[0.0] == pytest.approx(total["ipc"], abs=0.1) and total["ipc"] <= 6.0
    assert degree[8] == degree[10] == 0.0


def test_a_product_of_two_knots_is_found_at_the_later_one(u):
    past = lagged(scale_input(u), [0, STEP])
    total, degree, delay = scored(u, past.prod(axis=1, keepdims=True))
    assert degree[2] == pytest.approx(total["ipc"], abs=0.05)
    assert 0.75 < delay[0.2] <= total["ipc"] <= 1.0


def test_noise_has_none(u):
    total, _, _ = scored(u, np.random.default_rng(2).standard_normal((len(u), 8)))
    assert total["ipc"] == total["ipc_low"] == total["ipc_high"] == 0.0


def test_short_runs_have_fewer_degrees_and_a_highest_degree_few_delays():
    whole = {1: 5, 2: 4, 3: 2, 4: 1, 5: 1} | dict.fromkeys(range(6, 11), 0)
    assert spectrum.affordable(10, 5, 74) == whole
    assert spectrum.affordable(4, 5, 9) == {1: 3, 2: 1, 3: 0, 4: 0}
    assert spectrum.affordable(10, 5, 8) == {1: 2, 2: 0, 3: 0}
    assert spectrum.affordable(10, 5, 0) == {1: 0}


@pytest.mark.parametrize("setup", ["described", "published", "compliant"])
def test_the_default_runs_are_those_of_other_studies(setup):
    config = load("config/config.yaml")
    ours, *others = (
        {run.name for run in runs(config, name, setup)}
        for name in ("spectrum", "topology", "ridge", "capacity_origin")
    )
    assert ours and ours <= set().union(*others)


def made_up(status="ok"):
    """Readouts that are u, its square, its cube and u one knot ago."""
    scene = Scene(crosshatch(2, length=0.5), duration=24.0, sample_rate=RATE)
    u = drive(24.0)
    moved = np.stack([np.stack([u, u**2], -1), np.stack([np.roll(u, STEP), u**3], -1)], 1)
    if status == "unstable":
        moved[len(moved) // 2 :] = np.nan
    return xr.Dataset(
        {"input": ("time", u), "displacement": (("time", "readout", "axis"), 1e-3 * moved)},
        {"time": scene.times, "axis": ["x", "y"]},
        {
            "status": status, "setup": scene.setup, "sample_rate": scene.sample_rate,
            "scene": scene.to_json(), "run": f"run-{status}", "engine": "kirchhoff",
        },
    )  # fmt: skip


@pytest.fixture(scope="module")
def paths(tmp_path_factory):
    folder = tmp_path_factory.mktemp("spectrum")
    for status in ("ok", "unstable"):
        dataset.save(made_up(status), folder / status / "response.nc")
    return [folder / status / "response.nc" for status in ("ok", "unstable")]


@pytest.fixture(scope="module")
def table(paths):
    given = [capacity.score(made_up(status), alpha=0.1) for status in ("ok", "unstable")]
    return spectrum.table(given, paths, ["eq3", "grid"], alpha=0.1, degree=4)


def test_the_table_adds_up_to_the_total_of_each_run(table):
    stable = table[table["status"] == "ok"]
    assert not stable.duplicated(["run", "degree", "delay_s"]).any()
    assert stable["capacity"].sum() == pytest.approx(stable["ipc"].iloc[0])
    assert 3.0 < stable["ipc"].iloc[0] <= stable["n_signals"].iloc[0] == SIGNALS
    assert set(stable["degree"]) == {1, 2, 3, 4}
    at_once = stable[(stable["degree"] == 1) & (stable["capacity"] > 0.9)]
    np.testing.assert_allclose(at_once["delay_s"], [0.0, 0.2])


def test_an_unstable_run_has_one_row_without_numbers(table):
    unstable = table[table["status"] == "unstable"]
    assert len(unstable) == 1 and unstable["force_choice"].item() == "grid"
    empty = [*spectrum.TOTALS, *spectrum.RANKS, *spectrum.SPLIT_COLUMNS]
    assert unstable[empty].isna().all(axis=None)


def test_baselines_see_the_input_alone(paths):
    # of an unstable run the input is whole
    found = [spectrum.baselines(path, alpha=0.01, degree=4) for path in paths]
    pd.testing.assert_frame_equal(*found)
    totals = found[0].groupby("readout")["ipc"].first()
    assert totals["u"] == pytest.approx(1.0, abs=0.05)
    assert totals["delay line"] == pytest.approx(4.0, abs=0.05)  # of degree 4, delays go to 3
    lines = found[0][found[0]["readout"] == "delay line"]
    assert lines["n_signals"].iloc[0] == 6


def drawn_tables():
    """Three sizes, and three forces of which the last was unstable."""
    rows = []
    for choice, n, number in [("eq3", 2, 0.2), ("eq3", 4, 0.3), ("eq3", 6, 0.4),
                              ("grid", 4, 0.5), ("grid", 4, 1.0), ("grid", 4, 2.0)]:  # fmt: skip
        body = {"setup": "described", "n": n, "buckling_number": number, "force_N": number}
        body |= {"force_choice": choice, "status": "ok", "run": f"{choice}-{number}"}
        body |= {"n_signals": 30 * n, "effective_rank": 2.5, "kernel_rank": 9.0 if n < 6 else None}
        split = {(1, 0.0): 1.0, (1, 0.2): 0.5, (2, 0.0): number, (2, 0.2): 0.0}
        total = sum(split.values())
        body |= {"ipc": total, "ipc_low": total - 0.1, "ipc_high": total + 0.1}
        rows += [body | {"degree": d, "delay_s": at, "capacity": c} for (d, at), c in split.items()]
    table = pd.DataFrame(rows)
    last = table["run"] == "grid-2.0"
    table = table[~last | ~table["run"].duplicated()]
    table.loc[last, ["ipc", "ipc_low", "ipc_high", "degree", "delay_s", "capacity"]] = np.nan
    table.loc[last, ["n_signals", "effective_rank", "kernel_rank"]] = np.nan
    table.loc[last, "status"] = "unstable"
    alone = table[table["run"] == "eq3-0.2"][[*table.columns[7:]]]
    readouts = plotting.READOUTS
    baselines = pd.concat([alone.assign(readout=name) for name in readouts], ignore_index=True)
    return {"spectrum": table, "spectrum_baselines": baselines}


def test_the_figure_stacks_the_total_by_degree_and_by_delay(tmp_path):
    given = drawn_tables()
    figure = plotting.draw(given, "described", tmp_path / "spectrum.png")
    assert_written(tmp_path / "spectrum.png")
    assert_legible(figure)
    totals = given["spectrum"].groupby("run")["ipc"].first()
    by_degree, by_delay, against, forced = figure.axes[:4]
    for ax in (by_degree, by_delay):
        tops = {at: 0.0 for at in range(7)}
        for bar in ax.patches:
            at = round(bar.get_x() + bar.get_width() / 2)
            tops[at] = max(tops[at], bar.get_y() + bar.get_height())
        sizes = totals[["eq3-0.2", "eq3-0.3", "eq3-0.4"]]
        np.testing.assert_allclose([*tops.values()], [*sizes, *[sizes.iloc[0]] * 4])
    assert [list(mark.get_xdata()) for mark in marked(forced)] == [[2]]
    np.testing.assert_allclose(against.lines[0].get_ydata(), [60, 120, 180])
    np.testing.assert_allclose(against.lines[3].get_ydata(), sizes)
    assert "Longest delay (ms)" in said(figure) and "signals (the bound)" in said(figure)
    with pytest.raises(ValueError, match="no run of the published setup"):
        plotting.draw(given, "published", tmp_path / "none.png")
