"""The DAG: what runs, what runs again, what does not. On a copy of the tree, so that files can be
edited, and with a kernel cache of its own."""

import ast
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

from fiberweb.dataset import load

ROOT = Path(__file__).parents[2]
COPIED = ("Snakefile", "config", "envs", "fiberweb", "profiles", "workflow")
FINISH = {"topology_tables": 1, "topology_figure": 1, "merge": 2, "claims": 1}
SMOKE = ("--configfile", "config/smoke.yaml", "--config", "results=out")


def jobs(runs, target="figures"):
    """Jobs of a fresh study of so many runs."""
    return {"warmup": 1, "simulate": runs, "capacity": runs, target: 1} | FINISH


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

    def snakemake(self, *arguments):
        """Standard error of a call that must succeed."""
        done = subprocess.run(
            [sys.executable, "-m", "snakemake", *arguments, "--cores", "2"],
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
    assert tree.jobs("figures", *SMOKE) == jobs(3)
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


@pytest.mark.parametrize("target", ["figures", "published"])
def test_jobs_of_the_paper(tree, target):
    assert tree.planned(target) == jobs(10, target)


def test_jobs_of_one_study(tree):
    expected = jobs(10, "topology")
    del expected["claims"]
    assert tree.planned("topology") == expected


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
    table = pd.read_csv(out / "tables" / "topology.csv")
    assert list(table["n"]) == [2, 4, 6]
    assert set(table["setup"]) == {"described"} and set(table["status"]) == {"ok"}
    assert {path.name for path in (out / "runs").iterdir()} == set(table["run"])
    assert len(pd.read_csv(out / "tables" / "claims.csv")) > 30
    assert (out / "figures" / "topology.png").stat().st_size > 10_000
    assert (out / "figures" / "topology.pdf").exists()
    assert (out / "benchmarks" / "provenance.json").exists()
    assert all(run in (out / f"logs/simulate/{run}.log").read_text() for run in table["run"])
    assert not (smoked.folder / "results").exists()


@pytest.mark.slow
@pytest.mark.parametrize("target", ["figures", "topology", "claims"])
def test_nothing_to_do_the_second_time(smoked, target):
    assert smoked.jobs(target, *SMOKE) == {}


@pytest.mark.slow
def test_a_touch_reruns_nothing(smoked, edited):
    for module in (smoked.folder / "fiberweb").rglob("*.py"):
        edited(module, "")  # undone, since Numba compiles again what was touched
    assert smoked.planned("figures", *SMOKE) == {}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("module", "expected"),
    [
        ("fiberweb/capacity.py", {"capacity": 3, "figures": 1} | FINISH),
        ("fiberweb/plotting/topology.py", {"topology_figure": 1, "figures": 1}),
        ("fiberweb/claims.py", {"claims": 1, "figures": 1}),
        ("fiberweb/engines/kirchhoff.py", jobs(3)),
        ("workflow/scripts/merge.py", {"merge": 2, "claims": 1, "figures": 1}),
        ("README.md", {}),
    ],
)
def test_an_edit_reruns_what_depends_on_it(smoked, edited, module, expected):
    (smoked.folder / "README.md").touch()
    edited(module)
    assert smoked.planned("figures", *SMOKE) == expected


@pytest.mark.slow
def test_another_alpha_simulates_nothing(smoked, edited):
    edited("config/smoke.yaml", "\nscoring:\n  alpha: 0.1\n")
    assert smoked.planned("figures", *SMOKE) == {"capacity": 3, "figures": 1} | FINISH


@pytest.mark.slow
def test_a_larger_study_keeps_the_runs_it_has(smoked):
    path = smoked.folder / "larger.yaml"
    path.write_text("results: out\ntopology: {crosshatch: [2, 4, 6]}\n")
    planned = smoked.planned("figures", "--configfile", "config/smoke.yaml", str(path))
    assert (planned["simulate"], planned["capacity"], "warmup" in planned) == (1, 1, False)


@pytest.mark.slow
def test_an_unstable_run_is_a_result(smoked):
    (smoked.folder / "unstable.yaml").write_text(
        "results: blown\nscene: {duration: 4.0}\ntopology: {crosshatch: [2], polygon: []}\n"
        "numerics: {accuracy: null, time_step: 1.0e-3, force_time_step: true}\n"
    )
    smoked.snakemake("figures", "--configfile", "unstable.yaml")
    blown = smoked.folder / "blown"
    (response,) = blown.glob("runs/*/response.nc")
    attributes = load(response).attrs
    assert attributes["status"] == "unstable" and attributes["unstable_at"] < 4.0
    table = pd.read_csv(blown / "tables" / "topology.csv")
    assert list(table["status"]) == ["unstable"] and table["c_nl"].isna().all()
    assert (blown / "figures" / "topology.png").exists()


@pytest.mark.slow
def test_the_same_bytes_again(smoked):
    smoked.snakemake("figures", *SMOKE[:-1], "results=again")
    first, second = smoked.folder / "out", smoked.folder / "again"
    files = [path for part in ("runs", "tables", "figures") for path in (first / part).rglob("*")]
    files = [path for path in files if path.is_file() and "published" not in str(path)]
    assert len(files) > 12
    for path in files:
        other = second / path.relative_to(first)
        assert path.read_bytes() == other.read_bytes(), path.name


@pytest.mark.slow
def test_the_second_setup_joins_the_tables_for_good(smoked):
    """Last: it adds to what the tests above look at."""
    path = smoked.folder / "smallest.yaml"
    path.write_text("results: out\ntopology: {crosshatch: [2], polygon: []}\n")
    smallest = ("--configfile", "config/smoke.yaml", str(path))
    expected = jobs(1, "published")
    del expected["warmup"]
    smoked.snakemake("figures", *smallest)
    assert smoked.jobs("published", *smallest) == expected
    for target in ("figures", "published", "topology", "claims"):
        assert smoked.planned(target, *smallest) == {}, target
    table = pd.read_csv(smoked.folder / "out" / "tables" / "topology.csv")
    assert table["setup"].value_counts().to_dict() == {"described": 1, "published": 1}
    assert (smoked.folder / "out" / "figures" / "topology-published.png").exists()
    # a setup that is not complete is not begun by the other's target
    published = next(run for run in table["run"] if "published" in run)
    (smoked.folder / "out" / "runs" / published / "capacity.nc").unlink()
    assert smoked.planned("figures", *smallest) == {"merge": 2, "claims": 1, "figures": 1}


def listed():
    """The modules that each rule names under `input: code=`, by its script."""
    texts = [path.read_text() for path in (ROOT / "workflow" / "rules").glob("*.smk")]
    lists = {
        name: ast.literal_eval(value)
        for text in texts
        for name, value in re.findall(r"^([A-Z]+) = (\(\n.*?^\))", text, re.MULTILINE | re.DOTALL)
    }
    found = {}
    for rule in (rule for text in texts for rule in re.split(r"^rule ", text, flags=re.MULTILINE)):
        if call := re.search(r"code=code\((.*?)\)", rule, flags=re.DOTALL):
            patterns = eval(f"[{call[1]}]", {}, lists)
            script = re.search(r"scripts/(\w+\.py)", rule)[1]
            found[script] = {p for each in patterns for p in (ROOT / "fiberweb").glob(each)}
    return found


def imported(file):
    """Modules of the package that a file imports, anywhere in it."""
    package, names = ROOT / "fiberweb", set()
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("fiberweb"):
            if node.module == "fiberweb.tables" and [a.name for a in node.names] == ["write"]:
                continue  # how a table is written is no reason to measure or simulate again
            names |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
    paths = {package.parent / (name.replace(".", "/") + ".py") for name in names}
    return {path for path in paths if path.exists()}


@pytest.mark.parametrize("script", listed())
def test_rules_name_the_modules_they_use(script):
    """Followed through imports, except into modules that only read and write for this rule."""
    computing = {"simulate.py": {"dataset.py"}, "topology_tables.py": {"tables.py"}}
    shut = {"dataset.py", "tables.py"} - computing.get(script, set())
    queue, used = [ROOT / "workflow" / "scripts" / script], set()
    while queue:
        file = queue.pop()
        if file.name not in shut:
            new = imported(file) - used
            used |= new
            queue += new
    messages_only = {ROOT / "fiberweb" / name for name in ("errors.py", "explain.py")}
    assert used - messages_only <= listed()[script]
