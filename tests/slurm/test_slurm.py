"""The smoke run through SLURM: the same bytes as on this machine, with the controller or the node
killed midway; and how it scales, which `-s` shows."""

import os
import subprocess
import sys
import time

import pytest

from tests.workflow.conftest import Tree

SMOKE = ("figures", "--configfile", "config/smoke.yaml")
LARGE = "topology: {crosshatch: [8, 9, 10, 11], polygon: []}"
# without accounting, asked how jobs are every 5 s instead of 40, and with the environment of the
# caller as everywhere
SLURM = (
    "--profile", "profiles/slurm", "--slurm-status-command", "squeue",
    "--slurm-init-seconds-before-status-checks", "5",
)  # fmt: skip


@pytest.fixture(scope="session")
def tree(tmp_path_factory):
    return Tree(tmp_path_factory.mktemp("workflow"))


def made(results):
    files = [path for part in ("runs", "tables", "figures") for path in (results / part).rglob("*")]
    return {str(path.relative_to(results)): path.read_bytes() for path in files if path.is_file()}


def through_slurm(tree, *arguments):
    """Start a call through SLURM, and where it prints to."""
    printed = tree.folder / "printed"
    with printed.open("w") as file:
        call = subprocess.Popen(
            [sys.executable, "-m", "snakemake", *arguments, *SLURM],
            cwd=tree.folder, env=tree.environment, stdout=file, stderr=subprocess.STDOUT,
        )  # fmt: skip
    return call, printed


def wait_for_a_response(call, results):
    while call.poll() is None and not list((results / "runs").glob("*/response.nc")):
        time.sleep(1.0)
    assert call.poll() is None, "it ended before anything could happen to it"


@pytest.fixture(scope="session")
def here(tree):
    """What the smoke run makes without SLURM."""
    tree.snakemake(*SMOKE, "--config", "results=here")
    files = made(tree.folder / "here")
    assert len(files) > 100
    return files


def test_the_smoke_run_is_the_same_though_the_controller_is_killed(cluster, tree, here):
    call, printed = through_slurm(tree, *SMOKE, "--config", "results=there")
    wait_for_a_response(call, tree.folder / "there")
    cluster.kill_controller()
    time.sleep(20.0)
    cluster.start_controller()
    assert call.wait() == 0, printed.read_text()
    there = made(tree.folder / "there")
    assert here.keys() == there.keys()
    assert [name for name in here if here[name] != there[name]] == []


def test_a_node_that_dies_loses_no_run(cluster, tree, here):
    target = ("ridge", *SMOKE[1:], "--config", "results=anew")
    call, printed = through_slurm(tree, *target)
    wait_for_a_response(call, tree.folder / "anew")
    cluster.kill_node()
    cluster.start_node()
    assert call.wait() == 0, printed.read_text()
    anew = made(tree.folder / "anew")
    assert "figures/ridge.png" in anew
    assert [name for name in anew if here[name] != anew[name]] == []


def in_the_queue():
    asked = ["squeue", "--me", "--noheader"]
    return subprocess.run(asked, capture_output=True, text=True, check=True).stdout


def test_no_call_is_resumed_while_jobs_of_it_are_in_the_queue(cluster, tree, here):
    target = ("topology", *SMOKE[1:], "--config", "results=killed")
    call, printed = through_slurm(tree, *target, "--group-components", "runs=1")
    while not in_the_queue():
        assert call.poll() is None, printed.read_text()
        time.sleep(0.2)
    call.kill()
    call.wait()
    resume = [sys.executable, "-m", "fiberweb.tools.resume"]
    given = {"cwd": tree.folder, "env": tree.environment, "capture_output": True, "text": True}
    refused = subprocess.run(resume, **given)
    assert refused.returncode == 1
    assert f"SLURM still has jobs of a call in {tree.folder}" in refused.stderr
    subprocess.run(["scancel", "--me"], check=True)
    while in_the_queue():
        time.sleep(1.0)
    went_on = subprocess.run(resume, **given)
    assert went_on.returncode == 0, went_on.stdout + went_on.stderr
    killed = made(tree.folder / "killed")
    assert "figures/topology.png" in killed
    assert [name for name in killed if here[name] != killed[name]] == []


def test_two_jobs_at_once_are_faster_and_more_than_cores_are_not(cluster, tree):
    """Of four runs of a minute or less each; prints the wall times."""
    (tree.folder / "large.yaml").write_text(LARGE)
    seconds = {}
    for jobs in (1, 2, 4):
        begun = time.monotonic()
        call, printed = through_slurm(
            tree, f"by-{jobs}/tables/described/topology.csv", "--configfile", "large.yaml",
            "--config", f"results=by-{jobs}", "--jobs", str(jobs), "--group-components", "runs=1",
        )  # fmt: skip
        assert call.wait() == 0, printed.read_text()
        seconds[jobs] = time.monotonic() - begun
    print({jobs: round(took) for jobs, took in seconds.items()}, "s by jobs at once")
    one, two, four = (made(tree.folder / f"by-{jobs}") for jobs in seconds)
    assert one == two == four
    assert seconds[2] < 0.75 * seconds[1]
    assert os.cpu_count() > 2 or seconds[4] > 0.75 * seconds[2]
