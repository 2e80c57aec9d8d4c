"""A job, Snakemake, or all of them killed; Ctrl-C; two calls at once."""

import os
import signal
from pathlib import Path

import psutil
import pytest

from tests.faults.conftest import TARGET, finished

STAGES = ("simulate", "capacity", "figures")


def resumed(tree, before, expected):
    """Resume, and see that nothing is lost and nothing is done twice."""
    printed = tree.resume()
    assert f"Going on with: snakemake {' '.join(TARGET)}" in printed
    runs = sum("response.nc" in name for name in expected)
    assert finished(printed) == runs - finished(before)
    assert tree.made() == expected
    assert "there is nothing to resume" in tree.resume()


@pytest.mark.parametrize("stage", STAGES)
def test_a_job_is_killed(fresh, expected, stage):
    call = fresh.start()
    fresh.job(call, stage).kill()
    assert call.wait() != 0
    printed = fresh.printed()
    assert "has no end: its job was killed" in printed and "`make resume`" in printed
    resumed(fresh, printed, expected)


@pytest.mark.parametrize("stage", STAGES)
def test_snakemake_is_killed_and_its_jobs_go_on(fresh, expected, stage):
    call = fresh.start()
    job = fresh.job(call, stage)
    call.kill()
    call.wait()
    locks = fresh.folder / ".snakemake" / "locks"
    refused = fresh.resume(expected=1)
    assert "jobs are still at work" in refused and str(job.pid) in refused
    assert locks.is_dir()
    job.resume()
    psutil.wait_procs([job], timeout=60)
    resumed(fresh, fresh.printed(), expected)


@pytest.mark.parametrize("stage", STAGES)
def test_all_are_killed(fresh, expected, stage):
    call = fresh.start()
    fresh.job(call, stage)
    os.killpg(call.pid, signal.SIGKILL)
    call.wait()
    assert "Directory cannot be locked" in fresh.run(expected=1)
    resumed(fresh, fresh.printed(), expected)


@pytest.mark.parametrize("stage", STAGES)
def test_ctrl_c(fresh, expected, stage):
    call = fresh.start()
    job = fresh.job(call, stage)
    os.killpg(call.pid, signal.SIGINT)
    job.resume()
    assert call.wait(timeout=60) != 0
    assert "Traceback" not in fresh.printed()
    resumed(fresh, fresh.printed(), expected)


def test_two_calls_at_once(fresh, expected):
    call = fresh.start()
    job = fresh.job(call, "simulate")
    assert "Directory cannot be locked" in fresh.run(expected=1)
    refused = fresh.resume(expected=1)
    assert f"`snakemake {' '.join(TARGET)}` is at work" in refused and str(call.pid) in refused
    job.resume()
    assert call.wait() == 0, fresh.printed()
    assert fresh.made() == expected


def test_what_was_killed_while_it_wrote_leaves_nothing(fresh, expected):
    call = fresh.start()
    job = fresh.job(call, "simulate")
    (log,) = {Path(file.path) for file in job.open_files() if file.path.endswith(".log")}
    (fresh.out / "runs" / log.stem / f".response.nc.{job.pid}").write_bytes(b"half")
    os.killpg(call.pid, signal.SIGKILL)
    call.wait()
    resumed(fresh, fresh.printed(), expected)
