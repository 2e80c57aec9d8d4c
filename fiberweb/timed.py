"""CPU time of a job by what it is spent on, and its memory, for the last line of the job's log."""

from __future__ import annotations

import re
import resource
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Lock
from time import process_time, thread_time

TOOK = re.compile(r"^took (.+), at most (\d+) MB$", re.MULTILINE)
RSS_UNIT = 1 if sys.platform == "darwin" else 1024  # bytes
spent: dict[str, float] = {}  # of this process, s
_lock = Lock()


@contextmanager
def part(name: str) -> Iterator[None]:
    """Count the CPU time of what is done within as spent on `name`."""
    start = thread_time()  # others may be at work beside this one
    try:
        yield
    finally:
        with _lock:
            spent[name] = spent.get(name, 0.0) + thread_time() - start


def line() -> str:
    """What this process has spent so far, on each part and on the rest, and its largest memory."""
    parts = spent | {"rest": process_time() - sum(spent.values())}
    took = ", ".join(f"{name} {seconds:.3f} s" for name, seconds in parts.items())
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * RSS_UNIT
    return f"took {took}, at most {memory / 1e6:.0f} MB"


def write(results: str | Path, name: str) -> None:
    """Leave what this process has spent in <results>/logs/<name>.log, among those of the jobs."""
    path = Path(results, "logs", f"{name}.log")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(line() + "\n")


def read(log: str) -> dict[str, float]:
    """The last such line of a log as seconds by part; empty without one."""
    found = TOOK.findall(log)
    pairs = (text.split()[:2] for text in found[-1][0].split(", ")) if found else ()
    return {name: float(seconds) for name, seconds in pairs}


def memory(log: str) -> float:
    """The largest memory in the last such line of a log, MB; NaN without one."""
    found = TOOK.findall(log)
    return float(found[-1][1]) if found else float("nan")
