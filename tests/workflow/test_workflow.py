"""The DAG: what runs, what runs again, what does not. On a copy of the tree, so that files can be
edited, and with a kernel cache of its own."""

import ast
import os
import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pandas as pd
import pytest

from fiberweb import config
from fiberweb.runs import STUDIES, runs
from fiberweb.simulation import dataset
from fiberweb.studies.ridge.best import best_unbuckled, read_best

ROOT = Path(__file__).parents[2]
COPIED = ("Snakefile", "config", "envs", "fiberweb", "profiles", "workflow")
FINISH = {"topology_tables": 1, "topology_figure": 1, "merge": 2}
SMOKE = ("--configfile", "config/smoke.yaml", "--config", "results=out")
SMALL = """
scene: {duration: 4.0}
numerics: {accuracy: draft}
topology: {crosshatch: [2], polygon: []}
ridge: {n: 2, spacing: [0.06], force: [0.05]}
size: {n: [2], published_duration: 2.0, published_c_nl_force: [0.05], published_c_m_force: [0.05]}
pretension: {spacing: [0.06], tension: [0.01], published_force: [0.05]}
features: {n: 4, force: [0.05], verdict_force: 0.05}
memory_origin: {n: [2]}
"""
# the profile asks for an executor that only a cluster's user installs
CLUSTER = ("--profile", "profiles/slurm", "--executor", "local")
PAPER = config.load(ROOT / "config" / "config.yaml")


def jobs(count, target="topology"):
    """Jobs of a fresh topology study of so many runs."""
    return {"warmup": 1, "simulate": count, "capacity": count, target: 1} | FINISH


def names(made, setup, studies=STUDIES, best=None, full=False):
    """Names of the runs that studies ask for."""
    return {run.name for study in studies for run in runs(made, study, setup, best, full)}


class Tree:
    """A copy of what the workflow needs, and Snakemake in it."""

    def __init__(self, folder):
        self.folder = folder / "tree"
        self.folder.mkdir()
        for name in COPIED:
            source = ROOT / name
            copy = shutil.copytree if source.is_dir() else shutil.copy2
            copy(source, self.folder / name)
        self.environment = os.environ | {
            "PYTHONPATH": str(self.folder),
            "FIBERWEB_CACHE": str(folder / "cache"),
        }
        self.environment.pop("NUMBA_CACHE_DIR", None)

    def snakemake(self, *arguments, cores=2):
        """Standard error of a call that must succeed."""
        done = subprocess.run(
            [sys.executable, "-m", "snakemake", *arguments, "--cores", str(cores)],
            cwd=self.folder, env=self.environment, capture_output=True, text=True,
        )  # fmt: skip
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout + done.stderr

    def jobs(self, *arguments):
        """Count of jobs by rule; {} if there is nothing to do."""
        printed = self.snakemake(*arguments)
        if "Nothing to be done" in printed:
            return {}
        table = printed.split("Job stats:\n")[1].split("\n\n")[0]
        counts = dict(re.findall(r"^(\w+) +(\d+)$", table, flags=re.MULTILINE))
        assert int(counts.pop("total")) == sum(map(int, counts.values()))
        return {rule: int(count) for rule, count in counts.items()}

    def planned(self, *arguments):
        return self.jobs(*arguments[:1], "--dry-run", *arguments[1:])


@pytest.fixture(scope="module")
def tree(tmp_path_factory):
    return Tree(tmp_path_factory.mktemp("workflow"))


@pytest.fixture(scope="module")
def smoked(tree):
    """The tree after the smoke run."""
    tree.snakemake("figures", *SMOKE)
    return tree


@pytest.fixture
def edited(smoked):
    """Append a line to a file of the tree; undone after the test, time stamps included."""
    kept = []

    def edit(name, text="\n# edited\n"):
        path = smoked.folder / name
        kept.append((path, path.read_bytes(), path.stat()))
        path.write_bytes(path.read_bytes() + text.encode())

    yield edit
    for path, content, stat in reversed(kept):
        path.write_bytes(content)
        os.utime(path, ns=(stat.st_atime_ns, stat.st_mtime_ns))


FREE = set(STUDIES) - {"size", "pretension"}  # of what the ridge finds


@pytest.mark.parametrize(
    ("target", "arguments", "expected"),
    [
        ("figures", (), names(PAPER, "described", FREE)),
        ("published", (), names(PAPER, "published")),
        ("published_all", CLUSTER, names(PAPER, "published", full=True)),
    ],
    ids=["figures", "published", "published_all"],
)
def test_jobs_of_the_paper(tree, target, arguments, expected):
    planned = tree.planned(target, *arguments)
    assert planned["simulate"] == len(expected)
    assert (planned["warmup"], planned["claims"], planned[target]) == (1, 1, 1)
    assert planned["topology_figure"] == 1
    assert planned.get("ridge_best", 0) == (target == "figures")


def test_jobs_of_one_study(tree):
    assert tree.planned("topology") == jobs(10)


def test_jobs_of_one_figure(tree):
    planned = tree.planned("new/figures/ridge.png", *SMOKE[:-1], "results=new")
    assert (planned["simulate"], planned["capacity"], planned["study_figure"]) == (4, 4, 1)
    assert "claims" not in planned and "merge" not in planned


def test_a_figure_behind_the_checkpoint_waits_for_it(tree):
    planned = tree.planned("new/figures/size.png", *SMOKE[:-1], "results=new")
    assert (planned["simulate"], planned["ridge_best"]) == (4, 1)  # the ridge's runs only


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
    made = config.load(smoked.folder / "config/config.yaml", smoked.folder / "config/smoke.yaml")
    best = read_best(out / "tables" / "described" / "ridge_best.csv")
    ran = {path.name for path in (out / "runs").iterdir()}
    assert ran == names(made, "described", best=best)
    table = pd.read_csv(out / "tables" / "topology.csv")
    assert list(table["n"]) == [2, 4, 6]
    assert set(table["setup"]) == {"described"} and set(table["status"]) == {"ok"}
    for study in STUDIES:
        assert len(pd.read_csv(out / "tables" / f"{study}.csv")) > 0, study
        assert (out / "figures" / f"{study}.png").stat().st_size > 10_000, study
    assert (out / "figures" / "topology.pdf").exists()
    assert len(pd.read_csv(out / "tables" / "claims.csv")) > 30
    assert (out / "benchmarks" / "provenance.json").exists()
    assert all(run in (out / f"logs/simulate/{run}.log").read_text() for run in ran)
    assert not (smoked.folder / "results").exists()


@pytest.mark.slow
def test_size_follows_the_best_force_of_the_ridge(smoked):
    tables = smoked.folder / "out" / "tables"
    found = best_unbuckled(pd.read_csv(tables / "ridge.csv"))
    assert found["force_N"].nunique() > 1  # so that it can be told from one force throughout
    size = pd.read_csv(tables / "size.csv")
    rows = size[["spacing_m", "force_choice", "force_N", "n"]]
    made = found[["spacing_m", "choice", "force_N"]].merge(pd.Series([2, 3], name="n"), how="cross")
    assert sorted(map(tuple, rows.values)) == sorted(map(tuple, made.values))


@pytest.mark.slow
@pytest.mark.parametrize("target", ["figures", "topology", "claims", "out/figures/size.png"])
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
        ("fiberweb/capacity.py", "topology", {"capacity": 3, "topology": 1} | FINISH),
        ("fiberweb/plotting/topology.py", "topology", {"topology_figure": 1, "topology": 1}),
        ("fiberweb/plotting/ridge.py", "out/figures/ridge.png", {"study_figure": 1}),
        ("fiberweb/claims.py", "topology", {}),
        ("fiberweb/engines/kirchhoff.py", "topology", jobs(3)),
        ("fiberweb/studies.py", "figures", {}),
        ("workflow/scripts/merge.py", "topology", {"merge": 2, "topology": 1}),
        ("README.md", "figures", {}),
    ],
)
def test_an_edit_reruns_what_depends_on_it(smoked, edited, module, target, expected):
    (smoked.folder / "README.md").touch()
    edited(module)
    assert smoked.planned(target, *SMOKE) == expected


@pytest.mark.slow
def test_another_rule_for_a_claim_measures_nothing_again(smoked, edited):
    edited("fiberweb/claims_sweeps.py")
    planned = smoked.planned("figures", *SMOKE)
    assert planned["claims"] == 1 and not {"simulate", "capacity"} & set(planned)


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
    table = pd.read_csv(blown / "tables" / "topology.csv")
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
    simulated_again = set(pd.read_csv(first / "tables" / "topology.csv")["run"])
    shutil.copytree(first / "runs", second / "runs", ignore=lambda *_: simulated_again)
    shutil.copy2(first / "warmup.done", second)  # else newer than these runs
    targets = ("topology", "again/figures/size.png", "again/figures/buckling.png")
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
def test_the_second_setup_joins_the_tables_for_good(smoked):
    """Last: it adds to what the tests above look at."""
    (smoked.folder / "small.yaml").write_text(f"results: out\n{SMALL}")
    small = ("--configfile", "small.yaml")
    smoked.snakemake("topology", *small)
    smoked.snakemake("published", *small)
    for target in ("published", "topology"):
        assert smoked.planned(target, *small) == {}, target
    out = smoked.folder / "out"
    table = pd.read_csv(out / "tables" / "topology.csv")
    assert table["setup"].value_counts().to_dict() == {"described": 1, "published": 1}
    for study in ("topology", "ridge", "size", "pretension", "features"):
        assert (out / "figures" / f"{study}-published.png").exists()
    # a setup that is not complete is not begun by the other's target
    published = next(run for run in table["run"] if "published" in run)
    (out / "runs" / published / "capacity.nc").unlink()
    assert smoked.planned("topology", *small) == {"merge": 2, "topology": 1}


def listed():
    """The modules that each rule names under `input: code=`, by its script; for the rule that
    draws several studies, by the study's module."""
    texts = [path.read_text() for path in (ROOT / "workflow" / "rules").glob("*.smk")]
    values = {
        name: ast.literal_eval(value)
        for text in texts
        for name, value in re.findall(
            r"^([A-Z_]+) = (\(\n.*?^\)|\{\n    \"\w+\": \[.*?^\})", text, re.MULTILINE | re.DOTALL
        )
    }
    found = {}
    for rule in (part for text in texts for part in re.split(r"(?m)^(?:rule|checkpoint) ", text)):
        # up to the bracket that closes it, with at most one pair inside
        if call := re.search(r"code=(lambda \w+: )?code\(((?:[^()]|\([^()]*\))*)\)", rule):
            script = Path("workflow/scripts") / re.search(r"scripts/(\w+\.py)", rule)[1]
            for study in values["DRAWN_FROM"] if call[1] else [None]:
                names = values | {"wildcards": SimpleNamespace(study=study)}
                patterns = eval(f"[{call[2]}]", {}, names)
                start = Path(f"fiberweb/plotting/{study}.py") if study else script
                found[str(start)] = {p for each in patterns for p in (ROOT / "fiberweb").glob(each)}
    return found


def imported(file):
    """Modules of the package that a file imports, anywhere in it."""
    names = set()
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("fiberweb"):
            if node.module == "fiberweb.tables" and [a.name for a in node.names] == [
                "write"
            ]:
                continue  # how a table is written is no reason to measure or simulate again
            names |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "import_module":
            parts = node.args[0].values
            names.add("".join(p.value if isinstance(p, ast.Constant) else "*" for p in parts))
    return {path for name in names for path in ROOT.glob(name.replace(".", "/") + ".py")}


@pytest.mark.parametrize("start", listed())
def test_rules_name_the_modules_they_use(start):
    """Followed through imports, except into modules that only read and write for this rule."""
    computing = {"simulate.py": {"dataset.py"}, "topology_tables.py": {"tables.py"}}
    shut = {"dataset.py", "tables.py"} - computing.get(Path(start).name, set())
    queue, used = [ROOT / start], set()
    while queue:
        file = queue.pop()
        if file.name not in shut:
            new = imported(file) - used
            used |= new
            queue += new
    messages_only = {ROOT / "fiberweb" / name for name in ("errors.py", "explain.py")}
    missing = {str(path.relative_to(ROOT)) for path in used - messages_only - listed()[start]}
    assert not missing
