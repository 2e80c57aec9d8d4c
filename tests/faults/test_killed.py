"""What is killed, Ctrl-C, two calls at once, and others that take the cores."""

import contextlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from tests.faults.conftest import TARGET, TINY, finished

STAGES = ("simulate", "capacity", "figures")
RULES = ("simulate", "capacity", "figure")


def kill_job(tree, call, job):
    job.kill()
    assert call.wait() != 0
    assert "its log has no end: it was killed" in tree.said()


def kill_snakemake(tree, call, job):
    """Its jobs go on: nobody may be at work when it is unlocked."""
    family = [psutil.Process(call.pid), *psutil.Process(call.pid).children()]
    (snakemake,) = [each for each in family if "snakemake" in each.cmdline()]
    snakemake.kill()
    call.wait()
    refused = tree.resume(expected=1)
    assert "jobs are still at work" in refused and str(job.pid) in refused
    assert (tree.folder / ".snakemake" / "locks").is_dir()
    job.resume()
    _, alive = psutil.wait_procs([job], timeout=600)
    assert not alive


def kill_all(tree, call, job):
    os.killpg(call.pid, signal.SIGKILL)
    call.wait()
    _, alive = psutil.wait_procs([job], timeout=600)
    assert not alive


def interrupt(tree, call, job):
    os.killpg(call.pid, signal.SIGINT)
    with contextlib.suppress(psutil.NoSuchProcess):  # where Snakemake itself was quicker to end it
        job.resume()
    assert call.wait(timeout=600) != 0
    assert "Traceback" not in tree.said()


@pytest.mark.parametrize("end", [kill_job, kill_snakemake, kill_all, interrupt])
def test_what_is_killed_in_every_stage_goes_on(fresh, expected, end):
    """Each stage in turn, the first call and then those that resume it."""
    for stage in STAGES:
        call = fresh.start(resume=stage != STAGES[0])
        end(fresh, call, fresh.job(call, stage))
    printed = fresh.resume()
    assert f"Going on with: snakemake {' '.join(TARGET)}" in printed
    assert [finished(fresh.said() + printed, rule) for rule in RULES] == [1, 1, 1]
    assert fresh.made() == expected
    assert "there is nothing to resume" in fresh.resume()


def test_what_had_ended_well_is_not_done_again(fresh, expected):
    """Of six runs at least one had, when all are killed."""
    (fresh.folder / "tiny.yaml").write_text(TINY.replace("[2]", "[2, 3, 4, 5, 6, 7]"))
    call = fresh.start()
    while not finished(fresh.said()):
        assert call.poll() is None, fresh.said()
        time.sleep(0.01)
    kill_all(fresh, call, fresh.job(call, "simulate"))
    before = finished(fresh.said())
    assert before < 6
    printed = fresh.resume()
    assert finished(printed) == 6 - before
    made = fresh.made()
    assert {
        path: made[path] for path in expected if path.startswith("runs")
    }.items() <= expected.items()


def test_two_calls_at_once(fresh, expected):
    call = fresh.start()
    job = fresh.job(call, "simulate")
    assert "Directory cannot be locked" in fresh.run(expected=1)
    refused = fresh.resume(expected=1)
    assert f"`snakemake {' '.join(TARGET)}` is at work" in refused and str(call.pid) in refused
    job.resume()
    assert call.wait() == 0, fresh.said()
    assert fresh.made() == expected


def test_beside_others_that_take_all_cores(fresh, expected):
    hungry = [sys.executable, "-c", "while True: pass"]
    others = [subprocess.Popen(hungry) for _ in range(2 * os.cpu_count())]
    try:
        fresh.run()
        assert all(other.poll() is None for other in others)
    finally:
        for other in others:
            other.kill()
            other.wait()
    assert fresh.made() == expected


def test_what_was_killed_while_it_wrote_leaves_nothing(fresh, expected):
    call = fresh.start()
    job = fresh.job(call, "simulate")
    (log,) = {Path(file.path) for file in job.open_files() if file.path.endswith(".log")}
    (fresh.out / "runs" / log.stem / f".response.nc.{job.pid}").write_bytes(b"half")
    os.killpg(call.pid, signal.SIGKILL)
    call.wait()
    assert "Directory cannot be locked" in fresh.run(expected=1)
    fresh.resume()
    assert fresh.made() == expected
