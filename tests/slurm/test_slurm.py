"""The smoke run through SLURM: the same bytes as on this machine, with the controller killed once
midway."""

import subprocess
import sys
import time

import pytest

from tests.workflow.conftest import Tree

SMOKE = ("figures", "--configfile", "config/smoke.yaml")
# without accounting, and with the environment of the caller as everywhere
SLURM = ("--profile", "profiles/slurm", "--slurm-status-command", "squeue")


@pytest.fixture(scope="session")
def tree(tmp_path_factory):
    return Tree(tmp_path_factory.mktemp("workflow"))


def made(results):
    files = [path for part in ("runs", "tables", "figures") for path in (results / part).rglob("*")]
    return {str(path.relative_to(results)): path.read_bytes() for path in files if path.is_file()}


def test_the_smoke_run_is_the_same_though_the_controller_is_killed(cluster, tree):
    tree.snakemake(*SMOKE, "--config", "results=here")
    with (tree.folder / "printed").open("w") as file:
        call = subprocess.Popen(
            [sys.executable, "-m", "snakemake", *SMOKE, "--config", "results=there", *SLURM],
            cwd=tree.folder, env=tree.environment, stdout=file, stderr=subprocess.STDOUT,
        )  # fmt: skip
    killed = False
    while call.poll() is None:
        if not killed and list((tree.folder / "there" / "runs").glob("*/response.nc")):
            cluster.kill_controller()
            time.sleep(20.0)
            cluster.start_controller()
            killed = True
        time.sleep(1.0)
    printed = (tree.folder / "printed").read_text()
    assert call.returncode == 0, printed
    assert killed
    here, there = made(tree.folder / "here"), made(tree.folder / "there")
    assert len(here) > 100 and here.keys() == there.keys()
    assert [name for name in here if here[name] != there[name]] == []
