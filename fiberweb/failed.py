"""The last lines on the screen after a job has failed: which, why, and what to do."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

from fiberweb import timed
from fiberweb.runs import Run

AGAIN = "give the same command again"
# what is in the last line of a log, and what helps
REMEDIES = {
    "No space left on device": f"free some space, then {AGAIN}",
    "Read-only file system": "name a folder that can be written, --config results=FOLDER",
    "Permission denied": "name a folder that can be written, --config results=FOLDER",
    "MemoryError": f"{AGAIN} with fewer --cores",
    "cannot be read": f"`make resume`, or delete that file and {AGAIN}",
    "ValueError": f"change what it names, then {AGAIN}",
}
REPORT = "this should not happen: please report it with the log, as CONTRIBUTING.md says"
KILLED = "its log has no end: it was killed (out of memory?), or the disk is full"
NOTES = re.compile(r"^(wrote|took) ")
SHOWN = 5


def line(rule: str, wildcards: Mapping[str, str], log: str | Path, key: str | None = None) -> str:
    """One line on a job that failed.

    Args:
        rule, wildcards: of the job.
        log: its file.
        key: of the config that asks for the run; None of other jobs.
    """
    what = " ".join(filter(None, [rule, *wildcards.values()])) + (
        f", which {key} asks for," if key else ""
    )
    reason = _reason(Path(log))
    helps = (remedy for words, remedy in REMEDIES.items() if words in reason)
    remedy = next(helps, REPORT)
    if reason == KILLED:
        remedy = f"take fewer --cores, or free some space, then {AGAIN}"
    return f"{what} failed: {reason}. Log: {log}. What to do: {remedy}."


def tell(jobs: Iterable, runs: Mapping[str, Run]) -> None:
    """Print the lines of those of Snakemake's jobs that failed, of many the first ones and before
    them how many there are.

    Args:
        jobs: that failed; or groups of jobs.
        runs: the run table, by name.
    """
    lines = []
    for job in (job for each in jobs for job in getattr(each, "jobs", [each])):
        run = runs.get(job.wildcards_dict.get("run"))
        lines.append(line(job.rule.name, job.wildcards_dict, *job.log[:1], key=run and run.study))
    if len(lines) > SHOWN:
        lines = [f"{len(lines)} jobs failed, of which {SHOWN}:", *lines[:SHOWN]]
    print(*lines, sep="\n", file=sys.stderr)


def _reason(log: Path) -> str:
    """The last thing that a job said before it ended."""
    try:
        text = log.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return "it left no log"
    if not timed.read(text):
        return KILLED
    said = [each for each in text.splitlines() if each.strip() and not NOTES.match(each)]
    return said[-1].strip().rstrip(".") if said else "it said nothing"
