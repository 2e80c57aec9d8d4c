"""CPU time of a job by what it is spent on, for the last line of the job's log."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from time import process_time

TOOK = re.compile(r"^took ((?:\w+ \d+\.\d+ s(?:, )?)+)$", re.MULTILINE)
spent: dict[str, float] = {}  # of this process, s


@contextmanager
def part(name: str) -> Iterator[None]:
    """Count the CPU time of what is done within as spent on `name`."""
    start = process_time()
    try:
        yield
    finally:
        spent[name] = spent.get(name, 0.0) + process_time() - start


def line() -> str:
    """What this process has spent so far: on each part, and on the rest."""
    parts = spent | {"rest": process_time() - sum(spent.values())}
    return "took " + ", ".join(f"{name} {seconds:.3f} s" for name, seconds in parts.items())


def read(log: str) -> dict[str, float]:
    """The last such line of a log as seconds by part; empty without one."""
    found = TOOK.findall(log)
    pairs = (text.split()[:2] for text in found[-1].split(", ")) if found else ()
    return {name: float(seconds) for name, seconds in pairs}
