"""How far the workflow is, and when it will be finished."""

import json
import logging
import os
import re
import time
from datetime import datetime
from types import SimpleNamespace

import pytest

from fiberweb import Scene, crosshatch, progress
from fiberweb.engines import load
from fiberweb.progress import Job, Progress
from fiberweb.simulation.plan import expected_seconds, plan
from fiberweb.tools.status import latest, status

JOBS = {1: Job("simulate", "ridge, described", 2.0), 2: Job("simulate", "size, described", 6.0)}
JOBS |= {3: Job("capacity", "ridge, described"), 4: Job("capacity", "size, described")}


@pytest.fixture
def clock(monkeypatch):
    """A clock that is set by hand, at noon."""
    at = SimpleNamespace(now=datetime(2026, 11, 27, 12).timestamp())
    monkeypatch.setattr(time, "time", lambda: at.now)
    return at


def event(name, **values):
    record = logging.makeLogRecord(values)
    record.event = SimpleNamespace(value=name)
    return record


def run(followed, clock, number, seconds):
    followed.handle(event("job_started", jobs=[number]))
    clock.now += seconds
    followed.handle(event("job_finished", job_id=number))


def test_what_is_left_takes_what_it_took(tmp_path, clock, capsys):
    followed = Progress(tmp_path, lambda: JOBS)
    assert followed.line() == "0 of 2 runs and 0 of 4 jobs done"
    run(followed, clock, 1, 60.0)
    # three times the weight: 180 s; of capacities none is known, so 60 s each; one at a time
    assert followed.left() == pytest.approx(180.0 + 2 * 60.0)
    run(followed, clock, 3, 10.0)
    assert followed.left() == pytest.approx(180.0 + 10.0)
    followed.handle(event("job_started", jobs=[2]))
    clock.now += 30.0
    assert followed.left() == pytest.approx(150.0 + 10.0)
    assert capsys.readouterr().err.startswith("[12:01] 1 of 2 runs and 1 of 4 jobs done, now ridge")
    assert followed.line().endswith(", now size, described, finished at about 12:04, in 3 min")


def test_jobs_side_by_side_share_the_time(tmp_path, clock):
    jobs = {number: Job("simulate") for number in range(8)}
    followed = Progress(tmp_path, lambda: jobs)
    for pair in ([0, 1], [2, 3]):
        followed.handle(event("job_started", jobs=pair))
        clock.now += 10.0
        for number in pair:
            followed.handle(event("job_finished", job_id=number))
    assert followed.left() == pytest.approx(4 * 10.0 / 2)


def test_jobs_that_a_checkpoint_finds_are_counted(tmp_path, clock):
    known = {1: JOBS[1]}
    followed = Progress(tmp_path, lambda: known)
    run(followed, clock, 1, 1.0)
    known |= JOBS
    run(followed, clock, 2, 1.0)
    assert followed.line().startswith("2 of 2 runs and 2 of 4 jobs done")


def test_another_terminal_is_told(tmp_path, monkeypatch):
    with pytest.raises(ValueError, match=r"progress\.json is not there: no workflow"):
        status(tmp_path)
    monkeypatch.setattr(progress, "WRITTEN", 0.0)
    followed = Progress(tmp_path, lambda: JOBS)
    followed.handle(event("job_started", jobs=[1]))
    followed.handle(event("job_finished", job_id=1))
    assert status(tmp_path).startswith("1 of 2 runs and 1 of 4 jobs done, now ridge, described")
    followed.write(progress.FAILED)
    assert re.match(r"failed at \d\d:\d\d: 1 of 2 runs.*\nsnakemake", status(tmp_path))
    followed.write()
    path = tmp_path / progress.FILE
    state = json.loads(path.read_text())
    # killed, and its number given to another process since
    path.write_text(json.dumps(state | {"pid": os.getpid(), "begun": 0.0}))
    assert status(tmp_path).startswith("nothing is running: killed after")


def test_the_last_call_is_asked_for(tmp_path, clock):
    assert latest(tmp_path) == tmp_path
    Progress(tmp_path, lambda: JOBS)
    Progress(tmp_path / "smoke", lambda: JOBS)
    os.utime(tmp_path / progress.FILE, ns=(0, 0))
    assert latest(tmp_path) == tmp_path / "smoke"


@pytest.mark.parametrize(
    ("n", "setup", "force"), [(2, "described", 0.05), (8, "described", 0.3), (4, "published", 0.05)]
)
def test_expected_cost_is_about_that_of_the_plan(n, setup, force):
    scene = Scene(crosshatch(n, length=0.5), setup, force=force)
    planned = plan(scene)
    steps = scene.duration / planned.numerics.time_step
    exact = 1e-9 * load(planned.engine).NANOSECONDS * steps * planned.mesh.elements
    assert 0.4 < expected_seconds(scene) / exact < 1.6


@pytest.mark.parametrize(
    ("seconds", "said"),
    [(8.0, "8 s"), (50.0, "1 min"), (3500, "58 min"), (3590, "1 h 0 min"), (9e3, "2 h 30 min")],
)
def test_spans_are_said_as_people_do(seconds, said):
    assert progress.span(seconds) == said


KILLED = {"line": "", "pid": 1, "command": ["snakemake"], "ended": "", "begun": 0.0, "at": 0.0}


@pytest.mark.parametrize(
    "text", ["5", "{}", "[]", "{", "null", *(json.dumps(KILLED | d) for d in (
        {"pid": -1}, {"pid": "x"}, {"at": 1e300}, {"line": 5}, {"command": 5})
    )],
)  # fmt: skip
def test_a_damaged_file_is_named(tmp_path, text):
    (tmp_path / progress.FILE).write_text(text)
    with pytest.raises(ValueError, match=f"^{tmp_path / progress.FILE} is not as a call writes it"):
        status(tmp_path)


def test_a_file_is_no_folder(tmp_path):
    (tmp_path / "README.md").touch()
    with pytest.raises(ValueError, match=r"cannot be read \(Not a directory\): name the folder"):
        status(tmp_path / "README.md")
