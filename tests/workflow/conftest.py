"""A copy of the tree, so that files can be edited."""

import fcntl
import multiprocessing
import os
import re
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
COPIED = ("Snakefile", "config", "envs", "fiberweb", "profiles", "workflow")
SMOKE = ("--configfile", "config/smoke.yaml", "--config", "results=out")

FORKS = multiprocessing.get_context("forkserver")
FORKS.set_forkserver_preload(
    [
        "snakemake.cli",
        "numba",
        "pandas",
        "pydantic",
        "scipy.interpolate",
        "scipy.optimize",
        __name__,
    ]
)


def dry_run(tree, arguments):
    """`python -m snakemake` in this process, which has nothing of this package imported."""
    for stream, path in enumerate(tree.printed, start=1):
        os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), stream)
    assert "fiberweb" not in sys.modules
    os.chdir(tree.folder)
    os.environ.clear()
    os.environ.update(tree.environment)
    sys.path.insert(0, str(tree.folder))
    sys.argv = ["snakemake", *map(str, arguments)]
    from snakemake.cli import main

    main()


@cache
def snakemakes_parser():
    from snakemake.cli import get_argument_parser

    return get_argument_parser()


def within_a_call(function, call):
    """What a function returns within Snakemake's own, which have read a command line."""
    args = snakemakes_parser().parse_known_args(call)[0]
    return function(), args


class Tree:
    """A copy of what the workflow needs, and Snakemake in it."""

    def __init__(self, folder):
        self.folder = folder / "tree"
        self.folder.mkdir()
        for name in COPIED:
            source = ROOT / name
            copy = shutil.copytree if source.is_dir() else shutil.copy2
            copy(source, self.folder / name)
        self.printed = folder / "stdout", folder / "stderr"
        self.environment = os.environ | {"PYTHONPATH": str(self.folder)}

    def snakemake(self, *arguments, cores=2):
        """What a call that must succeed prints."""
        code, printed = self.call(*arguments, "--cores", str(cores))
        assert code == 0, printed
        return printed

    def refused(self, *arguments):
        """What a dry run that must fail prints."""
        code, printed = self.call(*arguments, "--dry-run", "--cores", "1")
        assert code != 0, printed
        return printed

    def call(self, *arguments):
        """Exit code of a call and what it prints; a dry run, which starts no job, is a fork of a
        process that has imported what takes longer than the run."""
        if "--dry-run" in arguments:
            process = FORKS.Process(target=dry_run, args=(self, arguments))
            process.start()
            process.join()
            return process.exitcode, "".join(out.read_text() for out in self.printed)
        done = subprocess.run(
            [sys.executable, "-m", "snakemake", *arguments],
            cwd=self.folder, env=self.environment, capture_output=True, text=True,
        )  # fmt: skip
        return done.returncode, done.stdout + done.stderr

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


@pytest.fixture(scope="session")
def tree(tmp_path_factory):
    return Tree(tmp_path_factory.mktemp("workflow"))


@pytest.fixture(scope="session")
def smoked(tree, tmp_path_factory):
    """The tree after the smoke run, which is made once for all processes that run tests."""
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    with open(shared / "smoke", "a+") as made:
        fcntl.flock(made, fcntl.LOCK_EX)
        made.seek(0)
        if not (folder := made.read()):
            first = Tree(tmp_path_factory.mktemp("smoked"))
            first.snakemake("figures", *SMOKE)
            made.write(folder := str(first.folder))
    shutil.copytree(folder, tree.folder, dirs_exist_ok=True)
    return tree


@pytest.fixture
def edited(smoked):
    """Append a line to a file of the tree; undone after the test, time stamps included."""
    kept = []

    def edit(name, text="\n# edited\n", start=None):
        path = smoked.folder / name
        kept.append((path, path.read_bytes(), path.stat()))
        path.write_text((path.read_text() if start is None else start) + text)

    yield edit
    for path, content, stat in reversed(kept):
        path.write_bytes(content)
        os.utime(path, ns=(stat.st_atime_ns, stat.st_mtime_ns))
