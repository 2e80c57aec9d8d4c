"""Tables, figure and claims of the features study, on made-up responses."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from fiberweb import Scene, crosshatch
from fiberweb.claims import judge as claims
from fiberweb.config import Config
from fiberweb.scoring import capacity, groups, tables
from fiberweb.scoring.recording import signals
from fiberweb.simulation import dataset
from fiberweb.studies.features import figure as plotting
from fiberweb.studies.features import tables as features
from fiberweb.tables import read, write
from tests.figures.legible import assert_legible, assert_written, marked, said

RATE = 25.0
BASELINES = pd.DataFrame({"readout": ["u", "powers"], "c_nl": [0.14, 0.41], "c_m": [0.09, 0.28]})
SCORES = {  # C_nl, C_m of a network that agrees with every claim
    "all": (0.80, 0.50), "crossing_x": (0.55, 0.15), "crossing_y": (0.55, 0.20),
    "horizontal_midpoint_x": (0.60, 0.20), "horizontal_midpoint_y": (0.70, 0.45),
    "vertical_midpoint_x": (0.70, 0.20), "vertical_midpoint_y": (0.60, 0.20),
    "lateral_midpoints": (0.78, 0.45), "near_springs": (0.74, 0.48), "near_actuation": (0.68, 0.30),
}  # fmt: skip


def response(force, status="ok", setup="described"):
    """Readouts that follow powers and delays of the input."""
    network = crosshatch(4, length=0.5)
    scene = Scene(network, setup=setup, force=force, duration=12.0, sample_rate=RATE)
    points = groups.readouts(network)
    random = np.random.default_rng(3)
    u = np.interp(scene.times, np.arange(0, 13, 0.2), random.uniform(-1, 1, 65))
    basis = np.column_stack([u, u**2, u**3, np.roll(u, 4), np.roll(u, 9)])
    moved = basis @ random.normal(size=(5, 2 * len(points)))
    moved += 0.01 * random.normal(size=moved.shape)
    moved = 1e-3 * moved.reshape(len(u), 2, -1).transpose(0, 2, 1)
    if status == "unstable":
        moved[50:] = np.nan
    return xr.Dataset(
        {"input": ("time", u), "displacement": (("time", "readout", "axis"), moved)},
        {"axis": ["x", "y"], "time": np.arange(len(u)) / RATE}
        | {c: ("readout", points[c]) for c in ("kind", "fibre", "section")},
        {
            "status": status, "setup": setup, "sample_rate": RATE, "scene": scene.to_json(),
            "run": f"run-{force}", "engine": "none", "elements_per_section": 1, "time_step": 1e-3,
        },
    )  # fmt: skip


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """Tables of two stable runs and an unstable one, as read back, and the runs as stored."""
    folder = tmp_path_factory.mktemp("features")
    runs = [response(0.1), response(0.2), response(0.9, "unstable")]
    paths = []
    for number, run in enumerate(runs):
        paths.append((folder / f"{number}c.nc", folder / f"{number}r.nc"))
        dataset.save(capacity.score(run), paths[-1][0])
        dataset.save(run, paths[-1][1])
    runs = [dataset.load(path) for _, path in paths]
    frames = {
        "features": features.group_table(*zip(*paths), ["grid"] * 3, 0.1, 0.2),
        "features_greedy": features.greedy_table(paths[1][1], 0.1, 0.95),
        "features_baselines": tables.input_baselines(paths[1][1], alpha=0.1),
        "unstable": features.greedy_table(paths[2][1], 0.1, 0.95),
    }
    for name, frame in frames.items():
        write(frame, folder / f"{name}.csv")
    stored = [dataset.load(path) for _, path in paths]
    return {name: read(folder / f"{name}.csv") for name in frames}, stored


def test_one_row_for_each_run_group_and_split(study):
    table = study[0]["features"]
    assert len(table) == 3 * len(groups.GROUPS) * 2
    assert {*tables.COLUMNS, "force_choice", *features.GROUP_COLUMNS} <= set(table.columns)
    assert set(table.loc[table["verdict"], "force_N"]) == {0.2}
    assert set(zip(table["split"], table["scoring"])) == {
        ("chronological", "clean"), ("shuffled", "published"),
    }  # fmt: skip


def test_a_group_is_scored_on_its_own_signals(study):
    frames, runs = study
    u, moved = runs[1]["input"].values, signals(runs[1])
    network = crosshatch(4, length=0.5)
    some = moved[:, groups.mask("near_actuation", network, runs[1])]
    table = frames["features"]
    rows = table[(table["force_N"] == 0.2) & (table["group"] == "near_actuation")]
    chronological, shuffled = (rows[rows["split"] == s].iloc[0] for s in rows["split"])
    expected = capacity.score_arrays(u, some, RATE, alpha=0.1)
    assert chronological["c_nl"] == pytest.approx(expected.c_nl)
    assert chronological["c_m_se"] == pytest.approx(expected.c_m_se)
    assert (chronological["n_signals"], shuffled["n_signals"]) == (32, 32)
    authors = {"scoring": "published", "shuffle": True}
    expected = capacity.score_arrays(u, some, RATE, alpha=0.1, **authors)
    assert shuffled["c_nl"] == pytest.approx(expected.c_nl)


def test_an_unstable_run_keeps_its_rows_without_numbers(study):
    frames, _ = study
    table = frames["features"]
    rows = table[table["status"] == "unstable"]
    assert set(rows["force_N"]) == {0.9} and len(rows) == 2 * len(groups.GROUPS)
    assert rows[["c_nl", "c_m_se", "effective_rank"]].isna().all(axis=None)
    assert list(frames["unstable"]["target"]) == ["c_m", "c_nl"]
    assert frames["unstable"]["c_nl"].isna().all()


def test_greedy_rows_name_their_signals_and_end_with_all(study):
    frames, runs = study
    greedy = frames["features_greedy"]
    assert list(greedy.columns) == list(features.GREEDY_COLUMNS)
    for target, rows in greedy.groupby("target"):
        assert list(rows["n_chosen"]) == list(range(1, 113))
        assert not rows.duplicated(["kind", "fibre", "section", "axis"]).any()
        assert rows["kept"].iloc[-1] == 1.0
        needed = rows["needed"].iloc[0]
        assert (rows["kept"].iloc[needed - 1 :] >= 0.95).all()
        whole = capacity.score_arrays(runs[1]["input"].values, signals(runs[1]), RATE, alpha=0.1)
        assert rows[target].iloc[-1] == pytest.approx(getattr(whole, target), abs=1e-6)
    assert needed < 20  # five directions and little noise


def test_the_figure_marks_unstable_runs_and_shows_the_share(study, tmp_path):
    frames = study[0] | {"features_baselines": BASELINES}
    figure = plotting.draw(frames, "described", tmp_path / "features.png")
    assert_written(tmp_path / "features.png")
    groups_at = np.arange(len(plotting.NAMES)) + plotting.BAR  # the last force's
    for mark in marked(figure, "unstable"):  # of C_nl and C_m
        np.testing.assert_allclose(mark.get_xdata(), groups_at)
    assert len(marked(figure)) == 2
    words = said(figure)
    needed = frames["features_greedy"].groupby("target")["needed"].first()
    for count in needed:
        assert f"{count} signals\nkeep 95 %" in words
    assert_legible(figure)
    assert "4×4 crosshatch (described setup)" in words and "verdicts" in words
    with pytest.raises(ValueError, match="no run of the published setup"):
        plotting.draw(frames, "published", tmp_path / "none.png")


def test_a_figure_whose_verdict_is_unstable_is_drawn(study, unsaved):
    frames = study[0] | {"features_baselines": BASELINES}
    frames["features"] = frames["features"].assign(verdict=frames["features"]["force_N"] == 0.9)
    frames["features_greedy"] = frames["unstable"]
    figure = plotting.draw(frames, "described", "unsaved")
    places = [len(mark.get_xdata()) for mark in marked(figure)]
    assert places == [len(plotting.NAMES)] * 2 + [1, 1]  # bars and curves, of C_nl and of C_m


def test_bars_are_the_scores_of_the_chronological_split(study, unsaved):
    given = study[0] | {"features_baselines": BASELINES}
    figure = plotting.draw(given, "described", "unsaved")
    scored = given["features"].query("split == 'chronological' and status == 'ok'")
    for ax, name in zip(figure.subfigs[1].axes, ("c_nl", "c_m")):
        bars = np.array([(bar.get_x() + plotting.BAR / 2, bar.get_height()) for bar in ax.patches])
        expected = [
            (place + shift, scored.query("force_N == @force and group == @group")[name].item())
            for force, shift in ((0.1, -plotting.BAR), (0.2, 0.0))
            for place, group in enumerate(plotting.NAMES)
        ]
        np.testing.assert_allclose(bars, expected, atol=1e-9)


def test_the_curves_are_what_the_chosen_signals_keep(study, unsaved):
    figure = plotting.draw(study[0] | {"features_baselines": BASELINES}, "described", "unsaved")
    curves, _ = figure.subfigs[2].subfigs
    for ax, target in zip(curves.axes, ("c_nl", "c_m")):
        greedy = study[0]["features_greedy"]
        rows = greedy[greedy["target"] == target]
        (curve,) = (line for line in ax.lines if len(line.get_xdata()) == len(rows))
        np.testing.assert_array_equal(curve.get_xydata(), rows[["n_chosen", "kept"]])


def scores(changed=(), split="chronological", force=0.2):
    table = pd.DataFrame.from_dict(SCORES, orient="index", columns=["c_nl", "c_m"])
    for group, column, value in changed:
        table.loc[group, column] = value
    table = table.rename_axis("group").reset_index()
    n_signals = table["group"].map({"all": 240, "lateral_midpoints": 84}).fillna(40)
    return table.assign(
        n_signals=n_signals, setup="published", split=split, force_N=force, verdict=force == 0.2
    )


def judge(name, table):
    rules = ["fiberweb.studies.features.claims"]
    row = claims.evaluate({"features": table}, "published", rules).set_index("id").loc[name]
    return row["value"], row["verdict"]


@pytest.mark.parametrize("name", [f"F{number}" for number in range(1, 8)])
def test_claims_hold_for_a_network_that_agrees(name):
    text, verdict = judge(name, scores())
    assert verdict == "holds" and text


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("F1", ("crossing_y", "c_nl", 0.90)),
        ("F1", ("crossing_x", "c_m", 0.60)),
        ("F1", ("vertical_midpoint_y", "c_nl", 0.74)),
        ("F2", ("crossing_y", "c_m", 0.36)),
        ("F3", ("lateral_midpoints", "c_nl", 0.75)),
        ("F4", ("lateral_midpoints", "c_m", 0.42)),
        ("F4", ("lateral_midpoints", "n_signals", 120)),
        ("F5", ("near_springs", "c_nl", 0.82)),
        ("F5", ("near_springs", "c_m", 0.41)),
        ("F5", ("near_springs", "c_m", 0.56)),
        ("F6", ("near_actuation", "c_nl", 0.75)),
        ("F7", ("near_actuation", "c_m", 0.38)),
    ],
)
def test_claims_differ_beyond_their_allowance(name, change):
    group, column, value = change
    table = scores()
    table.loc[table["group"] == group, column] = value
    assert judge(name, table)[1] == "differs"


def test_the_verdict_is_the_verdict_forces_and_the_others_are_printed():
    off = [("near_actuation", "c_nl", 0.1)]
    table = pd.concat([scores(), scores(off, "shuffled"), scores(off, force=0.85)])
    assert judge("F6", table) == ("0.850 (0.2 N shuffled: 0.125; 0.85 N: 0.125)", "holds")
    assert judge("F6", scores(force=0.85)) == ("no run at the verdict force", "not computed")
    unstable = scores().assign(c_nl=np.nan, c_m=np.nan)
    assert judge("F6", unstable) == ("the run at 0.2 N is unstable", "not computed")
    with pytest.raises(ValueError, match=r"several runs at 0\.2 N"):
        judge("F6", pd.concat([scores(), scores()]))


def test_the_verdict_force_must_be_run():
    with pytest.raises(ValueError, match=r"verdict_force = 0\.3 is not among features\.force"):
        Config(features={"verdict_force": 0.3})
