"""What jobs note of the files that they wrote, and which of those were cut short since.

A disk that fills up, a copy that breaks off or a machine that loses power leaves files that exist
and are not whole. Not every format tells, a table least of all, so a job's log ends in the size of
each file that it made.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

NOTE = re.compile(r"^wrote (.+), (\d+) bytes$", re.MULTILINE)
LOGS = "logs"  # folder of the logs among the results


def note(log: str | Path, paths: Iterable[str | Path]) -> None:
    """Print the size of those files that exist; they are named as seen from the results.

    Args:
        log: of the job, somewhere in <results>/logs.
        paths: of the files, in <results> as well.
    """
    results = next(folder.parent for folder in Path(log).parents if folder.name == LOGS)
    for path in map(Path, paths):
        if path.exists():
            print(f"wrote {path.relative_to(results).as_posix()}, {path.stat().st_size} bytes")


def cut_short(results: str | Path) -> dict[str, str]:
    """Files of another size than their jobs left them with, and a sentence on each.

    A file without a note, such as that of a job at work, is taken for whole.
    """
    found = {}
    for log in sorted(Path(results, LOGS).rglob("*.log")):
        for name, size in NOTE.findall(log.read_text(encoding="utf-8", errors="replace")):
            path = Path(results, name)
            if path.exists() and (left := path.stat().st_size) != int(size):
                found[str(path)] = f"{path} is broken: it has {left} bytes of the {size} written"
    return found
