"""How far a call of the workflow is and when it will be finished: a line on its own screen now and
then, and a file that another terminal can ask for it (`python -m fiberweb.tools.status`)."""

from __future__ import annotations

import contextlib
import json
import logging
import os
import sys
import threading
import time
from collections.abc import Callable, Mapping
from datetime import datetime
from pathlib import Path
from typing import NamedTuple

FILE = "progress.json"
FINISHED, FAILED = "finished", "failed"  # how a call ended
BETWEEN = 30.0  # s from one line on the screen to the next
WRITTEN = 5.0  # s from one writing of the file to the next
RUN = "simulate"  # the rule that makes a run
MEANINGS = {
    "line": "how many runs and jobs are done, and when all will be",
    "pid": "number of Snakemake's process",
    "command": "the call, its words as a list",
    "ended": f"how it ended: {FINISHED} or {FAILED}; empty while it runs, and where it was killed",
    "begun": ("when it began, from 1970 on, UTC", "s"),
    "at": ("when this was written, from 1970 on, UTC", "s"),
}


class Job(NamedTuple):
    """What is to be known of a job.

    Attributes:
        rule: that makes it.
        about: what it belongs to, for people: "ridge, described".
        weight: expected cost, in a unit that all jobs of the rule share.
    """

    rule: str
    about: str = ""
    weight: float = 1.0


class Progress(logging.Handler):
    """Listens to Snakemake's log, and says how far it is.

    What is left is expected to take what it took so far: seconds per weight of each rule, measured
    on the jobs that ended, with as many jobs side by side as there were on average.

    Args:
        results: folder of all results.
        jobs: gives what every job that is to run is, by its number; asked again when a job starts
            that was not among them.
    """

    def __init__(self, results: str | Path, jobs: Callable[[], Mapping[int, Job]]):
        super().__init__()
        self.path = Path(results) / FILE
        self.command = sys.argv[:]
        self.ask, self.jobs = jobs, dict(jobs())
        self.begun = self.said = self.written = time.time()
        self.started: dict[int, float] = {}
        self.took: dict[int, float] = {}
        self.at = ""  # what the job that started last is about
        self.counting = threading.Lock()
        self.write()

    def emit(self, record: logging.LogRecord) -> None:
        """Take note of jobs that start or end."""
        event = getattr(getattr(record, "event", None), "value", None)
        with self.counting:
            if event == "job_started":
                self.start(record.jobs)
            elif event == "job_finished":
                self.finish(record.job_id)

    def start(self, numbers: list[int]) -> None:
        """Jobs start."""
        if not self.jobs.keys() >= set(numbers):  # found by a checkpoint
            self.jobs |= self.ask()
        for number in numbers:
            self.started[number] = time.time()
            self.at = self.jobs[number].about if number in self.jobs else self.at

    def finish(self, number: int) -> None:
        """A job has ended well."""
        now = time.time()
        self.took[number] = now - self.started.get(number, now)
        if now - self.said > BETWEEN:
            self.said = now
            print(f"[{clock(now)}] {self.line()}", file=sys.stderr, flush=True)
        if now - self.written > WRITTEN:
            self.written = now
            self.write()

    def left(self) -> float:
        """Seconds that the rest is expected to take; NaN before any job has ended."""
        seconds: dict[str, float] = {}
        weights: dict[str, float] = {}
        for number in self.took.keys() & self.jobs.keys():
            rule, _, weight = self.jobs[number]
            seconds[rule] = seconds.get(rule, 0.0) + self.took[number]
            weights[rule] = weights.get(rule, 0.0) + weight
        busy = sum(self.took.values())
        if not busy:
            return float("nan")
        mean = busy / len(self.took)  # of rules of which none has ended
        now, rest = time.time(), 0.0
        for number, (rule, _, weight) in self.jobs.items():
            if number not in self.took:
                expected = weight * seconds[rule] / weights[rule] if rule in seconds else mean
                since = now - self.started[number] if number in self.started else 0.0
                rest += max(0.0, expected - since)
                busy += since
        return rest / max(1.0, busy / (now - self.begun))

    def line(self) -> str:
        """How many runs are done, of what the last one is, and when all will be finished."""
        runs = [number for number, job in self.jobs.items() if job.rule == RUN]
        done = sum(number in self.took for number in runs)
        counted = f"{done} of {len(runs)} runs and {len(self.took)} of {len(self.jobs)} jobs done"
        left = self.left()
        if len(self.took) == len(self.jobs) or not left >= 0.0:
            return counted
        end = f"finished at about {clock(time.time() + left)}, in {span(left)}"
        return ", ".join(filter(None, (counted, f"now {self.at}" * bool(self.at), end)))

    def write(self, ended: str = "") -> None:
        """Leave it in the file; ended: `FINISHED` or `FAILED`, once the call has."""
        state = {
            "line": self.line(), "pid": os.getpid(), "command": self.command, "ended": ended,
            "begun": self.begun, "at": time.time(),
        }  # fmt: skip
        with contextlib.suppress(OSError):  # a full disk stops jobs, which say so, and not this
            self.path.parent.mkdir(parents=True, exist_ok=True)
            partial = self.path.with_suffix(".partial")
            partial.write_text(json.dumps(state, indent=2), encoding="utf-8")
            partial.replace(self.path)


def clock(moment: float) -> str:
    """A time of day, with the day if it is not today."""
    then = datetime.fromtimestamp(moment)
    return then.strftime(
        "%H:%M" if then.date() == datetime.fromtimestamp(time.time()).date() else "%a %H:%M"
    )


def span(seconds: float) -> str:
    """A number of seconds as people say it: 40 s, 12 min or 3 h 20 min."""
    minutes = round(seconds / 60)
    if minutes >= 60:
        return f"{minutes // 60} h {minutes % 60} min"
    return f"{minutes} min" if minutes else f"{seconds:.0f} s"
