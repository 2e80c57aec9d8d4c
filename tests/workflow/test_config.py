"""Bad input is one sentence before anything runs; the generated files match the models."""

import inspect
import os
import re
import subprocess
import sys
from dataclasses import fields
from itertools import product
from pathlib import Path

import pytest

from fiberweb import studies
from fiberweb.config import check_folders, load
from fiberweb.engines import ENGINES
from fiberweb.model.scene import Scene
from fiberweb.runs import DIGITS, Run, check, run_table, runs
from fiberweb.scoring import capacity
from fiberweb.sections import NumericsSection, SceneSection, SetupSection
from fiberweb.simulation.plan import ACCURACIES
from fiberweb.studies.base import CHOICES, HORIZON
from fiberweb.studies.topology import example
from fiberweb.tools import schema

ROOT = Path(__file__).parents[2]
SETUPS = ("described", "published", "compliant")
SIMULATED = [name for name in studies.STUDIES if studies.setups(name)]
PAPER = ROOT / "config" / "config.yaml"
SMOKE = ROOT / "config" / "smoke.yaml"

BAD = {
    "unknown key": ({"scene": {"diametre": 2e-3}}, ["diametre", "diameter"]),
    "unknown section": ({"topolgy": {}}, ["topolgy", "topology"]),
    "dotted key": (
        {"scene.duration": 20.0},
        ["'scene.duration'", "scene: {duration: ...}", "--config 'scene={duration: ...}'"],
    ),
    "no blank": ({"scene": {"duration:20": None}}, ["blank after the colon", "duration: 20"]),
    "negative diameter": (
        {"scene": {"diameter": -0.002}}, ["scene.diameter", "-0.002", "greater than 0", "m)"],
    ),
    "N = 1": ({"topology": {"crosshatch": [4, 1]}}, ["topology.crosshatch.1", "= 1", "to 2"]),
    "odd polygon": ({"topology": {"polygon": [7]}}, ["topology.polygon.0", "= 7", "multiple of 2"]),
    "no network": ({"topology": {"crosshatch": [], "polygon": []}}, ["topology", "at least one"]),
    "tension a word": (
        {"scene": {"tension": "tight"}}, ["scene.tension", "'tight'", "number", "N)"],
    ),
    "number as text": (
        {"scene": {"youngs_modulus": "1e8"}}, ["scene.youngs_modulus", "'1e8'", "1.0e+8"],
    ),
    "too short to score": (
        {"scene": {"duration": 0.5}}, ["scene.duration", "0.5 s", "horizon of 1 s", "3.2 s"],
    ),
    "blank before a name": (
        {"webs": {"networks": [{"name": " 007", "fibres": [[[0.0, 0.0], [1.0, 0.0]]]}]}},
        ["webs.networks.0.name", "' 007'", "without blanks at its ends"],
    ),
    "no marker": (
        {"recordings": [{"path": "x.csv", "read": {"markers": {}}}]},
        ["recordings.0.read.markers = {}", "name at least one marker"],
    ),
    "no such accuracy": (
        {"numerics": {"accuracy": "ultra"}}, ["numerics.accuracy", "'ultra'", "'fine'"],
    ),
    "accuracy and step": (
        {"numerics": {"time_step": 1e-5}}, ["numerics.accuracy", "time_step", "null"],
    ),
    "accuracy of nothing": (
        {"accuracy": {"networks": []}}, ["accuracy.networks = []", "list at least one"],
    ),
    "accuracy of stubby fibres": (
        {"accuracy": {"length": 0.01}}, ["accuracy.length = 0.01 m", "N = 4", "spacing"],
    ),
    "accuracy too short to score": (
        {"accuracy": {"duration": 1.0}}, ["accuracy.duration", "1 s", "horizon of 1 s"],
    ),
    "value for a section": ({"scene": 5}, ["scene", "5", "tension, duration"]),
    "word for a list": ({"topology": {"polygon": 6}}, ["topology.polygon", "6", "list"]),
    "no such ends": (
        {"setups": {"described": {"ends": "free"}}}, ["setups.described.ends", "'free'"],
    ),
    "negative force": ({"ridge": {"force": [-1.0]}}, ["ridge.force.0", "-1.0", "0 ", "N)"]),
    "no spacing": ({"ridge": {"spacing": []}}, ["ridge.spacing = []", "at least one", "m)"]),
    "more than all": ({"features": {"share": 2}}, ["features.share", "= 2", "less than 1"]),
    "a force short": (
        {"size": {"published_c_nl_force": [0.4]}},
        ["size.published_c_nl_force", "1 force", "ridge.spacing 14", "for each"],
    ),
    "a force too many": (
        {"pretension": {"spacing": [0.05], "published_force": [0.4, 0.4]}},
        ["pretension.published_force", "[0.4, 0.4]", "pretension.spacing"],
    ),
    "not on the ridge": (
        {"pretension": {"spacing": [0.055], "published_force": [0.4]}},
        ["pretension.spacing", "0.055 m", "ridge.spacing"],
    ),
    "published runs too short to score": (
        {"size": {"published_duration": 1.0}}, ["size.published_duration", "1 s", "2 s"],
    ),
    "no such order": ({"narma": {"order": [3]}}, ["narma.order.0", "= 3", "2, 5 or 10"]),
    "springs without stiffness": (
        {"setups": {"compliant": {"ends": "sprung"}}},
        ["setups.compliant.ends = 'sprung'", "give setups.compliant.end_stiffness in N/m"],
    ),
    "stiffness without springs": (
        {"setups": {"described": {"end_stiffness": 50.0}}},
        ["setups.described.end_stiffness = 50 N/m", "ends = 'sliding'", "ends: sprung"],
    ),
    "springs of no stiffness": (
        {"setups": {"described": {"ends": "sprung", "end_stiffness": 0.0}}},
        ["setups.described.end_stiffness = 0.0", "greater than 0", "N/m)"],
    ),
    "negative bond": (
        {"setups": {"described": {"bond_stiffness": -1.0}}},
        ["setups.described.bond_stiffness = -1.0", "equal to 0", "N m)"],
    ),
    "a gain": (
        {"setups": {"described": {"loss_factor": -0.1}}},
        ["setups.described.loss_factor = -0.1", "equal to 0"],
    ),
    "loss at rest": (
        {"setups": {"described": {"loss_frequency": 0.0}}},
        ["setups.described.loss_frequency = 0.0", "greater than 0", "Hz)"],
    ),
    "knots too high": ({"scene": {"lowest_knot": 1}}, ["scene.lowest_knot = 1", "-1 or 0"]),
    "diameters by fibre": (
        {"scene": {"diameter": [1e-3, 2e-3]}}, ["scene.diameter = [0.001", "number", "m)"],
    ),
    "a stroke": (
        {"scene": {"stroke": 0.02}}, ["'scene.stroke'", "studies see to it", "Scene(stroke=...)"],
    ),
    "a setup's key of the scene": (
        {"scene": {"ends": "sprung"}}, ["'scene.ends'", "setups: {described: {ends: ...}}"],
    ),
    "the scene's key of a setup": (
        {"setups": {"described": {"density": 1e3}}},
        ["'setups.described.density'", "scene: {density: ...}"],
    ),
    "not a number": ({"scene": {"density": float("nan")}}, ["scene.density", "nan", "finite"]),
}  # fmt: skip


def is_one_sentence(text):
    return "\n" not in text and "Traceback" not in text and ". " not in text


@pytest.mark.parametrize(("values", "words"), BAD.values(), ids=BAD)
def test_bad_value_is_one_sentence(values, words):
    with pytest.raises(ValueError) as caught:
        load(PAPER, values)
    text = str(caught.value)
    assert is_one_sentence(text)
    assert all(word in text for word in words), text


def test_results_that_cannot_be_written(tmp_path):
    (tmp_path / "file").touch()
    results = str(tmp_path / "file" / "results")
    with pytest.raises(ValueError) as caught:
        check_folders(load({"results": results}))
    text = str(caught.value)
    assert is_one_sentence(text)
    assert results in text and "cannot be written" in text


def test_folders_that_can_be_used_are_left_alone(tmp_path):
    (tmp_path / "table.csv").touch()
    results = tmp_path / "new" / "results"
    check_folders(load({"results": str(results), "published_tables": str(tmp_path)}))
    assert not results.parent.exists()


def test_authors_tables_that_are_not_there(tmp_path):
    with pytest.raises(ValueError, match=r"published_tables = .* holds no CSV file"):
        check_folders(load({"published_tables": str(tmp_path)}))


def test_time_step_above_the_limit_names_the_limit():
    config = load(PAPER, {"numerics": {"accuracy": None, "time_step": 1e-3}})
    run = runs(config, "topology", "described")[0]
    with pytest.raises(ValueError) as caught:
        run.check()
    text = str(caught.value)
    assert is_one_sentence(text)
    assert text.startswith(run.name) and "time_step = 0.001 s" in text and "limit of" in text


def test_a_step_is_checked_for_every_network_but_not_for_every_force(monkeypatch):
    checked = []
    monkeypatch.setattr(Run, "check", lambda run: checked.append(run))
    own_step = {"numerics": {"accuracy": None, "time_step": 1e-5}}
    check(runs(load(own_step), "ridge", "described"))
    assert len(checked) == 14
    checked.clear()
    check(runs(load(), "ridge", "described"))
    assert len(checked) == 1


def test_a_tension_that_no_fibre_holds_is_found_in_any_study():
    found = runs(load({"pretension": {"tension": [0.01, 400.0]}}), "pretension", "published")
    with pytest.raises(ValueError, match="tension = 400 N: no fibre holds") as caught:
        check(found)
    assert is_one_sentence(str(caught.value))


@pytest.mark.parametrize(
    ("overlay", "words"),
    [
        ("scene: {tension: tight}", "scene.tension = 'tight'"),
        ("results: Snakefile/results", "results = 'Snakefile/results' cannot be written"),
        ("numerics: {accuracy: null, time_step: 1.0e-3}", "time_step = 0.001 s"),
        ("scene: {duration: 20.0}\nscene: {tension: 1.0}", "gives scene twice, in lines 1 and 2"),
    ],
    ids=["value", "folder", "time step", "given twice"],
)
def test_the_workflow_prints_the_sentence_and_nothing_else(tmp_path, overlay, words):
    (tmp_path / "bad.yaml").write_text(overlay)
    command = [sys.executable, "-m", "snakemake", "figures", "--cores", "1"]
    done = subprocess.run(
        [*command, "--configfile", str(tmp_path / "bad.yaml")],
        cwd=ROOT, env=os.environ | {"PYTHONPATH": str(ROOT)}, capture_output=True, text=True,
    )  # fmt: skip
    snakemakes_own = ("Using workflow specific profile", "Config file config/config.yaml is ext")
    printed = [row for row in done.stderr.splitlines() if not row.startswith(snakemakes_own)]
    assert done.returncode != 0
    assert len(printed) == 1 and words in printed[0], done.stderr


def test_a_nested_key_on_the_command_line_is_laid_over_its_section(tmp_path):
    (tmp_path / "my.yaml").write_text("topology: {crosshatch: [2, 3], polygon: [6]}")
    given = ["scene={duration: 20, tension: 2e-2}", "topology={polygon: []}", "scoring={alpha: .5}"]
    done = subprocess.run(
        [sys.executable, "-m", "snakemake", "topology", "-n", "--cores", "1",
         "--configfile", str(tmp_path / "my.yaml"), "--config", f"results={tmp_path}", *given],
        cwd=ROOT, env=os.environ | {"PYTHONPATH": str(ROOT)}, capture_output=True, text=True,
    )  # fmt: skip
    expected = load({
        "scene": {"duration": 20.0, "tension": 0.02},
        "topology": {"crosshatch": [2, 3], "polygon": []},
    })  # fmt: skip
    simulated = set(re.findall(r"Simulating (\S+)", done.stdout + done.stderr))
    assert simulated == {run.name for run in runs(expected, "topology", "described")}


def test_the_committed_config_is_the_models_defaults():
    assert load(PAPER) == load()


def test_schema_has_not_drifted():
    assert (ROOT / "config" / "schema.json").read_text() == schema.schema()


def test_table_of_keys_has_not_drifted():
    assert (ROOT / "config" / "README.md").read_text().endswith(schema.table())


def test_every_key_says_what_it_means():
    assert all(all(cell for cell in row) for row in schema.rows(load()))


def test_choices_are_those_of_the_engines():
    fields = NumericsSection.model_json_schema()["properties"]
    assert fields["accuracy"]["anyOf"][0]["enum"] == list(ACCURACIES)
    assert fields["engine"]["anyOf"][0]["enum"] == list(ENGINES)


def test_horizon_is_that_of_the_scoring():
    assert inspect.signature(capacity.Options).parameters["horizon"].default == HORIZON


def test_smoke_is_a_small_overlay():
    paper, smoke = load(PAPER), load(PAPER, SMOKE)
    assert smoke.results != paper.results
    assert smoke.scene.duration < 10
    assert set(smoke.topology.crosshatch) <= set(paper.topology.crosshatch)
    for study in SIMULATED:
        assert all(runs(smoke, study, setup) for setup in studies.setups(study))


def best_of(config):
    """What the ridge could find: the same for both choices, the least force of the grid."""
    return dict.fromkeys(product(CHOICES, config.ridge.spacing), min(config.ridge.force))


@pytest.mark.parametrize("setup", SETUPS)
def test_smoke_has_few_runs(setup):
    config = load(PAPER, SMOKE)
    best = best_of(config)
    names = {run.name for study in SIMULATED for run in runs(config, study, setup, best)}
    assert len(names) <= 32  # some four seconds each, two at a time


def test_names_of_runs_are_stable():
    # frozen: a name that changes orphans every run that users have on disk; a new field of a scene
    # must not
    own = {"crossing_stiffness": 50.0, "crossing_damping": 1.0, "damping": 10.0}
    config = load({"setups": {"described": own, "compliant": own}})
    assert [runs(config, "topology", setup)[1].name for setup in SETUPS] == [
        "crosshatch-n04-s100.0mm-f50.1mN-t10.0mN-d91121582e87",
        "crosshatch-n04-s100.0mm-f50.0mN-t10.0mN-published-01523591b387",
        "crosshatch-n04-s100.0mm-f50.1mN-t10.0mN-compliant-46dbb8755908",
    ]


@pytest.mark.parametrize(("n", "seeds"), [(2, (4630, 7253)), (4, (962, 7837))])
def test_two_scenes_have_two_names(n, seeds):
    """These share six digits, as many as there were: one run for both, and a row lost. Other
    scenes need other seeds, by trial of some ten thousand."""
    values = {
        "scene": {"duration": 4.0},
        "numerics": {"accuracy": "draft"},
        "robustness": {"n": [n], "seed": list(seeds)},
    }
    names = {run.name for run in runs(load(PAPER, values), "robustness", "described")}
    assert len(names) == 2
    assert len({name[: 6 - DIGITS] for name in names}) == 1


def test_one_name_for_two_scenes_is_refused(monkeypatch):
    monkeypatch.setattr("fiberweb.runs.DIGITS", 1)
    with pytest.raises(ValueError, match=r"is the name of two scenes, .* and .*: change") as caught:
        run_table(load({"robustness": {"n": [4], "seed": list(range(1, 18))}}))
    assert is_one_sentence(str(caught.value))


def test_the_paper_has_ten_networks_in_each_setup():
    for setup in SETUPS:
        names = {run.name for run in runs(load(), "topology", setup)}
        assert len(names) == 10
        for other in ("published", "compliant"):
            assert all((other in name) == (setup == other) for name in names)


def test_published_in_full_is_what_the_authors_ran():
    """The paper's grids: 14 spacings x 18 forces; 14 spacings x 6 sizes at two forces, which
    agree at 5 spacings; 6 spacings x 6 tensions, the least of which is the ridge's; Eq. 3's force
    on the 4x4 and on the 6x6 is one of the ridge's and one of the features'."""
    config = load(PAPER, {"published_all": True})
    found = {
        study: runs(config, study, "published")
        for study in ("topology", "ridge", "size", "pretension", "features")
    }
    at_our_step = {run.name for run in found["size"] if run.numerics}
    names = {study: {run.name for run in of} - at_our_step for study, of in found.items()}
    counts = {"topology": 10, "ridge": 14 * 18, "size": (2 * 14 - 5) * 6, "pretension": 36}
    assert {study: len(of) for study, of in names.items()} == counts | {"features": 3}
    assert len(names["ridge"] & names["pretension"]) == 6
    assert len(set.union(*names.values())) == 431
    assert len(at_our_step) == 2 * 14 - 5
    assert {run.scene.duration for run in found["size"]} == {50.0}


def test_published_takes_the_forces_about_buckling():
    config = load({"ridge": {"published_forces": 4}})
    for spacing in config.ridge.spacing:
        numbers = [
            run.scene.buckling_number
            for run in runs(config, "ridge", "published")
            if run.scene.network.spacing == pytest.approx(spacing)
        ]
        assert sum(b < 1 for b in numbers) <= 2 and sum(b >= 1 for b in numbers) <= 2
        assert len(numbers) == 4 or spacing == 0.02  # of which one force alone is above


def test_size_and_pretension_start_from_what_the_ridge_found():
    config = load()
    best = best_of(config) | {("best_c_m", 0.05): 0.4}
    size = runs(config, "size", "described", best)
    assert len(size) == 2 * 14 * 6
    chosen = {
        (run.choice, run.scene.network.spacing, run.scene.force)
        for run in runs(config, "pretension", "described", best)
    }
    least = min(config.ridge.force)
    assert chosen == {
        ("best_c_m", s, 0.4 if s == 0.05 else least) for s in config.pretension.spacing
    }


def test_a_spacing_without_a_stable_run_is_left_out():
    config = load()
    size = runs(config, "size", "described", {("best_c_m", 0.05): 0.4})
    assert {run.choice for run in size} == {"best_c_m"}
    assert {round(run.scene.network.spacing, 9) for run in size} == {0.05}


def test_what_the_ridge_found_are_the_configs_own_values():
    """A table holds ten digits, and a run's name depends on all of them."""
    spacing, force = 1 / 30, 1 / 7
    config = load({
        "ridge": {"spacing": [spacing], "force": [force, 0.1]},
        "size": {"published_c_nl_force": [0.4], "published_c_m_force": [0.4]},
        "pretension": {"spacing": [spacing], "published_force": [0.4]},
    })  # fmt: skip
    best = {("best_c_m", float(f"{spacing:.10g}")): float(f"{force:.10g}")}
    ridge = {run.name for run in runs(config, "ridge", "described")}
    size = [run for run in runs(config, "size", "described", best) if run.scene.network.n == 4]
    assert [run.name in ridge for run in size] == [True]


def test_a_name_depends_on_scene_and_numerics_only():
    def name(values):
        return runs(load(values), "topology", "described")[0].name

    assert name({"scoring": {"alpha": 1.0}, "results": "elsewhere"}) == name({})
    assert name({"scene": {"seed": 1}}) != name({})
    assert name({"numerics": {"accuracy": "fine"}}) != name({})
    assert name({"scene": {"tension": 1}}) == name({"scene": {"tension": 1.0}})


def test_accuracy_is_of_all_setups_but_the_published():
    config = load({"numerics": {"accuracy": "draft"}})
    for setup in ("described", "compliant"):
        assert all(run.numerics == {"accuracy": "draft"} for run in runs(config, "topology", setup))
    assert all(run.numerics == {} for run in runs(config, "topology", "published"))


def test_setups_differ_as_the_config_says():
    config = load({"setups": {"described": {"damping": 20.0}}})
    described, published, compliant = (
        runs(config, "topology", setup)[-1].scene for setup in SETUPS
    )
    assert (described.damping, described.network.diagonals) == (20.0, "all")
    assert (published.damping, published.network.diagonals) == (10.0, "skip-one")
    assert (compliant.damping, compliant.network.diagonals) == (2.5, "all")
    assert runs(config, "topology", "published")[-1].scoring["skip"] == 300


def test_a_config_has_every_field_of_a_scene_that_studies_do_not_see_to():
    """Studies choose a force each, so that none can be given a stroke instead."""
    of_studies = {"network", "setup", "force", "stroke", "lever", "disturbance", "centre_lines"}
    keys = [*SceneSection.model_fields, *SetupSection.model_fields]
    assert len(keys) == len(set(keys))
    assert {field.name for field in fields(Scene)} - of_studies == set(keys)


@pytest.mark.parametrize("setup", SETUPS)
def test_springs_bonds_and_loss_of_a_setup_reach_its_scenes(setup):
    own = {
        "bond_stiffness": 0.1, "loss_factor": 0.05, "loss_frequency": 50.0, "ends": "sprung",
        "end_stiffness": 52.5,
    }  # fmt: skip
    config = load({"setups": {setup: own}, "topology": {"polygon": []}})
    for other in SETUPS:
        for run in runs(config, "topology", other):
            found = {name: getattr(run.scene, name) for name in own}
            assert found == own if other == setup else not (set(found.items()) & set(own.items()))


def test_an_input_of_one_sign_reaches_every_scene():
    config = load({"scene": {"lowest_knot": 0}})
    assert {run.scene.lowest_knot for run in run_table(config).values()} == {0}


def test_studies_share_a_scene_they_both_ask_for():
    config = load()
    table = run_table(config)
    names = [run.name for name in SIMULATED for run in runs(config, name, "described")]
    assert len(names) > len(set(names))
    assert set(names) <= set(table)


def test_the_same_network_twice_is_one_run():
    config = load({"topology": {"crosshatch": [4, 4], "polygon": []}})
    assert len(runs(config, "topology", "described")) == 1


def test_the_example_is_8x8_or_the_nearest_crosshatch():
    def chosen(crosshatch, polygon):
        config = load({"topology": {"crosshatch": crosshatch, "polygon": polygon}})
        (run,) = example(runs(config, "topology", "described"), config.topology)
        network = run.scene.network
        return network.topology, network.n

    assert chosen([2, 8, 12], [6]) == ("crosshatch", 8)
    assert chosen([2, 4], [8]) == ("crosshatch", 4)
    assert chosen([], [6, 12]) == ("polygon", 6)


def test_a_run_that_is_not_there_is_refused():
    table = run_table(load(PAPER))
    name = next(iter(table))
    with pytest.raises(ValueError, match=f"^there is no run '{name}x' .* such as {name}$"):
        table[f"{name}x"]
    assert table.get("nope") is None and "nope" not in table
