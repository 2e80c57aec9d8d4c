"""Points, tables and figures of the twin, on made-up responses."""

import numpy as np
import pytest

from fiberweb.config import load
from fiberweb.runs import runs
from fiberweb.scoring import capacity, groups
from fiberweb.scoring.camera import film
from fiberweb.scoring.recording import signals
from fiberweb.simulation import dataset
from fiberweb.studies.twin import figure, observations, of_angles, of_sensitivity, tables
from fiberweb.studies.twin import sensitivity as panel
from fiberweb.tables import read, write
from tests.figures.legible import assert_legible, assert_written, marked, said
from tests.studies.experiment import SMALL, asked_for, response

TWIN = {
    "twin": {
        "n": [4, 6], "angle": [25.0, 50.0],
        "sensitivity": {
            "angle": [50.0], "tension": [3.0], "lever": [], "direction": [1], "damping": [],
            "loss_factor": [], "bond_stiffness": [], "youngs_modulus": [], "marker_noise": [0.0],
        },
    }
}  # fmt: skip


# --- points -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("angle", "stroke"), [(25.0, 29.58e-3), (40.0, 45.00e-3), (50.0, 53.62e-3)]
)
def test_strokes_are_sines_of_the_angles(angle, stroke):
    """70 mm sin(angle), away from the springs of vertical fibres."""
    scenes = {round(p.scene.motor_angle, 9): p.scene for p in asked_for("twin")[:12]}
    scene = scenes[angle]
    assert scene.stroke == pytest.approx(-stroke, abs=1e-5)
    assert (scene.lever, scene.lowest_knot, scene.drive_rate) == (0.07, 0, 2.0)
    assert (scene.ends, scene.end_stiffness, scene.tension) == ("sprung", 52.5, 1.0)
    assert scene.diameter == 0.45e-3 and scene.network.length == 0.52
    assert np.isinf(scene.crossing_stiffness) and np.isinf(scene.bond_stiffness)


def test_one_simulation_serves_all_cameras_and_both_setups():
    config = load()
    named = {setup: runs(config, "twin", setup) for setup in ("described", "published")}
    names = {setup: {run.name for run in of} for setup, of in named.items()}
    assert names["described"] == names["published"]
    by_noise = {
        run.choice: run.name for run in named["described"]
        if run.choice.startswith("marker_noise") and run.scene.network.n == 6
    }  # fmt: skip
    assert len(by_noise) == 4 and len(set(by_noise.values())) == 1
    assert {run.camera["frame_step"][0] for run in named["described"]} == {1}
    ours, theirs = (named[setup][0].scoring for setup in named)
    assert ours == {"scoring": "clean", "alpha": 1.0, "skip": 500}
    assert theirs["shuffle"] and theirs["overshoot"] == (2.0, 1.5)


def test_a_sensitivity_changes_one_thing():
    points = asked_for("twin", **TWIN)
    assert len(points) == 2 * 2 + 4 * 2
    by_choice = {p.choice: p for p in points if p.scene.network.n == 6 and p.scene.motor_angle > 49}
    same, tense, pulled, sharp = (
        by_choice[name] for name in ("same", "tension=3", "direction=1", "marker_noise=0")
    )
    assert (same.scene.tension, tense.scene.tension) == (1.0, 3.0)
    assert pulled.scene.stroke == -same.scene.stroke
    assert sharp.scene == same.scene and (same.camera["noise"], sharp.camera["noise"]) == (0.1, 0.0)


def test_runs_of_the_figure_and_of_the_panel():
    config = load(SMALL, TWIN)
    of = runs(config, "twin", "described")
    assert [run.choice for run in of_angles(of, config.twin)] == ["angle"] * 4
    chosen = of_sensitivity(of, config.twin)
    assert [run.choice for run in chosen].count("same") == 2  # both sizes at 50 degrees
    assert len(chosen) == 2 + 6


def test_elements_are_no_longer_than_asked_for():
    """Four in the 104 mm of a 4x4's sections, two in the 74 mm of a 6x6's, and as few in the panel,
    where the 6x6 is the same run."""
    of = {}
    for run in runs(load(), "twin", "described"):
        of.setdefault((run.choice, run.scene.network.n), set()).add(run.numerics["accuracy"])
    assert (of["angle", 4], of["angle", 6]) == ({"standard"}, {"draft"})
    assert (of["same", 4], of["damping=1", 6]) == ({"draft"}, {"draft"})
    with pytest.raises(ValueError, match=r"element = 0\.001 m is shorter than .* 'reference'"):
        asked_for("twin", experiment={"duration": 8.0, "skip": 30, "element": 0.001})


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"experiment": {"duration": 6.0}}, r"experiment.duration = 6 s .* record at least"),
        ({"experiment": {"direction": 0}}, "experiment.direction = 0"),
        ({"experiment": {"frame_step": [0]}}, "experiment.frame_step.0 = 0"),
        ({"twin": {"angle": [90.0]}}, "twin.angle.0 = 90"),
    ],
)
def test_bad_values_are_one_sentence(values, words):
    with pytest.raises(ValueError, match=words) as caught:
        load(values)
    assert "\n" not in str(caught.value)


# --- tables -------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """Tables of the study in both setups as read back, and the responses by choice, size, angle."""
    folder, found = tmp_path_factory.mktemp("twin"), {}
    made = {}
    for setup in ("described", "published"):
        points = asked_for("twin", setup, **TWIN)
        paths = []
        for number, point in enumerate(points):
            lost = point.choice == "tension=3" and point.scene.network.n == 4
            run = response(point.scene, f"run-{number}", "unstable" if lost else "ok")
            paths.append(folder / f"{number}.nc")
            dataset.save(run, paths[-1])
            at = round(point.scene.motor_angle)
            found[setup, point.choice, point.scene.network.n, at] = run, point
        how = {"scoring": points[0].scoring}
        main = [n for n, p in enumerate(points) if p.choice == "angle"]
        few = [n for n, p in enumerate(points) if p.choice != "angle"]
        of_main = {
            "response_paths": [paths[n] for n in main],
            "cameras": [points[n].camera for n in main],
        }
        made[setup] = {
            "twin": tables.by_readouts(**of_main, **how),
            "twin_curves": tables.curves(**of_main, **how),
            "twin_sensitivity": tables.sensitivity(
                [paths[n] for n in few], [points[n].camera for n in few],
                [points[n].choice for n in few], **how,
            ),
        }  # fmt: skip
        made[setup]["twin_observations"] = observations.table(made[setup]["twin_sensitivity"])
        for name, frame in made[setup].items():
            write(frame, folder / f"{name}.csv")
            made[setup][name] = read(folder / f"{name}.csv")
    return made, found


def test_one_row_for_each_run_reading_and_set(study):
    table = study[0]["described"]["twin"]
    assert list(table.columns) == list(tables.COLUMNS)
    assert len(table) == 4 * 2 * len(tables.READOUTS)
    assert set(table["setup"]) == {"described"} and set(table["frame_step"]) == {1, 2}
    assert (table["verdict"] == (table["frame_step"] == 1)).all()
    counts = table[table["n"] == 6].groupby("readouts")["n_signals"].first()
    assert counts["all"] == 2 * 119  # 120 markers less the driven one
    assert counts["lateral_midpoints"] == 2 * 6 * 7 - 1
    assert (counts["u"], counts["derivatives"], counts["powers"]) == (1, 4, 3)
    assert table[table["n"] == 4].groupby("readouts")["n_signals"].first()["all"] == 2 * 55


@pytest.mark.parametrize("setup", ["described", "published"])
def test_a_row_is_the_score_of_the_film(study, setup):
    made, found = study
    run, point = found[setup, "angle", 6, 50]
    camera = point.camera | {"frame_step": 2}
    seen = film(run, **camera)
    mask = groups.mask("near_springs", point.scene.network, seen)
    expected = capacity.score_arrays(
        seen["input"].values, signals(seen)[:, mask], 60.0, **point.scoring
    )
    table = made[setup]["twin"]
    (row,) = table.query(
        "n == 6 and angle_deg == 50 and frame_step == 2 and readouts == 'near_springs'"
    ).to_dict("records")
    assert row["setup"] == setup and row["stroke_m"] == pytest.approx(point.scene.stroke)
    assert row["c_nl"] == pytest.approx(expected.c_nl, abs=2e-3)  # the file rounds the motion
    assert row["recall_500ms"] == pytest.approx(expected.memory[30], abs=2e-3)


def test_curves_are_those_of_the_totals(study):
    for setup in ("described", "published"):
        table, curves = (study[0][setup][name] for name in ("twin", "twin_curves"))
        at = "n == 4 and angle_deg == 25 and frame_step == 1 and readouts == 'all'"
        shown = curves.query(at)
        of_order, of_lag = (shown[shown["target"] == name] for name in ("order", "lag"))
        assert list(of_order["at"]) == list(range(1, 11)) and len(of_lag) == 61
        (row,) = table.query(at).to_dict("records")
        assert row["c_nl"] == pytest.approx(of_order["c"].clip(lower=0).mean())
        assert row["c_m"] == pytest.approx(of_lag["c"].clip(lower=0).mean())


def test_the_panel_has_every_value_and_an_unstable_one_without_numbers(study):
    table = study[0]["described"]["twin_sensitivity"]
    assert set(table["parameter"]) == {"none", "tension", "direction", "marker_noise"}
    assert table.loc[table["parameter"] == "none", "value"].isna().all()
    lost = table[table["status"] == "unstable"]
    assert set(lost["parameter"]) == {"tension"} and set(lost["n"]) == {4}
    alone = lost["readouts"].isin(tables.TRIVIAL)
    assert lost.loc[~alone, "c_nl"].isna().all() and lost.loc[alone, "c_nl"].notna().all()
    verdicts = study[0]["described"]["twin_observations"]
    assert set(verdicts["parameter"]) == set(table["parameter"])
    of_lost = verdicts[verdicts["parameter"] == "tension"].set_index("observation")
    assert (
        of_lost.loc["E1", "verdict"] == "not computed" and "unstable" in of_lost.loc["E1", "text"]
    )
    assert of_lost.loc["E3", "verdict"] in ("holds", "differs")  # of the 6x6 alone


# --- figures ------------------------------------------------------------------------------------


def test_the_figure_is_legible_and_says_what_it_shows(study, tmp_path):
    picture = figure.draw(study[0]["published"], "published", tmp_path / "twin.png")
    assert_written(tmp_path / "twin.png")
    assert_legible(picture)
    words = said(picture)
    for word in ("4×4", "6×6", "the authors' scoring", "one frame in 2, taken", "degrees"):
        assert word in words, word
    with pytest.raises(ValueError, match="no run of the described setup"):
        figure.draw(study[0]["published"], "described", tmp_path / "none.png")


def test_bars_of_groups_are_those_of_the_table(study, unsaved):
    made = study[0]["described"]
    picture = figure.draw(made, "described", "unsaved")
    table = made["twin"].query("verdict and angle_deg == 50")
    for ax, name in zip(picture.subfigs[2].axes, ("c_nl", "c_m")):
        for n, bars in zip((4, 6), np.array_split(ax.patches, 2)):
            expected = table[table["n"] == n].set_index("readouts").loc[[*figure.GROUPS], name]
            np.testing.assert_allclose([bar.get_height() for bar in bars], expected)


def test_the_panel_marks_unstable_runs(study, tmp_path):
    made = study[0]["described"]
    picture = panel.draw(made, "described", tmp_path / "panel.png")
    assert_written(tmp_path / "panel.png")
    assert_legible(picture)
    assert len(marked(picture)) == 2  # one run, in two axes
    for word in ("pretension", "pull to\nsprings", "noise", "holds", "differs", "unstable run"):
        assert word in said(picture), word
