"""What jobs note of the files that they wrote, and which of those were cut short since.

A disk that fills up, a copy that breaks off or a machine that loses power leaves files that exist
and are not whole. Not every format tells, a table least of all, so a job's log ends in the size and
the checksum of each file that it made. Every call looks at the sizes; at the content, which takes
long, one that resumes another.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable
from glob import escape
from pathlib import Path

NOTE = re.compile(r"^wrote (.+), (\d+) bytes(?:, sha256 (\w+))?$", re.MULTILINE)
READ_ALL = "FIBERWEB_READ_ALL"  # variable with which content is looked at as well
LOGS = "logs"  # folder of the logs among the results
BESIDE = "-metadata.json"  # end of the name of what says what a table rests on


def clear(paths: Iterable[str | Path]) -> None:
    """Delete what a job that was killed left of these files under their temporary names."""
    for path in map(Path, paths):
        for left in path.parent.glob(f".{escape(path.name)}.*"):
            left.unlink(missing_ok=True)


def note(log: str | Path, paths: Iterable[str | Path]) -> None:
    """Print size and checksum of those files that exist, and of what lies beside them; they are
    named as seen from the results.

    Args:
        log: of the job, somewhere in <results>/logs.
        paths: of the files, in <results> as well.
    """
    results = next(folder.parent for folder in Path(log).parents if folder.name == LOGS)
    for path in (Path(f"{made}{end}") for made in paths for end in ("", BESIDE)):
        if path.exists():
            name, size = path.relative_to(results).as_posix(), path.stat().st_size
            print(f"wrote {name}, {size} bytes, sha256 {_checksum(path)}")


def broken(results: str | Path, read_all: bool = False) -> dict[str, str]:
    """Files of another size than their jobs left them with, or with `read_all` of other content,
    and a sentence on each. A table is broken where what lies beside it is, or is gone.

    A file without a note, such as that of a job at work, is taken for whole.
    """
    found = {}
    for log in sorted(Path(results, LOGS).rglob("*.log")):
        for name, size, checksum in NOTE.findall(log.read_text("utf-8", errors="replace")):
            path, made = Path(results, name), Path(results, name.removesuffix(BESIDE))
            if not made.exists():
                continue
            if not path.exists():
                found[str(made)] = f"{path} is gone"
            elif (left := path.stat().st_size) != int(size):
                found[str(made)] = f"{path} is broken: it has {left} bytes of the {size} written"
            elif read_all and checksum and _checksum(path) != checksum:
                found[str(made)] = f"{path} is broken: its content is not what was written"
    return found


def _checksum(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
