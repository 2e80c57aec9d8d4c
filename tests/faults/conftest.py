"""Real signals, disks and permissions: `make test-faults`, or pytest with FAULTS=1. Elsewhere
nothing here is collected."""

import os
import re
import shutil
import subprocess
import sys
import time

import psutil
import pytest

from tests.workflow.conftest import Tree

collect_ignore_glob = [] if os.environ.get("FAULTS") else ["test_*.py"]

# A job has a Python of its own or, where a call has more jobs than this, is a fork of one process.
WAYS = {"own": "> 8", "forks": "> 0"}
TARGET = ("out/figures/topology.png", "--configfile", "tiny.yaml", "--cores", "2")
TINY = """
results: out
scene: {duration: 3.3}
numerics: {accuracy: draft}
topology: {crosshatch: [2], polygon: []}
"""


class Faulty(Tree):
    """A clone with the smallest of configs, of which calls and jobs can be disturbed."""

    def __init__(self, folder, way):
        super().__init__(folder)
        self.out = self.folder / "out"
        (self.folder / "tiny.yaml").write_text(TINY)
        snakefile = self.folder / "Snakefile"
        text = snakefile.read_text()
        assert WAYS["own"] in text
        snakefile.write_text(text.replace(WAYS["own"], WAYS[way]))

    def call(self, *command, expected=0, **environment):
        """What a command prints, which must end in the code expected (None: in any but 0)."""
        done = subprocess.run(
            command, cwd=self.folder, env=self.environment | environment, text=True,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=3600,
        )  # fmt: skip
        good = done.returncode == expected if expected is not None else done.returncode != 0
        assert good, f"{done.returncode}\n{done.stdout}"
        return done.stdout

    def run(self, *more, **given):
        return self.call(sys.executable, "-m", "snakemake", *TARGET, *more, **given)

    def resume(self, *more, **given):
        return self.call(sys.executable, "-m", "fiberweb.tools.resume", *more, **given)

    def start(self, resume=False):
        """Start a call, alone in its group of processes, as a shell does."""
        first = [sys.executable, "-m", "snakemake", *TARGET]
        return subprocess.Popen(
            [sys.executable, "-m", "fiberweb.tools.resume"] if resume else first,
            cwd=self.folder, env=self.environment, text=True, start_new_session=True,
            stdout=(self.folder / "printed").open("a"), stderr=subprocess.STDOUT,
        )  # fmt: skip

    def said(self):
        """What the calls that were started have said."""
        return (self.folder / "printed").read_text()

    def job(self, call, stage):
        """The first process of a call that is at work on a job of a stage, and is stopped there."""
        began, logs = time.time_ns(), self.out / "logs" / stage
        while call.poll() is None:
            started = {str(log) for log in logs.glob("*") if log.stat().st_mtime_ns > began}
            for process in psutil.Process(call.pid).children(recursive=True) if started else []:
                try:
                    if not started.isdisjoint(file.path for file in process.open_files()):
                        process.suspend()
                        return process
                except psutil.Error:
                    continue
            time.sleep(0.005)
        raise AssertionError(f"no job of {stage} was seen\n{self.said()}")

    def made(self):
        """Content of all that is made, by path."""
        folders = ("runs", "tables", "figures")
        files = [path for folder in folders for path in (self.out / folder).rglob("*")]
        return {
            str(path.relative_to(self.out)): path.read_bytes() for path in files if path.is_file()
        }


def finished(printed, rule="simulate"):
    """Count of jobs of a rule that Snakemake has seen end well."""
    return len(re.findall(rf"^Finished jobid: \d+ \(Rule: {rule}\)", printed, re.MULTILINE))


@pytest.fixture(scope="session", params=WAYS)
def undisturbed(request, tmp_path_factory):
    """(how jobs are run, a clone in which nothing went wrong)"""
    tree = Faulty(tmp_path_factory.mktemp("undisturbed"), request.param)
    printed = tree.run()
    assert (tree.out / "logs" / "forks.log").exists() == (request.param == "forks"), printed
    return request.param, tree


one_way = pytest.mark.parametrize("undisturbed", ["own"], indirect=True)


@pytest.fixture
def expected(undisturbed):
    """What is made where nothing goes wrong."""
    return undisturbed[1].made()


@pytest.fixture
def fresh(undisturbed, tmp_path):
    """A clone in which nothing was done."""
    return Faulty(tmp_path, undisturbed[0])


@pytest.fixture
def done(undisturbed, tmp_path):
    """A clone in which all was made."""
    way, before = undisturbed
    tree = Faulty(tmp_path, way)
    shutil.copytree(before.out, tree.out)
    shutil.copytree(before.folder / ".snakemake", tree.folder / ".snakemake")
    return tree
