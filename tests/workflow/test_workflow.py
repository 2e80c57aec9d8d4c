"""The DAG: what runs, what runs again, what does not. On a copy of the tree, so that files can be
edited."""

import os
import re
import shutil
import signal
import subprocess
import sys

import matplotlib as mpl
import matplotlib.image
import numpy as np
import pandas as pd
import pytest

from fiberweb import config, files, studies
from fiberweb.runs import runs
from fiberweb.simulation import dataset
from fiberweb.studies.ridge.best import best_unbuckled, read_best
from fiberweb.tools.status import status
from tests.workflow.conftest import ROOT, SMOKE, Tree

FINISH = {"table": 4, "figure": 1}
STUDIES = [name for name in studies.STUDIES if studies.setups(name)]
SMALL = """
scene: {duration: 4.0}
numerics: {accuracy: draft}
topology: {crosshatch: [2], polygon: []}
ridge: {n: 2, spacing: [0.06], force: [0.05]}
size: {n: [2], published_duration: 2.0, published_c_nl_force: [0.05], published_c_m_force: [0.05]}
pretension: {spacing: [0.06], tension: [0.01], published_force: [0.05]}
features: {n: 4, force: [0.05], verdict_force: 0.05}
capacity_origin: {n: [2], force_n: 2, force: [0.05], element: [0.02], step: [5.0e-6]}
memory_origin: {n: [2], filter_element: [0.02], filter_step: [5.0e-6]}
experiment: {duration: 8.0, skip: 100}
twin:
  n: [4]
  angle: [50.0]
  sensitivity: {angle: [50.0], tension: [], lever: [], direction: [], damping: [], loss_factor: [],
    bond_stiffness: [], youngs_modulus: []}
narma: {twin_n: 4}
"""
# the profile asks for an executor that only a cluster's user installs
CLUSTER = ("--profile", "profiles/slurm", "--executor", "local")
PAPER = config.load(ROOT / "config" / "config.yaml")
ALL = config.load(ROOT / "config" / "config.yaml", {"published_all": True})


def jobs(count, target="topology"):
    """Jobs of a fresh topology study of so many runs."""
    return {"warmup": 1, "simulate": count, "capacity": count, target: 1} | FINISH


def names(values, setup, of=STUDIES, best=None):
    """Names of the runs that studies ask for."""
    return {run.name for study in of for run in runs(values, study, setup, best)}


FREE = set(STUDIES) - {"size", "pretension"}  # of what the ridge finds


@pytest.mark.parametrize(
    ("target", "arguments", "expected", "engines"),
    [
        ("figures", (), names(PAPER, "described", FREE), 1),
        ("published", (), names(PAPER, "published"), 2),
        ("compliant", (), names(PAPER, "compliant", FREE), 2),
        ("published", (*CLUSTER, "--config", "published_all=True"), names(ALL, "published"), 2),
    ],
    ids=["figures", "published", "compliant", "published in full"],
)
def test_jobs_of_the_paper(tree, target, arguments, expected, engines):
    planned = tree.planned(target, *arguments)
    assert planned["simulate"] == len(expected)
    assert (planned["warmup"], planned["setup_claims"], planned[target]) == (engines, 1, 1)
    assert planned.get("ridge_best", 0) == (target != "published")


def test_jobs_of_one_study(tree):
    assert tree.planned("topology") == jobs(10)


def test_jobs_of_one_figure(tree):
    planned = tree.planned("new/figures/ridge.png", *SMOKE[:-1], "results=new")
    assert planned == {
        "warmup": 1, "simulate": 4, "capacity": 4, "table": 3, "figure": 1
    }  # fmt: skip


def test_every_study_is_a_target(tree):
    every = [*STUDIES, "accuracy"]
    planned = tree.jobs(*every, "--dry-run", *SMOKE[:-1], "results=new")
    assert {study: planned.get(study) for study in every} == dict.fromkeys(every, 1)


def test_the_report_has_a_page_for_all_that_is_no_picture(tree):
    made = files.Files(PAPER).products("described")
    planned = tree.planned("report_described")
    assert planned["page"] == sum(not file.endswith(".png") for file in made) + 1  # ridge_best.csv


def test_a_figure_behind_the_checkpoint_waits_for_it(tree):
    planned = tree.planned("new/figures/size.png", *SMOKE[:-1], "results=new")
    assert (planned["simulate"], planned["ridge_best"]) == (4, 1)  # the ridge's runs only


def test_a_misspelt_table_of_a_figure_is_named(tree):
    study = tree.folder / "fiberweb/studies/narma/__init__.py"
    text = study.read_text()
    study.write_text(text.replace('draw", tuple(TABLES)', 'draw", ("narma.cvs",)'))
    try:
        printed = tree.refused("narma")
    finally:
        study.write_text(text)
    assert "no study makes the table narma.cvs" in printed and "'narma.csv'" in printed


def test_a_study_that_the_workflow_needs_is_named(tree):
    registry = tree.folder / "fiberweb/studies/__init__.py"
    text = registry.read_text()
    for name in ("ridge", "buckling", "accuracy"):
        registry.write_text(text.replace(f'    "{name}",\n', ""))
        try:
            printed = tree.refused("topology")
        finally:
            registry.write_text(text)
        assert f"fiberweb/studies/__init__.py lacks '{name}'" in printed


def test_lint(tree):
    assert "in a good condition" in tree.snakemake("--lint")


def test_format():
    command = [sys.executable, "-m", "snakefmt", "--check", "Snakefile", "workflow/rules"]
    assert subprocess.run(command, cwd=ROOT, check=False).returncode == 0


def test_scripts_compute_nothing():
    for script in (ROOT / "workflow" / "scripts").glob("*.py"):
        assert len(script.read_text().splitlines()) < 40, script.name


@pytest.mark.slow
def test_smoke_writes_everything(smoked):
    out = smoked.folder / "out"
    values = config.load(smoked.folder / "config/config.yaml", smoked.folder / "config/smoke.yaml")
    best = read_best(out / "tables" / "described" / "ridge_best.csv")
    ran = {path.name for path in (out / "runs").iterdir()}
    assert ran == names(values, "described", best=best)
    table = pd.read_csv(out / "tables" / "described" / "topology.csv")
    assert list(table["n"]) == [2, 4, 6]
    assert set(table["setup"]) == {"described"} and set(table["status"]) == {"ok"}
    assert table["c_nl"].between(0, 1).all() and table["c_m"].between(0, 1).all()
    for study in (name for name in STUDIES if "described" in studies.setups(name)):
        for file in studies.load(study).TABLES:
            assert (out / "tables" / "described" / file).exists(), file
        for name in studies.load(study).FIGURES:
            assert np.ptp(mpl.image.imread(out / "figures" / f"{name}.png")) > 0.5, name
            assert (out / "figures" / f"{name}.pdf").read_bytes().startswith(b"%PDF"), name
    claims = pd.read_csv(out / "tables" / "described" / "claims.csv", index_col="id")
    judged = claims["verdict"].isin(["holds", "differs"])
    assert judged.any() and claims.loc[judged, "value"].notna().all()
    assert claims.loc["T1", "verdict"] == "not computed"  # it is of the 8x8
    assert claims.loc["G1", "verdict"] == "not applicable"
    assert (out / "provenance.json").exists()
    assert all(run in (out / f"logs/simulate/{run}.log").read_text() for run in ran)
    assert not (smoked.folder / "results").exists()  # dry runs of the paper write nothing


@pytest.mark.slow
def test_another_terminal_is_told_that_it_has_finished(smoked):
    said = status(smoked.folder / "out")
    assert re.match(r"finished at .*: (\d+) of \1 runs and (\d+) of \2 jobs done\n", said)


@pytest.mark.slow
def test_size_follows_the_best_force_of_the_ridge(smoked):
    tables = smoked.folder / "out" / "tables" / "described"
    found = best_unbuckled(pd.read_csv(tables / "ridge.csv"))
    assert found["force_N"].nunique() > 1  # so that it can be told from one force throughout
    size = pd.read_csv(tables / "size.csv")
    rows = size[["spacing_m", "force_choice", "force_N", "n"]]
    made = found[["spacing_m", "choice", "force_N"]].merge(pd.Series([2, 3], name="n"), how="cross")
    assert sorted(map(tuple, rows.values)) == sorted(map(tuple, made.values))


@pytest.mark.slow
@pytest.mark.parametrize("target", ["figures", "topology", "out/figures/size.png"])
def test_nothing_to_do_the_second_time(smoked, target):
    assert smoked.planned(target, *SMOKE) == {}


@pytest.mark.slow
def test_a_touch_reruns_nothing(smoked, edited):
    for module in (smoked.folder / "fiberweb").rglob("*.py"):
        edited(module, "")  # undone, since Numba compiles again what was touched
    assert smoked.planned("figures", *SMOKE) == {}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("module", "target", "expected"),
    [
        ("fiberweb/scoring/capacity.py", "topology", {"capacity": 3, "topology": 1} | FINISH),
        ("fiberweb/scoring/regression.py", "topology", {"capacity": 3, "topology": 1} | FINISH),
        ("fiberweb/scoring/tables.py", "topology", {"table": 3, "figure": 1, "topology": 1}),
        ("fiberweb/studies/topology/figure.py", "figures", {"figure": 1, "figures": 1}),
        ("fiberweb/studies/ridge/figure.py", "out/figures/ridge.png", {"figure": 1}),
        ("fiberweb/claims/judge.py", "topology", {}),
        ("fiberweb/engines/kirchhoff.py", "topology", jobs(3)),
        ("fiberweb/model/buckling.py", "topology", jobs(3)),
        ("fiberweb/studies/noise/__init__.py", "figures", {}),
        ("workflow/scripts/figure.py", "topology", {"figure": 1, "topology": 1}),
        ("README.md", "figures", {}),
    ],
)
def test_an_edit_reruns_what_depends_on_it(smoked, edited, module, target, expected):
    (smoked.folder / "README.md").touch()
    edited(module, "\nEDITED = True\n")
    assert smoked.planned(target, *SMOKE) == expected


@pytest.mark.slow
def test_a_comment_or_a_docstring_reruns_nothing(smoked, edited):
    for module in (smoked.folder / "fiberweb").rglob("*.py"):
        text = module.read_text().replace('"""', '"""Edited. ', 1)
        edited(module, "\n# edited\n", start=text)
    assert smoked.planned("figures", *SMOKE) == {}


@pytest.mark.slow
def test_another_rule_for_a_claim_measures_nothing_again(smoked, edited):
    edited("fiberweb/studies/size/claims.py", "\nEDITED = True\n")
    assert smoked.planned("figures", *SMOKE) == {"setup_claims": 1, "figures": 1}


@pytest.mark.slow
def test_another_alpha_simulates_nothing(smoked, edited):
    edited("config/smoke.yaml", "\nscoring:\n  alpha: 0.1\n")
    planned = smoked.planned("figures", *SMOKE)
    assert "simulate" not in planned and planned["capacity"] > 3


@pytest.mark.slow
@pytest.mark.parametrize(
    ("values", "target", "expected"),
    [
        ("topology: {crosshatch: [2, 4, 6]}", "topology", 1),
        ("ridge: {force: [0.05, 0.4]}", "out/tables/described/ridge.csv", 2),  # at two spacings
        ("features: {force: [0.06], verdict_force: 0.06}", "figures", 1),
        ("chaos: {buckling: [0.5, 0.7]}", "figures", 2),  # twins
    ],
    ids=["size", "force", "features", "chaos"],
)
def test_a_changed_point_is_simulated_alone(smoked, values, target, expected):
    (smoked.folder / "point.yaml").write_text(f"results: out\n{values}\n")
    planned = smoked.planned(target, "--configfile", "config/smoke.yaml", "point.yaml")
    assert (planned["simulate"], "warmup" in planned) == (expected, False)


@pytest.mark.slow
def test_certificates_where_the_config_asks_for_them(smoked):
    (smoked.folder / "certified.yaml").write_text(
        "results: certified\ncertify: true\nscene: {duration: 5}\nnumerics: {accuracy: draft}\n"
        "topology: {crosshatch: [2], polygon: []}\n"
    )
    asked = ("certified/tables/described/topology.csv", "--configfile", "certified.yaml")
    assert smoked.jobs(*asked)["certificate"] == 1
    (row,) = pd.read_csv(smoked.folder / asked[0]).itertuples()
    (path,) = (smoked.folder / "certified" / "runs").glob("*/certificate.csv")
    verdicts = pd.read_csv(path).groupby("capacity")["verdict"].first()
    assert (row.c_nl_verdict, row.c_m_verdict) == (verdicts["c_nl"], verdicts["c_m"])
    assert smoked.planned(*asked) == {}


@pytest.mark.slow
def test_an_unstable_run_is_a_result(smoked):
    (smoked.folder / "unstable.yaml").write_text(
        "results: blown\nscene: {duration: 4.0}\ntopology: {crosshatch: [2], polygon: []}\n"
        "numerics: {accuracy: null, time_step: 1.0e-3, force_time_step: true}\n"
    )
    smoked.snakemake("topology", "--configfile", "unstable.yaml")
    blown = smoked.folder / "blown"
    (response,) = blown.glob("runs/*/response.nc")
    attributes = dataset.load(response).attrs
    assert attributes["status"] == "unstable" and attributes["unstable_at"] < 4.0
    table = pd.read_csv(blown / "tables" / "described" / "topology.csv")
    assert list(table["status"]) == ["unstable"] and table["c_nl"].isna().all()
    assert (blown / "figures" / "topology.png").exists()


@pytest.mark.slow
def test_an_interrupt_keeps_what_is_finished(smoked):
    (smoked.folder / "stopped.yaml").write_text(
        "results: stopped\nscene: {duration: 20.0}\nnumerics: {accuracy: draft}\n"
        "topology: {crosshatch: [2, 4, 6, 8], polygon: []}\n"
    )
    call = [sys.executable, "-m", "snakemake", "topology", "--cores", "2"]
    running = subprocess.Popen(
        [*call, "--configfile", "stopped.yaml"],
        cwd=smoked.folder, env=smoked.environment, start_new_session=True, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    finished = 0
    for row in running.stdout:
        finished += row.startswith("Finished jobid") and "simulate" in row
        if finished == 1:
            os.killpg(running.pid, signal.SIGINT)  # as Ctrl-C does, to Snakemake and its jobs
    assert running.wait(timeout=60) != 0
    planned = smoked.planned("topology", "--configfile", "stopped.yaml")
    assert planned["simulate"] == 4 - finished > 0
    assert len(list((smoked.folder / "stopped").glob("runs/*/response.nc"))) >= finished


@pytest.mark.slow
def test_the_same_bytes_again(smoked):
    """On one core what two have made: one study from the start; tables and figures of one behind
    the checkpoint and an animation from the runs there are."""
    first, second = smoked.folder / "out", smoked.folder / "again"
    simulated_again = set(pd.read_csv(first / "tables/described/topology.csv")["run"])
    shutil.copytree(first / "runs", second / "runs", ignore=lambda *_: simulated_again)
    shutil.copytree(first / "warmup", second / "warmup")  # else newer than these runs
    targets = ("topology", "again/figures/size.png", "again/figures/buckling-B0.9.gif")
    smoked.snakemake(*targets, *SMOKE[:-1], "results=again", cores=1)
    files = [path for part in ("runs", "tables", "figures") for path in (second / part).rglob("*")]
    files = [path for path in files if path.is_file()]
    assert {"size.csv", "size.pdf", "topology.png", "topology_curves.csv"} <= {
        path.name for path in files
    }
    assert any(path.suffix == ".gif" for path in files)
    for path in files:
        assert path.read_bytes() == (first / path.relative_to(second)).read_bytes(), path.name


@pytest.mark.slow
def test_the_second_setup_leaves_the_first_alone(smoked, tmp_path):
    own = Tree(tmp_path)  # other tests look at the tables that it writes anew
    shutil.copytree(smoked.folder, own.folder, dirs_exist_ok=True)
    (own.folder / "small.yaml").write_text(f"results: out\n{SMALL}")
    small = ("--configfile", "small.yaml")
    own.snakemake("topology", *small)
    table = own.folder / "out" / "tables" / "described" / "topology.csv"
    before = table.read_bytes()
    studies = ("topology", "ridge", "size", "pretension", "features", "capacity_origin")
    drawn = [f"out/figures/{study}-published.png" for study in studies]
    own.snakemake(*drawn, *small)
    assert own.jobs(*drawn, "topology", "--dry-run", *small) == {}
    assert table.read_bytes() == before
    published = table.parents[1] / "published"
    assert set(pd.read_csv(published / "topology.csv")["setup"]) == {"published"}
    for figure in drawn:
        assert np.ptp(mpl.image.imread(own.folder / figure)) > 0.5


def test_neither_a_matplotlibrc_nor_a_notebooks_backend_changes_a_picture(
    smoked, tmp_path, monkeypatch
):
    drawn = [smoked.folder / "out" / "figures" / f"noise.{end}" for end in ("png", "pdf")]
    before = [path.read_bytes() for path in drawn]
    (tmp_path / "matplotlibrc").write_text("text.usetex: True\nfont.size: 30\n")
    monkeypatch.setitem(smoked.environment, "MATPLOTLIBRC", str(tmp_path / "matplotlibrc"))
    backend = "module://matplotlib_inline.backend_inline"
    monkeypatch.setitem(smoked.environment, "MPLBACKEND", backend)
    printed = smoked.snakemake("out/figures/noise.png", "--force", *SMOKE)
    assert "Drawing out/figures/noise.png" in printed
    assert [path.read_bytes() for path in drawn] == before
